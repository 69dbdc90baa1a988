#include "engine/physics/bur/bur.h"

#include <fmt/core.h>

#include <array>

#include "engine/base/text.h"
#include "engine/base/toml_reader.h"

namespace cavum {
namespace {

/// Titles in data/burs: the catalogue takes them from here.
[[maybe_unused]] constexpr std::array k_titles{noop("Cylinder, flat end, 1.0 mm"),
                                               noop("Cylinder, round end, 1.0 mm"),
                                               noop("Endodontic access, long, 1.0 mm ball end"),
                                               noop("Flame, 1.0 mm"),
                                               noop("Inverted cone, 1.0 mm"),
                                               noop("Needle, 0.8 mm"),
                                               noop("Pear, 1.0 mm"),
                                               noop("Round, 0.8 mm"),
                                               noop("Round, 1.0 mm"),
                                               noop("Round, 1.4 mm"),
                                               noop("Taper, flat end, 1.0 mm"),
                                               noop("Taper, round end, 1.2 mm")};

}  // namespace

Bur parse_bur(const std::string& text, const std::string& where) {
  const toml::table document = parse_toml(text, where);
  TomlReader in(document, where);
  Bur bur;
  bur.name = in.text("name");
  bur.title = in.text("title");
  bur.cutting_length_mm = in.number("cutting_length_mm", 0.1, 20);
  const toml::array* pieces = in.array("profile");
  if (pieces == nullptr)
    in.fail("profile", msg("is missing"), msg("list {{r_mm, z_mm}} from the tip upwards"));
  constexpr std::size_t k_max_pieces =
      64;  // the distance to each is taken at each node of the head's table
  if (pieces->size() > k_max_pieces)
    in.fail("profile", msg("has {} pieces", pieces->size()), msg("list at most {}", k_max_pieces));
  std::vector<ProfileSegment> segments;
  for (const auto& node : *pieces) {
    if (!node.is_table())
      in.fail("profile", msg("has an entry that is not a table"),
              msg("write {{r_mm = .., z_mm = ..}}"));
    TomlReader piece(*node.as_table(), where);
    ProfileSegment s;
    s.end = {piece.number("r_mm", 0, 5), piece.number("z_mm", 0, 60)};
    if (const toml::array* c = piece.array("centre")) {
      const auto r = c->size() == 2 ? c->get(0)->value<double>() : std::nullopt;
      const auto z = c->size() == 2 ? c->get(1)->value<double>() : std::nullopt;
      if (!r || !z) piece.fail("centre", msg("is not [r, z]"), msg("give two numbers in mm"));
      s.arc = true;
      s.centre = {*r, *z};
    }
    piece.finish();
    segments.push_back(s);
  }
  in.finish();
  try {
    bur.profile = Profile(std::move(segments));
  } catch (const Error& e) {
    in.fail("profile", e.problem(), msg("correct it"));
  }
  bur.head = bur.profile.below(bur.cutting_length_mm);
  ProfilePoint facing{0, -1};
  for (const auto& p : bur.profile.walk(0.005, bur.cutting_length_mm)) {
    // carving relies on it: see carve_head
    if (facing.r_mm * p.normal.z_mm - facing.z_mm * p.normal.r_mm < -1e-6)
      in.fail("profile", msg("is hollow at a height of {}", as_mm(p.at.z_mm, k_as_needed)),
              msg("make it convex up to cutting_length_mm"));
    facing = p.normal;
    bur.head_radius_mm = std::max(bur.head_radius_mm, p.at.r_mm);
    if (p.normal.z_mm < -1e-9) bur.widest_from_mm = p.at.z_mm;  // still facing down
  }
  bur.field = HeadField(bur.head, bur.cutting_length_mm, bur.head_radius_mm);
  bur.smallest_radius_mm = bur.head.smallest_arc_mm(bur.head_radius_mm);
  bur.widest_to_mm = bur.cutting_length_mm;
  for (const auto& p : bur.profile.walk(0.005, bur.cutting_length_mm))
    if (p.normal.z_mm > 1e-9) {
      bur.widest_to_mm = p.at.z_mm;  // faces up from here on
      break;
    }
  return bur;
}

}  // namespace cavum
