// `cavum tooth`: make a tooth, import one, look at it, export its surface.
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/lab/scan/printable.h"
#include "engine/physics/force/force_model.h"
#include "engine/tooth/make/grow_teeth.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/make/plant_lesion.h"
#include "engine/tooth/surface_mesh.h"
#include "engine/tooth/tooth.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/checked_toml.h"
#include "ui/cli/tooth_facts.h"
#include "ui/cli/tooth_verbs_parts.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

std::vector<double> parse_numbers(const std::string& text, const std::string& option) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    double v = 0.0;
    const auto read = std::from_chars(part.data(), part.data() + part.size(), v);
    if (read.ec != std::errc{} || read.ptr != part.data() + part.size() || !std::isfinite(v))
      throw Error(Name{option}, msg("cannot read '{}' as a number", part),
                  msg("write numbers with commas between, such as 10,10,6"));
    numbers.push_back(v);
  }
  return numbers;
}

Vec3 parse_vec(const std::string& text, const std::string& option) {
  const auto n = parse_numbers(text, option);
  if (n.size() != 3)
    throw Error(Name{option}, msg("needs three numbers, '{}' has {}", text, n.size()),
                msg("write them as x,y,z"));
  return {n[0], n[1], n[2]};
}

void save_and_tell(const Tooth& tooth, const std::string& path, bool json,
                   const nlohmann::ordered_json& more) {
  save_tooth_file(tooth, path);
  nlohmann::ordered_json d = describe(tooth, std::filesystem::file_size(path));
  if (json) {
    d["out"] = path;
    d.update(more);
    print_json(d);
  } else {
    print_tooth(tooth, d);
    say(msg("written: {}", path), 2);
  }
}

namespace {

using Json = nlohmann::ordered_json;

/// Tissues that any of the shipped material sets knows; empty when the data folder is not there.
std::vector<std::string> known_tissues() {
  std::set<std::string> names;
  try {
    const auto folder =
        std::filesystem::path(scenarios::find_data_file("materials", "consistent.toml", ""))
            .parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".toml")
        for (const auto& [name, material] :
             parse_force_model(read_text_file(entry.path().string()), entry.path().string())
                 .materials)
          names.insert(name);
  } catch (const std::exception&) {
    return {};
  }
  return {names.begin(), names.end()};
}

/// A tissue of one's own is welcome, a slip of the pen is not: both are named on standard error.
void notice_unknown_tissues(const Tooth& tooth) {
  const auto known = known_tissues();
  for (const auto& t : tooth.tissues) {
    if (known.empty() || std::find(known.begin(), known.end(), t.name) != known.end()) continue;
    say_error(msg(
        "notice: no shipped material set has the tissue '{}'; {}; a tissue of your own needs [materials.{}] in the exam's --model",
        t.name, scenarios::suggestion(t.name, known), t.name));
  }
}

/// The surface is kept exactly, but leaves are whole: what counts them counts another size. That is
/// said.
void notice_part_leaves(const std::vector<double>& sizes_mm, double leaf_mm, const Message& what) {
  for (const double mm : sizes_mm) {
    const double leaves = mm / leaf_mm, low = std::floor(leaves) * leaf_mm,
                 high = std::ceil(leaves) * leaf_mm;
    if (std::fabs(leaves - std::round(leaves)) < 1e-6) continue;
    say_error(msg(
        "notice: {} of {} is no whole number of leaves of {}: its surface is exact, but bounds and volumes count whole leaves; {} or {} would be "
        "both",
        what, as_mm(mm, k_as_needed), as_mm(leaf_mm, k_as_needed), as_number(low),
        as_mm(high, k_as_needed)));
  }
}

