// `cavum tooth landmarks`: what a dentist would point at, as points in mm; drawn; and put by a
// person where the program is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "ui/cli/landmark_picture.h"
#include "ui/cli/tooth_facts.h"
#include "ui/cli/tooth_verbs_parts.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

Json point(Vec3 p) {
  return Json::array({rounded(p.x, 1e-3), rounded(p.y, 1e-3), rounded(p.z, 1e-3)});
}
Json point(const std::optional<Vec3>& p) { return p ? point(*p) : Json(nullptr); }
Json points(const std::vector<Vec3>& line) {
  Json out = Json::array();
  for (const Vec3 p : line) out.push_back(point(p));
  return out;
}
Json lines(const std::vector<Polyline>& all) {
  Json out = Json::array();
  for (const auto& line : all) out.push_back(points(line));
  return out;
}

Json landmarks_json(const Tooth& tooth, const Landmarks& l) {
  Json cusps = Json::array(), mouths = Json::array(), named = Json::object();
  for (const auto& c : l.cusps)
    cusps.push_back({{"name", c.name},
                     {"tip_mm", point(c.tip_mm)},
                     {"prominence_mm", rounded(c.prominence_mm, 1e-3)}});
  for (const auto& m : l.canal_mouths)
    mouths.push_back({{"at_mm", point(m.at_mm)}, {"radius_mm", rounded(m.radius_mm, 1e-3)}});
  for (const auto& [name, at] : named_points(l)) named[name] = point(at);
  return {{"tooth", tooth.name},
          {"hash", tooth_hash(tooth)},
          {"tooth_class",
           {{"name", name_of(l.tooth_class.kind)},
            {"probability", rounded(l.tooth_class.probability, 0.01)},
            {"reason", l.tooth_class.reason}}},
          {"long_axis",
           {{"through_mm", point(l.long_axis.through_mm)},
            {"occlusal", point(l.long_axis.occlusal)},
            {"tilt_deg", rounded(l.long_axis.tilt_deg, 0.01)}}},
          {"points_mm", named},
          {"cusps", cusps},
          {"cusp_ridges_mm", lines(l.cusp_ridges)},
          {"mesial_ridge",
           {{"crest_mm", points(l.mesial_ridge.crest_mm)},
            {"lowest_mm", point(l.mesial_ridge.lowest_mm)}}},
          {"distal_ridge",
           {{"crest_mm", points(l.distal_ridge.crest_mm)},
            {"lowest_mm", point(l.distal_ridge.lowest_mm)}}},
          {"central_fissure_mm", points(l.central_fissure_mm)},
          {"fissure_branches_mm", lines(l.fissure_branches_mm)},
          {"incisal_edge_mm", points(l.incisal_edge_mm)},
          {"occlusal_table_mm", points(l.occlusal_table_mm)},
          {"height_of_contour_mm", points(l.height_of_contour_mm)},
          {"neck_mm", points(l.neck_mm)},
          {"canal_mouths", mouths},
          {"moved", l.moved},
          {"notes", l.notes}};
}

void print_landmarks(const Tooth& tooth, const Landmarks& l) {
  Lines out;
  out.add(Name{tooth.name});
  out.add(msg("class: {}, sure to {}: {}", in_words(l.tooth_class.kind),
              as_number(l.tooth_class.probability, 2), l.tooth_class.reason),
          2);
  const Vec3 up = l.long_axis.occlusal;
  out.add(msg("axis: ({} {} {}), {} from +z", as_number(up.x, 3), as_number(up.y, 3),
              as_number(up.z, 3), as_deg(l.long_axis.tilt_deg, 1)),
          2);
  std::size_t cusp = 0;
  for (const auto& [name, at] : named_points(l)) {
    const bool is_cusp = name.starts_with("cusp_"),
               moved = std::find(l.moved.begin(), l.moved.end(), name) != l.moved.end();
    out.row({Name{name}, msg("{}", as_number(at.x, 2)), msg("{}", as_number(at.y, 2)),
             msg("{}", as_mm(at.z, 2)), is_cusp ? msg("{}", Term{l.cusps[cusp++].name}) : Message(),
             moved ? msg("(put by a person)") : Message()},
            2);
  }
  const auto line = [&out](const Message& what, const Polyline& p, bool closed) {
    if (p.empty()) return;
    double low = p[0].z, high = p[0].z;
    for (const Vec3 q : p) {
      low = std::min(low, q.z);
      high = std::max(high, q.z);
    }
    const auto n = static_cast<std::int64_t>(p.size());
    out.row({what, msgn("{} point", "{} points", n, n), closed ? msg("closed") : msg("open"),
             msg("z {} to {}", as_number(low, 2), as_mm(high, 2))},
            2);
  };
  line(msg("mesial ridge"), l.mesial_ridge.crest_mm, false);
  line(msg("distal ridge"), l.distal_ridge.crest_mm, false);
  line(msg("central fissure"), l.central_fissure_mm, false);
  for (const auto& b : l.fissure_branches_mm) line(msg("fissure branch"), b, false);
  line(msg("incisal edge"), l.incisal_edge_mm, false);
  line(msg("occlusal table"), l.occlusal_table_mm, true);
  line(msg("height of contour"), l.height_of_contour_mm, true);
  line(msg("neck"), l.neck_mm, true);
  for (const auto& n : l.notes) out.add(msg("note: {}", n), 2);
  say(out);
}

