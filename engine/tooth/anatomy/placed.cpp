#include "engine/tooth/anatomy/placed.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr std::size_t k_max_of_a_kind = 16;

enum class Kind {
  cusp,
  mesial_ridge,
  distal_ridge,
  mesial_pit,
  central_pit,
  distal_pit,
  pulp_horn,
  chamber_roof,
  chamber_floor,
  canal_mouth,
  apex
};
struct KindName {
  std::string_view name;
  Kind kind;
  bool numbered;
};
constexpr std::array<KindName, 11> k_kinds{{{"cusp", Kind::cusp, true},
                                            {"mesial_ridge", Kind::mesial_ridge, false},
                                            {"distal_ridge", Kind::distal_ridge, false},
                                            {"mesial_pit", Kind::mesial_pit, false},
                                            {"central_pit", Kind::central_pit, false},
                                            {"distal_pit", Kind::distal_pit, false},
                                            {"pulp_horn", Kind::pulp_horn, true},
                                            {"chamber_roof", Kind::chamber_roof, false},
                                            {"chamber_floor", Kind::chamber_floor, false},
                                            {"canal_mouth", Kind::canal_mouth, true},
                                            {"apex", Kind::apex, true}}};

struct Name {
  Kind kind;
  std::size_t number;  // from 1; 0 where the kind has none
};
std::optional<Name> parsed(std::string_view text) {
  for (const auto& k : k_kinds) {
    if (!k.numbered) {
      if (text == k.name) return Name{k.kind, 0};
      continue;
    }
    if (text.size() < k.name.size() + 2 || !text.starts_with(k.name) || text[k.name.size()] != '_')
      continue;
    const auto digits = text.substr(k.name.size() + 1);
    std::size_t number = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (read.ec == std::errc{} && read.ptr == digits.data() + digits.size() && digits[0] != '0' &&
        number <= k_max_of_a_kind)
      return Name{k.kind, number};
  }
  return std::nullopt;
}

/// Item `number` of a list, which may grow by one; null beyond.
template <class T>
T* item(std::vector<T>& list, std::size_t number) {
  if (number == list.size() + 1) list.emplace_back();
  return number <= list.size() ? &list[number - 1] : nullptr;
}

bool put_cusp(Landmarks& l, std::size_t number, Vec3 at) {
  const std::size_t before = l.cusps.size();
  CuspTip* cusp = item(l.cusps, number);
  if (cusp == nullptr) return false;
  cusp->tip_mm = at;
  if (l.cusps.size() > before) cusp->name = fmt::format("cusp {}", number);
  return true;
}

bool put_point(std::vector<Vec3>& list, std::size_t number, Vec3 at) {
  Vec3* point = item(list, number);
  if (point != nullptr) *point = at;
  return point != nullptr;
}

void put_ridge(MarginalRidge& ridge, Vec3 at) {
  ridge.lowest_mm = at;
  if (ridge.crest_mm.empty()) return;
  // the crest goes through its lowest place: the nearest of its points moves there, the others the
  // less the nearer they are to its ends, the cusps
  const auto& crest = ridge.crest_mm;
  std::size_t near = 0;
  for (std::size_t i = 1; i < crest.size(); ++i)
    if (flat_distance(crest[i], at) < flat_distance(crest[near], at)) near = i;
  const Vec3 way = at - crest[near];
  const std::size_t last = crest.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double to_end =
        i <= near ? static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(near, 1))
                  : static_cast<double>(last - i) / static_cast<double>(last - near);
    ridge.crest_mm[i] = i == near ? at : crest[i] + way * to_end;
  }
}

/// The central fissure ends at its pit: what lies beyond the place nearest to it goes, and the pit
/// takes that place.
void end_fissure(Polyline& fissure, Vec3 pit, bool distal) {
  if (fissure.empty()) return;
  if (distal) std::reverse(fissure.begin(), fissure.end());
  const auto near = std::min_element(fissure.begin(), fissure.end(), [&](Vec3 a, Vec3 b) {
    return flat_distance(a, pit) < flat_distance(b, pit);
  });
  if (fissure.end() - near > 1) fissure.erase(fissure.begin(), near);  // a line keeps two points
  fissure.front() = pit;
  if (distal) std::reverse(fissure.begin(), fissure.end());
}

