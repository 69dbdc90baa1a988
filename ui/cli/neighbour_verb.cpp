// `cavum tooth neighbour`: sets teeth beside a tooth, and gum around their necks.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/tooth/make/add_adjacent.h"
#include "ui/cli/tooth_facts.h"
#include "ui/cli/tooth_verbs_parts.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

struct NeighbourArgs {
  std::string file, mesial, distal, out;
  std::vector<std::string> confirmed;
  AdjacentSpec spec;
  bool json = false;
};

nlohmann::ordered_json facts_json(const std::optional<ContactFacts>& c) {
  if (!c) return nullptr;
  return {
      {"at_mm", {rounded(c->at_mm.x, 1e-3), rounded(c->at_mm.y, 1e-3), rounded(c->at_mm.z, 1e-3)}},
      {"gap_mm", rounded(c->gap_mm, 1e-4)},
      {"width_mm", rounded(c->width_mm, 0.01)},
      {"height_mm", rounded(c->height_mm, 0.01)}};
}

void add_contact(Lines& out, const Message& side, const std::optional<ContactFacts>& c) {
  if (!c) return;
  out.add(msg("{}: touches at {}, {} apart; nearer than {} over {} × {}", side, c->at_mm,
              as_mm(c->gap_mm, 3), as_mm(c->gap_mm + 0.05, 2), as_number(c->width_mm, 1),
              as_mm(c->height_mm, 1)),
          2);
}

void run_neighbour(NeighbourArgs a) {
  require_distinct_paths({{"--out " + a.out, a.out}},
                         {{a.file, a.file}, {"--mesial", a.mesial}, {"--distal", a.distal}});
  const Tooth tooth = load_tooth_file(a.file);
  std::optional<Tooth> mesial, distal;
  if (!a.mesial.empty()) a.spec.mesial.tooth = &mesial.emplace(load_tooth_file(a.mesial));
  if (!a.distal.empty()) a.spec.distal.tooth = &distal.emplace(load_tooth_file(a.distal));
  a.spec.confirmed = !a.confirmed.empty();
  const AddedAdjacent done = add_adjacent(tooth, a.spec, a.file);
  save_tooth_file(done.tooth, a.out);
  auto d = describe(done.tooth, std::filesystem::file_size(a.out));
  if (a.json) {
    d["out"] = a.out;
    d["contact"] = {{"mesial", facts_json(done.mesial)}, {"distal", facts_json(done.distal)}};
    print_json(d);
    return;
  }
  print_tooth(done.tooth, d);
  Lines out;
  add_contact(out, msg("mesial"), done.mesial);
  add_contact(out, msg("distal"), done.distal);
  out.add(msg("written: {}", a.out), 2);
  say(out);
}

}  // namespace

void add_neighbour(CLI::App& tooth) {
  auto* verb =
      tooth.add_subcommand("neighbour", tr("Set teeth beside a tooth, and gum around their necks"));
  auto a = std::make_shared<NeighbourArgs>();
  verb->add_option("TOOTH", a->file, tr("Tooth file (.cvt)"))->required();
  verb->add_option("--mesial", a->mesial, tr("Tooth file of the mesial neighbour"));
  verb->add_option("--distal", a->distal, tr("Tooth file of the distal neighbour"));
  verb->add_option("--contact-mm", a->spec.contact_mm,
                   tr("Least distance at the contact, 0 to 1.5 leaves"))
      ->capture_default_str();
  verb->add_option("--reach-mm", a->spec.reach_mm,
                   tr("How far beyond the contact a neighbour is kept, 1 to 6"))
      ->capture_default_str();
  verb->add_option("--mesial-turn-deg", a->spec.mesial.turn_deg,
                   tr("Turns the mesial neighbour about z, from mesial towards buccal"))
      ->capture_default_str();
  verb->add_option("--distal-turn-deg", a->spec.distal.turn_deg, tr("Turns the distal neighbour"))
      ->capture_default_str();
  verb->add_flag("--gum", a->spec.gum,
                 tr("Gum around the necks, with a papilla below each contact"));
  verb->add_option("--confirm", a->confirmed,
                   tr("neighbours: set teeth side by side that no jaw has so"))
      ->check(one_of({"neighbours"}));
  verb->add_option("--out", a->out, tr("Tooth file to write (.cvt)"))->required();
  verb->add_flag("--json", a->json, tr("One JSON object on stdout"));
  verb->callback([a] { run_neighbour(*a); });
}

}  // namespace cavum::ui
