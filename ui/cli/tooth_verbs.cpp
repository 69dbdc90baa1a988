// `cavum tooth`: make a tooth, import one, look at it, export its surface.
#include <fmt/ranges.h>

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
#include "ui/parts/own_places.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#ifdef CAVUM_WITH_IMPORT
#include "engine/tooth/import/import_meshes.h"
#include "engine/tooth/import/import_volume.h"
#include "engine/tooth/import/segment.h"
#include "engine/tooth/import/sense.h"
#include "engine/tooth/mesh/read_mesh.h"
#include "ui/parts/option_checks.h"
#endif

namespace cavum::ui {

std::vector<double> parse_numbers(const std::string& text, const std::string& option) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    double v = 0.0;
    const auto read = std::from_chars(part.data(), part.data() + part.size(), v);
    if (read.ec != std::errc{} || read.ptr != part.data() + part.size() || !std::isfinite(v))
      throw Error(Name{option}, msg("cannot read '{}' as a number", part), msg("write numbers with commas between, such as 10,10,6"));
    numbers.push_back(v);
  }
  return numbers;
}

Vec3 parse_vec(const std::string& text, const std::string& option) {
  const auto n = parse_numbers(text, option);
  if (n.size() != 3) throw Error(Name{option}, msg("needs three numbers, '{}' has {}", text, n.size()), msg("write them as x,y,z"));
  return {n[0], n[1], n[2]};
}

namespace {

using Json = nlohmann::ordered_json;

/// Saves the tooth and says what it is; `more` adds fields to the JSON.
void finish(const Tooth& tooth, const std::string& path, bool json, const Json& more = Json::object()) {
  save_tooth_file(tooth, path);
  Json d = describe(tooth, std::filesystem::file_size(path));
  if (json) {
    d["out"] = path;
    d.update(more);
    print_json(d);
  } else {
    print_tooth(tooth, d);
    say(msg("written: {}", path), 2);
  }
}

/// Tissues that any of the shipped material sets knows; empty when the data folder is not there.
std::vector<std::string> known_tissues() {
  std::set<std::string> names;
  try {
    const auto folder = std::filesystem::path(scenarios::find_data_file("materials", "consistent.toml", "")).parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".toml")
        for (const auto& [name, material] : parse_force_model(read_text_file(entry.path().string()), entry.path().string()).materials)
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
    say_error(msg("notice: no shipped material set has the tissue '{}'; {}; a tissue of your own needs [materials.{}] in the exam's --model", t.name,
                  scenarios::suggestion(t.name, known), t.name));
  }
}

/// The surface is kept exactly, but leaves are whole: what counts them counts another size. That is said.
void notice_part_leaves(const std::vector<double>& sizes_mm, double leaf_mm, const Message& what) {
  for (const double mm : sizes_mm) {
    const double leaves = mm / leaf_mm, low = std::floor(leaves) * leaf_mm, high = std::ceil(leaves) * leaf_mm;
    if (std::fabs(leaves - std::round(leaves)) < 1e-6) continue;
    say_error(
        msg("notice: {} of {} is no whole number of leaves of {}: its surface is exact, but bounds and volumes count whole leaves; {} or {} would be "
            "both",
            what, as_mm(mm, k_as_needed), as_mm(leaf_mm, k_as_needed), as_number(low), as_mm(high, k_as_needed)));
  }
}

/// The tooth with the lesion that --lesion asks for; as it is without.
Tooth with_lesion(Tooth tooth, const std::string& text) {
  if (text.empty()) return tooth;
  const auto n = parse_numbers(text, "--lesion");
  if (n.size() != 6) throw Error(Name{"--lesion"}, msg("needs six numbers, '{}' has {}", text, n.size()), msg("write them as x,y,z,rx,ry,rz"));
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
  app->add_option("--lesion", c->lesion, tr("x,y,z,rx,ry,rz, mm: softened dentin in an ellipsoid, hidden under a sound surface"));
  app->add_flag("--json", c->json, tr("One JSON object on stdout"));
  return c;
}

/// Without a place for it nothing is made.
template <class Maker>
void make_tooth(const MakeArgs& c, const Maker& maker) {
  require_own_places({{"--out " + c.out, c.out}}, {});
  finish(with_lesion(maker(), c.lesion), c.out, c.json);
}

