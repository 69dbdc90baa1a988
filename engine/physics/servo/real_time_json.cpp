#include "engine/physics/servo/real_time_json.h"

namespace cavum {
namespace {

nlohmann::json histogram(const Lateness& l) {
  nlohmann::json bins = nlohmann::json::array();
  for (std::size_t i = 0; i < l.counts.size(); ++i) {
    const bool last = i == Lateness::k_edges_us.size();
    bins.push_back(
        {{"up_to_us", last ? nlohmann::json(nullptr) : nlohmann::json(Lateness::k_edges_us[i])},
         {"ticks", l.counts[i]}});
  }
  return {{"mean_us", l.mean_us()},        {"p50_us", l.quantile_us(0.5)},
          {"p99_us", l.quantile_us(0.99)}, {"p999_us", l.quantile_us(0.999)},
          {"worst_us", l.worst_us()},      {"histogram", bins}};
}

}  // namespace

nlohmann::json to_json(const RealTimeReport& s) {
  return {{"ticks", s.ticks},
          {"overruns", s.overruns},
          {"made_up", s.made_up},
          {"skipped_late", s.skipped_late},
          {"skipped_full", s.skipped_full},
          {"guard_cuts", s.guard_cuts},
          {"lateness", histogram(s.lateness)},
          {"work", histogram(s.work)},
          {"fifo", to_json_value(s.fifo)},
          {"memory", to_json_value(s.memory)},
          {"ended", to_json_value(s.ended)}};
}

}  // namespace cavum
