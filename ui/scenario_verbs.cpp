// `cavum scenario check | show | new`: authoring help.
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/tooth/tooth.h"
#include "scenarios/exam.h"
#include "scenarios/parse.h"
#include "scenarios/picture.h"
#include "scenarios/zone_map.h"
#include "ui/print_json.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

struct Options {
  std::string scenario, tooth, out;
  bool json = false, force = false;
};

int check(const Options& o) {
  std::vector<Problem> problems = check_scenario(read_text_file(o.scenario), o.scenario);
  if (problems.empty()) {
    // the zones must also fit the tooth, when it is there
    try {
      const Scenario s = load_scenario(o.scenario);
      const Tooth tooth = load_tooth_file(o.tooth.empty() ? find_tooth_file(s) : o.tooth);
      static_cast<void>(build_zones(s, tooth));
      require_tissues(s, tooth);
      for (const auto& name : s.points) static_cast<void>(find_data_file("points", name + ".toml", o.scenario));
    } catch (const Error& e) {
      const std::string text = e.what();
      const auto at = text.find(": "), then = text.find("; ");
      problems.push_back({text.substr(0, at), text.substr(at + 2, then - at - 2), text.substr(then + 2), 0, 0});
    }
  }
  if (o.json) {
    nlohmann::ordered_json j{{"scenario", o.scenario}, {"sound", problems.empty()}, {"problems", nlohmann::ordered_json::array()}};
    for (const auto& p : problems)
      j["problems"].push_back({{"where", p.where}, {"line", p.line}, {"column", p.column}, {"what", p.what}, {"what_to_do", p.what_to_do}});
    print_json(j);
  } else {
    for (const auto& p : problems) std::cout << p.text() << "\n";
    if (problems.empty()) std::cout << o.scenario << ": sound\n";
  }
  return problems.empty() ? 0 : 1;
}

int show(const Options& o) {
  require_writable(o.out);
  const Scenario s = load_scenario(o.scenario);
  const Tooth tooth = load_tooth_file(o.tooth.empty() ? find_tooth_file(s) : o.tooth);
  const ZoneMap zones = build_zones(s, tooth);
  const std::string svg = scenario_sheet_svg(s, tooth, zones);
  write_text_file(o.out, svg);
  const double leaf = zones.leaf_volume_mm3();
  if (o.json) {
    nlohmann::ordered_json j{
        {"out", o.out}, {"tooth", tooth.name}, {"opening_z_mm", zones.opening_z_mm()}, {"zones_mm3", nlohmann::ordered_json::object()}};
    for (std::size_t z = 1; z < k_zones; ++z) j["zones_mm3"][zone_name(static_cast<Zone>(z))] = static_cast<double>(zones.counts()[z]) * leaf;
    print_json(j);
    return 0;
  }
  for (std::size_t z = 1; z < k_zones; ++z)
    std::cout << zone_name(static_cast<Zone>(z)) << ": " << static_cast<double>(zones.counts()[z]) * leaf << " mm3\n";
  std::cout << "drawn: " << o.out << "\n";
  return 0;
}

int make_new(const Options& o) {
  if (std::filesystem::exists(o.out) && !o.force) throw Error(o.out, "the file exists already", "choose another name, or overwrite it with --force");
  write_text_file(o.out, scenario_template());
  std::cout << "written: " << o.out << "; next: cavum scenario check " << o.out << "\n";
  return 0;
}

}  // namespace

void add_scenario_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<Options>();
  auto* verb = app.add_subcommand("scenario", "Write and check exam scenarios");
  verb->require_subcommand(1);

  auto* checks = verb->add_subcommand("check", "Name every mistake of a scenario file");
  checks->add_option("scenario", o->scenario, "scenario file (TOML)")->required();
  checks->add_option("--tooth", o->tooth, "check the zones against this tooth instead");
  checks->add_flag("--json", o->json, "one JSON object on standard output");
  checks->callback([o, &exit_code] { exit_code = check(*o); });

  auto* shows = verb->add_subcommand("show", "Draw the zones on three sections and from above (SVG)");
  shows->add_option("scenario", o->scenario, "scenario file (TOML)")->required();
  shows->add_option("--out", o->out, "SVG file")->required();
  shows->add_option("--tooth", o->tooth, "draw them in this tooth instead");
  shows->add_flag("--json", o->json, "one JSON object on standard output");
  shows->callback([o, &exit_code] { exit_code = show(*o); });

  auto* news = verb->add_subcommand("new", "Write a commented scenario to start from");
  news->add_option("--out", o->out, "file to write")->required();
  news->add_flag("--force", o->force, "overwrite");
  news->callback([o, &exit_code] { exit_code = make_new(*o); });
}

}  // namespace cavum