/// `--seed`: another individual of the kind. What the plain tooth lets choose is drawn then, so the two do not go together.
std::shared_ptr<std::optional<std::uint64_t>> add_seed(CLI::App* app, const std::vector<CLI::Option*>& drawn) {
  auto seed = std::make_shared<std::optional<std::uint64_t>>();
  auto* option =
      app->add_option("--seed", *seed,
                      tr("Draw an individual with measures of its own (docs/teeth.md); without it, the plain tooth of round measures"))
          ->check([](const std::string& text) { return text.starts_with('-') ? tr("a whole number is needed, 0 or more") : std::string(); });
  for (auto* other : drawn) option->excludes(other);
  return seed;
}

void add_make_molar(CLI::App& make) {
  auto* molar = make.add_subcommand("molar", tr("A parametric lower first molar"));
  auto shape = std::make_shared<MolarShape>();
  auto args = add_make_args(molar);
  molar->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  molar->add_option("--periodontium-mm", shape->periodontium_mm, tr("Supporting tissue around the roots, mm; 0 = none"))->capture_default_str();
  const auto seed = add_seed(
      molar, {molar->add_option("--canals", shape->canals, tr("Root canals, 2 to 4"))->capture_default_str(),
              molar->add_option("--occlusal-enamel-mm", shape->occlusal_enamel_mm, tr("Enamel below the central fossa, mm"))->capture_default_str(),
              molar->add_option("--lateral-enamel-mm", shape->lateral_enamel_mm, tr("Enamel of the walls, mm"))->capture_default_str(),
              molar->add_option("--chamber-roof-mm", shape->chamber_roof_mm, tr("z of the pulp chamber's roof, mm"))->capture_default_str(),
              molar->add_option("--chamber-height-mm", shape->chamber_height_mm, tr("Height of the pulp chamber, mm"))->capture_default_str()});
  molar->callback([=] {
    make_tooth(*args, [&] { return seed->has_value() ? grow_molar({**seed, shape->leaf_mm, shape->periodontium_mm}) : make_molar(*shape); });
  });
}

void add_make_premolar(CLI::App& make) {
  auto* premolar = make.add_subcommand("premolar", tr("A parametric upper second premolar"));
  auto shape = std::make_shared<PremolarShape>();
  auto args = add_make_args(premolar);
  premolar->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  premolar->add_option("--periodontium-mm", shape->periodontium_mm, tr("Supporting tissue around the root, mm; 0 = none"))->capture_default_str();
  const auto seed = add_seed(
      premolar, {premolar->add_option("--occlusal-enamel-mm", shape->occlusal_enamel_mm, tr("Enamel below the fissure, mm"))->capture_default_str(),
                 premolar->add_option("--lateral-enamel-mm", shape->lateral_enamel_mm, tr("Enamel of the walls, mm"))->capture_default_str(),
                 premolar->add_option("--chamber-roof-mm", shape->chamber_roof_mm, tr("z of the pulp chamber's roof, mm"))->capture_default_str()});
  premolar->callback([=] {
    make_tooth(*args, [&] { return seed->has_value() ? grow_premolar({**seed, shape->leaf_mm, shape->periodontium_mm}) : make_premolar(*shape); });
  });
}

