// What a rig recorded: a table with a position, a table of force alone, the rig's own description,
// a table with options and all that is judged of it, or a time stamp, by the first byte.
#include "engine/lab/explain/recording/date_time.h"
#include "engine/lab/explain/recording/overview.h"
#include "engine/lab/explain/recording/recording.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

namespace {

/// Every option at once, and what is judged of the recording.
void read_with_options(const std::string& text) {
  explain::ReadingOptions options;
  options.units = {{"f", "gf"}, {"x", "um"}};
  options.negate = {"x", "f"};
  options.surface_mm = 37.4;
  options.lever_mm = 80.0;
  const explain::Recording r = explain::parse_recording_as(text, "recording.csv", options);
  static_cast<void>(explain::judge_conventions(r));
}

}  // namespace

void fuzz_explain(Data data) {
  if (data.empty()) return;
  const std::string text = text_of(data.subspan(1));
  try {
    switch (data[0] % 5) {
      case 2:
        static_cast<void>(explain::parse_rig(text, "rig.toml"));
        break;
      case 3:
        read_with_options(text);
        break;
      case 4:
        static_cast<void>(explain::parse_stamp(text, explain::SlashOrder::month_first));
        break;
      case 0:
        if (const explain::Recording r = explain::parse_recording(text, "recording.csv");
            r.rows() < 1000)
          static_cast<void>(explain::overview_of(r));
        break;
      default:
        static_cast<void>(
            explain::parse_recording(text, "recording.csv", {{"x_mm", "displacement"}}, false));
    }
  } catch (const Error&) {
  }
}

std::vector<Bytes> explain_seeds() {
  const auto with = [](char kind, const std::string& text) { return bytes_of(kind + text); };
  std::string long_one = "session,t_s,x_mm,v_mm_s,f_n,word\n";
  for (int i = 0; i < 20; ++i)
    long_one += std::string(i < 12 ? "a," : "b,") + std::to_string(0.001 * i) + "," +
                std::to_string(0.01 * i) + ",10," + std::to_string(0.2 * i) + ",dry\n";
  return {
      with(0, long_one),
      with(
          0,
          "# a rig\nt_s,displacement,f_n,temperature\r\n0,0,0,20\r\n0.001,0.1,0.5,\r\n0.002,0.2,1.5,21\r\n"),
      with(0, "t_s;x_mm;f_n\n0;1e-3;1\n1;\"2\";-1e0\n"),
      with(1, "t_s,f_n\n0,0\n0.1,1\n0.2,nan\n0.3,2\n"),
      with(
          2,
          "k_n_per_mm = 8.4\nc_n_s_per_mm = 0.6\nposition_quantum_mm = 0.055\nforce_quantum_n = 0.01\nforce_limit_n = 20\nlayer_depths_mm = [0.5, "
          "1.5]\n"),
      with(3,
           "Press 7\nNo.;12\nZeit [ms];Weg [\xb5m];Pr\xfc"
           "fkraft [mN]\n-;-;-\n0;1,5;-2\n5;2,5;-3\n"),
      with(3, "\xef\xbb\xbftime  angle  torque\ns rad Nm\n0 0 0\n1e-3 0.1 2.5\n"),
      with(0, "# t_s x_mm f_n\n0 0 0\n1 1 1\n2 2 2\n"),
      with(
          0,
          "Date,Time,position_in,load_lbf\n2026-11-24,23:59:59.5,1.5,\"0.25\"\n2026-11-25,00:00:00.5,1.6,0.5\n"),
      with(4, "2026-11-24T10:15:30.123+01:00"),
      with(4, "11/24/2026 10:15:30,5 PM")};
}

}  // namespace cavum::fuzz
