#include "ui/cli/tooth_facts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/octree_edit.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

/// Box of everything but air and periodontium, mm.
Bounds bounds_of(const Tooth& tooth) {
  const auto& o = tooth.octree;
  const LeafBounds box = o.bounds([&](std::uint8_t t) { return t != k_periodontium; });
  if (box.empty()) return {{}, {}};
  const auto mm = [&](IVec3 l) { return o.origin_mm() + to_vec3(l) * o.leaf_mm(); };
  return {mm(box.low), mm(box.high)};
}

}  // namespace

double rounded(double v, double unit) { return std::round(v / unit) * unit; }

nlohmann::ordered_json describe(const Tooth& tooth, std::uintmax_t file_bytes) {
  using Json = nlohmann::ordered_json;
  const auto& o = tooth.octree;
  const auto count = o.count_leaves();
  const Bounds b = bounds_of(tooth);
  const auto triple = [](Vec3 v) {
    return Json::array({rounded(v.x, 1e-6), rounded(v.y, 1e-6), rounded(v.z, 1e-6)});
  };
  Json tissues = Json::array();
  for (const auto& t : tooth.tissues)
    if (count[t.id] > 0)
      tissues.push_back(
          {{"name", t.name},
           {"volume_mm3", rounded(static_cast<double>(count[t.id]) * o.leaf_volume_mm3(), 1e-6)},
           {"solid", t.solid}});
  Json source = Json::array();
  for (const auto& entry : tooth.source) source.push_back(Json(encode(entry)));
  return {{"name", tooth.name},
          {"jaw", tooth.kind.jaw == Jaw::upper   ? Json("upper")
                  : tooth.kind.jaw == Jaw::lower ? Json("lower")
                                                 : Json()},
          {"class", name_of(tooth.kind.tooth_class)},
          {"fdi", tooth.kind.number ? Json(tooth.kind.number->fdi) : Json()},
          {"source", source},
          {"leaf_mm", o.leaf_mm()},
          {"bounds_mm", {{"low", triple(b.low)}, {"high", triple(b.high)}}},
          {"tissues", tissues},
          {"memory_bytes", o.memory_bytes()},
          {"file_bytes", file_bytes},
          {"hash", tooth_hash(tooth)},
          {"guesses", tooth.notes_of(ToothNote::Kind::guess)},
          {"warnings", tooth.notes_of(ToothNote::Kind::warning)},
          {"mirror_image", !tooth.notes_of(ToothNote::Kind::mirror_image).empty()}};
}

void print_tooth(const Tooth& tooth, const nlohmann::ordered_json& d) {
  Lines out;
  out.add(Name{tooth.name});
  for (const auto& entry : tooth.source) out.add(msg("from: {}", in_words(entry)), 2);
  const auto corner = [&d](const char* which) {
    const auto& at = d["bounds_mm"][which];
    return Vec3{at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
  };
  out.add(msg("leaf: {}; from {} to {}", as_mm(tooth.octree.leaf_mm(), k_as_needed), corner("low"),
              corner("high")),
          2);
  for (const auto& t : d["tissues"])
    out.row({msg("{}", Term{t["name"].get<std::string>()}),
             msg("{}", as_mm3(t["volume_mm3"].get<double>(), 3)),
             t["solid"].get<bool>() ? Message() : msg("(not solid)")},
            2);
  out.add(msg("memory: {} MB, file {} MB", as_number(d["memory_bytes"].get<double>() / 1e6, 2),
              as_number(d["file_bytes"].get<double>() / 1e6, 2)),
          2);
  out.add(msg("hash: {}", d["hash"].get<std::string>()), 2);
  for (const auto& guess : tooth.notes_of(ToothNote::Kind::guess))
    out.add(msg("guess: {}", guess), 2);
  for (const auto& warning : tooth.notes_of(ToothNote::Kind::warning))
    out.add(msg("notice: {}", warning), 2);
  say(out);
}

}  // namespace cavum::ui
