// What a dentist would point at on a tooth: cusp tips, fissures, pits, marginal ridges, the neck,
// the pulp's horns and canals. Found in the leaves of any crown that stands in the tooth frame (a
// maker's, or a scan's), so that zones can be laid from them. What a tooth lacks, and what cannot
// be told, is absent. Definitions, sources and figures: docs/anatomy.md.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tooth/tooth.h"

namespace cavum {

/// "incisor", "unknown", ...
[[nodiscard]] std::string_view name_of(ToothClass kind) noexcept;
/// For people: "a molar".
[[nodiscard]] Message in_words(ToothClass kind);

/// Points in a row, mm of the tooth frame. A closed one does not repeat its first point.
using Polyline = std::vector<Vec3>;

struct ClassGuess {
  ToothClass kind = ToothClass::unknown;
  double probability = 0.0;  ///< 0 to 1: how many of the signs agree, none against the guess
  Message reason;            ///< the signs with their figures, for people
};

enum class CuspSide : std::uint8_t { untold, buccal, lingual };

struct CuspTip {
  std::string
      name;  ///< "mesiobuccal", "buccal", ...; "cusp 3" where the place has no name of its own
  Vec3 tip_mm;
  double prominence_mm = 0.0;        ///< above the highest way to a higher cusp
  CuspSide side = CuspSide::untold;  ///< of one whose place has a name of its own, as it was found
};

/// The crest between two cusps at the mesial or distal end of the occlusal table.
struct MarginalRidge {
  Polyline crest_mm;              ///< from the buccal to the lingual cusp; empty when absent
  std::optional<Vec3> lowest_mm;  ///< lowest place of the crest
};

struct CanalOpening {
  Vec3 at_mm;              ///< middle of the opening
  double radius_mm = 0.0;  ///< of a circle of its area
};

struct LongAxis {
  Vec3 through_mm;         ///< middle of the neck, else of the crown
  Vec3 occlusal{0, 0, 1};  ///< unit vector
  double tilt_deg = 0.0;   ///< against the tooth frame's +z
};

/// All points mm of the tooth frame. Empty, or no value: the tooth has none, or it could not be
/// told.
struct Landmarks {
  ClassGuess tooth_class;
  LongAxis long_axis;
  std::vector<CuspTip> cusps;         ///< buccal ones from mesial to distal, then lingual ones
  std::vector<Polyline> cusp_ridges;  ///< from each cusp tip along the edge of the occlusal table
  MarginalRidge mesial_ridge, distal_ridge;
  Polyline central_fissure_mm;                ///< from the mesial to the distal pit
  std::vector<Polyline> fissure_branches_mm;  ///< each from the central fissure outwards
  std::optional<Vec3> mesial_pit_mm, central_pit_mm, distal_pit_mm;
  Polyline incisal_edge_mm;       ///< of a front tooth, from mesial to distal
  Polyline occlusal_table_mm;     ///< closed: along cusp ridges and marginal ridges
  Polyline height_of_contour_mm;  ///< closed: the widest place of the crown in every direction
  Polyline neck_mm;  ///< closed: the cemento-enamel junction, where enamel ends on the outside
  std::vector<Vec3> pulp_horns_mm;
  std::optional<Vec3> chamber_roof_mm,
      chamber_floor_mm;  ///< lowest place of the roof over the chamber's middle; middle of the
                         ///< floor. No floor: one canal
  std::vector<CanalOpening>
      canal_mouths;  ///< where canals leave the chamber; of a single canal: at the neck
  std::vector<Vec3> apices_mm;
  std::vector<std::string>
      moved;  ///< names of the points that a person put, see Tooth::placed_landmarks
  std::vector<Message> notes;  ///< what is absent or doubtful, and why, for people
};

/// Finds them. Uses only + - * / and sqrt in a fixed order: the same tooth gives the same bits
/// everywhere. Below 2 s for a molar of 0.05 mm leaves. Of a tooth with neighbours or gum
/// (adjacent.h) they are those of the tooth alone. Points that a person put
/// (Tooth::placed_landmarks) stand in place of what was found. Never throws for a tooth without
/// anatomy (a block): then nearly all is absent.
[[nodiscard]] Landmarks find_landmarks(const Tooth& tooth);

/// Every single point by its name, in a fixed order: `cusp_1`, ..., `mesial_ridge`, `distal_ridge`,
/// `mesial_pit`, `central_pit`, `distal_pit`, `pulp_horn_1`, `chamber_roof`, `chamber_floor`,
/// `canal_mouth_1`, `apex_1`. These are the names that a person may set.
[[nodiscard]] std::vector<NamedPoint> named_points(const Landmarks& landmarks);
/// Whether `name` is one that find_landmarks understands (numbers 1 to 16).
[[nodiscard]] bool is_landmark_name(std::string_view name) noexcept;

}  // namespace cavum
