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
#include "engine/language/language.h"
#include "engine/language/say.h"
#include "engine/servo/servo.h"
#include "grading/ledger/class_list.h"
#include "scenarios/file/parse.h"
#include "ui/parts/terminal.h"
#include "ui/verbs/help_in_language.h"
#include "ui/verbs/verbs.h"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error that is told, not the end of an exam
  cavum::ui::SafeTerminal terminal;
  std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  try {
    const std::string asked = cavum::take_language_option(arguments);
    cavum::set_language(asked.empty() ? cavum::language_of_environment() : asked);
  } catch (const cavum::Error& e) {
    std::fprintf(stderr, "cavum: %s\n", cavum::one_line(e.what()).c_str());
    return 2;
  }
  CLI::App app{"Cavum examines cavity opening on virtual teeth: exams, grades, replays."};
  app.set_version_flag("--version", fmt::format("cavum {}, physics {}", cavum::version(), cavum::k_physics_version));
  app.require_subcommand(1);
  std::string language;  // taken out above: the verbs' help is in it already
  app.add_option("--language", language,
                 cavum::tr("language of what is shown ({}); else the first that there is of $LANGUAGE, $LC_ALL, $LC_MESSAGES, $LANG",
                           cavum::as_is(fmt::format("{}", fmt::join(cavum::languages(), ", ")))));
  // what programs read stays English: JSON, the manual page; the help is translated where it is laid out
  const auto has = [&](std::string_view word) { return std::find(arguments.begin(), arguments.end(), word) != arguments.end(); };
  const bool for_programs = has("--json") || (!arguments.empty() && arguments[0] == "manual");
  terminal.translate(!for_programs && !has("--help") && !has("-h") && !has("--help-all") && !has("--version"));
  app.formatter(std::make_shared<cavum::ui::HelpInLanguage>());
  app.failure_message(CLI::FailureMessage::simple);
  int exit_code = 0;
  cavum::ui::add_tooth_verbs(app, exit_code);
  cavum::ui::add_scenario_verbs(app, exit_code);
  cavum::ui::add_exam_verbs(app, exit_code);
  cavum::ui::add_replay_verbs(app, exit_code);
  cavum::ui::add_session_verbs(app, exit_code);
  cavum::ui::add_grade_verbs(app, exit_code);
  cavum::ui::add_scan_verbs(app, exit_code);
  cavum::ui::add_rig_verbs(app, exit_code);
  cavum::ui::add_explain_verbs(app, exit_code);
  cavum::ui::add_ledger_verbs(app, exit_code);
  cavum::ui::add_report_verbs(app, exit_code);
  cavum::ui::add_cohort_verbs(app, exit_code);
  cavum::ui::add_verify_verbs(app, exit_code);
  cavum::ui::add_verify_all_verb(app, exit_code);
  cavum::ui::add_device_verbs(app, exit_code);
  cavum::ui::add_station_verbs(app, exit_code);
  cavum::ui::add_serve_verbs(app, exit_code);
  cavum::ui::add_manual_verbs(app, exit_code);
  const auto verbs = app.get_subcommands([](CLI::App*) { return true; });
  if (!arguments.empty() && !arguments[0].starts_with('-') &&
      std::none_of(verbs.begin(), verbs.end(), [&](const CLI::App* v) { return v->get_name() == arguments[0]; })) {
    std::fprintf(stderr, "cavum: %s\n",
                 fmt::format("command line: there is no verb '{}'; see `cavum --help`", cavum::one_line(arguments[0])).c_str());
    return 2;
  }
  cavum::keep_memory_reserve();
  try {
    std::vector<std::string> from_the_end(arguments.rbegin(), arguments.rend());
    app.parse(std::move(from_the_end));
  } catch (const CLI::CallForHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForAllHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForVersion& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "cavum: %s\n",
                 fmt::format("command line: {}; see `cavum --help` or `cavum VERB --help`", cavum::one_line(e.what())).c_str());
    return 2;
  } catch (const cavum::scenarios::ProblemsError& e) {
    for (const auto& p : e.problems()) std::fprintf(stderr, "cavum: %s\n", cavum::one_line(cavum::english_text(p.message())).c_str());
    return 2;
  } catch (const cavum::ledger::ListMistakes& e) {
    for (const auto& text : e.texts()) std::fprintf(stderr, "cavum: %s\n", cavum::one_line(text).c_str());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "cavum: %s\n", "memory: there is not enough; close other programs, and try again");
    return 2;
  } catch (const std::filesystem::filesystem_error& e) {
    std::fprintf(stderr, "cavum: %s\n",
                 fmt::format("{}: {}; give another file or folder", cavum::one_line(e.path1().string().substr(0, 300)), e.code().message()).c_str());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cavum: %s\n", cavum::one_line(e.what()).c_str());
    return 2;
  }
  return exit_code;
}
