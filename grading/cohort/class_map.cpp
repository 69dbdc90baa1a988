#include "grading/cohort/class_map.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/text.h"
#include "engine/session/session_reader.h"
#include "grading/cohort/class_figures.h"
#include "grading/marking/grade.h"
#include "scenarios/file/parse.h"
#include "scenarios/file/surface_files.h"
#include "scenarios/zones/placed.h"

namespace cavum::cohort {

std::size_t ClassMap::index(IVec3 leaf) const noexcept { return cell_index(leaf - low_, size_); }

void ClassMap::reach(IVec3 low, IVec3 high) {
  const IVec3 end = low_ + size_;
  if (!count_.empty()) {
    if (low.x >= low_.x && low.y >= low_.y && low.z >= low_.z && high.x <= end.x &&
        high.y <= end.y && high.z <= end.z)
      return;
    low = min(low, low_);
    high = max(high, end);
  }
  ClassMap wider(*zones_);
  wider.low_ = low;
  wider.size_ = high - low;
  wider.count_.assign(cells_of(wider.size_), 0);
  for (int z = low_.z; z < end.z; ++z)
    for (int y = low_.y; y < end.y; ++y)
      for (int x = low_.x; x < end.x; ++x)
        wider.count_[wider.index({x, y, z})] = count_[index({x, y, z})];
  low_ = wider.low_;
  size_ = wider.size_;
  count_ = std::move(wider.count_);
}

void ClassMap::add(const std::vector<IVec3>& removed) {
  if (sessions_ == 0) reach(zones_->low(), zones_->low() + zones_->size());
  if (!removed.empty()) {
    LeafBounds box;
    for (const IVec3 l : removed) box.add(l);
    reach(box.low, box.high + IVec3{1, 1, 1});
  }
  for (const IVec3 l : removed) ++count_[index(l)];
  ++sessions_;
}

double ClassMap::percent(IVec3 leaf) const noexcept {
  const IVec3 l = leaf - low_;
  if (sessions_ == 0 || !lies_in(l, size_)) return 0;
  const double removed = 100.0 * count_[index(leaf)] / static_cast<double>(sessions_);
  const scenarios::Zone zone = zones_->zone(leaf);
  if (zone == scenarios::Zone::target) return removed - 100;
  return zone == scenarios::Zone::leeway_sides || zone == scenarios::Zone::leeway_bottom ? 0
                                                                                         : removed;
}

namespace {

/// What two sessions must share so that their leaves mean the same places.
std::string task_of(const SessionReader& reader) {
  const SessionSetup setup = reader.setup();
  return to_hex(sha256(setup.scenario_toml)) + to_hex(sha256(setup.tooth));
}

std::vector<IVec3> counted_leaves(const SessionReader& reader) {
  const auto ticks = grading::counted_ticks(reader.ticks(), reader.events());
  std::vector<IVec3> out;
  for (const auto& r : reader.removed())
    if (r.tick < ticks) out.push_back(r.leaf.leaf());
  return out;
}

}  // namespace

std::unique_ptr<ClassTooth> class_tooth(const records::Registry& registry,
                                        const records::LedgerPaths& places,
                                        const std::string& exam) {
  auto out = std::make_unique<ClassTooth>();
  struct Task {
    std::string path;  // of one of its sessions
    std::vector<std::vector<IVec3>> cavities;
  };
  std::map<std::string, Task> tasks;
  for (const auto& [candidate, session] : counting_sessions(registry, exam)) {
    try {
      const std::string path = records::recording_of(places, *session);
      if (to_hex(sha256(read_file(path))) != session->file_sha256)
        throw Error(path, msg("was changed since it was filed"), msg("put an intact copy back"));
      const SessionReader reader(path);
      reader.require_readable();
      Task& task = tasks[task_of(reader)];
      task.path = path;
      task.cavities.push_back(counted_leaves(reader));
    } catch (const Error& e) {
      out->findings.push_back(msg("entry {}: {}", session->seq, e.message()));
    }
  }
  const auto most = std::max_element(tasks.begin(), tasks.end(), [](const auto& a, const auto& b) {
    return a.second.cavities.size() < b.second.cavities.size();
  });
  if (most == tasks.end())
    throw Error(places.folder,
                out->findings.empty()
                    ? msg("no session of '{}' can be read", exam)
                    : msg("no session of '{}' can be read ({})", exam, out->findings.front()),
                msg("see `cavum ledger verify {}`", places.folder));
  const auto sat = scenarios::prepare_exam(SessionReader(most->second.path).setup());
  out->scenario = std::move(sat->scenario);
  out->tooth = std::move(sat->tooth);
  out->zones = std::move(sat->zones);
  out->map = std::make_unique<ClassMap>(out->zones);
  for (const auto& cavity : most->second.cavities) out->map->add(cavity);
  for (const auto& [key, task] : tasks)
    if (key != most->first) out->left_out += task.cavities.size();
  return out;
}

}  // namespace cavum::cohort
