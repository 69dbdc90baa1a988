// What a rig recorded: CSV with a position, CSV of force alone, or the rig's own description, by the first byte.
#include "engine/explain/recording/recording.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_explain(Data data) {
  if (data.empty()) return;
  const std::string text = text_of(data.subspan(1));
  try {
    if (data[0] % 3 == 2)
      static_cast<void>(explain::parse_rig(text, "rig.toml"));
    else
      static_cast<void>(explain::parse_recording(text, "recording.csv", {{"x_mm", "displacement"}}, data[0] % 3 == 0));
  } catch (const Error&) {
  }
}

std::vector<Bytes> explain_seeds() {
  const auto with = [](char kind, const std::string& text) { return bytes_of(kind + text); };
  std::string long_one = "session,t_s,x_mm,v_mm_s,f_n,word\n";
  for (int i = 0; i < 20; ++i)
    long_one +=
        std::string(i < 12 ? "a," : "b,") + std::to_string(0.001 * i) + "," + std::to_string(0.01 * i) + ",10," + std::to_string(0.2 * i) + ",dry\n";
  return {
      with(0, long_one), with(0, "# a rig\nt_s,displacement,f_n,temperature\r\n0,0,0,20\r\n0.001,0.1,0.5,\r\n0.002,0.2,1.5,21\r\n"),
      with(0, "t_s;x_mm;f_n\n0;1e-3;1\n1;\"2\";-1e0\n"), with(1, "t_s,f_n\n0,0\n0.1,1\n0.2,nan\n0.3,2\n"),
      with(2,
           "k_n_per_mm = 8.4\nc_n_s_per_mm = 0.6\nposition_quantum_mm = 0.055\nforce_quantum_n = 0.01\nforce_limit_n = 20\nlayer_depths_mm = [0.5, "
           "1.5]\n")};
}

}  // namespace cavum::fuzz
