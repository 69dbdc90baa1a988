#include "engine/tooth/import/sense.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/import/orientation.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

constexpr double k_across_cosine = 0.70710678;  // 45 degrees
constexpr double k_centroids_apart_mm = 1.0;    // nearer ones tell no direction
constexpr double k_sure = 0.6;                  // a class guessed less surely contradicts nobody
constexpr double k_min_coronal_share = 0.35;    // of the pulp, in the coronal half of its length
constexpr double k_askew_deg = 30.0, k_wrong_deg = 50.0;
// Bays of the outlines of 8 human premolars and molars are at most 0.11 mm deep. A front tooth has
// its wide places at different heights: not tried.
constexpr double k_bay_mm = 0.6;
constexpr int k_directions = 72;

/// Refuses, or warns where the user has confirmed `name`.
void object(const SenseOptions& options, std::string_view name, const std::string& where,
            const Message& what, const Message& what_to_do, ToothSense& sense) {
  if (std::find(options.confirmed.begin(), options.confirmed.end(), name) ==
      options.confirmed.end())
    throw Error(ImportError::contradicted, Name{where}, what,
                msg("{}; where you know better, --confirm {} takes it as it is", what_to_do, name));
  sense.warnings.push_back(msg("confirmed against what was measured ({}): {}", name, what));
}

bool is_crown_width(double mm) { return mm >= k_min_crown_width_mm && mm <= k_max_crown_width_mm; }

/// Share of the pulp's leaves in the upper half of its height; none without pulp.
std::optional<double> coronal_share(const Tooth& tooth) {
  const Octree& tree = tooth.octree;
  std::vector<std::uint64_t> by_z(
      static_cast<std::size_t>(std::max(tree.size().z, 1)) + Octree::k_max_edge_leaves, 0);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != k_pulp) return;
    for (int z = at.z; z < at.z + edge; ++z)
      by_z[static_cast<std::size_t>(z)] +=
          static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge);
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

/// Incisors and canines: a worn or blunt canine has an edge, too, so their shapes contradict
/// nobody.
bool is_front(ToothClass kind) { return kind == ToothClass::incisor || kind == ToothClass::canine; }

/// How deep the deepest bay in the crown's outline is, seen from above, mm: how far a place lies
/// inside of every line that has all of it on one side.
double deepest_bay_mm(const Polyline& outline) {
  double deepest = 0;
  std::vector<double> bays(outline.size(), 1e9);
  for (int k = 0; k < k_directions && !outline.empty(); ++k) {
    const SinCos d = det_sincos(2 * k_pi * k / k_directions);
    double out = -1e9;
    for (const Vec3 p : outline) out = std::max(out, p.x * d.cos + p.y * d.sin);
    for (std::size_t i = 0; i < outline.size(); ++i)
      bays[i] = std::min(bays[i], out - outline[i].x * d.cos - outline[i].y * d.sin);
  }
  for (const double bay : bays) deepest = std::max(deepest, bay);
  return deepest;
}

/// The `--rotate-deg` that brings a frame right which is `deg` off, seen from above; +y was turned
/// over where it is mirrored.
double rotate_deg(const FrameOptions& frame, double deg) {
  const double to = std::round(frame.rotate_deg + (frame.mirror ? -deg : deg));
  return (to > 180 ? to - 360 : to <= -180 ? to + 360 : to) + 0.0;  // no -0
}

Message other_number(const SenseOptions& options) {
  return options.number ? msg("give the number of the other side, {}, if it is that tooth",
                              options.number->other_side().fdi)
                        : msg("give its --tooth-number: those of quadrants 2 and 4 are mirrored");
}

/// The user has said nothing of where mesial and buccal are: the file's axes stand for them by rule
/// alone.
bool said_nothing_of_sides(const FrameOptions& frame, const SenseOptions& options) {
  return !options.number && !frame.mesial_axis && options.patient_frame.empty() &&
         frame.rotate_deg == 0 && !frame.mirror;
}