/// The tooth with the lesion that --lesion asks for; as it is without.
Tooth with_lesion(Tooth tooth, const std::string& text) {
  if (text.empty()) return tooth;
  const auto n = parse_numbers(text, "--lesion");
  if (n.size() != 6)
    throw Error(Name{"--lesion"}, msg("needs six numbers, '{}' has {}", text, n.size()),
                msg("write them as x,y,z,rx,ry,rz"));
  return plant_lesion(std::move(tooth), {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
}

/// What all of `tooth make` have.
struct MakeArgs {
  std::string out, lesion;
  bool json = false;
};

std::shared_ptr<MakeArgs> add_make_args(CLI::App* app) {
  auto c = std::make_shared<MakeArgs>();
  app->add_option("--out", c->out, tr("Tooth file to write (.cvt)"))->required();
  app->add_option(
      "--lesion", c->lesion,
      tr("x,y,z,rx,ry,rz, mm: softened dentin in an ellipsoid, hidden under a sound surface"));
  app->add_flag("--json", c->json, tr("One JSON object on stdout"));
  return c;
}

/// Without a place for it nothing is made.
template <class Maker>
void make_tooth(const MakeArgs& c, const Maker& maker) {
  require_distinct_paths({{"--out " + c.out, c.out}}, {});
  save_and_tell(with_lesion(maker(), c.lesion), c.out, c.json, nlohmann::ordered_json::object());
}

/// `--seed`: another individual of the kind. What the plain tooth lets choose is drawn then, so the
/// two do not go together.
std::shared_ptr<std::optional<std::uint64_t>> add_seed(CLI::App* app,
                                                       const std::vector<CLI::Option*>& drawn) {
  auto seed = std::make_shared<std::optional<std::uint64_t>>();
  auto* option =
      app->add_option(
             "--seed", *seed,
             tr("Draw an individual with measures of its own (docs/teeth.md); without it, the plain tooth of round measures"))
          ->check([](const std::string& text) {
            return text.starts_with('-') ? tr("a whole number is needed, 0 or more")
                                         : std::string();
          });
  for (auto* other : drawn) option->excludes(other);
  return seed;
}

void add_make_molar(CLI::App& make) {
  auto* molar = make.add_subcommand("molar", tr("A parametric lower first molar"));
  auto shape = std::make_shared<MolarShape>();
  auto args = add_make_args(molar);
  molar->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  molar
      ->add_option("--periodontium-mm", shape->periodontium_mm,
                   tr("Supporting tissue around the roots, mm; 0 = none"))
      ->capture_default_str();
  const auto seed =
      add_seed(molar, {molar->add_option("--canals", shape->canals, tr("Root canals, 2 to 4"))
                           ->capture_default_str(),
                       molar
                           ->add_option("--occlusal-enamel-mm", shape->occlusal_enamel_mm,
                                        tr("Enamel below the central fossa, mm"))
                           ->capture_default_str(),
                       molar
                           ->add_option("--lateral-enamel-mm", shape->lateral_enamel_mm,
                                        tr("Enamel of the walls, mm"))
                           ->capture_default_str(),
                       molar
                           ->add_option("--chamber-roof-mm", shape->chamber_roof_mm,
                                        tr("z of the pulp chamber's roof, mm"))
                           ->capture_default_str(),
                       molar
                           ->add_option("--chamber-height-mm", shape->chamber_height_mm,
                                        tr("Height of the pulp chamber, mm"))
                           ->capture_default_str()});
  molar->callback([=] {
    make_tooth(*args, [&] {
      return seed->has_value() ? grow_molar({**seed, shape->leaf_mm, shape->periodontium_mm})
                               : make_molar(*shape);
    });
  });
}

void add_make_premolar(CLI::App& make) {
  auto* premolar = make.add_subcommand("premolar", tr("A parametric upper second premolar"));
  auto shape = std::make_shared<PremolarShape>();
  auto args = add_make_args(premolar);
  premolar->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))
      ->capture_default_str();
  premolar
      ->add_option("--periodontium-mm", shape->periodontium_mm,
                   tr("Supporting tissue around the root, mm; 0 = none"))
      ->capture_default_str();
  const auto seed =
      add_seed(premolar, {premolar
                              ->add_option("--occlusal-enamel-mm", shape->occlusal_enamel_mm,
                                           tr("Enamel below the fissure, mm"))
                              ->capture_default_str(),
                          premolar
                              ->add_option("--lateral-enamel-mm", shape->lateral_enamel_mm,
                                           tr("Enamel of the walls, mm"))
                              ->capture_default_str(),
                          premolar
                              ->add_option("--chamber-roof-mm", shape->chamber_roof_mm,
                                           tr("z of the pulp chamber's roof, mm"))
                              ->capture_default_str()});
  premolar->callback([=] {
    make_tooth(*args, [&] {
      return seed->has_value() ? grow_premolar({**seed, shape->leaf_mm, shape->periodontium_mm})
                               : make_premolar(*shape);
    });
  });
}

void add_make_incisor(CLI::App& make) {
  auto* incisor = make.add_subcommand("incisor", tr("A parametric upper central incisor"));
  auto shape = std::make_shared<IncisorShape>();
  auto args = add_make_args(incisor);
  incisor->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  incisor
      ->add_option("--periodontium-mm", shape->periodontium_mm,
                   tr("Supporting tissue around the root, mm; 0 = none"))
      ->capture_default_str();
  const auto seed =
      add_seed(incisor, {incisor
                             ->add_option("--incisal-enamel-mm", shape->incisal_enamel_mm,
                                          tr("Enamel at the edge, mm"))
                             ->capture_default_str(),
                         incisor
                             ->add_option("--lateral-enamel-mm", shape->lateral_enamel_mm,
                                          tr("Enamel of the faces, mm"))
                             ->capture_default_str(),
                         incisor
                             ->add_option("--chamber-top-mm", shape->chamber_top_mm,
                                          tr("z of the pulp chamber's incisal end, mm"))
                             ->capture_default_str()});
  incisor->callback([=] {
    make_tooth(*args, [&] {
      return seed->has_value() ? grow_incisor({**seed, shape->leaf_mm, shape->periodontium_mm})
                               : make_incisor(*shape);
    });
  });
}

struct BlockArgs {
  std::string size = "10,10,6", layers = "enamel:1.2,dentin:2.0,pulp:1.5,dentin:1.3";
  double leaf_mm = 0.05;
};

