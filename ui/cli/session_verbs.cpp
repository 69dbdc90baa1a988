// `cavum session`: what a recorded exam holds, as files that others can use.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/write_file.h"
#include "engine/device/motion_file.h"
#include "engine/lab/scan/printable.h"
#include "engine/physics/servo/servo_config.h"
#include "engine/session/session_reader.h"
#include "grading/measures/apart.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

struct ExportArguments {
  std::string session, motion, stl;
};

void export_motion(const ExportArguments& o) {
  require_writable(o.motion);
  const SessionReader session(o.session);
  const std::vector<TickInput> inputs = session.inputs();
  if (inputs.empty())
    throw Error(Name{o.session}, msg("holds no tick"), msg("give a session with motion"));
  const double quantum_mm =
      parse_servo_config(session.setup().servo_toml, o.session).position_quantum_mm;
  write_private_text_file(
      o.motion, motion_text(inputs, session.setup().first_tip_mm(), quantum_mm, o.session));
  say(msg("{} ticks of motion in {}", inputs.size(), o.motion));
}

/// The tooth as it was left, as one closed surface.
void export_surface(const ExportArguments& o) {
  require_distinct_paths({{"--stl " + o.stl, o.stl}}, {{"", o.session}});
  const SessionReader session(o.session);
  session.require_readable();
  if (!session.closed())
    throw Error(Name{o.session}, msg("this exam was not closed, and has no final tooth"),
                msg("close it with `cavum exam --resume --end --out {}`", o.session));
  Tooth before = load_tooth(session.setup().tooth, o.session + ": tooth"),
        after = load_tooth(session.final_tooth(), o.session + ": final tooth");
  if (const auto apart = grading::take_apart(before)) {
    after.octree = grading::take_apart(*apart, after.octree, {}).after;
    before = apart->own;
    say(msg("of the tooth alone: what stands beside it is left out"));
  }
  const Printable p = printable_surface(after, tissues_around_tooth(before));
  write_mesh_file(p.mesh, o.stl);
  say(msg("{} triangles around {} in {}, mm, tooth frame", p.mesh.triangles.size(),
          as_mm3(p.volume_mm3, 3), o.stl));
  if (p.left_out > 0)
    say(msgn("{} part of {} beside it left out: crumbs that were cut off",
             "{} parts of {} beside it left out: crumbs that were cut off",
             static_cast<std::int64_t>(p.left_out), p.left_out, as_mm3(p.left_out_mm3, 3)));
}

}  // namespace

void add_session_verbs(CLI::App& app, int& exit_code) {
  auto* session =
      app.add_subcommand("session", tr("What a recorded exam holds, as files that others can use"));
  session->require_subcommand(1);
  auto* v = session->add_subcommand(
      "export",
      tr("Write the motion of a recorded exam (`cavum exam --motion` with it and the same scenario gives the same marks), "
         "or its final tooth to be printed"));
  auto o = std::make_shared<ExportArguments>();
  v->add_option("session", o->session, tr("a recorded exam (.cavum)"))->required();
  v->add_option("--motion", o->motion,
                tr("CSV to write: a row for each tick, with bur and step of the encoder"));
  v->add_option(
      "--stl", o->stl,
      tr("surface of the tooth as it was left to write (.stl or .ply): closed, one part, mm, pulp filled"));
  v->callback([o, &exit_code] {
    if (o->motion.empty() && o->stl.empty())
      throw Error(msg("session export"), msg("is not told what to write"),
                  msg("give --motion F.csv, --stl F.stl, or both"));
    if (!o->motion.empty()) export_motion(*o);
    if (!o->stl.empty()) export_surface(*o);
    exit_code = 0;
  });
}

}  // namespace cavum::ui
