// `cavum verify`: what is proved of one recorded exam, in words.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/session/station_key.h"
#include "grading/records/explain_session.h"
#include "grading/records/station_ticket.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

void add_verify_verbs(CLI::App& app, int& exit_code) {
  struct Options {
    std::string session, school_key;
    bool as_json = false;
  };
  const auto o = std::make_shared<Options>();
  auto* verify = app.add_subcommand(
      "verify", tr("Say in words what is proved of a recorded exam, and what is not"));
  verify->add_option("session", o->session, tr("a .cavum file"))->required();
  verify->add_option(
      "--school-key", o->school_key,
      tr("public key (hexadecimal) of the school that must have issued the ticket; else a ticket is compared with "
         "$CAVUM_HOME/school.pub where that is"));
  verify->add_flag("--json", o->as_json, tr("one JSON object on stdout"));
  verify->callback([o, &exit_code] {
    const std::string key = o->school_key.empty() ? records::station_school_key()
                                                  : parse_public_key(o->school_key, "--school-key");
    const records::SessionExplanation e =
        records::explain_session(o->session, key, !o->school_key.empty());
    if (o->as_json)
      print_json(nlohmann::json{{"verified", e.holds},
                                {"proved", e.proved},
                                {"findings", e.findings},
                                {"remarks", e.remarks}});
    else
      say(records::to_text(e));
    exit_code = e.holds ? 0 : 1;
  });
}

}  // namespace cavum::ui
