// The result of an exam: every figure that docs/grading.md defines, each with what it is uncertain
// by and, where points were lost, when and where. Plain data; grade.h makes it, result_json.h
// writes it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "engine/base/vec.h"
#include "grading/result/finding.h"
#include "scenarios/exam/runner.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::grading {

/// Raised whenever the same recording may get another verdict, other points, other figures or
/// another finding than before: sealed results are compared as a whole but for their sentences. It
/// stands in every result.
inline constexpr int k_grading_version = 1;

/// Tick of what was removed of a preparation that was handed in without its recording: nobody knows
/// when.
inline constexpr std::int64_t k_untimed_tick = 0x7fffffff;

/// When and where something happened; tick -1 = never.
struct Trace {
  std::int64_t tick = -1;
  Vec3 site_mm;
  [[nodiscard]] bool timed() const noexcept { return tick >= 0 && tick != k_untimed_tick; }
  [[nodiscard]] double t_s() const noexcept { return static_cast<double>(tick) * k_tick_s; }
};

/// A volume and what is not known of it along its border: the true volume lies within ± bound.
struct BoundedVolume {
  double mm3 = 0.0, bound_mm3 = 0.0;
};

/// What was removed in one zone.
struct ZoneVolume {
  BoundedVolume removed;
  double bottom_or_sides_mm3 =
      0.0;  ///< of it lies where bottom and sides meet and may as well belong to the other
  std::array<double, scenarios::k_walls + 1> by_wall_mm3{};  ///< by the target's nearest wall
  Trace first;  ///< first leaf removed there, all of it or a part
  /// As a figure of its own, not in a sum of bottom and sides.
  [[nodiscard]] BoundedVolume alone() const noexcept {
    return {removed.mm3, removed.bound_mm3 + bottom_or_sides_mm3};
  }
};

struct VolumeMeasures {
  BoundedVolume target, removed, missed;
  double target_removed_percent = 0.0, target_removed_bound_percent = 0.0;
  double dice = 0.0, dice_bound = 0.0;
  std::array<ZoneVolume, scenarios::k_zones> zone;  ///< by Zone
  std::array<double, scenarios::k_walls + 1> target_by_wall_mm3{}, missed_by_wall_mm3{},
      missed_bound_by_wall_mm3{};
  std::array<BoundedVolume, 256> tissue;  ///< removed, by tissue id
  std::array<Trace, 256> tissue_first;    ///< first leaf removed of each
  std::array<Trace, scenarios::k_walls + 1>
      target_last;  ///< last leaf of the target removed towards each wall
  /// R without T, L and C: in no zone, or protected wherever that lies.
  [[nodiscard]] BoundedVolume outside() const noexcept {
    const BoundedVolume &none = zone[static_cast<std::size_t>(scenarios::Zone::none)].removed,
                        &guarded =
                            zone[static_cast<std::size_t>(scenarios::Zone::protected_)].removed;
    return {none.mm3 + guarded.mm3, none.bound_mm3 + guarded.bound_mm3};
  }
};

/// Signed distance of the cut surface from the target's, mm, + = overcut. Meaningless when samples
/// == 0.
struct WallMeasures {
  std::size_t samples = 0;  ///< leaves of cut surface
  double mean_mm = 0.0, p95_mm = 0.0, max_over_mm = 0.0, max_under_mm = 0.0;
  /// Of the mean and the 95th percentile; of the largest it is ShapeMeasures::bound_mm.
  double mean_bound_mm = 0.0, p95_bound_mm = 0.0;
  bool over_outside = false;  ///< `worst_over` lies beyond the container: what was cut there is no
                              ///< wall of the cavity
  Trace worst_over,
      worst_under;  ///< worst_under without a tick where the thickest place was never cut
};

