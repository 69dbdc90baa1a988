// The one binary: `cavum VERB ...`. Exit 0 done, 1 done and the answer is no, 2 usage or unreadable input.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/memory_reserve.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "engine/physics/servo/servo.h"
#include "grading/records/class_list.h"
#include "scenarios/file/parse.h"
#include "ui/cli/command_line_error.h"
#include "ui/cli/help_in_language.h"
#include "ui/cli/verbs.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/say.h"
#include "ui/parts/terminal.h"

namespace {

/// `exit_code`: where the verb writes it.
int run_verb(CLI::App& app, const std::vector<std::string>& arguments, const int& exit_code) {
  try {
    std::vector<std::string> from_the_end(arguments.rbegin(), arguments.rend());
    app.parse(std::move(from_the_end));
  } catch (const CLI::Success& e) {  // help or version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    cavum::ui::say_error(cavum::ui::command_line_error(e, app, arguments));
    return 2;
  } catch (const cavum::scenarios::ProblemsError& e) {
    for (const auto& p : e.problems()) cavum::ui::say_error(p.message());
    return 2;
  } catch (const cavum::records::ListMistakes& e) {
    for (const auto& mistake : e.mistakes()) cavum::ui::say_error(mistake);
    return 2;
  } catch (const std::bad_alloc&) {
    cavum::ui::say_error(cavum::msg("memory: there is not enough; close other programs, and try again"));
    return 2;
  } catch (const std::filesystem::filesystem_error& e) {
    cavum::ui::say_error(cavum::msg("{}: {}; give another file or folder", e.path1().string().substr(0, 300), e.code().message()));
    return 2;
  } catch (const cavum::Error& e) {
    cavum::ui::say_error(e.message());
    return 2;
  } catch (const std::exception& e) {
    cavum::ui::say_error(cavum::msg("{}", e.what()));
    return 2;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error that is told, not the end of an exam
  cavum::ui::SafeTerminal terminal;
  std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  try {
    cavum::set_language(cavum::language_of_environment());  // of errors of the option itself
    if (const std::string asked = cavum::take_language_option(arguments); !asked.empty()) cavum::set_language(asked);
  } catch (const cavum::Error& e) {
    cavum::ui::say_error(e.message());
    return 2;
  }
  if (!arguments.empty() && arguments[0] == "manual") cavum::set_language("en");  // packaged once, for all
  CLI::App app{cavum::tr("Cavum examines cavity opening on virtual teeth: exams, grades, replays."), "cavum"};
  cavum::ui::help_in_language(app);
  app.set_version_flag("--version", fmt::format("cavum {}, physics {}", cavum::version(), cavum::k_physics_version),
                       cavum::tr("Display program version information and exit"));
  app.require_subcommand(1);
  std::string language;  // taken out above
  app.add_option("--language", language,
                 cavum::tr("language of what is shown ({}); else the first that there is of $LANGUAGE, $LC_ALL, $LC_MESSAGES, $LANG",
                           cavum::list_of(cavum::languages())));
  app.failure_message(CLI::FailureMessage::simple);
  int exit_code = 0;
  for (const auto add : {cavum::ui::add_tooth_verbs, cavum::ui::add_scenario_verbs, cavum::ui::add_exam_verbs, cavum::ui::add_replay_verbs,
                         cavum::ui::add_session_verbs, cavum::ui::add_grade_verbs, cavum::ui::add_scan_verbs, cavum::ui::add_rig_verbs,
                         cavum::ui::add_explain_verbs, cavum::ui::add_ledger_verbs, cavum::ui::add_report_verbs, cavum::ui::add_cohort_verbs,
                         cavum::ui::add_verify_verbs, cavum::ui::add_verify_all_verb, cavum::ui::add_device_verbs, cavum::ui::add_station_verbs,
                         cavum::ui::add_serve_verbs, cavum::ui::add_manual_verbs})
    add(app, exit_code);
  cavum::ui::group_help_flags(app);
  const auto verbs = app.get_subcommands([](CLI::App*) { return true; });
  if (!arguments.empty() && !arguments[0].starts_with('-') &&
      std::none_of(verbs.begin(), verbs.end(), [&](const CLI::App* v) { return v->get_name() == arguments[0]; })) {
    cavum::ui::say_error(cavum::msg("command line: there is no verb '{}'; see `cavum --help`", arguments[0]));
    return 2;
  }
  cavum::keep_memory_reserve();
  return run_verb(app, arguments, exit_code);
}
