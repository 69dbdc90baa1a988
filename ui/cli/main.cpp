// The one binary: `cavum VERB ...`. Exit 0 done, 1 done and the answer is no, 2 usage or unreadable
// input.
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
#include "engine/base/system_error.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "engine/physics/servo/servo.h"
#include "grading/records/class_list.h"
#include "scenarios/file/parse.h"
#include "ui/cli/command_line_error.h"
#include "ui/cli/help_in_language.h"
#include "ui/cli/reported_error.h"
#include "ui/cli/verbs.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/terminal.h"

namespace {

using cavum::msg;

/// `exit_code`: where the verb writes it. What is wrong goes to `errors`.
int run_verb(CLI::App& app, const std::vector<std::string>& arguments, const int& exit_code,
             std::vector<cavum::Error>& errors) {
  try {
    std::vector<std::string> from_the_end(arguments.rbegin(), arguments.rend());
    app.parse(std::move(from_the_end));
  } catch (const CLI::Success& e) {  // help or version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    errors.push_back(cavum::ui::command_line_error(e, app, arguments));
  } catch (const cavum::scenarios::ProblemsError& e) {
    for (const auto& p : e.problems())
      errors.emplace_back(p.mistake, p.where, p.what, p.what_to_do);
  } catch (const cavum::records::ListMistakes& e) {
    errors = e.mistakes();
  } catch (const std::bad_alloc&) {
    errors.emplace_back(cavum::MemoryError::ran_out, msg("memory"), msg("there is not enough"),
                        msg("close other programs, and try again"));
  } catch (const std::filesystem::filesystem_error& e) {
    const int why = e.code().value();
    errors.emplace_back(cavum::system_code(why), cavum::Name{e.path1().string().substr(0, 300)},
                        cavum::system_words(why), msg("give another file or folder"));
  } catch (const cavum::Error& e) {
    errors.push_back(e);
  } catch (const std::exception& e) {
    errors.emplace_back(msg("this program"), cavum::Name{e.what()}, msg("try again"));
  }
  return errors.empty() ? exit_code : 2;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(
      SIGXFSZ,
      SIG_IGN);  // a file that may not grow is an error that is told, not the end of an exam
  cavum::ui::SafeTerminal terminal;
  std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  const bool as_json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  const auto refused = [&](cavum::Error error) {
    cavum::ui::report_errors({std::move(error)}, as_json);
    return 2;
  };
  try {
    cavum::set_language(cavum::language_of_environment());  // of errors of the option itself
    if (const std::string asked = cavum::take_language_option(arguments); !asked.empty())
      cavum::set_language(asked);
  } catch (const cavum::Error& e) {
    return refused(e);
  }
  if (!arguments.empty() && arguments[0] == "manual")
    cavum::set_language("en");  // packaged once, for all
  CLI::App app{cavum::tr("Cavum examines cavity opening on virtual teeth: exams, grades, replays."),
               "cavum"};
  cavum::ui::help_in_language(app);
  app.set_version_flag(
      "--version", fmt::format("cavum {}, physics {}", cavum::version(), cavum::k_physics_version),
      cavum::tr("Display program version information and exit"));
  app.require_subcommand(1);
  std::string language;  // taken out above
  app.add_option(
      "--language", language,
      cavum::tr(
          "language of what is shown ({}); else the first that there is of $LANGUAGE, $LC_ALL, $LC_MESSAGES, $LANG",
          cavum::list_of(cavum::languages())));
  app.failure_message(CLI::FailureMessage::simple);
  int exit_code = 0;
  for (const auto add :
       {cavum::ui::add_tooth_verbs, cavum::ui::add_scenario_verbs, cavum::ui::add_exam_verbs,
        cavum::ui::add_replay_verbs, cavum::ui::add_session_verbs, cavum::ui::add_grade_verbs,
        cavum::ui::add_scan_verbs, cavum::ui::add_rig_verbs, cavum::ui::add_explain_verbs,
        cavum::ui::add_ledger_verbs, cavum::ui::add_report_verbs, cavum::ui::add_cohort_verbs,
        cavum::ui::add_verify_verbs, cavum::ui::add_verify_all_verb, cavum::ui::add_device_verbs,
        cavum::ui::add_station_verbs, cavum::ui::add_serve_verbs, cavum::ui::add_manual_verbs})
    add(app, exit_code);
  cavum::ui::group_help_flags(app);
  const auto verbs = app.get_subcommands([](CLI::App*) { return true; });
  if (!arguments.empty() && !arguments[0].starts_with('-') &&
      std::none_of(verbs.begin(), verbs.end(),
                   [&](const CLI::App* v) { return v->get_name() == arguments[0]; }))
    return refused(cavum::ui::no_verb(arguments[0]));
  cavum::keep_memory_reserve();
  std::vector<cavum::Error> errors;
  const int end = run_verb(app, arguments, exit_code, errors);
  if (!errors.empty()) cavum::ui::report_errors(errors, as_json);
  return end;
}
