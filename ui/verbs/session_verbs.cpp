// `cavum session`: what a recorded exam holds, as files that others can use.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/write_file.h"
#include "engine/device/motion_file.h"
#include "engine/servo/servo_config.h"
#include "engine/session/session_reader.h"
#include "ui/verbs/verbs.h"

namespace cavum::ui {
namespace {

struct ExportArguments {
  std::string session, motion;
};

void export_motion(const ExportArguments& o) {
  require_writable(o.motion);
  const SessionReader session(o.session);
  const std::vector<TickInput> inputs = session.inputs();
  if (inputs.empty()) throw Error(o.session, "holds no tick", "give a session with motion");
  const double quantum_mm = parse_servo_config(session.setup().servo_toml, o.session).position_quantum_mm;
  write_private_text_file(o.motion, motion_text(inputs, session.setup().first_tip_mm(), quantum_mm, o.session));
  std::cout << inputs.size() << " ticks of motion in " << o.motion << "\n";
}

}  // namespace

void add_session_verbs(CLI::App& app, int& exit_code) {
  auto* session = app.add_subcommand("session", "What a recorded exam holds, as files that others can use");
  session->require_subcommand(1);
  auto* v = session->add_subcommand("export",
                                    "Write the motion of a recorded exam: `cavum exam --motion` with it and the same scenario gives the same marks");
  auto o = std::make_shared<ExportArguments>();
  v->add_option("session", o->session, "a recorded exam (.cavum)")->required();
  v->add_option("--motion", o->motion, "CSV to write: a row for each tick, with point and step of the encoder")->required();
  v->callback([o, &exit_code] {
    export_motion(*o);
    exit_code = 0;
  });
}

}  // namespace cavum::ui
