// What a result says beside its figures: why the verdict is what it is, and what a reader must
// know. Each is a kind with its values; who decides asks for the kind, and only a face puts it into
// words. One table has all kinds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/fact.h"
#include "engine/base/fact_table.h"

namespace cavum::grading {

/// Whom a finding concerns: `examiner` leaves the verdict to an examiner; `detail` is of use to
/// examiners alone.
enum class Concerns : std::uint8_t { reader, examiner, detail };

// FINDING(kind, Concerns, English sentence, names of its values)
// clang-format off
#define CAVUM_FINDINGS(FINDING) \
  /* why the verdict is what it is */ \
  FINDING(critical_limit, reader, "criterion {} alone fails the exam", "criterion") \
  FINDING(band_too_full, reader, "{} {}, and at most {} may be: {}", "count", "band", "most", "criteria") \
  FINDING(bands_too_full, reader, "{} {} or worse, and at most {} may be: {}", "count", "band", "most", "criteria") \
  FINDING(sum_reaches, reader, "the sum reaches {}, the pass mark is {}", "percent", "pass_percent") \
  FINDING(judged_sum_reaches, reader, "the sum of what could be judged reaches {}, the pass mark is {}", "percent", "pass_percent") \
  FINDING(lowest_criterion_reaches, reader, "criterion {} reaches {}, the pass mark is {}", "criterion", "percent", "pass_percent") \
  FINDING(enough_alone, reader, "the points alone would be enough", ) \
  FINDING(borderline, reader, "the points lie within the borderline band of {}", "borderline_percent") \
  FINDING(bound_crosses, reader, "the score's bound of ± {} reaches across the pass mark (every figure off by all of its bound, each to the same side)", "bound_percent") \
  FINDING(criterion_below, reader, "criterion {} reaches {}, below the pass mark, too", "criterion", "percent") \
  FINDING(not_judged, reader, "not judged, for a preparation without its recording does not show it: {} ({} points); the score is of the other {}", "criteria", "points", "judged_points") \
  FINDING(not_judged_same, reader, "with all and without any of those points it would be {} to {} of the whole rubric: {} either way", "least_percent", "most_percent", "verdict") \
  FINDING(not_judged_open, examiner, "with all and without any of those points it would be {} to {} of the whole rubric: an examiner must decide", "least_percent", "most_percent") \
  FINDING(not_judged_critical, examiner, "what could not be judged has a critical limit: an examiner must decide about {}", "criteria") \
  FINDING(bounds_open, examiner, "the bounds of the figures leave the verdict open: an examiner must decide, as the rubric asks", ) \
  FINDING(force_without_tissue, detail, "the force shows a faulty breakthrough and the tissue none, which costs nothing: the tissue decides", ) \
  FINDING(tissue_without_force, detail, "the force does not show the faulty breakthrough that the tissue shows: the tissue decides", ) \
  FINDING(last_step_open, examiner, "the last step, '{}', was not completed: an examiner must decide", "step") \
  FINDING(fault_not_asked, reader, "{} was opened, which is a fault, and no criterion of this rubric asks for it", "tissue") \
  /* what a reader must know */ \
  FINDING(extra_time, reader, "{} of extra time was granted: the limit was {}", "extra", "limit_s") \
  FINDING(left_handed, reader, "the exam was set up for the left hand", ) \
  FINDING(high_contrast, reader, "the exam was shown in high-contrast colours", ) \
  FINDING(other_limit, reader, "the exam ran under a limit of {}; the scenario it is marked by has {}, which was not applied", "limit_s", "own_limit_s") \
  FINDING(paused, reader, "a pause of {} from {} on, which does not count", "length_s", "t_s", "tick") \
  FINDING(paused_by_office, reader, "the exam office paused the exam for {} from {} on, which does not count", "length_s", "t_s", "tick") \
  FINDING(pause_refused_turning, reader, "a pause was asked for at {} and not given, for the handpiece turned", "t_s", "tick") \
  FINDING(pause_refused_none_left, reader, "a pause was asked for at {} and not given, for none was left", "t_s", "tick") \
  FINDING(time_lost, reader, "{} were lost while the station's program stood still: the exam's clock does not show them, and the candidate had them", "lost_s") \
  FINDING(interrupted, reader, "the recording was interrupted at {} and taken up again; the exam's clock stood still meanwhile", "t_s", "tick") \
  FINDING(interrupted_for, reader, "the recording was interrupted at {} and taken up again after {} by the computer's clock; the exam's clock stood still meanwhile", "t_s", "away_s", "tick") \
  FINDING(late_ticks, reader, "{} ticks were recorded after the exam was over, {} removed in them; they do not count", "ticks", "removed_mm3") \
  FINDING(work_after_time, reader, "the candidate went on for {} after time was up, with the pedal pressed for {}; the tooth stayed as it was, and nothing of it counts", "late_s", "pedal_s") \
  FINDING(work_after_end, reader, "the candidate went on for {} after the exam was over, with the pedal pressed for {}; the tooth stayed as it was, and nothing of it counts", "late_s", "pedal_s") \
  FINDING(steps_open, reader, "steps not completed: {} of {}", "open", "steps") \
  FINDING(step_failed, reader, "step '{}' failed at {}: {}", "step", "t_s", "condition", "tick") \
  FINDING(step_timed_out, reader, "step '{}' ran out of its time at {}: its limit was {}", "step", "t_s", "limit_s", "tick") \
  FINDING(step_timed_out_otherwise, reader, "step '{}' ran out of its time at {}", "step", "t_s", "tick") \
  FINDING(record_differs, examiner, "the list of removed leaves and the final tooth disagree: an examiner must look at this recording", ) \
  /* what a criterion's points are for, and what was lost */ \
  FINDING(not_shown, reader, "not judged: a preparation without its recording does not show it", ) \
  FINDING(not_shown_critical, reader, "it has a critical limit, so the verdict is no pass", ) \
  FINDING(not_measured, reader, "cannot be measured: nothing was cut there, or tooth and scenario have nothing of the kind", ) \
  FINDING(full_marks, reader, "full marks", ) \
  FINDING(full_marks_for_part, reader, "full marks for what was done", ) \
  FINDING(below_full, reader, "{} where {} gives full marks", "value", "full") \
  FINDING(at_end, reader, "as it stood at the end, {}", "t_s", "tick") \
  FINDING(granted_limits, reader, "the limits are {} times the rubric's, for the time that was granted", "times") \
  FINDING(fails_exam, reader, "this alone fails the exam", ) \
  FINDING(fails_exam_in_bound, reader, "this alone fails the exam, and the limit lies within the bound of the figure", ) \
  FINDING(above_critical, reader, "critical above {}: this alone fails the exam", "limit") \
  FINDING(below_critical, reader, "critical below {}: this alone fails the exam", "limit") \
  FINDING(above_critical_in_bound, reader, "critical above {}, which lies within the bound of the figure: this alone fails the exam", "limit") \
  FINDING(below_critical_in_bound, reader, "critical below {}, which lies within the bound of the figure: this alone fails the exam", "limit") \
  FINDING(critical_in_bound, reader, "the critical limit of {} lies within the bound of the figure", "limit") \
  FINDING(part_counts, reader, "only {} of the target was removed: {} of these points count (all of them from {} on)", "done_percent", "counts_percent", "all_from_percent") \
  FINDING(part_towards_counts, reader, "only {} of the target towards {} was removed: {} of these points count (all of them from {} on)", "done_percent", "wall_name", "counts_percent", "all_from_percent", "wall") \
  FINDING(in_band, reader, "{}", "band") \
  FINDING(in_band_beyond, reader, "{}, beyond {}", "band", "limit") \
  FINDING(in_band_for_part, reader, "{}, for less than half of the work was done", "band") \
  FINDING(band_limit_in_bound, reader, "the limit of {} lies within the bound of the figure", "limit") \
  FINDING(target_left, reader, "{} of the target left standing, the largest part towards {} ({}), where it was cut last at {}", "missed_mm3", "wall_name", "largest_mm3", "t_s", "tick", "wall") \
  FINDING(target_left_partly_cut, reader, "{} of the target left standing, the largest part towards {} ({}), where some of it was cut", "missed_mm3", "wall_name", "largest_mm3", "wall") \
  FINDING(target_left_uncut, reader, "{} of the target left standing, the largest part towards {} ({}), where nothing of it was cut", "missed_mm3", "wall_name", "largest_mm3", "wall") \
  FINDING(removed_beyond, reader, "{} removed beyond the target", "removed_mm3") \
  FINDING(removed_outside, reader, "the largest part outside all zones at {} ({})", "wall_name", "largest_mm3", "wall") \
  FINDING(removed_in_zone, reader, "the largest part in {} at {} ({})", "zone", "wall_name", "largest_mm3", "wall") \
  FINDING(wall_uncut, reader, "nothing was cut there", ) \
  FINDING(wall_beyond_container, reader, "cut outside the container, up to {} beyond {}", "furthest_mm", "wall_name", "wall") \
  FINDING(wall_overcut, reader, "{} overcut by up to {}", "wall_name", "furthest_mm", "wall") \
  FINDING(wall_thick, reader, "{} left up to {} thick", "wall_name", "furthest_mm", "wall") \
  FINDING(wall_p95_thick, reader, "{}, 95 % of whose places lie no further out than that; the furthest {} thick", "wall_name", "furthest_mm", "wall") \
  FINDING(wall_p95_overcut, reader, "{}, 95 % of whose places lie no further out than that; the furthest {} beyond the target", "wall_name", "furthest_mm", "wall") \
  FINDING(wall_mean_thick, reader, "{}, in the mean of its places; the furthest {} thick", "wall_name", "furthest_mm", "wall") \
  FINDING(wall_mean_overcut, reader, "{}, in the mean of its places; the furthest {} beyond the target", "wall_name", "furthest_mm", "wall") \
  FINDING(end_too_far, reader, "{} at the {} end ({} too far)", "part_mm", "end", "beyond_mm") \
  FINDING(end_short, reader, "{} at the {} end ({} short)", "part_mm", "end", "short_mm") \
  FINDING(length, reader, "length {} instead of {}", "length_mm", "target_mm") \
  FINDING(width, reader, "width {} instead of {}", "width_mm", "target_mm") \
  FINDING(depth, reader, "depth {} instead of {}", "depth_mm", "target_mm") \
  FINDING(taper, reader, "the walls open by {} instead of {}", "taper_deg", "target_deg") \
  FINDING(roof_left, reader, "roof left above the chamber, around {}", "site_mm") \
  FINDING(canals_covered, reader, "hard tissue stands over the mouths around {}", "site_mm") \
  FINDING(floor_uncut, reader, "no hard tissue was cut below the target", ) \
  FINDING(dentin_thinnest, reader, "thinnest at {}", "site_mm") \
  FINDING(pulp_opened, reader, "the pulp was opened at {}", "site_mm") \
  FINDING(neighbour_cut, reader, "the neighbour is cut deepest at {}", "site_mm") \
  FINDING(no_contact_opened, reader, "the target opens no contact", ) \
  FINDING(clearance, reader, "least between {} and the neighbour's {}", "site_mm", "neighbour_mm") \
  FINDING(full_time_over, reader, "that time was over at {}", "t_s", "tick") \
  FINDING(pressed_hardest, reader, "pressed hardest at {}, at {}", "site_mm", "t_s", "tick") \
  FINDING(force_above_limit, reader, "above the limit first at {}", "t_s", "tick") \
  FINDING(nothing_opened, reader, "no faulty breakthrough", ) \
  FINDING(tissue_opened, reader, "{} opened, {} of its wall in all, none of it removed", "tissue", "area_mm2") \
  FINDING(tissue_opened_and_removed, reader, "{} opened, {} of its wall in all, {} of it removed", "tissue", "area_mm2", "removed_mm3") \
  FINDING(none_from_outside, reader, "no soft tissue was removed from outside the tooth", ) \
  FINDING(from_outside, reader, "soft tissue was removed from outside the tooth", ) \
  FINDING(force_fell, reader, "a drop in force from {} at {}", "force_n", "t_s", "tick") \
  FINDING(no_fall_confirmed, reader, "no faulty breakthrough that force and tissue show", ) \
  FINDING(tissue_touched, reader, "{} touched", "tissue") \
  FINDING(tissue_untouched, reader, "{} never touched", "tissue") \
  FINDING(violated, reader, "the first violation was at {}", "t_s", "tick") \
  FINDING(first_cut, reader, "cut first at {}, at {}", "site_mm", "t_s", "tick") \
  FINDING(cut_site, reader, "the place is {}, cut at {}", "site_mm", "t_s", "tick") \
  FINDING(site, reader, "the place is {}", "site_mm") \
  FINDING(site_uncut, reader, "the place is {}, where nothing was cut", "site_mm") \
  /* of a scan */ \
  FINDING(scan_parts_left_out, reader, "small parts of the scan next to the tooth were left out: {}, {} of its surface", "count", "percent") \
  FINDING(scan_faces_turned, reader, "the faces of the scan looked inwards and were turned", ) \
  FINDING(scan_shows_nothing, reader, "the scan shows nothing that was removed", ) \
  FINDING(scan_cavities, reader, "{} separate cavities were found, and all of them count", "count") \
  FINDING(scan_deeper_apart, examiner, "apart from the cavity the scan lies up to {} deeper than the tooth, at {}: a nick, or a groove that one of the two surfaces lacks; it is not counted, and an examiner must look at it", "deep_mm", "site_mm") \
  FINDING(scan_apart_counted, reader, "were it counted, the verdict would be {}, with {} of {} points", "verdict", "points", "max") \
  FINDING(scan_other_pose, examiner, "the scan fits the tooth nearly as well in another pose ({} of it, {} in this one): an examiner must look at it", "other_percent", "percent") \
  FINDING(scan_doubtful, examiner, "the scan fits the tooth doubtfully ({} of what should fit, {} of the crown seen): an examiner must look at it", "fit_percent", "crown_percent")
// clang-format on

enum class FindingKind : std::uint8_t {
#define CAVUM_FINDING_KIND(KIND, ...) KIND,
  CAVUM_FINDINGS(CAVUM_FINDING_KIND)
#undef CAVUM_FINDING_KIND
};

inline constexpr FactRow k_findings[] = {
#define CAVUM_FINDING_ROW(KIND, CONCERNS, ENGLISH, ...) \
  {#KIND, static_cast<std::size_t>(FindingKind::KIND), ENGLISH, {__VA_ARGS__}},
    CAVUM_FINDINGS(CAVUM_FINDING_ROW)
#undef CAVUM_FINDING_ROW
};
[[nodiscard]] constexpr std::span<const FactRow> rows_of(FindingKind) { return k_findings; }
inline constexpr Concerns k_finding_concerns[] = {
#define CAVUM_FINDING_CONCERNS(KIND, CONCERNS, ...) Concerns::CONCERNS,
    CAVUM_FINDINGS(CAVUM_FINDING_CONCERNS)
#undef CAVUM_FINDING_CONCERNS
};

struct Finding : TableFact<FindingKind> {
  [[nodiscard]] Concerns concerns() const noexcept {
    return k_finding_concerns[static_cast<std::size_t>(kind)];
  }
  /// Leaves the verdict to an examiner.
  [[nodiscard]] bool asks_examiner() const noexcept { return concerns() == Concerns::examiner; }
  friend bool operator==(const Finding&, const Finding&) = default;
};
using Findings = std::vector<Finding>;
/// One sentence after the other.
[[nodiscard]] List sentences(const Findings& findings);

namespace finding_detail {
/// To a millionth: the same digits wherever it is worked out, and wherever it is said.
[[nodiscard]] Value as_sealed(Value value);
}  // namespace finding_detail

/// A finding of this kind: the compiler counts its values.
template <FindingKind kind, class... A>
[[nodiscard]] Finding finding(A&&... values) {
  return {fact_of<kind>(
      finding_detail::as_sealed(message_detail::value_of(std::forward<A>(values)))...)};
}

/// With its words.
[[nodiscard]] Fact fact_of(const Finding& finding);
/// {"kind", "values"}. No words: what is sealed and compared.
[[nodiscard]] nlohmann::ordered_json to_json(const Finding& finding);
/// Reads what to_json wrote. Throws Error for anything else.
[[nodiscard]] Finding finding_in(const nlohmann::json& json);
/// Of a list; none of null.
[[nodiscard]] Findings findings_in(const nlohmann::json& list);

}  // namespace cavum::grading
