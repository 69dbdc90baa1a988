// What an instructor writes: one TOML file with the tooth, the burs, the steps, the zones and the
// rubric of an exam. Plain data; `parse_scenario` (parse.h) reads it, `build_zones` (zone_map.h)
// lays its zones into a tooth, `Runner` (runner.h) runs its steps, and grading reads the rubric.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/hash.h"
#include "engine/base/vec.h"

namespace cavum {
struct TriangleMesh;
}

namespace cavum::scenarios {

/// Which leaves of a tissue a shape speaks of. The chamber of a pulp is what lies above its floor:
/// the level where, going down from the widest slice, the pulp parts into canals or narrows to a
/// third.
enum class TissuePart { all, chamber };

/// A closed line on the occlusal surface, seen from above. All lengths in mm, tooth frame x and y.
struct OutlineSpec {
  enum class Kind {
#define OUTLINE(KIND, ...) KIND,
#include "scenarios/file/outlines_table.inc"
  };
  Kind kind{};
  Vec3 centre_mm;  ///< added to every point; z unused
  bool from_chamber =
      false;  ///< centre counted from the middle of the pulp chamber instead of the tooth's origin
  double radius_mm = 0.0;       ///< circle
  std::vector<Vec3> points_mm;  ///< polygon corners, or the path of a stroke
  double width_mm = 0.0;        ///< of a stroke, and along a fissure
  std::string tissue = "pulp";  ///< projection: seen from above, the shadow of this tissue
  TissuePart part = TissuePart::all;
  double offset_mm = 0.0;    ///< moves the outline outwards (negative: inwards)
  double rounding_mm = 0.0;  ///< projection: no notch and no corner sharper than this radius
  double ridge_mm =
      0.0;  ///< fissure: of each marginal ridge that stays, from its crest to the outline
  bool branches = false;  ///< fissure: its branches, too
  int through = 0;        ///< fissure: goes on through the mesial (+1) or distal (-1) ridge
  std::vector<std::vector<Vec3>>
      paths_mm;  ///< fissure: its lines on the tooth, once it was placed there ...
  std::vector<Vec3> bottom_line_mm;  ///< ... and the bottom of the central one between the ridges,
                                     ///< z at the surface
};

/// Where a column ends.
struct BottomSpec {
  enum class Kind {
#define BOTTOM(KIND, ...) KIND,
#include "scenarios/file/bottoms_table.inc"
  };
  Kind kind{};
  double z_mm = 0.0;      ///< level: height in the tooth frame
  double depth_mm = 0.0;  ///< below the surface (everywhere, or its lowest or mean height inside
                          ///< the outline), or below the lowest enamel under it
  std::string tissue = "pulp";
  TissuePart part = TissuePart::all;
  double deeper_mm = 0.0;  ///< moves a tissue's roof or floor down
};

/// A body of one of the kinds of bodies_table.inc, which says what belongs to each. Bodies of a
/// list are combined in their order.
struct ShapeSpec {
  enum class Kind {
#define BODY(KIND, ...) KIND,
#include "scenarios/file/bodies_table.inc"
  };
  enum class Combine { add, subtract, intersect };
  Kind kind{};
  Combine combine = Combine::add;
  Vec3 at_mm;             ///< centre, or middle of the lower face
  Vec3 axis{0, 0, 1};     ///< from the lower face upwards, unit
  double turn_deg = 0.0;  ///< about the axis
  Vec3 size_mm;           ///< along x, y and the axis
  double radius_mm = 0.0, top_radius_mm = 0.0,
         height_mm = 0.0;  ///< of a canal's cone: radius at the mouth, 0 = the mouth's own
  OutlineSpec outline;
  BottomSpec bottom;
  double taper_deg = 0.0;  ///< its walls open by this angle towards the occlusal side; of a crown
                           ///< they lean inwards
  bool leans = false;      ///< along the way in from lingual of a front tooth (leaning_column.h)
  std::string tissue = "pulp";  ///< what it follows ...
  TissuePart part = TissuePart::all;
  double offset_mm = 0.0;  ///< ... grown by this much
  std::string file;        ///< STL: as written, relative to the scenario's file; else empty
  Sha256 file_sha256{};    ///< of the file, once it was read
  std::shared_ptr<const TriangleMesh>
      surface;  ///< what the file holds, tooth frame; null until read_surfaces (surface_files.h)
  int canals_x = 0,
      canals_y =
          0;  ///< only canals on this side of the chamber's middle, +1 mesial / buccal; 0 = either
  double deeper_mm = 0.0;      ///< begins this far below the canal's mouth
  int side = 1;                ///< at the mesial or buccal (+1), distal or lingual (-1) surface
  double width_mm = 0.0;       ///< from buccal to lingual
  double depth_mm = 0.0;       ///< from the outer surface inwards
  double above_neck_mm = 0.0;  ///< of its floor or finish line above the cemento-enamel junction
  bool level =
      false;  ///< heights count from the neck's middle, else from the neck below each place
  double occlusal_mm = 0.0;  ///< of what is taken off the occlusal surface or the incisal edge
  int line = 0, column = 0;  ///< in the scenario file, for messages
};

/// Width of a zone beside and below the target, mm, measured from the target's surface.
struct MarginSpec {
  double sides_mm = 0.0, bottom_mm = 0.0;
};

struct ZoneSpec {
  std::vector<ShapeSpec> target;            ///< to remove
  MarginSpec leeway;                        ///< tolerated
  MarginSpec container;                     ///< damage; beyond it lies `outside`
  std::vector<ShapeSpec> protected_shapes;  ///< must stay, even inside leeway and container:
                                            ///< belongs to neither, and counts as outside
};

struct StepSpec {
  std::string id, instruction;
  std::string complete_when;           ///< expression over live quantities
  std::string fail_when;               ///< may be empty
  std::optional<double> time_limit_s;  ///< of this step; when it passes, the step has failed
  bool failure_ends_exam = false;
};

/// Where something stands in the file, from 1; 0 = not written.
struct Place {
  int line = 0, column = 0;
};

/// Which tissues may be broken into, and which must not.
struct PerforationSpec {
  std::vector<std::string> aims, faults;
};

struct CriterionSpec {
  std::string id, title, metric;
  double full = 0.0, zero = 0.0;  ///< metric value for full and for no points; linear between
  double points = 0.0;
  std::optional<double> critical_above,
      critical_below;                    ///< beyond it the exam is failed whatever the sum
  std::vector<double> band_limits = {};  ///< where each of the rubric's bands but the last ends,
                                         ///< from `full` on; empty: in no band
  std::vector<std::string> shares_with =
      {};  ///< ids of criteria that charge the same mistakes, and are meant to
  Place metric_at = {}, zero_at = {};  ///< in the rubric's file
};

/// A grade in words, as licensing boards give one to each criterion.
struct BandSpec {
  std::string name;
  std::optional<int> most = {};  ///< criteria that may lie in it or in a worse one: one more fails
                                 ///< the exam; none: any number
};

struct RubricSpec {
  bool compensatory = true;         ///< points of one criterion may make up for another
  double pass_percent = 60.0;       ///< of all points (non-compensatory: of each criterion's)
  double borderline_percent = 0.0;  ///< this close to the pass mark a person decides
  bool open_step_passes =
      false;  ///< an exam whose last step is open may pass by its points; else a person decides
  bool review_within_bound =
      false;  ///< a person decides where the bounds of the figures leave the verdict open
  std::vector<BandSpec> bands = {};  ///< best first, two at least; empty: points alone decide
  std::vector<CriterionSpec> criteria;
  std::string path;  ///< file it was read from
};

/// The mistake that the task exists to catch, made by the simulated candidate `careless`: it cuts
/// as an expert would who has understood the target wrongly, and the exam must fail it by criterion
/// `fails_by`.
struct CarelessSpec {
  std::string fails_by;  ///< empty: the scenario says nothing of it
  double sides_mm =
      0.0;  ///< this far beyond the target's sides (negative: it stays away from them)
  double bottom_mm = 0.0;  ///< and below its floor
  double opening_percent =
      100.0;                ///< cuts only in the middle of the outline: of its length and width
  bool perforates = false;  ///< goes on through the floor into the first tissue of
                            ///< perforation.faults that lies below
  friend bool operator==(const CarelessSpec&, const CarelessSpec&) = default;
};

/// Changes granted to one candidate; recorded with the result. An exam may be begun with others
/// than its file says.
struct Accommodations {
  double extra_time_percent = 0.0;  ///< of every time limit
  double extra_time_s = 0.0;  ///< besides, of the exam's limit; steps get as much in proportion
  bool left_handed = false;
  bool high_contrast = false;
  friend bool operator==(const Accommodations&, const Accommodations&) = default;
};

/// Breaks that the candidate may take with a button of the stylus while the handpiece stands still.
/// In a break the clock of exam and step stands still, the handpiece stays off, and no condition is
/// looked at.
struct PauseSpec {
  int count = 0;           ///< breaks allowed; 0 = none
  double longest_s = 0.0;  ///< after which a break ends by itself
  int button = 2;          ///< 1 or 2: pressed once to begin, once more to go on
};

/// What the window shows of the work while the exam runs. Practice shows all of it.
struct GaugeSpec {
  bool speed = false, force = false, depth = false;
};

/// By language ("de"): what stands for each English text of a scenario.
using Translations = std::map<std::string, std::map<std::string, std::string>>;

struct Scenario {
  std::string id, title, description;
  std::string path;        ///< file it was read from
  std::string tooth_file;  ///< as written
  std::vector<std::string>
      burs;  ///< allowed burs, names of data/burs/NAME.toml; the first is mounted
  double max_rpm = 200000.0;
  double time_limit_s = 0.0;
  double force_limit_n =
      0.0;  ///< pressing harder than this counts as force over limit; 0 = no limit
  Accommodations accommodations;
  PauseSpec pauses;
  GaugeSpec gauges;
  bool hold_results = false;  ///< the station shows none: the school releases them
  std::vector<StepSpec> steps;
  ZoneSpec zones;
  PerforationSpec perforation;
  RubricSpec rubric;
  CarelessSpec careless;
  Translations languages;
  std::map<std::string, Place> places;  ///< by "time_limit_s", "burs/2", "steps/0/complete_when",
                                        ///< "zones/target/1", "rubric/criteria/3/metric" ...
};

}  // namespace cavum::scenarios
