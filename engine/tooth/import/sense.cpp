#include "engine/tooth/import/sense.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr double k_across_cosine = 0.70710678;  // 45 degrees
constexpr double k_centroids_apart_mm = 1.0;    // nearer ones tell no direction
constexpr double k_sure = 0.6;                  // a class guessed less surely contradicts nobody
constexpr double k_least_coronal_share = 0.35;  // of the pulp, in the coronal half of its length
constexpr double k_degrees = 57.29577951308232;
constexpr double k_askew_deg = 30.0, k_wrong_deg = 50.0;
constexpr double k_neck_wave_mm = 0.35;  // least height of the neck's two waves that tells the mesiodistal line
constexpr double k_higher_mm = 0.5;
// Bays of the outlines of 8 human premolars and molars are at most 0.11 mm deep. A front tooth has its wide places at different heights: not tried.
constexpr double k_bay_mm = 0.6;
constexpr int k_directions = 72;

/// Refuses, or warns where the user takes it anyway.
void object(const SenseOptions& options, const std::string& where, const std::string& what, const std::string& what_to_do, ToothSense& sense) {
  if (!options.anyway) throw Error(where, what, what_to_do + ", or --anyway to take it as it is");
  sense.warnings.push_back("taken anyway: " + what);
}

bool is_crown_width(double mm) { return mm >= k_least_crown_width_mm && mm <= k_most_crown_width_mm; }

/// Share of the pulp's leaves in the upper half of its height; none without pulp.
std::optional<double> coronal_share(const Tooth& tooth) {
  const Octree& tree = tooth.octree;
  std::vector<std::uint64_t> by_z(static_cast<std::size_t>(std::max(tree.size().z, 1)) + Octree::k_max_edge_leaves, 0);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != k_pulp) return;
    for (int z = at.z; z < at.z + edge; ++z) by_z[static_cast<std::size_t>(z)] += static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge);
  });
  std::size_t low = 0, high = by_z.size();
  while (low < high && by_z[low] == 0) ++low;
  while (high > low && by_z[high - 1] == 0) --high;
  if (high <= low + 4) return std::nullopt;
  std::uint64_t all = 0, upper = 0;
  for (std::size_t z = low; z < high; ++z) {
    all += by_z[z];
    if (z >= (low + high) / 2) upper += by_z[z];
  }
  return static_cast<double>(upper) / static_cast<double>(all);
}

/// Incisors and canines: a worn or blunt canine has an edge, too, so their shapes contradict nobody.
bool is_front(ToothClass kind) { return kind == ToothClass::incisor || kind == ToothClass::canine; }

/// How deep the deepest bay in the crown's outline is, seen from above, mm: how far a place lies inside of every line that has all of it on one side.
double deepest_bay_mm(const Polyline& outline) {
  double deepest = 0;
  std::vector<double> bays(outline.size(), 1e9);
  for (int k = 0; k < k_directions && !outline.empty(); ++k) {
    const SinCos d = det_sincos(2 * k_pi * k / k_directions);
    double out = -1e9;
    for (const Vec3 p : outline) out = std::max(out, p.x * d.cos + p.y * d.sin);
    for (std::size_t i = 0; i < outline.size(); ++i) bays[i] = std::min(bays[i], out - outline[i].x * d.cos - outline[i].y * d.sin);
  }
  for (const double bay : bays) deepest = std::max(deepest, bay);
  return deepest;
}

/// Angle of a line from +x, -90 to 90 degrees, counter-clockwise seen from above.
double line_deg(double x, double y) {
  double deg = std::atan2(y, x) * k_degrees;
  if (deg > 90) deg -= 180;
  if (deg <= -90) deg += 180;
  return deg;
}

struct LineGuess {
  double deg;
  std::string reason;
  bool sure;
};

