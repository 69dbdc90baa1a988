// Results for other systems: a gradebook that Moodle reads, scores for a learning platform over LTI
// Advantage, signed results for the file, and one row for each criterion for research. Names leave
// the school's identities only for results that were released.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "grading/records/exported_grade.h"
#include "grading/records/filing.h"
#include "grading/records/identities.h"

namespace cavum::records {

/// Moodle's grade import (CSV, first row names): "ID number", for each exam the grade that counts,
/// verdict, points, one column for each criterion, and feedback, as exported_grade has them: all of
/// an exam on one scale, and 0 where the exam was failed whatever the points are. A result on
/// another scale has no points of criteria. One row for each candidate with a released result; of
/// several attempts at one exam the last released one counts. `left_out` receives how many results
/// had no known candidate. What a simulated operator sat is left out, whoever's ticket it used;
/// `with_simulated` writes it in rows of its own, under no student's number, verdict and feedback
/// beginning with SIMULATED.
[[nodiscard]] std::string moodle_csv(const Registry& registry, Identities& identities,
                                     int& left_out, Wording say, bool with_simulated = false);

/// Scores as the LTI Advantage Assignment and Grade Services 2.0 take them, one object for each
/// candidate and exam: userId, timestamp, activityProgress, gradingProgress, and scoreGiven,
/// scoreMaximum, comment once released, with the time of the release. The last released attempt
/// stands until a newer one is released. Before that gradingProgress is `Pending`, and
/// `PendingManual` while the verdict is `review`. Of simulated operators as in moodle_csv: userId
/// is then `simulated:` and the pseudonym, which no platform knows.
[[nodiscard]] nlohmann::json lti_scores(const Registry& registry, Identities& identities,
                                        Wording say, bool with_simulated = false);

/// How many released results were sat by simulated operators.
[[nodiscard]] std::size_t released_simulated(const Registry& registry);

/// {"results":[{session, candidate, file_sha256, released, result, shown, simulated, findings,
/// contested_by, chosen, makes_up, made_up_by}], "ledger", "checkpoint", "public_key",
/// "signature"}: keys in order, no spaces, signed by the school over "CVRESULT" and the text of the
/// object without "signature". Pseudonyms only.
[[nodiscard]] std::string signed_results(const Registry& registry, const Ledger& ledger);
/// Why `text` is not what signed_results wrote; empty when it is. As check_receipt(): `public_key`
/// (hexadecimal) is the school's, empty = the file's own; with a ledger's content also whether that
/// still begins with what the export saw. The text has to be the one that was written, to the
/// character: another program might read an object with a key twice, or a number with more digits,
/// in another way.
[[nodiscard]] Findings check_results(const std::string& text, const std::string& public_key,
                                     const LedgerContent* ledger);

/// CSV, one row for each session and criterion: session, candidate, scenario, station, simulated,
/// regraded, findings, contested (their numbers), chosen, makes_up, made_up_by (entries of tickets,
/// or empty), verdict, released, criterion, metric, value, unit, points, max. Pseudonyms only.
[[nodiscard]] std::string tidy_csv(const Registry& registry);

}  // namespace cavum::records