struct ShapeMeasures {
  scenarios::Facing facing;  ///< how the walls are called, and which way is down
  std::array<WallMeasures, scenarios::k_walls> wall;
  double bound_mm = 0.0;  ///< of every place on a surface, and so of a distance between two
  std::optional<double> length_mm, width_mm, depth_mm, taper_deg;  ///< none without a cut surface
  double taper_bound_deg = 0.0;
  double target_length_mm = 0.0, target_width_mm = 0.0, target_depth_mm = 0.0;
  /// What is missing of the target's and what is too much, together: one does not make up for the
  /// other. None where nothing of the target was cut. Each is the sum of two distances: twice the
  /// bound.
  std::optional<double> length_error_mm, width_error_mm, depth_error_mm;
  /// The two errors of the outline end by end: mesial, distal, buccal, lingual.
  struct EndError {
    double part_mm = 0.0;    ///< of the error; both ends of an outline add up to it
    double beyond_mm = 0.0;  ///< the cut's end beyond the target's, negative: short of it
  };
  std::array<EndError, 4> end_error;
};

/// A connected piece of something, for places.
struct Piece {
  Vec3 middle_mm;
  double part = 0.0, whole = 0.0;  ///< what of it counts, and all of it
};

/// Straight-line access; see grading/measures/access.h.
struct AccessMeasures {
  std::optional<BoundedVolume>
      overhang;  ///< roof left above the aim; none when the target holds none of it
  std::optional<double> canals_covered_percent;  ///< of the canals' mouths; none without canals
  double canals_bound_percent = 0.0;
  Vec3 overhang_middle_mm,
      canals_covered_mm;               ///< middle of what is left over, and of the mouths under it
  std::vector<Piece> overhang_pieces;  ///< mm3, the largest first
  std::vector<Piece> canal_mouths;  ///< covered leaves of all, in the order of the tooth's leaves
  BoundedVolume floor_cut;          ///< hard tissue removed below the target
  Trace floor_first;
  std::optional<double> target_taper_deg;
  double target_taper_bound_deg = 0.0;
};

/// What was left between the cavity and the pulp; see grading/measures/over_pulp.h.
struct OverPulpMeasures {
  std::optional<double>
      dentin_mm;  ///< where it is thinnest; none without pulp, or where nothing hard was cut
  double bound_mm = 0.0;
  Trace thinnest;  ///< place on the cut surface, and when it was cut
  Vec3 pulp_mm;    ///< nearest place on the pulp's wall
};

/// What was done to the teeth and the gum beside the tooth; see grading/measures/adjacent.h. Zeros
/// where nothing stands there.
struct AdjacentMeasures {
  bool neighbours = false, gum = false;  ///< there are any
  BoundedVolume neighbour_removed;       ///< hard tissue of neighbours
  double nick_depth_mm = 0.0, nick_depth_bound_mm = 0.0;
  Trace deepest;  ///< of the nick, on its floor
  double nick_area_mm2 = 0.0, nick_area_bound_mm2 = 0.0;
  Trace first_nick;
  std::optional<double> clearance_mm;  ///< none where the target opens no contact
  double clearance_bound_mm = 0.0;
  Vec3 clearance_from_mm, clearance_to_mm;  ///< nearest places: of the tooth, of its neighbour
  BoundedVolume gum_removed;
  double gum_touched_s = 0.0, gum_touched_bound_s = 0.0;
  Trace first_gum;
};

/// A breakthrough seen in the force.
struct PerforationEvent {
  std::int64_t tick = 0;       ///< onset of the drop
  std::int64_t seen_tick = 0;  ///< when the detector could say so
  double probability = 0.0;    ///< 0..1, of the detector; 0.5 = as likely as not
  Vec3 site_mm;                ///< tip
  double force_before_n = 0.0, force_after_n = 0.0;
  double advance_mm = 0.0;  ///< of the tip, against the force, while it dropped
  bool fault = false;       ///< by the place: outside target and leeway, or no aim in this scenario
  bool confirmed = false;   ///< tissue of that kind was opened then
};

