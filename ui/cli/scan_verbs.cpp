// `cavum scan`: a prepared tooth, scanned, marked as a virtual one.
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/tooth/adjacent.h"
#include "engine/tooth/mesh/mesh_units.h"
#include "grading/result/result_json.h"
#include "grading/scan/grade_scan.h"
#include "scenarios/file/parse.h"
#include "scenarios/file/rubric_check.h"
#include "scenarios/zones/zone_map.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#include "ui/report/report.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

struct ScanArguments {
  std::string scan, scenario, tooth, rubric, units = "mm", out, out_tooth, report;
  bool mirror = false, json = false;
};

/// How the scan was laid upon the tooth. `rotation` turns the file's frame into the tooth's, row by
/// row; lengths in mm.
Json facts_json(const grading::ScanFacts& f, const ScanArguments& o, double seconds) {
  const auto row = [](Vec3 v) {
    return Json::array({grading::rounded(v.x), grading::rounded(v.y), grading::rounded(v.z)});
  };
  const auto percent = [](double share) { return grading::rounded(100 * share); };
  const Rigid& pose = f.pose.to_tooth;
  Json apart = Json::array();
  for (const auto& piece : f.apart)
    apart.push_back({{"at_mm", row(piece.at_mm)},
                     {"deep_mm", grading::rounded(piece.deep_mm)},
                     {"mm3", grading::rounded(piece.mm3)}});
  return {{"file", o.scan},
          {"units", o.units},
          {"mirrored", o.mirror},
          {"triangles", f.triangles},
          {"rms_mm", grading::rounded(f.fit.rms_mm)},
          {"noise_mm", grading::rounded(f.fit.noise_mm)},
          {"form_mm", grading::rounded(f.fit.form_mm)},
          {"surface_bound_mm", grading::rounded(f.surface_bound_mm)},
          {"surface_mean_bound_mm", grading::rounded(f.surface_mean_bound_mm)},
          {"fits_percent", percent(f.fit.fits)},
          {"fits_within_mm", grading::rounded(f.fit.within_mm)},
          {"beyond_percent", percent(f.fit.beyond)},
          {"just_below_percent", percent(f.fit.shallow)},
          {"agreement_percent", percent(agreement(f.fit))},
          {"crown_seen_percent", percent(f.fit.crown_seen)},
          {"second_pose_percent", percent(f.second_share)},
          {"cavities", f.cavities},
          {"unseen_mm3", grading::rounded(f.unseen_mm3)},
          {"left_as_noise_mm3", grading::rounded(f.left_as_noise_mm3)},
          {"apart", apart},
          {"end_mm", grading::rounded(f.end_mm)},
          {"holes", f.holes},
          {"pose",
           {{"rotation",
             {row(pose.rotation.row_x), row(pose.rotation.row_y), row(pose.rotation.row_z)}},
            {"shift_mm", row(pose.shift_mm)}}},
          {"took_s", grading::rounded(seconds)}};
}

Message facts_text(const grading::ScanFacts& f, double seconds) {
  return msg(
      "scan: {} triangles, laid upon the tooth with {} RMS over {} of its surface; {} of the crown is seen; {}",
      f.triangles, as_mm(f.fit.rms_mm, 3), as_percent(100 * f.fit.fits, 1),
      as_percent(100 * f.fit.crown_seen, 1), as_s(seconds, 1));
}

void run_scan_grade(const ScanArguments& o) {
  if (!o.out.empty() && std::filesystem::exists(o.out))
    throw Error(Name{o.out}, msg("exists already, and a result is never overwritten"),
                msg("choose another name"));
  require_distinct_paths({{"--out " + o.out, o.out},
                          {"--out-tooth " + o.out_tooth, o.out_tooth},
                          {"--report " + o.report, o.report}},
                         {{"", o.scan}, {"", o.scenario}, {"", o.tooth}, {"", o.rubric}});
  if (!o.report.empty()) report::require_report_path(o.report);
  const double unit_mm = mm_per_unit(o.units);
  const auto begun = std::chrono::steady_clock::now();
  const scenarios::Scenario scenario = scenarios::load_scenario(o.scenario);
  const Tooth with_adjacent =
      load_tooth_file(o.tooth.empty() ? scenarios::find_tooth_file(scenario) : o.tooth);
  scenarios::require_tissues(scenario, with_adjacent);
  const scenarios::RubricSpec rubric =
      o.rubric.empty() ? scenario.rubric
                       : scenarios::parse_rubric(read_text_file(o.rubric), o.rubric);
  if (!o.rubric.empty())
    scenarios::require_none(scenarios::not_in_this_exam(rubric, scenario, with_adjacent));
  const scenarios::ZoneMap zones = scenarios::build_zones(scenario, with_adjacent);
  const Tooth tooth = has_adjacent(with_adjacent) ? own_tooth(with_adjacent)
                                                  : with_adjacent;  // a tooth is scanned alone
  const grading::GradedScan g =
      grading::grade_scan(o.scan, {unit_mm, o.mirror}, scenario, rubric, tooth, zones);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  Json marked = grading::with_words(grading::to_json(g.result));
  marked["scan"] = facts_json(g.facts, o, seconds);
  if (!o.out.empty())
    write_text_file(o.out, marked.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                    {.may_replace = false});
  if (!o.out_tooth.empty()) save_tooth_file(g.after, o.out_tooth);
  if (!o.report.empty())
    report::write_scan_report(o.report, o.scan, g, g.input(scenario, tooth, zones), rubric);
  if (o.json) return print_json(marked);
  say(grading::to_text(g.result));
  say(facts_text(g.facts, seconds));
  if (!o.report.empty()) say(msg("report: {}", o.report));
}

}  // namespace

void add_scan_verbs(CLI::App& app, int& exit_code) {
  auto* scan = app.add_subcommand("scan", tr("Prepared teeth that were scanned"));
  scan->require_subcommand(1);
  auto* v = scan->add_subcommand(
      "grade",
      tr("Mark a scan of a prepared tooth as an exam of the scenario is marked, in whatever pose it lies; time, way and force are not judged"));
  auto o = std::make_shared<ScanArguments>();
  v->add_option(
       "scan", o->scan,
       tr("surface of the prepared tooth (STL, PLY, OBJ, OFF), open or closed: the crown at least"))
      ->required();
  v->add_option("--scenario", o->scenario, tr("the task (TOML)"))->required();
  v->add_option(
      "--tooth", o->tooth,
      tr("the unprepared tooth (.cvt), from `tooth import` or `tooth make`; left out: the scenario's"));
  v->add_option("--rubric", o->rubric,
                tr("mark by this rubric (TOML) instead of the scenario's own"));
  v->add_option("--units", o->units, tr("unit of the scan: mm, cm, m, um or in"))
      ->capture_default_str();
  v->add_flag("--mirror", o->mirror,
              tr("the scan is of the real tooth, and the tooth was imported as its mirror image"));
  v->add_option("--out", o->out, tr("write the JSON to this file too, which must not exist yet"));
  v->add_option("--out-tooth", o->out_tooth, tr("write the tooth as the scan shows it (.cvt)"));
  v->add_option(
      "--report", o->report,
      tr("write a report with the tooth in 3D, sections and every figure (.html or .pdf)"));
  v->add_flag("--json", o->json, tr("one JSON object on standard output"));
  v->callback([o, &exit_code] {
    run_scan_grade(*o);
    exit_code = 0;
  });
}

}  // namespace cavum::ui
