// `cavum replay`: simulates recorded sessions again and says whether they are true. Works on one
// file or on a folder, and writes JUnit for CI.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/session/station_key.h"
#include "engine/session/verify.h"
#include "ui/cli/session_files.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

using nlohmann::json;

struct ReplayArguments {
  std::string path, junit;
  std::optional<std::string> station_key;
  bool verify = false, as_json = false;
};

struct Outcome {
  VerifyReport report;
  double seconds = 0;
  std::exception_ptr unreadable;  // set when the file is no session at all
  [[nodiscard]] bool readable() const noexcept { return unreadable == nullptr; }
};

/// In a folder one unusable file is a failed session, not the end of the run.
Outcome verify_timed(const std::string& path, const std::string& station_key) {
  const auto start = std::chrono::steady_clock::now();
  Outcome o;
  try {
    o.report = verify_session(path, station_key);
  } catch (const Error& e) {
    o.report.file = path;
    o.report.findings.push_back(damage<DamageKind::recording_unsound>(e.message()));
    o.unreadable = std::current_exception();
  }
  o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return o;
}

json to_json(const VerifyReport& r) {
  json divergence = nullptr;
  if (const auto& d = r.first_divergence)
    divergence = {
        {"tick", d->tick}, {"what", d->what}, {"recorded", d->recorded}, {"replayed", d->replayed}};
  return {{"file", r.file},
          {"verified", r.verified},
          {"closed", r.closed},
          {"intact", r.intact},
          {"ticks", r.ticks},
          {"ticks_replayed", r.ticks_replayed},
          {"ticks_different", r.ticks_different},
          {"first_divergence", divergence},
          {"findings", r.findings},
          {"speed_x_realtime", r.speed_x_realtime},
          {"station_key", r.station_key}};
}

/// The same names over all sessions; the first divergence is the first session's that has one.
json to_json(const std::string& folder, const std::vector<Outcome>& outcomes) {
  json sum = {{"file", folder},
              {"verified", true},
              {"closed", true},
              {"ticks", 0},
              {"first_divergence", nullptr},
              {"findings", json::array()}};
  json sessions = json::array();
  std::int64_t ticks = 0;
  double realtime_s = 0, replay_s = 0;
  for (const auto& o : outcomes) {
    json one = to_json(o.report);
    sum["verified"] = sum["verified"].get<bool>() && o.report.verified;
    sum["closed"] = sum["closed"].get<bool>() && o.report.closed;
    ticks += o.report.ticks;
    if (o.report.speed_x_realtime > 0) {
      realtime_s += static_cast<double>(o.report.ticks_replayed);
      replay_s += static_cast<double>(o.report.ticks_replayed) / o.report.speed_x_realtime;
    }
    if (sum["first_divergence"].is_null() && !one["first_divergence"].is_null()) {
      sum["first_divergence"] = one["first_divergence"];
      sum["first_divergence"]["file"] = o.report.file;
    }
    for (json f : one["findings"]) {
      f["file"] = o.report.file;
      sum["findings"].push_back(std::move(f));
    }
    sessions.push_back(std::move(one));
  }
  sum["ticks"] = ticks;
  sum["speed_x_realtime"] = replay_s > 0 ? realtime_s / replay_s : 0.0;
  sum["sessions"] = std::move(sessions);
  return sum;
}

std::string to_junit(const std::vector<Outcome>& outcomes) {
  std::size_t failures = 0, errors = 0;
  double seconds = 0;
  for (const auto& o : outcomes) {
    failures += o.readable() && !o.report.verified;
    errors += !o.readable();
    seconds += o.seconds;
  }
  std::ostringstream out;
  out.precision(3);
  out << std::fixed
      << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"cavum replay\" tests=\""
      << outcomes.size() << "\" failures=\"" << failures << "\" errors=\"" << errors << "\" time=\""
      << seconds << "\">\n";
  for (const auto& o : outcomes) {
    out << "  <testcase classname=\"cavum.replay\" name=\"" << xml_text(o.report.file)
        << "\" time=\"" << o.seconds << "\"";
    if (o.report.verified) {
      out << "/>\n";
      continue;
    }
    std::string lines;
    for (const auto& f : o.report.findings) lines += english_text(f.message()) + "\n";
    const char* tag = o.readable() ? "failure" : "error";
    out << ">\n    <" << tag << " message=\""
        << xml_text(o.report.findings.empty() ? "not verified"
                                              : english_text(o.report.findings.front().message()))
        << "\">" << xml_text(lines) << "</" << tag << ">\n  </testcase>\n";
  }
  out << "</testsuite>\n</testsuites>\n";
  return out.str();
}

void print(const Outcome& o) {
  const VerifyReport& r = o.report;
  say(r.verified ? msg("{}: verified", r.file) : msg("{}: NOT VERIFIED", r.file));
  if (r.ticks_replayed > 0)
    say(msg("{} of {} ticks replayed, {} times real time", r.ticks_replayed, r.ticks,
            as_number(r.speed_x_realtime, 0)),
        2);
  if (r.closed) say(msg("closed by station {}", r.station_key), 2);
  for (const auto& f : r.findings) say(msg("- {}", f.message()), 2);
}

int run(const ReplayArguments& options) {
  const std::string station_key =
      options.station_key ? parse_public_key(*options.station_key, "--station-key") : "";
  const bool folder = std::filesystem::is_directory(options.path);
  const std::vector<std::string> sessions =
      folder ? sessions_in(options.path) : std::vector{options.path};
  std::vector<NamedFile> read;
  for (const auto& path : sessions) read.push_back({path, path});
  require_distinct_paths({{"--junit " + options.junit, options.junit}}, read);
  std::vector<Outcome> outcomes;
  for (const auto& path : sessions) outcomes.push_back(verify_timed(path, station_key));
  if (!options.junit.empty())
    write_text_file(options.junit, to_junit(outcomes));  // CI wants its file whatever happened
  if (!folder && !outcomes[0].readable()) std::rethrow_exception(outcomes[0].unreadable);
  if (options.as_json) {
    print_json(folder ? to_json(options.path, outcomes) : to_json(outcomes[0].report));
  } else {
    for (const auto& o : outcomes) print(o);
  }
  const bool all = std::all_of(outcomes.begin(), outcomes.end(),
                               [](const Outcome& o) { return o.report.verified; });
  return all ? 0 : 1;
}

}  // namespace

void add_replay_verbs(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ReplayArguments>();
  CLI::App* verb =
      app.add_subcommand("replay", tr("Simulate a recorded session again and compare every tick"));
  verb->add_option("session", options->path, tr("a .cavum file, or a folder searched for them"))
      ->required();
  verb->add_flag("--verify", options->verify,
                 tr("check chain, signature, every tick, every removed leaf and the final tooth"))
      ->required();
  verb->add_flag("--json", options->as_json, tr("one JSON object on stdout"));
  verb->add_option("--junit", options->junit, tr("also write JUnit XML, one test case a session"));
  verb->add_option("--station-key", options->station_key,
                   tr("public key (hexadecimal) of the station that must have closed it"));
  verb->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace cavum::ui