/// How clear a drop in force was: `felt_and_cut_on` for longer than a reaction takes, `faint` from
/// 0.03 N and 0.1 on.
enum class DropSeverity : std::uint8_t { not_felt, faint, felt, felt_and_cut_on };
inline constexpr std::array k_drop_severities{"not_felt", "faint", "felt", "felt_and_cut_on"};

/// The force that a cavity took away; see grading/perforation/drop.h. Of all stretches of 1.5 s
/// where it was opened the one furthest beyond (or least below) 0.1 N and 0.3 of the filled tooth's
/// force. Forces are those rendered to the hand, means over 30 ms.
struct ForceDrop {
  double missing_n = 0.0;       ///< how much more is missing at its end than at its beginning
  double share = 0.0;           ///< the same as a share of what the filled tooth would give, 0..1
  std::int64_t from_tick = -1;  ///< its beginning
  Vec3 site_mm;                 ///< of the tip then
  std::int64_t to_tick = -1;    ///< its end
  std::int64_t felt_tick = -1;  ///< first tick in which both figures were reached; -1 = never
  double cut_on_s = 0.0;        ///< time for which the cavity was opened further after that
  [[nodiscard]] bool felt() const noexcept { return felt_tick >= 0; }
  [[nodiscard]] DropSeverity severity() const noexcept {
    constexpr double k_reaction_s = 0.5, k_faint_n = 0.03, k_faint_share = 0.1;
    if (felt()) return cut_on_s > k_reaction_s ? DropSeverity::felt_and_cut_on : DropSeverity::felt;
    return missing_n >= k_faint_n && share >= k_faint_share ? DropSeverity::faint
                                                            : DropSeverity::not_felt;
  }
};

/// What was laid open from the cavity of all tissues of a kind; see grading/perforation/exposure.h.
struct PerforationTruth {
  bool perforated = false;  ///< some face of such a tissue lies open to the cavity, or some of it
                            ///< was removed from there
  Trace first;
  std::string tissue;                           ///< opened first
  double area_mm2 = 0.0, area_bound_mm2 = 0.0;  ///< of their walls that lies open
  double volume_mm3 = 0.0, bound_mm3 = 0.0;     ///< removed from the cavity, in whole leaves
  double outside_mm3 = 0.0;                     ///< removed from outside the tooth: no perforation
  Trace first_outside;
  std::optional<ForceDrop> drop;  ///< none where nothing was opened, or where the physics of the
                                  ///< recording is not this program's
};

struct PerforationMeasures {
  bool force_known = true;               ///< false: there is no recording of it
  std::vector<PerforationEvent> events;  ///< in order of time
  PerforationTruth fault, aim;           ///< `aim`: the breakthrough that the task asks for
  bool has_aims = false;                 ///< the task asks for one
  [[nodiscard]] bool detected() const noexcept {
    for (const auto& e : events)
      if (e.fault) return true;
    return false;
  }
  /// Force and tissue tell the same story about faults.
  [[nodiscard]] bool agree() const noexcept {
    return !force_known || detected() == fault.perforated;
  }
  /// The aim was opened, and no event of the force tells of it.
  [[nodiscard]] bool aim_unseen() const noexcept {
    if (!force_known) return false;
    for (const auto& e : events)
      if (!e.fault) return false;
    return has_aims && aim.perforated;
  }
};

struct MotionMeasures {
  double time_s = 0.0, handpiece_time_s = 0.0, idle_s = 0.0, path_mm = 0.0;
  double force_mean_n = 0.0, force_peak_n = 0.0, force_over_limit_s = 0.0;
  /// Durations: a tick for each time that it began or ended, idle a tenth of a second. Way and
  /// force: what rounding in the recording leaves open.
  double time_bound_s = 0.0, handpiece_bound_s = 0.0, idle_bound_s = 0.0, over_limit_bound_s = 0.0,
         path_bound_mm = 0.0, force_bound_n = 0.0;
  Trace force_peak, first_over_limit;
  double lost_s = 0.0;  ///< in which the station's program stood still: the exam's clock does not
                        ///< show it, and the candidate had it
  std::int64_t late_ticks = 0;    ///< recorded after the exam was over; they count nowhere
  double late_removed_mm3 = 0.0;  ///< removed in them
};