/// Which way mesial and buccal are. What contradicts what was said is refused; where nothing was
/// said there is nothing to contradict, and a warning says what the shape shows, here and in every
/// task for the tooth.
void sense_orientation(const Landmarks& l, const FrameOptions& frame, const SenseOptions& options,
                       const std::string& where, ToothSense& sense) {
  const Orientation seen = seen_orientation(l, options.number);
  const int mesial = seen.mesial();
  const List signs{seen.mesial_signs};
  const auto contradict = [&](std::string_view name, const Message& what,
                              const Message& what_to_do) {
    if (said_nothing_of_sides(frame, options))
      sense.warnings.push_back(
          msg("nothing was said of mesial, and by rule {}; {}", what, what_to_do));
    else
      object(options, name, where, what, what_to_do, sense);
  };
  if (seen.turn) {
    const auto& [deg, line, reason] = *seen.turn;
    sense.guesses.push_back(
        line ? msg("mesiodistal line {} degrees from +x: {}", as_number(deg, 0), reason)
             : msg("buccal {} degrees from +y: {}", as_number(deg, 0), reason));
    const double off = std::fabs(deg);
    const std::string turn = fmt::format("--rotate-deg {:.0f}", rotate_deg(frame, deg));
    const Number degrees = as_number(deg, 0);
    const Message what =
        line
            ? msg("+x should be mesial, but the shape puts the mesiodistal line {} degrees off ({})",
                  degrees, reason)
            : msg("+y should be buccal, but the shape puts that side {} degrees off ({})", degrees,
                  reason);
    if (off > 180 - k_wrong_deg && (mesial > 0 || (mesial == 0 && frame.mesial_axis)))
      contradict(
          "side",
          mesial > 0
              ? msg("{}, and mesial where it should be: the tooth of the other side of the jaw",
                    what)
              : what,
          msg("{}, or say {} if mesial is on the other end", other_number(options), turn));
    else if (off > k_wrong_deg)
      contradict(
          "mesial", what,
          frame.mesial_axis ? msg("say {}, or another --mesial-axis", turn) : msg("say {}", turn));
    else if (off > k_askew_deg)
      sense.warnings.push_back(msg("{}: {} would bring it there", what, turn));
    if (off > k_wrong_deg)
      return;  // confirmed: mesial's own signs were looked for along the wrong line
  }
  if (mesial != 0)
    sense.guesses.push_back(mesial > 0 ? msg("mesial towards +x: {}", signs)
                                       : msg("mesial towards -x: {}", signs));
  if (mesial < 0) {
    const Message what =
        msg("+x should be mesial, but the shape puts that side towards -x ({})", signs);
    const std::string turn = fmt::format("--rotate-deg {:.0f}", rotate_deg(frame, 180));
    if (seen.buccal_told)
      contradict(
          "side",
          msg("{}, and buccal where it should be: the tooth of the other side of the jaw", what),
          other_number(options));
    else
      contradict("mesial", what, msg("say {}", turn));
  }
  if (!seen.turn && mesial == 0 && l.tooth_class.kind != ToothClass::unknown)
    sense.warnings.emplace_back(msg(
        "neither buccal nor mesial could be told from the shape: where they are was not checked"));
  else if (!frame.mesial_axis && mesial == 0)
    sense.warnings.emplace_back(msg(
        "which end is mesial was neither said nor told by the shape: +x was taken by rule, see the frame"));
}

}  // namespace

Vec3 mesial_in_patient(const ToothNumber& number, const std::string& patient_frame) {
  if (patient_frame != "lps" && patient_frame != "ras")
    throw Error("--patient-frame", msg("'{}' is no frame known here", patient_frame),
                msg("give lps or ras"));
  // degrees between the arch and the midplane at each tooth, of a parabola that fits a mean dental
  // arch: by eye, good to some 15 degrees
  static constexpr std::array<double, 8> k_arch_deg{85, 70, 52, 38, 28, 18, 10, 5};
  const SinCos turn =
      det_sincos(k_arch_deg[static_cast<std::size_t>(number.place() - 1)] * k_pi / 180);
  const Vec3 lps{number.left() ? -turn.sin : turn.sin, -turn.cos, 0};
  return patient_frame == "lps" ? lps : Vec3{-lps.x, -lps.y, 0};
}

FrameOptions settled_frame(const FrameOptions& frame, const SenseOptions& options) {
  FrameOptions settled = frame;
  if (!options.number) return settled;
  if (frame.mirror && options.number->y_is_buccal())
    throw Error(ImportError::contradicted, Name{"--mirror"},
                msg("would make +y lingual on tooth {}", options.number->in_words()),
                msg("leave it out, or give the number of the other side"));
  settled.mirror = !options.number->y_is_buccal();
  return settled;
}