void add_make_incisor(CLI::App& make) {
  auto* incisor = make.add_subcommand("incisor", tr("A parametric upper central incisor"));
  auto shape = std::make_shared<IncisorShape>();
  auto args = add_make_args(incisor);
  incisor->add_option("--leaf-mm", shape->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  incisor->add_option("--periodontium-mm", shape->periodontium_mm, tr("Supporting tissue around the root, mm; 0 = none"))->capture_default_str();
  const auto seed = add_seed(
      incisor,
      {incisor->add_option("--incisal-enamel-mm", shape->incisal_enamel_mm, tr("Enamel at the edge, mm"))->capture_default_str(),
       incisor->add_option("--lateral-enamel-mm", shape->lateral_enamel_mm, tr("Enamel of the faces, mm"))->capture_default_str(),
       incisor->add_option("--chamber-top-mm", shape->chamber_top_mm, tr("z of the pulp chamber's incisal end, mm"))->capture_default_str()});
  incisor->callback([=] {
    make_tooth(*args, [&] { return seed->has_value() ? grow_incisor({**seed, shape->leaf_mm, shape->periodontium_mm}) : make_incisor(*shape); });
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
  for (const auto& layer : layers) notice_part_leaves({layer.thickness_mm}, args.leaf_mm, msg("layer '{}'", layer.tissue));
  return layered;
}

void add_make_block(CLI::App& make) {
  auto* block = make.add_subcommand("block", tr("A block of flat layers; origin at the centre of its top face"));
  auto shape = std::make_shared<BlockArgs>();
  auto args = add_make_args(block);
  block->add_option("--size-mm", shape->size, tr("x,y,z, mm"))->capture_default_str();
  block->add_option("--layers", shape->layers, tr("name:thickness_mm from top to bottom"))->capture_default_str();
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
  auto* cube = make.add_subcommand("cube", tr("A cube of one tissue; origin at the centre of its top face"));
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
  for (auto* add : {add_make_molar, add_make_premolar, add_make_incisor, add_make_block, add_make_cube}) add(*make);
}

struct ImportArgs {
  std::string volume, enamel, dentin, pulp, map, spacing, occlusal, mesial, out, units, patient_frame;
  std::optional<int> fdi, universal;
  std::vector<std::string> confirmed;
  bool mirror = false;
  std::optional<double> enamel_threshold, dentin_threshold;
  double leaf_mm = 0.05, periodontium_mm = 1.0, rotate_deg = 0.0;
  bool json = false;
};

#ifdef CAVUM_WITH_IMPORT
/// Every mesh that was named is there, and every layer was named.
void require_meshes(const ImportArgs& a) {
  const std::pair<const char*, const std::string*> layers[] = {{"--enamel", &a.enamel}, {"--dentin", &a.dentin}, {"--pulp", &a.pulp}};
  std::vector<std::string> missing;
  for (const auto& [option, path] : layers) {
    if (!path->empty())
      require_mesh_file(*path);
    else
      missing.emplace_back(option);
  }
  if (!missing.empty())
    throw Error(msg("tooth import"), missing.size() == 1 ? msg("{} is missing", missing[0]) : msg("{} and {} are missing", missing[0], missing[1]),
                msg("give one closed surface for each of the three layers"));
}

/// Which tooth the user says it is, in which unit and frame.
SenseOptions sense_options(const ImportArgs& a) {
  SenseOptions sense;
  if (a.fdi) sense.number = from_fdi(*a.fdi, "--tooth-number");
  if (a.universal) sense.number = from_universal(*a.universal, "--universal");
  sense.units = a.units;
  sense.patient_frame = a.patient_frame;
  sense.confirmed = a.confirmed;
  if (!a.patient_frame.empty() && !sense.number)
    throw Error(Name{"--patient-frame"}, msg("tells where mesial is only for a tooth that is named"), msg("give --tooth-number or --universal, too"));
  return sense;
}

Json sense_json(const ToothSense& sense, const SenseOptions& options) {
  Json number = nullptr;
  if (options.number) number = {{"fdi", options.number->fdi}, {"universal", options.number->universal()}, {"text", options.number->text()}};
  return {{"tooth_number", number},
          {"tooth_class", {{"name", name_of(sense.tooth_class.kind)}, {"probability", rounded(sense.tooth_class.probability, 0.01)}}},
          {"guesses", sense.guesses},
          {"warnings", sense.warnings}};
}

/// Warnings where they are seen even when the result goes to a file; print_tooth says them and the guesses, too.
void show_sense(const ToothSense& sense) {
  for (const auto& w : sense.warnings) say_error(msg("notice: {}", w));
}

void run_import(const ImportArgs& a) {
  require_own_places({{"--out " + a.out, a.out}}, {{"", a.volume}, {"", a.enamel}, {"", a.dentin}, {"", a.pulp}});
  FrameOptions frame;
  if (!a.occlusal.empty()) frame.occlusal_axis = parse_vec(a.occlusal, "--occlusal-axis");
  if (!a.mesial.empty()) frame.mesial_axis = parse_vec(a.mesial, "--mesial-axis");
  frame.rotate_deg = a.rotate_deg;
  frame.mirror = a.mirror;
  const SenseOptions sense = sense_options(a);
  if (!a.patient_frame.empty() && !frame.mesial_axis) frame.mesial_axis = mesial_in_patient(*sense.number, a.patient_frame);
  const bool meshes = !a.enamel.empty() || !a.dentin.empty() || !a.pulp.empty();
  if (meshes == !a.volume.empty())
    throw Error(msg("tooth import"), msg("needs either a VOLUME or the meshes --enamel --dentin --pulp"), msg("give one of the two"));
  if (meshes) {
    require_meshes(a);
    if (!a.spacing.empty() || !a.map.empty() || a.enamel_threshold || a.dentin_threshold)
      throw Error(msg("tooth import"), msg("spacing, map and thresholds belong to volumes"), msg("leave them out for meshes (unit mm)"));
    const MeshImport done = import_meshes({a.enamel, a.dentin, a.pulp}, {a.leaf_mm, a.periodontium_mm, frame, sense});
    finish(done.tooth, a.out, a.json,
           {{"mesh_volume_mm3", {{"enamel", done.mesh_enamel_mm3}, {"dentin", done.mesh_dentin_mm3}, {"pulp", done.mesh_pulp_mm3}}},
            {"overlap_leaves", done.overlap_leaves},
            {"gap_leaves", done.gap_leaves},
            {"sense", sense_json(done.sense, sense)}});
    show_sense(done.sense);
    return;
  }
  if (!a.units.empty()) throw Error(Name{"--units"}, msg("belongs to meshes"), msg("give --spacing-mm for a volume"));
  VolumeImportOptions options;
  options.sense = sense;
  if (!a.spacing.empty()) {
    auto n = parse_numbers(a.spacing, "--spacing-mm");
    if (n.size() == 1) n = {n[0], n[0], n[0]};
    if (n.size() != 3) throw Error(Name{"--spacing-mm"}, msg("needs one number or three"), msg("write 0.125 or 0.1,0.1,0.2"));
    options.spacing_mm = Vec3{n[0], n[1], n[2]};
  }
  options.thresholds = {a.enamel_threshold, a.dentin_threshold};
  if (!a.map.empty()) options.labels = parse_label_map(a.map);
  options.leaf_mm = a.leaf_mm;
  options.periodontium_mm = a.periodontium_mm;
  options.frame = frame;
  const VolumeImport done = import_volume(a.volume, options);
  finish(done.tooth, a.out, a.json,
         {{"spacing", in_words(done.spacing)},
          {"spacing_assumed", done.spacing.by == VoxelSpacing::By::assumed},
          {"native_voxels", {{"enamel", done.native_enamel}, {"dentin", done.native_dentin}, {"pulp", done.native_pulp}}},
          {"pulp_bodies", done.pulp_bodies},
          {"rim_percent", done.rim_percent},
          {"sense", sense_json(done.sense, sense)}});
  show_sense(done.sense);
  if (!a.json) {
    say(msg("voxels: enamel {}, dentin {}, pulp {} (bodies: {}); rim {}", done.native_enamel, done.native_dentin, done.native_pulp, done.pulp_bodies,
            as_percent(done.rim_percent, 2)),
        2);
    say(in_words(done.spacing), 2);
  }
}
#else
void run_import(const ImportArgs&) {
  throw Error(msg("tooth import"), msg("this build has no import"), msg("configure with -DCAVUM_IMPORT=ON (needs OpenVDB, OpenMesh and ITK)"));
}
#endif

void add_import(CLI::App& tooth) {
  auto* verb = tooth.add_subcommand("import", tr("Build a tooth from layer meshes, a CT volume or a label map"));
  auto a = std::make_shared<ImportArgs>();
  verb->add_option("VOLUME", a->volume, tr("MetaImage, NRRD, NIfTI, TIFF, or a folder with a DICOM series or TIFF stack"));
  verb->add_option("--enamel", a->enamel, tr("Closed enamel surface (STL, PLY, OBJ, OFF; mm)"));
  verb->add_option("--dentin", a->dentin, tr("Closed dentin surface"));
  verb->add_option("--pulp", a->pulp, tr("Closed pulp surface"));
  verb->add_option("--map", a->map, tr("VOLUME is a label map: 1=enamel,2=dentin,3=pulp"));
  verb->add_option("--spacing-mm", a->spacing, tr("Voxel edge, one number or x,y,z; overrides the file's"));
  verb->add_option("--dentin-threshold", a->dentin_threshold, tr("Gray above which tissue is hard (default: automatic)"));
  verb->add_option("--enamel-threshold", a->enamel_threshold, tr("Gray above which hard tissue is enamel (default: automatic)"));
  verb->add_option("--occlusal-axis", a->occlusal, tr("x,y,z in the file's frame (default: dentin centroid to enamel centroid)"));
  verb->add_option("--mesial-axis", a->mesial, tr("x,y,z in the file's frame (default: the file's x axis)"));
  verb->add_option("--rotate-deg", a->rotate_deg, tr("Turn about the occlusal axis, degrees"))->capture_default_str();
  verb->add_option("--units", a->units, tr("Unit of the meshes: mm, cm, m, um or in (default: mm, and checked)"));
  auto* fdi = verb->add_option("--tooth-number", a->fdi, tr("Which tooth it is, by its FDI number: 36"));
  verb->add_option("--universal", a->universal, tr("Which tooth it is, by its universal number: 19"))->excludes(fdi);
  verb->add_option("--patient-frame", a->patient_frame,
                   tr("lps or ras: the file's axes are the patient's, and tell with the number where mesial is"));
  verb->add_flag("--mirror", a->mirror, tr("Mirror it, so that +y is buccal: with a number of quadrant 2 or 4 it is done without asking"));
#ifdef CAVUM_WITH_IMPORT
  verb->add_option("--confirm", a->confirmed,
                   tr("Take what the shape contradicts, by the name that the refusal says: {}; may be given again", list_of(k_confirmable)))
      ->check(one_of({k_confirmable.begin(), k_confirmable.end()}));
#endif
  verb->add_option("--leaf-mm", a->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  verb->add_option("--periodontium-mm", a->periodontium_mm, tr("Supporting tissue around the roots, mm; 0 = none"))->capture_default_str();
  verb->add_option("--out", a->out, tr("Tooth file to write (.cvt)"))->required();
  verb->add_flag("--json", a->json, tr("One JSON object on stdout"));
  verb->callback([=] { run_import(*a); });
}

void add_info(CLI::App& tooth) {
  auto* info = tooth.add_subcommand("info", tr("What a tooth file holds"));
  auto path = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  info->add_option("FILE", *path, tr("Tooth file (.cvt)"))->required();
  info->add_flag("--json", *json, tr("One JSON object on stdout"));
  info->callback([=] {
    const Tooth t = load_tooth_file(*path);
    const Json d = describe(t, std::filesystem::file_size(*path));
    if (*json)
      print_json(d);
    else
      print_tooth(t, d);
  });
}

void add_mesh(CLI::App& tooth) {
  auto* mesh =
      tooth.add_subcommand("mesh", tr("Export the closed surface of a tissue, of all solid tissues together, or of the whole tooth to be printed"));
  struct MeshArgs {
    std::string file, tissue = "solid", out;
    bool json = false;
  };
  auto a = std::make_shared<MeshArgs>();
  mesh->add_option("FILE", a->file, tr("Tooth file (.cvt)"))->required();
  mesh->add_option("--tissue", a->tissue, tr("Tissue by name; solid, with the pulp's hollow; or outer: the outside alone, pulp filled"))
      ->capture_default_str();
  mesh->add_option("--out", a->out, tr("Mesh to write (.stl or .ply), mm"))->required();
  mesh->add_flag("--json", a->json, tr("One JSON object on stdout"));
  mesh->callback([=] {
    require_own_places({{"--out " + a->out, a->out}}, {{"", a->file}});
    const Tooth t = load_tooth_file(a->file);
    const TriangleMesh m = a->tissue == "outer" ? printable_surface(t, tissues_around_tooth(t)).mesh : surface_mesh(t, a->tissue);
    write_mesh_file(m, a->out);
    const double volume = rounded(signed_volume_mm3(m), 1e-6);
    if (a->json) {
      const Json d{
          {"out", a->out}, {"tissue", a->tissue}, {"triangles", m.triangles.size()}, {"vertices", m.vertices_mm.size()}, {"volume_mm3", volume}};
      print_json(d);
    } else {
      say(msg("{}: {} triangles around {} of {}", a->out, m.triangles.size(), as_mm3(volume, 3), Term{a->tissue}));
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
