// `cavum tooth lesion`: caries grown into a tooth of one's own, by site, width and depth.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "engine/tooth/make/lesion_site.h"
#include "ui/cli/tooth_verbs_parts.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

struct LesionArgs {
  std::string file, out;
  LesionSite site;
  bool json = false;
};

void grow(const LesionArgs& a) {
  require_distinct_paths({{"--out " + a.out, a.out}}, {{a.file, a.file}});
  Tooth tooth = load_tooth_file(a.file);
  const LesionShape shape = place_lesion(tooth, find_landmarks(tooth), a.site);
  tooth = plant_lesion(std::move(tooth), shape);
  const std::string what = fmt::format("{} lesion, {} mm wide, {} mm into dentin", a.site.surface,
                                       fixed(a.site.width_mm, 1), fixed(a.site.depth_mm, 1));
  tooth.name += ", " + what;
  auto& planted = std::get<LesionPlanted>(tooth.source.back());
  planted.surface = a.site.surface, planted.width_mm = a.site.width_mm,
  planted.depth_mm = a.site.depth_mm;
  save_tooth_file(tooth, a.out);
  const auto leaves = tooth.octree.count_leaves()[tooth.tissue_id("lesion")];
  const double leaf = tooth.octree.leaf_mm(),
               mm3 = static_cast<double>(leaves) * leaf * leaf * leaf;
  const Vec3 c = shape.centre_mm, r = shape.radii_mm;
  if (a.json) {
    print_json(nlohmann::ordered_json{{"tooth", a.out},
                                      {"site", a.site.surface},
                                      {"centre_mm", {c.x, c.y, c.z}},
                                      {"radii_mm", {r.x, r.y, r.z}},
                                      {"lesion_mm3", mm3}});
    return;
  }
  say(msg("{}: {} lesion, {} wide, {} into dentin, {}, around {}", a.out, Term{a.site.surface},
          as_mm(a.site.width_mm, 1), as_mm(a.site.depth_mm, 1), as_mm3(mm3, 2), c));
  say(msg("next: {}",
          fmt::format("cavum scenario new --tooth {} --task lesion --out F.toml", a.out)));
}

}  // namespace

void add_lesion(CLI::App& tooth) {
  auto* verb =
      tooth.add_subcommand("lesion", tr("Grow a hidden lesion into the dentin of a tooth"));
  auto a = std::make_shared<LesionArgs>();
  verb->add_option("TOOTH", a->file, tr("Tooth file (.cvt)"))->required();
  verb->add_option("--site", a->site.surface,
                   tr("where it begins: occlusal, mesial, distal, buccal, lingual"))
      ->capture_default_str();
  verb->add_option("--width-mm", a->site.width_mm, tr("along the border of enamel and dentin"))
      ->capture_default_str();
  verb->add_option("--depth-mm", a->site.depth_mm, tr("into dentin from that border"))
      ->capture_default_str();
  verb->add_option("--out", a->out, tr("Tooth file to write (.cvt)"))->required();
  verb->add_flag("--json", a->json, tr("One JSON object on stdout"));
  verb->callback([a] { grow(*a); });
}

}  // namespace cavum::ui