void check_crown_size(Vec3 extent, const SenseOptions& options, const std::string& where,
                      bool of_volume, ToothSense& sense) {
  const double width = std::max(extent.x, extent.y);
  if (is_crown_width(width)) return;
  const double given = options.units.empty() ? 1.0 : mm_per_unit(options.units);
  std::vector<Message> likely, options_likely;
  for (const auto& u : k_mesh_units)
    if (u.mm != given && is_crown_width(width / given * u.mm)) {
      likely.push_back(msg("{} ({})", Term{std::string(u.text)}, as_mm(width / given * u.mm, 1)));
      options_likely.push_back(msg("--units {}", u.name));
    }
  const Message wide =
      msg("the enamel is {} wide, and human crowns {} to {}", as_mm(width, k_as_needed),
          as_number(k_min_crown_width_mm, 1), as_mm(k_max_crown_width_mm, 0));
  if (likely.empty())
    object(options, "size", where, msg("{}; no unit known here makes it one", wide),
           msg("check file and unit, and that it is one tooth alone, without its neighbours"),
           sense);
  else
    object(
        options, "size", where, msg("{}; the file is probably in one of: {}", wide, List{likely}),
        of_volume ? msg("give --spacing-mm") : msg("say one of: {}", List{options_likely}), sense);
}

void check_closed_pulp(const OpenPulp& open, const SenseOptions& options, const std::string& where,
                       ToothSense& sense) {
  constexpr double k_open_mm2 = 0.05;  // some leaves may touch where a surface is ragged
  if (open.mm2 <= k_open_mm2) return;
  object(
      options, "pulp", where,
      msg("the pulp lies open in the crown: {} of it, at ({} {} {}) mm", as_mm2(open.mm2, 2),
          as_number(open.at_mm.x, 1), as_number(open.at_mm.y, 1), as_number(open.at_mm.z, 1)),
      msg("check that the surfaces belong together; a tooth whose pulp is open is no exam's tooth"),
      sense);
}

void tell_bare_dentin(const BareDentin& bare, ToothSense& sense) {
  constexpr double k_bare_mm2 = 0.3;  // some leaves are bare where two meshes end upon each other
  if (bare.largest_mm2 <= k_bare_mm2) return;
  sense.warnings.push_back(msg(
      "dentin lies bare in the crown: {} of it, the largest place of {} about ({} {} {}) mm: worn, or the enamel has a hole, a crack or a "
      "cavity; look at it (tooth show) before it is an exam's tooth",
      as_mm2(bare.mm2, 1), as_mm2(bare.largest_mm2, 1), as_number(bare.at_mm.x, 1),
      as_number(bare.at_mm.y, 1), as_number(bare.at_mm.z, 1)));
}

void tell_loose_layers(const LayersApart& apart, const Overlaps& overlaps, ToothSense& sense) {
  // thirteen human teeth: at most 0.4, 0.2 and 0.3 %
  constexpr double k_apart = 0.01, k_enamel_in_dentin = 0.015, k_pulp_in_dentin = 0.03;
  const bool pulp_apart =
      overlaps.of_the_pulp > k_pulp_in_dentin &&
      overlaps.of_the_pulp < 0.5;  // more: the dentin has no chamber, and is meant so
  if (apart.share <= k_apart && overlaps.of_the_enamel <= k_enamel_in_dentin && !pulp_apart) return;
  sense.warnings.push_back(msg(
      "the surfaces fit loosely: void at {} of the places where enamel and dentin face each other, {} of the enamel and {} of the pulp in the "
      "dentin, too; see that all are of one tooth and in one frame",
      as_percent(100 * apart.share, 1), as_percent(100 * overlaps.of_the_enamel, 1),
      as_percent(pulp_apart ? 100 * overlaps.of_the_pulp : 0.0, 1)));
}

void tell_pieces(const EnamelPieces& pieces, ToothSense& sense) {
  if (pieces.apart_mm3 > 0)
    sense.warnings.push_back(msg(
        "{} of the enamel lie apart from the crown, about ({} {} {}) mm: a pearl, or a part of it",
        as_mm3(pieces.apart_mm3, 2), as_number(pieces.apart_mm.x, 1),
        as_number(pieces.apart_mm.y, 1), as_number(pieces.apart_mm.z, 1)));
}

