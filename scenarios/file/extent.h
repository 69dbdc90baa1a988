// How far the values of live quantities and measures can run in one exam. All begin at 0, so the
// upper end is all there is to say.
#pragma once

#include <map>
#include <string>

namespace cavum::scenarios {

inline constexpr double k_no_end = 1e300;

/// The upper ends, of one tooth, its zones and its scenario. Volumes are of all that could be
/// removed.
struct ExamExtent {
  double limit_s = 0.0;       ///< of the exam, with what is granted
  double step_s = 0.0;        ///< of the step in question
  double over_limit_s = 0.0;  ///< 0 without a force limit
  double target_mm3 = 0.0, tooth_mm3 = 0.0, protected_mm3 = 0.0;
  double leeway_sides_mm3 = 0.0, leeway_bottom_mm3 = 0.0, leeway_mm3 = 0.0;
  double container_sides_mm3 = 0.0, container_bottom_mm3 = 0.0, container_mm3 = 0.0;
  double steps = 0.0;
  double fault = 0.0;  ///< 1 when a tissue is one, else 0
  double rpm = 0.0;
  double last_bur = 0.0;  ///< of the tray, the first is 0
  std::map<std::string, double>
      tissue_mm3;  ///< by its name; one that is not in it is none of this tooth
  // the same in every exam
  double percent = 100.0, one = 1.0, no_end = k_no_end;
};

/// An upper end, and that in words.
struct Most {
  double ExamExtent::*value;
  const char* words;
};

/// All of them.
namespace most {
inline constexpr Most limit{&ExamExtent::limit_s, "the time limit"};
inline constexpr Most step{&ExamExtent::step_s, "the step's time limit"};
inline constexpr Most over_limit{&ExamExtent::over_limit_s, "the time limit"};
inline constexpr Most target{&ExamExtent::target_mm3, "the target"};
inline constexpr Most tooth{&ExamExtent::tooth_mm3, "the tooth"};
inline constexpr Most guarded{&ExamExtent::protected_mm3, "what is protected"};
inline constexpr Most leeway_sides{&ExamExtent::leeway_sides_mm3, "the leeway there"};
inline constexpr Most leeway_bottom{&ExamExtent::leeway_bottom_mm3, "the leeway there"};
inline constexpr Most leeway{&ExamExtent::leeway_mm3, "the leeway"};
inline constexpr Most container_sides{&ExamExtent::container_sides_mm3, "the container there"};
inline constexpr Most container_bottom{&ExamExtent::container_bottom_mm3, "the container there"};
inline constexpr Most container{&ExamExtent::container_mm3, "the container"};
inline constexpr Most steps{&ExamExtent::steps, "the number of steps"};
inline constexpr Most fault{&ExamExtent::fault, "1"};
inline constexpr Most rpm{&ExamExtent::rpm, "max_rpm"};
inline constexpr Most last_bur{&ExamExtent::last_bur, "the last bur of the tray"};
inline constexpr Most percent{&ExamExtent::percent, "100"};
inline constexpr Most one{&ExamExtent::one, "1"};
inline constexpr Most no_end{&ExamExtent::no_end, "no end"};
}  // namespace most

}  // namespace cavum::scenarios
