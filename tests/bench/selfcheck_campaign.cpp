// Simulated stations and their histories: how often the self-check calls a station changed that is
// not, and how often it finds a hidden change.
//     selfcheck_campaign [STATIONS_OF_EACH_FAMILY [SEED]]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "engine/device/selfcheck/check_rule.h"
#include "tests/engine/device/selfcheck/arm_families.h"

namespace {

using namespace cavum::testing_selfcheck;

/// Two-sided 95 % of a share, Wilson's, in per cent.
std::pair<double, double> interval(int hits, int of) {
  if (of == 0) return {0.0, 100.0};
  const double z = 1.96, n = of, p = hits / n, mid = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {100.0 * (mid - half), 100.0 * (mid + half)};
}

void print_share(const char* what, int hits, int of) {
  const auto [low, high] = interval(hits, of);
  std::printf("  %s %d of %d = %.1f %% (%.1f to %.1f)", what, hits, of,
              of > 0 ? 100.0 * hits / of : 0.0, low, high);
}

struct Sum {
  int stations = 0, too_few = 0, unchanged = 0, alarms = 0, doubtful = 0, friction = 0,
      friction_doubt = 0, gain_too = 0, gain = 0, gain_doubt = 0, friction_too = 0,
      hands_unseen = 0;
  double longest_s = 0.0;
  std::map<std::string, int> causes, alarm_of;

  void add(const StationTrial& t) {
    ++stations;
    longest_s = std::max(longest_s, t.longest_s);
    doubtful += t.doubtful;
    if (t.learnt < static_cast<int>(cavum::k_checks_to_learn)) {
      ++too_few;
      return;
    }
    unchanged += t.unchanged_checks;
    alarms += t.false_alarms;
    if (t.false_alarms > 0) ++alarm_of[t.false_alarm];
    friction += t.friction_found ? 1 : 0;
    friction_doubt += t.friction_doubtful ? 1 : 0;
    gain_too += t.gain_named_too ? 1 : 0;
    gain += t.gain_found ? 1 : 0;
    gain_doubt += t.gain_doubtful ? 1 : 0;
    friction_too += t.friction_named_too ? 1 : 0;
    hands_unseen += t.hand_unseen ? 1 : 0;
    if (!t.gain_cause.empty()) ++causes[t.gain_cause];
  }
  void print(const char* name) const {
    std::printf(
        "%s: %d stations, %d of them never learnt, longest check %.1f s, %d doubtful checks of stations that did not change\n",
        name, stations, too_few, longest_s, doubtful);
    print_share("false alarms", alarms, unchanged);
    for (const auto& [what, n] : alarm_of) std::printf("; %s %d", what.c_str(), n);
    std::printf("\n");
    print_share("+0.1 N found", friction, stations - too_few);
    std::printf("; doubtful %d; gain named, too, %d\n", friction_doubt, gain_too);
    print_share("gain -10 % found", gain, stations - too_few);
    std::printf("; doubtful %d; friction named, too, %d;", gain_doubt, friction_too);
    for (const auto& [what, n] : causes) std::printf(" called %s %d", what.c_str(), n);
    std::printf("\n");
    print_share("a hand on it, called unchanged", hands_unseen, stations - too_few);
    std::printf("\n");
    std::fflush(stdout);
  }
};

}  // namespace

int main(int count, char** words) {
  const int stations = count > 1 ? std::atoi(words[1]) : 100;
  const std::uint64_t seed = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
  constexpr std::uint64_t k_apart = 100003;
  Sum all;
  for (const std::string& family : arm_families()) {
    Sum sum;
    for (int i = 0; i < stations; ++i) {
      const std::uint64_t own = seed * k_apart + static_cast<std::uint64_t>(i);
      const int learns = static_cast<int>(cavum::k_checks_to_learn) + i % 23;  // 8 to 30 checks
      const StationTrial t = try_station(family, own, learns, 3);
      sum.add(t);
      all.add(t);
    }
    sum.print(family.c_str());
  }
  all.print("all");
  return 0;
}