/// The mesiodistal line: along a front tooth's edge; across the line of a premolar's two cusps; else through the two places where the neck stands
/// high.
std::optional<LineGuess> mesiodistal_line(const Landmarks& l) {
  if (l.incisal_edge_mm.size() > 4 && l.tooth_class.kind == ToothClass::incisor) {
    const Vec3 way = l.incisal_edge_mm.front() - l.incisal_edge_mm.back();
    return LineGuess{line_deg(way.x, way.y), "the incisal edge runs along it", true};
  }
  if (l.tooth_class.kind == ToothClass::premolar && l.cusps.size() == 2) {
    const Vec3 across = l.cusps[0].tip_mm - l.cusps[1].tip_mm;
    return LineGuess{line_deg(-across.y, across.x), "the two cusps stand across it", true};
  }
  if (l.tooth_class.kind == ToothClass::premolar && l.cusps.size() == 1 && !l.occlusal_table_mm.empty()) {
    Vec3 table;
    for (const Vec3 p : l.occlusal_table_mm) table += p;
    const Vec3 across = l.cusps[0].tip_mm - table / static_cast<double>(l.occlusal_table_mm.size());
    return LineGuess{line_deg(-across.y, across.x), "the cusp and the table stand across it", false};
  }
  if (l.neck_mm.size() < 36) return std::nullopt;
  // second harmonic of the neck's height around the crown: it rises towards the neighbours
  const Vec3 through = l.long_axis.through_mm, axis = l.long_axis.occlusal;
  double c = 0, s = 0;
  for (const Vec3 p : l.neck_mm) {
    const Vec3 out = p - through;
    const double r2 = std::max(out.x * out.x + out.y * out.y, 1e-9), height = dot(out, axis);
    c += height * (out.x * out.x - out.y * out.y) / r2;
    s += height * 2 * out.x * out.y / r2;
  }
  c *= 2.0 / static_cast<double>(l.neck_mm.size());
  s *= 2.0 / static_cast<double>(l.neck_mm.size());
  const double wave = 2 * std::sqrt(c * c + s * s);
  if (wave < k_neck_wave_mm) return std::nullopt;
  const double deg = 0.5 * std::atan2(s, c) * k_degrees;
  return LineGuess{deg, fmt::format("the neck stands {:.1f} mm higher there than across", wave), false};
}

void sense_line(const Landmarks& l, bool mesial_given, const SenseOptions& options, const std::string& where, ToothSense& sense) {
  const auto line = mesiodistal_line(l);
  if (!line) {
    if (l.tooth_class.kind != ToothClass::unknown) sense.warnings.emplace_back("the mesiodistal line could not be told from the shape");
    return;
  }
  sense.guesses.push_back(fmt::format("mesiodistal line {:.0f} degrees from +x: {}", line->deg, line->reason));
  const double off = std::fabs(line->deg);
  if (off < k_askew_deg) return;
  const std::string what =
      fmt::format("+x should be mesial, but the shape puts the mesiodistal line {:.0f} degrees off ({})", line->deg, line->reason);
  if (mesial_given && line->sure && off > k_wrong_deg)
    object(options, where, what, "check --mesial-axis and --rotate-deg", sense);
  else if (line->sure || !mesial_given)  // what was said weighs more than the neck's wave, which was 77 degrees off on a human molar
    sense.warnings.push_back(what + fmt::format("; --rotate-deg {:.0f} more would bring it there", line->deg));
}

void sense_sides(const Landmarks& l, bool says_lingual, ToothSense& sense) {
  if (l.tooth_class.kind != ToothClass::premolar) return;
  if (l.cusps.size() == 1) {  // the lingual one of lower premolars may be too low to stand out, the buccal one never is
    constexpr double k_off_axis_mm = 0.4;
    const double y = l.cusps[0].tip_mm.y - l.long_axis.through_mm.y;
    if (std::fabs(y) > k_off_axis_mm && (y < 0) != says_lingual)
      sense.warnings.push_back(
          fmt::format("+y should be {}, but the only cusp that stands out lies {:.1f} mm to the other side: the frame may be turned or "
                      "mirrored; check --patient-frame, --mesial-axis and --mirror",
                      says_lingual ? "lingual" : "buccal", std::fabs(y)));
    return;
  }
  if (l.cusps.size() != 2) return;
  const double higher = l.cusps[0].tip_mm.z - l.cusps[1].tip_mm.z;
  if (std::fabs(higher) < k_higher_mm) return;
  sense.guesses.push_back(
      fmt::format("buccal towards {}y: the cusp there is {:.1f} mm higher, as premolars have it", higher > 0 ? '+' : '-', std::fabs(higher)));
  if ((higher < 0) != says_lingual)
    sense.warnings.push_back(fmt::format("+y should be {}, but the higher cusp stands on the other side: mesial and distal may be exchanged",
                                         says_lingual ? "lingual" : "buccal"));
}

}  // namespace