bool put(const Name& name, Vec3 at, Landmarks& l) {
  switch (name.kind) {
    case Kind::cusp:
      return put_cusp(l, name.number, at);
    case Kind::mesial_ridge:
      put_ridge(l.mesial_ridge, at);
      return true;
    case Kind::distal_ridge:
      put_ridge(l.distal_ridge, at);
      return true;
    case Kind::mesial_pit:
      l.mesial_pit_mm = at;
      end_fissure(l.central_fissure_mm, at, false);
      return true;
    case Kind::central_pit:
      l.central_pit_mm = at;
      return true;
    case Kind::distal_pit:
      l.distal_pit_mm = at;
      end_fissure(l.central_fissure_mm, at, true);
      return true;
    case Kind::pulp_horn:
      return put_point(l.pulp_horns_mm, name.number, at);
    case Kind::chamber_roof:
      l.chamber_roof_mm = at;
      return true;
    case Kind::chamber_floor:
      l.chamber_floor_mm = at;
      return true;
    case Kind::canal_mouth: {
      CanalOpening* mouth = item(l.canal_mouths, name.number);
      if (mouth != nullptr) mouth->at_mm = at;
      return mouth != nullptr;
    }
    default:
      return put_point(l.apices_mm, name.number, at);
  }
}

/// Where no fissure was found, on a worn crown say, and a person put both ends: straight from pit
/// to pit.
void draw_fissure(Landmarks& l) {
  const auto put = [&](const char* name) {
    return std::find(l.moved.begin(), l.moved.end(), name) != l.moved.end();
  };
  if (!l.central_fissure_mm.empty() || !put("mesial_pit") || !put("distal_pit")) return;
  constexpr int k_parts = 10;
  std::vector<Vec3> pits{*l.mesial_pit_mm};
  if (l.central_pit_mm) pits.push_back(*l.central_pit_mm);
  pits.push_back(*l.distal_pit_mm);
  for (std::size_t i = 0; i + 1 < pits.size(); ++i)
    for (int k = 0; k < k_parts; ++k)
      l.central_fissure_mm.push_back(pits[i] +
                                     (pits[i + 1] - pits[i]) * (static_cast<double>(k) / k_parts));
  l.central_fissure_mm.push_back(pits.back());
  l.notes.emplace_back(
      msg("the central fissure is drawn straight between the pits that were put by hand"));
}

}  // namespace

void place_landmarks(const std::vector<NamedPoint>& placed, Landmarks& landmarks) {
  // by number, so that a list may grow by several
  std::vector<NamedPoint> sorted = placed;
  std::sort(sorted.begin(), sorted.end(), [](const NamedPoint& a, const NamedPoint& b) {
    return a.name.size() != b.name.size() ? a.name.size() < b.name.size() : a.name < b.name;
  });
  for (const auto& [name, at] : sorted) {
    const auto known = parsed(name);
    if (known && put(*known, at, landmarks))
      landmarks.moved.push_back(name);
    else
      landmarks.notes.push_back(
          known ? msg("the point '{}' that was put is beyond the end of its list", name)
                : msg("the point '{}' that was put is of no known name", name));
  }
  draw_fissure(landmarks);
}

std::vector<NamedPoint> named_points(const Landmarks& l) {
  std::vector<NamedPoint> out;
  const auto list = [&](std::string_view name, const auto& items, const auto& place) {
    for (std::size_t i = 0; i < items.size(); ++i)
      out.push_back({fmt::format("{}_{}", name, i + 1), place(items[i])});
  };
  const auto one = [&](std::string_view name, const std::optional<Vec3>& at) {
    if (at) out.push_back({std::string(name), *at});
  };
  const auto itself = [](Vec3 p) { return p; };
  list("cusp", l.cusps, [](const CuspTip& c) { return c.tip_mm; });
  one("mesial_ridge", l.mesial_ridge.lowest_mm);
  one("distal_ridge", l.distal_ridge.lowest_mm);
  one("mesial_pit", l.mesial_pit_mm);
  one("central_pit", l.central_pit_mm);
  one("distal_pit", l.distal_pit_mm);
  list("pulp_horn", l.pulp_horns_mm, itself);
  one("chamber_roof", l.chamber_roof_mm);
  one("chamber_floor", l.chamber_floor_mm);
  list("canal_mouth", l.canal_mouths, [](const CanalOpening& c) { return c.at_mm; });
  list("apex", l.apices_mm, itself);
  return out;
}

bool is_landmark_name(std::string_view name) noexcept { return parsed(name).has_value(); }

}  // namespace cavum
