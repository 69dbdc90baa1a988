// The one binary: `cavum VERB ...`. Exit 0 done, 1 done and the answer is no, 2 usage or unreadable input.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include "engine/base/memory_reserve.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "engine/servo/servo.h"
#include "scenarios/file/parse.h"
#include "ui/parts/terminal.h"
#include "ui/verbs/verbs.h"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error that is told, not the end of an exam
  const cavum::ui::SafeTerminal terminal;
  CLI::App app{"Cavum examines cavity opening on virtual teeth: exams, grades, replays."};
  app.set_version_flag("--version", fmt::format("cavum {}, physics {}", cavum::version(), cavum::k_physics_version));
  app.require_subcommand(1);
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
  cavum::ui::add_device_verbs(app, exit_code);
  cavum::ui::add_station_verbs(app, exit_code);
  cavum::ui::add_manual_verbs(app, exit_code);
  const auto verbs = app.get_subcommands([](CLI::App*) { return true; });
  if (argc > 1 && argv[1][0] != '-' && std::none_of(verbs.begin(), verbs.end(), [&](const CLI::App* v) { return v->get_name() == argv[1]; })) {
    std::fprintf(stderr, "cavum: command line: there is no verb '%s'; see `cavum --help`\n", cavum::one_line(argv[1]).c_str());
    return 2;
  }
  cavum::keep_memory_reserve();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForAllHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForVersion& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "cavum: command line: %s; see `cavum --help` or `cavum VERB --help`\n", cavum::one_line(e.what()).c_str());
    return 2;
  } catch (const cavum::scenarios::ProblemsError& e) {
    for (const auto& p : e.problems()) std::fprintf(stderr, "cavum: %s\n", cavum::one_line(p.text()).c_str());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "cavum: memory: there is not enough; close other programs, and try again\n");
    return 2;
  } catch (const std::filesystem::filesystem_error& e) {
    std::fprintf(stderr, "cavum: %.300s: %s; give another file or folder\n", cavum::one_line(e.path1().string()).c_str(), e.code().message().c_str());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cavum: %s\n", cavum::one_line(e.what()).c_str());
    return 2;
  }
  return exit_code;
}
