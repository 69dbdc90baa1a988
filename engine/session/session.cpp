#include "engine/session/session.h"

#include <fmt/core.h>

#include <algorithm>
#include <ctime>
#include <fstream>

namespace cavum {
namespace {

std::int64_t clock_ns(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1000000000 + t.tv_nsec;
}

Artifact artifact(std::string name, Bytes bytes) {
  const Sha256 sum = sha256(bytes);
  return {std::move(name), sum, std::move(bytes)};
}
Artifact artifact(std::string name, const std::string& text) {
  return artifact(std::move(name), Bytes(text.begin(), text.end()));
}

}  // namespace

Clocks read_clocks() {
  return {clock_ns(CLOCK_MONOTONIC), clock_ns(CLOCK_BOOTTIME), clock_ns(CLOCK_REALTIME)};
}

std::string boot_id() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(in, id);
  return id;
}

std::string utc_text(std::int64_t utc_ns) {
  const auto seconds = static_cast<std::time_t>(utc_ns / 1000000000);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char text[32] = {};
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::vector<Artifact> artifacts_of(const SessionSetup& setup) {
  std::vector<Artifact> all;
  all.push_back(artifact("scenario.toml", setup.scenario_toml));
  if (!setup.rubric_toml.empty()) all.push_back(artifact("rubric.toml", setup.rubric_toml));
  all.push_back(artifact("start_tooth.cvt", setup.tooth));
  for (std::size_t i = 0; i < setup.burs_toml.size(); ++i) {
    const std::string number = std::to_string(i);
    all.push_back(
        artifact(fmt::format("bur_{}{}.toml",
                             std::string(3 - std::min<std::size_t>(3, number.size()), '0'), number),
                 setup.burs_toml[i]));
  }
  all.push_back(artifact("force_model.toml", setup.force_model_toml));
  all.push_back(artifact("servo.toml", setup.servo_toml));
  if (!setup.landmarks_json.empty())
    all.push_back(artifact("landmarks.json", setup.landmarks_json));
  for (const auto& [name, bytes] : setup.attachments)
    all.push_back(artifact("attachment/" + name, bytes));
  return all;
}

}  // namespace cavum