int ToothNumber::universal() const noexcept {
  switch (quadrant()) {
    case 1:
      return 9 - place();
    case 2:
      return 8 + place();
    case 3:
      return 25 - place();
    default:
      return 24 + place();
  }
}

ToothClass ToothNumber::tooth_class() const noexcept {
  return place() <= 2 ? ToothClass::incisor : place() == 3 ? ToothClass::canine : place() <= 5 ? ToothClass::premolar : ToothClass::molar;
}

std::string ToothNumber::text() const {
  static constexpr std::array<const char*, 8> k_names{"central incisor", "lateral incisor", "canine",       "first premolar",
                                                      "second premolar", "first molar",     "second molar", "third molar"};
  return fmt::format("{} (universal {}), {} {} {}", fdi, universal(), upper() ? "upper" : "lower", left() ? "left" : "right",
                     k_names[static_cast<std::size_t>(place() - 1)]);
}

ToothNumber from_fdi(int number, const std::string& option) {
  const ToothNumber n{number};
  if (number < 11 || n.quadrant() > 4 || n.place() < 1 || n.place() > 8)
    throw Error(option, fmt::format("{} is no permanent tooth of the FDI", number), "give 11 to 18, 21 to 28, 31 to 38 or 41 to 48");
  return n;
}

ToothNumber from_universal(int number, const std::string& option) {
  if (number < 1 || number > 32) throw Error(option, fmt::format("{} is no permanent tooth of the universal system", number), "give 1 to 32");
  const int fdi = number <= 8 ? 10 + 9 - number : number <= 16 ? 20 + number - 8 : number <= 24 ? 30 + 25 - number : 40 + number - 24;
  return from_fdi(fdi, option);
}

Vec3 mesial_in_patient(const ToothNumber& number, const std::string& patient_frame) {
  if (patient_frame != "lps" && patient_frame != "ras")
    throw Error("--patient-frame", fmt::format("'{}' is no frame known here", patient_frame), "give lps or ras");
  // degrees between the arch and the midplane at each tooth, of a parabola that fits a mean dental arch: by eye, good to some 15 degrees
  static constexpr std::array<double, 8> k_arch_deg{85, 70, 52, 38, 28, 18, 10, 5};
  const SinCos turn = det_sincos(k_arch_deg[static_cast<std::size_t>(number.place() - 1)] * k_pi / 180);
  const Vec3 lps{number.left() ? -turn.sin : turn.sin, -turn.cos, 0};
  return patient_frame == "lps" ? lps : Vec3{-lps.x, -lps.y, 0};
}

void check_crown_size(Vec3 extent, const SenseOptions& options, const std::string& where, bool of_volume, ToothSense& sense) {
  const double width = std::max(extent.x, extent.y);
  if (is_crown_width(width)) return;
  const double given = options.units.empty() ? 1.0 : mm_per_unit(options.units);
  std::string likely, option;
  for (const auto& u : k_mesh_units)
    if (u.mm != given && is_crown_width(width / given * u.mm)) {
      likely += fmt::format("{}{} ({:.1f} mm)", likely.empty() ? "" : " or ", u.text, width / given * u.mm);
      option += fmt::format("{}--units {}", option.empty() ? "" : " or ", u.name);
    }
  const std::string wide =
      fmt::format("the enamel is {:.4g} mm wide, and human crowns {:.1f} to {:.0f} mm", width, k_least_crown_width_mm, k_most_crown_width_mm);
  if (likely.empty())
    object(options, where, wide + "; no unit known here makes it one", "check file and unit", sense);
  else
    object(options, where, fmt::format("{}; the file is probably in {}", wide, likely), of_volume ? "give --spacing-mm" : "say " + option, sense);
}

