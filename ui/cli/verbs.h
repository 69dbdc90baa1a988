// The verbs of the command line. Each family adds its own subcommands; a verb that runs stores its
// exit code: 0 done, 1 done and the answer is no. Unusable input is thrown as Error and ends
// with 2.
#pragma once

#include <string>

#include "ui/parts/option_checks.h"

namespace cavum::ui {

void add_tooth_verbs(CLI::App& app, int& exit_code);
void add_scenario_verbs(CLI::App& app, int& exit_code);
void add_exam_verbs(CLI::App& app, int& exit_code);
void add_replay_verbs(CLI::App& app, int& exit_code);
void add_session_verbs(CLI::App& app, int& exit_code);
void add_grade_verbs(CLI::App& app, int& exit_code);
/// After the ledger's: `ledger report` is one of them.
void add_report_verbs(CLI::App& app, int& exit_code);
/// The report (HTML) for an instructor or a student of a recording that a ledger holds. Throws
/// Error, also where a student may not see it.
[[nodiscard]] std::string filed_report(const std::string& ledger_folder,
                                       const std::string& recording,
                                       const std::string& reader = "instructor");
void add_scan_verbs(CLI::App& app, int& exit_code);
void add_rig_verbs(CLI::App& app, int& exit_code);
void add_device_verbs(CLI::App& app, int& exit_code);
void add_explain_verbs(CLI::App& app, int& exit_code);
void add_ledger_verbs(CLI::App& app, int& exit_code);
void add_cohort_verbs(CLI::App& app, int& exit_code);
void add_verify_verbs(CLI::App& app, int& exit_code);
void add_verify_all_verb(CLI::App& app, int& exit_code);
void add_station_verbs(CLI::App& app, int& exit_code);
void add_serve_verbs(CLI::App& app, int& exit_code);
/// What it writes speaks of all that `app` has when it runs.
void add_manual_verbs(CLI::App& app, int& exit_code);

}  // namespace cavum::ui