/// A pause, in ticks of the recording: the exam's clock stood still from `begin` up to `end`, which
/// counts again.
struct PauseMeasure {
  std::int64_t begin = 0, end = 0;
  bool by_office = false;  ///< the exam office has paused the exam: a fire alarm
};

/// What a candidate went on to do when time was up: not simulated, and nothing of it counts.
struct LateWork {
  std::int64_t ticks = 0, pedal_ticks = 0;
};

struct ProgressMeasures {
  int steps = 0, steps_completed = 0, steps_failed = 0, violations = 0;
  Trace first_violation;
  Finish finish = Finish::running;
  std::string open_last_step;  ///< the last step's id, where the exam ended with it open; empty: it
                               ///< was completed, or there was no exam
};

struct CriterionResult {
  std::string id, title, metric, unit;
  Findings facts;  ///< why it has its points, the most important first: what was lost, or that
                   ///< nothing was
  std::optional<double> value;  ///< none when the metric cannot be measured on this cavity
  bool judged = true;  ///< false: what was handed in does not show it. It has no points and takes
                       ///< none from the score
  double bound = 0.0;
  double points = 0.0, max = 0.0;
  double points_bound = 0.0;  ///< by the bounds of the value and of the work's share
  double work_share =
      1.0;  ///< of its points that count, for not enough of the work was done that it judges
  bool critical_failed = false;
  bool limit_in_bound = false;  ///< the value lies no further from a critical limit than its bound
  std::optional<std::size_t> band;  ///< that it lies in, of Result::bands
  Trace first;                      ///< where the loss began
  [[nodiscard]] Message reason() const { return msg("{}", sentences(facts)); }
};

/// A band of the rubric, and the criteria that lie in it.
struct BandResult {
  std::string name;
  std::optional<int> most;  ///< criteria that may lie in it or in a worse one
  std::size_t criteria = 0;
};

enum class Verdict { pass, fail, review };

/// A preparation that was handed in without its recording: nothing is known of time, way and force,
/// nor of these tissues, by their ids.
struct NotShown {
  std::array<bool, 256> tissue{};
};

struct Result {
  std::string scenario_id, scenario_title, tooth_name;
  double leaf_mm = 0.0;
  Verdict verdict = Verdict::fail;
  Findings verdict_reasons;
  double points = 0.0, max_points = 0.0;
  double points_bound = 0.0;  ///< the sum of the criteria's
  double unjudged_points =
      0.0;  ///< most points of the criteria that could not be judged; no part of `max_points`
  bool compensatory = true;
  double pass_percent = 0.0, borderline_percent = 0.0;
  std::vector<BandResult> bands;  ///< best first; empty: the rubric has none
  std::vector<CriterionResult> criteria;
  VolumeMeasures volumes;
  ShapeMeasures shape;
  AccessMeasures access;
  OverPulpMeasures over_pulp;
  AdjacentMeasures beside;
  PerforationMeasures perforation;
  MotionMeasures motion;
  ProgressMeasures progress;
  scenarios::Accommodations accommodations;
  Trace end;                     ///< last tick that counts, and where the tip was
  std::int64_t limit_ticks = 0;  ///< of the exam's clock, with what was granted
  std::vector<PauseMeasure> pauses;
  int pauses_refused = 0;
  LateWork late_work;
  Findings notes;  ///< what a reader must know: disagreement in the record, late ticks
  std::optional<NotShown> not_shown;  ///< none of a recorded exam
  std::vector<Tissue> tissues;
};

[[nodiscard]] Term word_of(Verdict verdict);
[[nodiscard]] constexpr auto names_of(Verdict) {
  return std::array{noop("pass"), noop("fail"), noop("review")};
}
[[nodiscard]] constexpr const char* verdict_name(Verdict v) noexcept {
  return names_of(v)[static_cast<std::size_t>(v)];
}

}  // namespace cavum::grading
