// Where on the tooth a class removes what it should leave and leaves what it should remove: leaf by
// leaf, how many of those who sat one exam.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "grading/records/filing.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::cohort {

/// The cavities of a class laid over each other.
class ClassMap {
 public:
  /// `zones` of the exam that all of them sat.
  explicit ClassMap(const scenarios::ZoneMap& zones) : zones_(&zones) {}
  /// One more cavity: each leaf once.
  void add(const std::vector<IVec3>& removed);

  [[nodiscard]] std::size_t sessions() const noexcept { return sessions_; }
  /// Per cent of the class, -100..100: + that removed this leaf although it lies outside the target
  /// and its leeway, - that left it although it lies inside the target. 0 in the leeway, for that
  /// may be removed or left.
  [[nodiscard]] double percent(IVec3 leaf) const noexcept;
  /// First leaf and number of leaves of the box that holds all removed leaves and the target.
  [[nodiscard]] IVec3 low() const noexcept { return low_; }
  [[nodiscard]] IVec3 size() const noexcept { return size_; }

 private:
  void reach(IVec3 low, IVec3 high);  // [low, high)
  [[nodiscard]] std::size_t index(IVec3 leaf) const noexcept;

  const scenarios::ZoneMap* zones_;
  std::size_t sessions_ = 0;
  IVec3 low_, size_;
  std::vector<std::uint16_t> count_;
};

/// The tooth that a class was examined on, with the map of its cavities.
struct ClassTooth {
  scenarios::Scenario scenario;
  Tooth tooth;
  scenarios::ZoneMap zones;
  std::unique_ptr<ClassMap> map;
  std::size_t left_out = 0;  ///< that sat the same exam with another text, tooth or leaf than most
  std::vector<Message>
      findings;  ///< sessions whose files are gone or changed: they are not in the map
};
/// Reads the filed sessions that count for one exam (counting_sessions). Throws Error when none of
/// them can be read.
[[nodiscard]] std::unique_ptr<ClassTooth> class_tooth(const records::Registry& registry,
                                                      const records::LedgerPaths& places,
                                                      const std::string& exam);

}  // namespace cavum::cohort