void check_upright(Vec3 occlusal, Vec3 dentin_centroid, Vec3 enamel_centroid, const SenseOptions& options, const std::string& where,
                   ToothSense& sense) {
  const Vec3 along = enamel_centroid - dentin_centroid;
  if (options.number && !options.patient_frame.empty() && (occlusal.z < 0) != options.number->upper())
    object(options, where,
           fmt::format("the crown points {} in the patient, and tooth {} is {}", occlusal.z < 0 ? "down" : "up", options.number->text(),
                       options.number->upper() ? "an upper one" : "a lower one"),
           "give another number or --patient-frame", sense);
  if (!(length(along) > k_centroids_apart_mm)) return;
  const Vec3 way = normalized(along);
  const double cosine = dot(way, occlusal);
  if (cosine > k_across_cosine) return;
  const char* how = cosine < -k_across_cosine ? "points to the root: the tooth would stand upside down" : "runs across the tooth";
  object(options, where, fmt::format("the occlusal axis {}; the enamel lies towards ({:.2f} {:.2f} {:.2f})", how, way.x, way.y, way.z),
         fmt::format("give --occlusal-axis {:.2f},{:.2f},{:.2f}, or leave it out", way.x, way.y, way.z), sense);
}

void sense_tooth(const Tooth& tooth, const FrameOptions& frame, const SenseOptions& options, const std::string& where, ToothSense& sense) {
  const Landmarks l = find_landmarks(tooth);
  sense.tooth_class = l.tooth_class;
  const std::string kind(name_of(l.tooth_class.kind));
  if (l.tooth_class.kind == ToothClass::unknown)
    sense.guesses.push_back(fmt::format("class not told{}{}", l.tooth_class.reason.empty() ? "" : ": ", l.tooth_class.reason));
  else
    sense.guesses.push_back(fmt::format("class {}, sure to {:.2f}: {}", kind, l.tooth_class.sureness, l.tooth_class.reason));
  if (options.number) {
    const char* article = l.tooth_class.kind == ToothClass::incisor ? "an" : "a";
    const ToothClass said = options.number->tooth_class();
    if (l.tooth_class.kind == ToothClass::unknown)
      sense.warnings.push_back("whether it is tooth " + options.number->text() + " could not be checked");
    else if (l.tooth_class.kind != said && l.tooth_class.sureness >= k_sure && !(is_front(l.tooth_class.kind) && is_front(said)))
      object(options, where,
             fmt::format("it is said to be tooth {}, but has the shape of {} {} ({})", options.number->text(), article, kind, l.tooth_class.reason),
             "give another number", sense);
    else if (l.tooth_class.kind != said)
      sense.warnings.push_back(fmt::format("tooth {} has rather the shape of {} {}", options.number->text(), article, kind));
  }
  if (const auto share = coronal_share(tooth); share && *share < k_least_coronal_share)
    object(options, where,
           fmt::format("only {:.0f} % of the pulp lie in the half of its length that is nearer to the crown: crown and root may be exchanged",
                       100 * *share),
           "check that the three layers belong together and which way is occlusal", sense);
  if (const double bay = deepest_bay_mm(l.height_of_contour_mm); bay > k_bay_mm && !is_front(l.tooth_class.kind))
    object(options, where,
           fmt::format("the crown's outline, seen from above, has a bay of {:.1f} mm, as no crown has: a piece of another tooth may hang on it", bay),
           "look at the surfaces and cut off what is not of this tooth", sense);
  const bool mesial_given = frame.mesial_axis.has_value();
  sense_line(l, mesial_given, options, where, sense);
  const bool y_is_lingual = options.number && options.number->y_is_buccal() == frame.mirror;
  sense_sides(l, y_is_lingual, sense);
  if (y_is_lingual)
    sense.warnings.push_back(
        fmt::format("+y is lingual on tooth {}, and landmarks take it for buccal: --mirror makes it so", options.number->text()));
  if (!mesial_given) sense.warnings.emplace_back("which end is mesial was not said: +x was taken by rule, see the frame");
}

void name_tooth(const ToothSense& sense, const SenseOptions& options, bool mirrored, Tooth& tooth) {
  if (options.number) {
    tooth.name = fmt::format("tooth {}; {}", options.number->text(), tooth.name);
    const bool buccal = options.number->y_is_buccal() != mirrored;
    const bool front = options.number->place() <= 3;
    tooth.source += fmt::format("; tooth number given: FDI {}, universal {}; +y is {}", options.number->fdi, options.number->universal(),
                                buccal ? (front ? "labial" : "buccal") : "lingual");
  }
  if (mirrored) tooth.source += "; mirrored";
  for (const auto& g : sense.guesses) tooth.source += "; guess: " + g;
  for (const auto& w : sense.warnings) tooth.source += "; warning: " + w;
}

}  // namespace cavum