void check_upright(Vec3 occlusal, Vec3 dentin_centroid, Vec3 enamel_centroid,
                   const SenseOptions& options, const std::string& where, ToothSense& sense) {
  const Vec3 along = enamel_centroid - dentin_centroid;
  if (options.number && !options.patient_frame.empty() &&
      (occlusal.z < 0) != options.number->upper())
    object(options, "upright", where,
           occlusal.z < 0
               ? msg("the crown points down in the patient, and tooth {} is an upper one",
                     options.number->in_words())
               : msg("the crown points up in the patient, and tooth {} is a lower one",
                     options.number->in_words()),
           msg("give another number or --patient-frame"), sense);
  if (!(length(along) > k_centroids_apart_mm)) return;
  const Vec3 way = normalized(along);
  const double cosine = dot(way, occlusal);
  if (cosine > k_across_cosine) return;
  const Number x = as_number(way.x, 2), y = as_number(way.y, 2), z = as_number(way.z, 2);
  object(
      options, "upright", where,
      cosine < -k_across_cosine
          ? msg("the occlusal axis points to the root: the tooth would stand upside down; the enamel lies towards ({} {} {})",
                x, y, z)
          : msg("the occlusal axis runs across the tooth; the enamel lies towards ({} {} {})", x, y,
                z),
      msg("give --occlusal-axis {},{},{}, or leave it out", x, y, z), sense);
}

void sense_tooth(const Tooth& tooth, const FrameOptions& frame, const SenseOptions& options,
                 const std::string& where, ToothSense& sense) {
  const Landmarks l = find_landmarks(tooth);
  sense.tooth_class = l.tooth_class;
  const Message kind = in_words(l.tooth_class.kind);
  if (l.tooth_class.kind == ToothClass::unknown)
    sense.guesses.push_back(l.tooth_class.reason.empty()
                                ? msg("class not told")
                                : msg("class not told: {}", l.tooth_class.reason));
  else
    sense.guesses.push_back(msg("{}, sure to {}: {}", kind, as_number(l.tooth_class.probability, 2),
                                l.tooth_class.reason));
  if (options.number) {
    const ToothClass said = options.number->tooth_class();
    if (l.tooth_class.kind == ToothClass::unknown)
      sense.warnings.push_back(
          msg("whether it is tooth {} could not be checked", options.number->in_words()));
    else if (l.tooth_class.kind != said && l.tooth_class.probability >= k_sure &&
             !(is_front(l.tooth_class.kind) && is_front(said)))
      object(options, "class", where,
             msg("it is said to be tooth {}, but by its shape it is {} ({})",
                 options.number->in_words(), kind, l.tooth_class.reason),
             msg("give another number"), sense);
    else if (l.tooth_class.kind != said)
      sense.warnings.push_back(
          msg("tooth {}: by its shape rather {}", options.number->in_words(), kind));
  }
  if (const auto share = coronal_share(tooth); share && *share < k_min_coronal_share)
    object(
        options, "pulp", where,
        msg("only {} of the pulp lie in the half of its length that is nearer to the crown: crown and root may be exchanged",
            as_percent(100 * *share, 0)),
        msg("check that the three layers belong together and which way is occlusal"), sense);
  if (const double bay = deepest_bay_mm(l.height_of_contour_mm);
      bay > k_bay_mm && !is_front(l.tooth_class.kind))
    object(
        options, "outline", where,
        msg("the crown's outline, seen from above, has a bay of {}, as no crown has: a piece of another tooth may hang on it, or a piece of it is "
            "missing (a cavity, a break)",
            as_mm(bay, 1)),
        msg("look at the surfaces and cut off what is not of this tooth"), sense);
  if (options.number && frame.mirror)
    sense.warnings.push_back(msg(
        "tooth {} is taken as its mirror image, so that +x is mesial and +y buccal in every task, picture and word",
        options.number->fdi));
  sense_orientation(l, frame, options, where, sense);
}

void name_tooth(const ToothSense& sense, const SenseOptions& options, bool mirrored, Tooth& tooth) {
  if (options.number) {
    tooth.name = fmt::format("{}{}; {}", name_with(*options.number),
                             mirrored ? ", mirror image" : "", tooth.name);
    tooth.kind = ToothKind(*options.number);
  }
  if (mirrored) tooth.notes.push_back({ToothNote::Kind::mirror_image, {}});
  for (const auto& g : sense.guesses) tooth.notes.push_back({ToothNote::Kind::guess, g});
  for (const auto& w : sense.warnings) tooth.notes.push_back({ToothNote::Kind::warning, w});
}

}  // namespace cavum
