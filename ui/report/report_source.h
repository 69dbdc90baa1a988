// Everything that a report is made of: the result and what it was measured on, what is proved of
// the session, and what the school's ledger knows. The page's data and the document are both made
// from it, so that they tell the same.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grading/cohort/progress.h"
#include "grading/feedback/lessons.h"
#include "grading/feedback/why.h"
#include "grading/marking/grade.h"
#include "grading/marking/session_input.h"
#include "grading/result/compare.h"
#include "grading/result/result.h"
#include "grading/scan/grade_scan.h"

namespace cavum::report {

/// Whom a report is for: a student sees the verdict and where each point went, an instructor every
/// figure besides.
enum class ReportReader { student, instructor };

/// What is known of a session file's truth.
struct ReportIntegrity {
  enum class Replay { not_done, agrees, differs };
  std::string file;  ///< without its folder
  std::string file_sha256, chain_sha256, final_tooth_sha256, result_sha256, station_key, closed_utc;
  Replay replay = Replay::not_done;
  bool at_filing = false;  ///< `replay` was done when the ledger took the session in
  std::vector<Message> proved, findings, remarks;  ///< as explain_session says them
};

/// One attempt of a candidate at an exam, as the ledger holds it.
struct ReportAttempt {
  std::uint64_t entry = 0;
  std::string date;  ///< when it was filed, UTC
  std::optional<grading::Verdict> verdict;
  double points = 0, max = 0;
  bool released = false, this_one = false, regraded = false, simulated = false;
  Message doubt;  ///< why it does not stand as sound; empty when it does
};

/// The entry that a result came from, where that is no exam's own.
struct ReportRegrade {
  std::uint64_t entry = 0;
  std::string date, reason;
  std::string person;          ///< who decided; empty: it was marked anew
  grading::Verdict verdict{};  ///< of that person
  std::string by_program;      ///< the verdict of the program, before anybody decided
};

/// What the ledger says of a session.
struct ReportFiling {
  std::uint64_t entry = 0, entries = 0;  ///< its number, and how many the root below is of
  std::string ledger, school, public_key, root, date;
  bool released = false;
  std::vector<Message> findings;         ///< what it was filed with, and that it is contested
  std::optional<ReportRegrade> regrade;  ///< that gave the result of this report
  Message not_filed;  ///< the result of this report is not the one that the ledger holds: how it
                      ///< differs
  std::optional<std::string> name;      ///< of the candidate: only when asked for, and released
  std::vector<ReportAttempt> attempts;  ///< of this candidate at this exam, the oldest first
  std::optional<cohort::AttemptScatter> scatter =
      {};  ///< of the class at this exam; none where too few sat it twice
  std::optional<cohort::Progress> progress = {};  ///< up to this attempt
};

/// A scan of a prepared tooth, where that was marked and no recording.
struct ReportScan {
  std::string file, file_sha256;  ///< its name without folder
  grading::ScanFacts facts;
};

/// Something that happened, in words.
enum class EventGroup { perforation, aim, violation, step, pause, limit, finish, device, gap };
/// "perforation" and so on: as the page's data have it, and in words.
[[nodiscard]] const char* name_of(EventGroup group) noexcept;
[[nodiscard]] Message word_of(EventGroup group);

struct ReportEvent {
  double t_s = 0;
  EventGroup kind = EventGroup::device;
  Message text;
  std::optional<Vec3> site_mm;
};

struct ReportSource;

/// Another who sat the same exam, shown beside this one.
struct ComparedReport {
  const ReportSource& source;
  std::string name;  ///< "Candidate A18", "The built-in expert", in the reader's language
};

struct ReportSource {
  const grading::Result& result;
  const grading::GradeInput& input;
  const grading::ReportFacts& facts;
  const grading::Comparison* regrade =
      nullptr;  ///< what the session was sealed with, where this result is another one
  ReportReader reader = ReportReader::instructor;
  ReportIntegrity integrity = {};
  std::optional<ReportFiling> filing = {};
  std::optional<ReportScan> scan = {};  ///< then there is no motion, and nothing of `integrity`
  scenarios::RubricSpec rubric = {};    ///< that the result was marked by
  std::vector<grading::Why> lost = {};  ///< of each criterion that lost points
  std::vector<grading::Lesson> lessons = {};
  std::vector<ReportEvent> events = {};  ///< in order of time
  std::optional<ComparedReport> beside = {};
};

/// With what follows from the result: `lost`, `lessons` and `events`. The references must outlive
/// it.
[[nodiscard]] ReportSource report_source(const grading::Result& result,
                                         const grading::GradeInput& input,
                                         const grading::ReportFacts& facts,
                                         const scenarios::RubricSpec& rubric);

/// The events of the exam and the breakthroughs seen in the force, in words and in order of time.
[[nodiscard]] std::vector<ReportEvent> report_events(const grading::Result& result,
                                                     const grading::GradeInput& input,
                                                     const std::vector<std::string>& burs_toml);

/// Title of a report: the exam's.
[[nodiscard]] std::string report_title(const ReportSource& source);

}  // namespace cavum::report