/// `central_pit=0.1,0.2,1.0`
NamedPoint parse_placed(const std::string& text) {
  const auto equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (equals == std::string::npos || !is_landmark_name(name))
    throw Error(
        Name{"--set"}, msg("cannot read '{}'", text),
        msg("write NAME=x,y,z with a name that `cavum tooth landmarks` prints, such as central_pit=0.1,0.2,1.0"));
  return {name, parse_vec(text.substr(equals + 1), "--set " + name)};
}

/// A point that a person puts lies on the tooth or close to it.
void require_near(const Tooth& tooth, const NamedPoint& point) {
  constexpr double k_near_mm = 1.0;
  const Octree& tree = tooth.octree;
  const IVec3 low = tree.leaf_at(point.at_mm - Vec3{k_near_mm, k_near_mm, k_near_mm}),
              high = tree.leaf_at(point.at_mm + Vec3{k_near_mm, k_near_mm, k_near_mm});
  const IVec3 n = tree.size();
  for (int z = std::max(0, low.z); z <= std::min(high.z, n.z - 1); ++z)
    for (int y = std::max(0, low.y); y <= std::min(high.y, n.y - 1); ++y)
      for (int x = std::max(0, low.x); x <= std::min(high.x, n.x - 1); ++x)
        if (tree.tissue({x, y, z}) != k_air &&
            length(tree.centre_mm({x, y, z}) - point.at_mm) <= k_near_mm)
          return;
  throw Error(Name{"--set " + point.name},
              msg("lies more than {} from the tooth", as_mm(k_near_mm, 0)),
              msg("give a place on it, mm of the tooth frame"));
}

struct LandmarkArgs {
  std::string file, picture, out_tooth;
  std::vector<std::string> set, unset;
  bool json = false;
};

void run_landmarks(const LandmarkArgs& a) {
  require_distinct_paths(
      {{"--out " + a.picture, a.picture}, {"--out-tooth " + a.out_tooth, a.out_tooth}},
      {{"", a.file}});
  const bool changes = !a.set.empty() || !a.unset.empty();
  if (changes == a.out_tooth.empty())
    throw Error(msg("tooth landmarks"),
                changes ? msg("--set and --unset need --out-tooth")
                        : msg("--out-tooth needs --set or --unset"),
                msg("a tooth is never changed where it lies: name the new file"));
  Tooth tooth = load_tooth_file(a.file);
  auto& placed = tooth.placed_landmarks;
  for (const auto& name : a.unset)
    if (std::erase_if(placed, [&](const NamedPoint& p) { return p.name == name; }) == 0)
      throw Error(Name{"--unset"}, msg("nobody put a point '{}'", name),
                  msg("name one that is marked as put by a person"));
  for (const auto& text : a.set) {
    const NamedPoint point = parse_placed(text);
    require_near(tooth, point);
    std::erase_if(placed, [&](const NamedPoint& p) { return p.name == point.name; });
    placed.push_back(point);
  }
  const Landmarks l = find_landmarks(tooth);
  for (const auto& p : placed)
    if (std::find(l.moved.begin(), l.moved.end(), p.name) == l.moved.end())
      throw Error(Name{"--set " + p.name}, msg("is beyond the end of its list"),
                  msg("number it as the next one"));
  if (!a.out_tooth.empty()) save_tooth_file(tooth, a.out_tooth);
  if (!a.picture.empty()) write_text_file(a.picture, landmark_picture(tooth, l));
  if (a.json) {
    print_json(landmarks_json(tooth, l));
    return;
  }
  print_landmarks(tooth, l);
  for (const auto* path : {&a.picture, &a.out_tooth})
    if (!path->empty()) say(msg("written: {}", *path), 2);
}

}  // namespace

void add_landmarks(CLI::App& tooth) {
  auto* verb = tooth
                   .add_subcommand(
                       "landmarks",
                       tr("Cusps, fissures, pits, ridges, neck, pulp and canals as points in mm"))
                   ->alias("show");
  auto a = std::make_shared<LandmarkArgs>();
  verb->add_option("TOOTH", a->file, tr("Tooth file (.cvt)"))->required();
  verb->add_option("--out", a->picture,
                   tr("Picture to write (.svg): from above and from two sides"));
  verb->add_option("--set", a->set,
                   tr("NAME=x,y,z, mm: put a landmark by hand; may be given again"));
  verb->add_option("--unset", a->unset, tr("NAME: take a point back that was put by hand"));
  verb->add_option("--out-tooth", a->out_tooth,
                   tr("Tooth file to write (.cvt), with the points that were put"));
  verb->add_flag("--json", a->json, tr("One JSON object on stdout"));
  verb->callback([=] { run_landmarks(*a); });
}

}  // namespace cavum::ui
