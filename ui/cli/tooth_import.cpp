// `cavum tooth import`: a tooth from meshes, a CT volume or a label map.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/base/error.h"
#include "ui/cli/tooth_facts.h"
#include "ui/cli/tooth_verbs_parts.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
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
namespace {

struct ImportArgs {
  std::string volume, enamel, dentin, pulp, map, spacing, occlusal, mesial, out, units,
      patient_frame;
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
  const std::pair<const char*, const std::string*> layers[] = {
      {"--enamel", &a.enamel}, {"--dentin", &a.dentin}, {"--pulp", &a.pulp}};
  std::vector<std::string> missing;
  for (const auto& [option, path] : layers) {
    if (!path->empty())
      require_mesh_file(*path);
    else
      missing.emplace_back(option);
  }
  if (!missing.empty())
    throw Error(msg("tooth import"),
                missing.size() == 1 ? msg("{} is missing", missing[0])
                                    : msg("{} and {} are missing", missing[0], missing[1]),
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
    throw Error(Name{"--patient-frame"},
                msg("tells where mesial is only for a tooth that is named"),
                msg("give --tooth-number or --universal, too"));
  return sense;
}

nlohmann::ordered_json sense_json(const ToothSense& sense, const SenseOptions& options) {
  nlohmann::ordered_json number = nullptr;
  if (options.number)
    number = {{"fdi", options.number->fdi},
              {"universal", options.number->universal()},
              {"text", options.number->text()}};
  return {{"tooth_number", number},
          {"tooth_class",
           {{"name", name_of(sense.tooth_class.kind)},
            {"probability", rounded(sense.tooth_class.probability, 0.01)}}},
          {"guesses", sense.guesses},
          {"warnings", sense.warnings}};
}

/// Warnings where they are seen even when the result goes to a file; print_tooth says them and the
/// guesses, too.
void show_sense(const ToothSense& sense) {
  for (const auto& w : sense.warnings) say_error(msg("notice: {}", w));
}

void run_import(const ImportArgs& a) {
  require_distinct_paths({{"--out " + a.out, a.out}},
                         {{"", a.volume}, {"", a.enamel}, {"", a.dentin}, {"", a.pulp}});
  FrameOptions frame;
  if (!a.occlusal.empty()) frame.occlusal_axis = parse_vec(a.occlusal, "--occlusal-axis");
  if (!a.mesial.empty()) frame.mesial_axis = parse_vec(a.mesial, "--mesial-axis");
  frame.rotate_deg = a.rotate_deg;
  frame.mirror = a.mirror;
  const SenseOptions sense = sense_options(a);
  if (!a.patient_frame.empty() && !frame.mesial_axis)
    frame.mesial_axis = mesial_in_patient(*sense.number, a.patient_frame);
  const bool meshes = !a.enamel.empty() || !a.dentin.empty() || !a.pulp.empty();
  if (meshes == !a.volume.empty())
    throw Error(msg("tooth import"),
                msg("needs either a VOLUME or the meshes --enamel --dentin --pulp"),
                msg("give one of the two"));
  if (meshes) {
    require_meshes(a);
    if (!a.spacing.empty() || !a.map.empty() || a.enamel_threshold || a.dentin_threshold)
      throw Error(msg("tooth import"), msg("spacing, map and thresholds belong to volumes"),
                  msg("leave them out for meshes (unit mm)"));
    const MeshImport done =
        import_meshes({a.enamel, a.dentin, a.pulp}, {a.leaf_mm, a.periodontium_mm, frame, sense});
    save_and_tell(done.tooth, a.out, a.json,
                  {{"mesh_volume_mm3",
                    {{"enamel", done.mesh_enamel_mm3},
                     {"dentin", done.mesh_dentin_mm3},
                     {"pulp", done.mesh_pulp_mm3}}},
                   {"overlap_leaves", done.overlap_leaves},
                   {"gap_leaves", done.gap_leaves},
                   {"sense", sense_json(done.sense, sense)}});
    show_sense(done.sense);
    return;
  }
  if (!a.units.empty())
    throw Error(Name{"--units"}, msg("belongs to meshes"), msg("give --spacing-mm for a volume"));
  VolumeImportOptions options;
  options.sense = sense;
  if (!a.spacing.empty()) {
    auto n = parse_numbers(a.spacing, "--spacing-mm");
    if (n.size() == 1) n = {n[0], n[0], n[0]};
    if (n.size() != 3)
      throw Error(Name{"--spacing-mm"}, msg("needs one number or three"),
                  msg("write 0.125 or 0.1,0.1,0.2"));
    options.spacing_mm = Vec3{n[0], n[1], n[2]};
  }
  options.thresholds = {a.enamel_threshold, a.dentin_threshold};
  if (!a.map.empty()) options.labels = parse_label_map(a.map);
  options.leaf_mm = a.leaf_mm;
  options.periodontium_mm = a.periodontium_mm;
  options.frame = frame;
  const VolumeImport done = import_volume(a.volume, options);
  save_and_tell(done.tooth, a.out, a.json,
                {{"spacing", in_words(done.spacing)},
                 {"spacing_assumed", done.spacing.by == VoxelSpacing::By::assumed},
                 {"native_voxels",
                  {{"enamel", done.native_enamel},
                   {"dentin", done.native_dentin},
                   {"pulp", done.native_pulp}}},
                 {"pulp_bodies", done.pulp_bodies},
                 {"rim_percent", done.rim_percent},
                 {"sense", sense_json(done.sense, sense)}});
  show_sense(done.sense);
  if (!a.json) {
    say(msg("voxels: enamel {}, dentin {}, pulp {} (bodies: {}); rim {}", done.native_enamel,
            done.native_dentin, done.native_pulp, done.pulp_bodies,
            as_percent(done.rim_percent, 2)),
        2);
    say(in_words(done.spacing), 2);
  }
}
#else
void run_import(const ImportArgs&) {
  throw Error(msg("tooth import"), msg("this build has no import"),
              msg("configure with -DCAVUM_IMPORT=ON (needs OpenVDB, OpenMesh and ITK)"));
}
#endif

}  // namespace

void add_import(CLI::App& tooth) {
  auto* verb = tooth.add_subcommand(
      "import", tr("Build a tooth from layer meshes, a CT volume or a label map"));
  auto a = std::make_shared<ImportArgs>();
  verb->add_option(
      "VOLUME", a->volume,
      tr("MetaImage, NRRD, NIfTI, TIFF, or a folder with a DICOM series or TIFF stack"));
  verb->add_option("--enamel", a->enamel, tr("Closed enamel surface (STL, PLY, OBJ, OFF; mm)"));
  verb->add_option("--dentin", a->dentin, tr("Closed dentin surface"));
  verb->add_option("--pulp", a->pulp, tr("Closed pulp surface"));
  verb->add_option("--map", a->map, tr("VOLUME is a label map: 1=enamel,2=dentin,3=pulp"));
  verb->add_option("--spacing-mm", a->spacing,
                   tr("Voxel edge, one number or x,y,z; overrides the file's"));
  verb->add_option("--dentin-threshold", a->dentin_threshold,
                   tr("Gray above which tissue is hard (default: automatic)"));
  verb->add_option("--enamel-threshold", a->enamel_threshold,
                   tr("Gray above which hard tissue is enamel (default: automatic)"));
  verb->add_option("--occlusal-axis", a->occlusal,
                   tr("x,y,z in the file's frame (default: dentin centroid to enamel centroid)"));
  verb->add_option("--mesial-axis", a->mesial,
                   tr("x,y,z in the file's frame (default: the file's x axis)"));
  verb->add_option("--rotate-deg", a->rotate_deg, tr("Turn about the occlusal axis, degrees"))
      ->capture_default_str();
  verb->add_option("--units", a->units,
                   tr("Unit of the meshes: mm, cm, m, um or in (default: mm, and checked)"));
  auto* fdi =
      verb->add_option("--tooth-number", a->fdi, tr("Which tooth it is, by its FDI number: 36"));
  verb->add_option("--universal", a->universal,
                   tr("Which tooth it is, by its universal number: 19"))
      ->excludes(fdi);
  verb->add_option(
      "--patient-frame", a->patient_frame,
      tr("lps or ras: the file's axes are the patient's, and tell with the number where mesial is"));
  verb->add_flag(
      "--mirror", a->mirror,
      tr("Mirror it, so that +y is buccal: with a number of quadrant 2 or 4 it is done without asking"));
#ifdef CAVUM_WITH_IMPORT
  verb->add_option(
          "--confirm", a->confirmed,
          tr("Take what the shape contradicts, by the name that the refusal says: {}; may be given again",
             list_of(k_confirmable)))
      ->check(one_of({k_confirmable.begin(), k_confirmable.end()}));
#endif
  verb->add_option("--leaf-mm", a->leaf_mm, tr("Edge of a leaf, mm"))->capture_default_str();
  verb->add_option("--periodontium-mm", a->periodontium_mm,
                   tr("Supporting tissue around the roots, mm; 0 = none"))
      ->capture_default_str();
  verb->add_option("--out", a->out, tr("Tooth file to write (.cvt)"))->required();
  verb->add_flag("--json", a->json, tr("One JSON object on stdout"));
  verb->callback([=] { run_import(*a); });
}

}  // namespace cavum::ui