Tooth make_layered(const BlockArgs& args) {
  const Vec3 size = parse_vec(args.size, "--size-mm");
  const std::vector<Layer> layers = parse_layers(args.layers);
  Tooth layered = make_block(size, layers, args.leaf_mm);
  notice_unknown_tissues(layered);
  notice_part_leaves({size.x, size.y, size.z}, args.leaf_mm, msg("a side"));
  for (const auto& layer : layers)
    notice_part_leaves({layer.thickness_mm}, args.leaf_mm, msg("layer '{}'", layer.tissue));
  return layered;
}

void add_make_block(CLI::App& make) {
  auto* block = make.add_subcommand(
      "block", tr("A block of flat layers; origin at the centre of its top face"));
  auto shape = std::make_shared<BlockArgs>();
  auto args = add_make_args(block);
  block->add_option("--size-mm", shape->size, tr("x,y,z, mm"))->capture_default_str();
  block->add_option("--layers", shape->layers, tr("name:thickness_mm from top to bottom"))
      ->capture_default_str();
  block->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  block->callback([=] { make_tooth(*args, [&] { return make_layered(*shape); }); });
}

struct CubeArgs {
  double edge_mm = 10, leaf_mm = 0.05;
  std::string tissue = "dentin";
};

Tooth make_plain(const CubeArgs& args) {
  Tooth plain = make_cube(args.edge_mm, args.tissue, args.leaf_mm);
  notice_unknown_tissues(plain);
  notice_part_leaves({args.edge_mm}, args.leaf_mm, msg("an edge"));
  return plain;
}

void add_make_cube(CLI::App& make) {
  auto* cube =
      make.add_subcommand("cube", tr("A cube of one tissue; origin at the centre of its top face"));
  auto shape = std::make_shared<CubeArgs>();
  auto args = add_make_args(cube);
  cube->add_option("--edge-mm", shape->edge_mm, tr("Edge, mm"))->capture_default_str();
  cube->add_option("--tissue", shape->tissue, tr("Tissue"))->capture_default_str();
  cube->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  cube->callback([=] { make_tooth(*args, [&] { return make_plain(*shape); }); });
}

void add_make(CLI::App& tooth) {
  auto* make = tooth.add_subcommand("make", tr("Build a tooth from formulae"));
  make->require_subcommand(1);
  for (auto* add :
       {add_make_molar, add_make_premolar, add_make_incisor, add_make_block, add_make_cube})
    add(*make);
}

void add_info(CLI::App& tooth) {
  auto* info = tooth.add_subcommand("info", tr("What a tooth file holds"));
  auto path = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  info->add_option("FILE", *path, tr("Tooth file (.cvt)"))->required();
  info->add_flag("--json", *as_json, tr("One JSON object on stdout"));
  info->callback([=] {
    const Tooth t = load_tooth_file(*path);
    const Json d = describe(t, std::filesystem::file_size(*path));
    if (*as_json)
      print_json(d);
    else
      print_tooth(t, d);
  });
}

void add_mesh(CLI::App& tooth) {
  auto* mesh = tooth.add_subcommand(
      "mesh",
      tr("Export the closed surface of a tissue, of all solid tissues together, or of the whole tooth to be printed"));
  struct MeshArgs {
    std::string file, tissue = "solid", out;
    bool json = false;
  };
  auto a = std::make_shared<MeshArgs>();
  mesh->add_option("FILE", a->file, tr("Tooth file (.cvt)"))->required();
  mesh->add_option(
          "--tissue", a->tissue,
          tr("Tissue by name; solid, with the pulp's hollow; or outer: the outside alone, pulp filled"))
      ->capture_default_str();
  mesh->add_option("--out", a->out, tr("Mesh to write (.stl or .ply), mm"))->required();
  mesh->add_flag("--json", a->json, tr("One JSON object on stdout"));
  mesh->callback([=] {
    require_distinct_paths({{"--out " + a->out, a->out}}, {{"", a->file}});
    const Tooth t = load_tooth_file(a->file);
    const TriangleMesh m = a->tissue == "outer" ? printable_surface(t, tissues_around_tooth(t)).mesh
                                                : surface_mesh(t, a->tissue);
    write_mesh_file(m, a->out);
    const double volume = rounded(signed_volume_mm3(m), 1e-6);
    if (a->json) {
      const Json d{{"out", a->out},
                   {"tissue", a->tissue},
                   {"triangles", m.triangles.size()},
                   {"vertices", m.vertices_mm.size()},
                   {"volume_mm3", volume}};
      print_json(d);
    } else {
      say(msg("{}: {} triangles around {} of {}", a->out, m.triangles.size(), as_mm3(volume, 3),
              Term{a->tissue}));
    }
  });
}

}  // namespace

void add_tooth_verbs(CLI::App& app, int& exit_code) {
  auto* tooth = app.add_subcommand("tooth", tr("Make, import, inspect and export teeth"));
  tooth->require_subcommand(1);
  add_make(*tooth);
  add_import(*tooth);
  add_info(*tooth);
  add_mesh(*tooth);
  add_landmarks(*tooth);
  add_lesion(*tooth);
  add_neighbour(*tooth);
  tooth->callback([&exit_code] { exit_code = 0; });
}

}  // namespace cavum::ui
