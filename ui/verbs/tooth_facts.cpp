#include "ui/verbs/tooth_facts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/text.h"
#include "engine/tooth/octree_edit.h"
#include "engine/tooth/tooth_notes.h"

namespace cavum::ui {
namespace {

/// Box of everything but air and periodontium, mm.
struct Bounds {
  Vec3 low, high;
};
Bounds bounds_of(const Tooth& tooth) {
  const auto& o = tooth.octree;
  IVec3 low{1 << 20, 1 << 20, 1 << 20}, high{-1, -1, -1};
  o.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t == k_periodontium) return;
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x + edge), std::max(high.y, at.y + edge), std::max(high.z, at.z + edge)};
  });
  if (high.x < 0) return {};
  const auto mm = [&](IVec3 l) { return o.origin_mm() + Vec3{double(l.x), double(l.y), double(l.z)} * o.leaf_mm(); };
  return {mm(low), mm(high)};
}

}  // namespace

double rounded(double v, double unit) { return std::round(v / unit) * unit; }

nlohmann::ordered_json describe(const Tooth& tooth, std::uintmax_t file_bytes) {
  using Json = nlohmann::ordered_json;
  const auto& o = tooth.octree;
  const auto count = o.count_leaves();
  const Bounds b = bounds_of(tooth);
  const auto triple = [](Vec3 v) { return Json::array({rounded(v.x, 1e-6), rounded(v.y, 1e-6), rounded(v.z, 1e-6)}); };
  Json tissues = Json::array();
  for (const auto& t : tooth.tissues)
    if (count[t.id] > 0)
      tissues.push_back(
          {{"name", t.name}, {"volume_mm3", rounded(static_cast<double>(count[t.id]) * o.leaf_volume_mm3(), 1e-6)}, {"solid", t.solid}});
  const ToothNotes notes = notes_of(tooth);
  return {{"name", tooth.name},
          {"source", tooth.source},
          {"leaf_mm", o.leaf_mm()},
          {"bounds_mm", {{"low", triple(b.low)}, {"high", triple(b.high)}}},
          {"tissues", tissues},
          {"memory_bytes", o.memory_bytes()},
          {"file_bytes", file_bytes},
          {"hash", tooth_hash(tooth)},
          {"guesses", notes.guesses},
          {"warnings", notes.warnings},
          {"mirror_image", notes.mirror_image}};
}

void print_tooth(const nlohmann::ordered_json& d) {
  std::printf("%s\n", one_line(d["name"].get<std::string>()).c_str());
  std::printf("  from    %s\n", one_line(d["source"].get<std::string>()).c_str());
  const auto& low = d["bounds_mm"]["low"];
  const auto& high = d["bounds_mm"]["high"];
  std::printf("  leaf    %g mm; x %.2f..%.2f  y %.2f..%.2f  z %.2f..%.2f mm\n", d["leaf_mm"].get<double>(), low[0].get<double>(),
              high[0].get<double>(), low[1].get<double>(), high[1].get<double>(), low[2].get<double>(), high[2].get<double>());
  for (const auto& t : d["tissues"])
    std::printf("  %-14s %10.3f mm3%s\n", one_line(t["name"].get<std::string>()).c_str(), t["volume_mm3"].get<double>(),
                t["solid"].get<bool>() ? "" : "  (not solid)");
  std::printf("  memory  %.2f MB, file %.2f MB\n", d["memory_bytes"].get<double>() / 1e6, d["file_bytes"].get<double>() / 1e6);
  std::printf("  hash    %s\n", d["hash"].get<std::string>().c_str());
  for (const auto& guess : d["guesses"]) std::printf("  guess   %s\n", one_line(guess.get<std::string>()).c_str());
  for (const auto& warning : d["warnings"]) std::printf("  notice  %s\n", one_line(warning.get<std::string>()).c_str());
}

}  // namespace cavum::ui
