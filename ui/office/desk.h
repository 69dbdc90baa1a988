// What people and stations do at the office, each as one call: it reads the ledger or adds to it, with who and why in the entry. One at a time; what
// takes long (a tooth that is made, an exam that is verified) happens elsewhere.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grading/ledger/class_regrade.h"
#include "grading/ledger/ledger.h"
#include "grading/ledger/passback.h"
#include "ui/office/accounts.h"
#include "ui/office/board.h"
#include "ui/office/inbox.h"
#include "ui/office/papers.h"

namespace cavum::office {

/// Files that the office keeps beside the ledger, in the school's own folder: office/ID.
struct OfficePlaces {
  std::string folder;
  /// A ticket's file with its accommodations, for the stations: there while the ticket is live.
  [[nodiscard]] std::string ticket(const std::string& nonce) const { return folder + "/tickets/" + nonce + ".ticket"; }
  [[nodiscard]] std::string inbox() const { return folder + "/inbox"; }
};

/// A recording that is filed, as of so many entries of the ledger.
struct Recording {
  std::string path;
  std::size_t entries = 0;
};

class Desk {
 public:
  /// `exams`: scenario files that tickets may be issued for.
  Desk(const std::string& ledger_folder, const SigningKey& school, OfficePlaces places, std::vector<std::string> exams);

  [[nodiscard]] const std::string& ledger_id() const noexcept { return id_; }
  [[nodiscard]] const std::string& school() const noexcept { return school_; }
  [[nodiscard]] const std::string& public_key() const noexcept { return public_key_; }

  // Each takes and gives JSON (docs/office.md), and throws Error in the words of what is wrong.
  [[nodiscard]] nlohmann::json exams() const;
  [[nodiscard]] nlohmann::json preview(const nlohmann::json& asked);
  /// Of "most" from the place "first" of the list on; without them of all. A portion at a time, so that stations are heard in between.
  [[nodiscard]] nlohmann::json issue(const nlohmann::json& asked, const Account& by);
  /// `grants`: with what each candidate is granted, as long as the ticket's file is kept; it may tell of health.
  /// `seen`: candidates whom a station has said it has.
  [[nodiscard]] nlohmann::json tickets(bool grants, const std::set<std::string>& seen);
  /// A makeup sitting of a ticket: when, what became of the first and why, and what the candidate is granted.
  [[nodiscard]] nlohmann::json make_up(const nlohmann::json& asked, const Account& by);
  /// Of who has begun (`seen`, too) only with "begun": true.
  [[nodiscard]] nlohmann::json cancel(const nlohmann::json& asked, const Account& by, const std::set<std::string>& seen);
  [[nodiscard]] nlohmann::json board(const Board& board, const Inbox& inbox);
  [[nodiscard]] nlohmann::json invite(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json revoke(const nlohmann::json& asked, const Account& by);
  // The day: what candidates are told, pauses, incidents, who is not here, rooms and seats (desk_day.cpp).
  [[nodiscard]] nlohmann::json announce(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json hold(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json go_on(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json note_incident(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json incidents();
  /// Who has a ticket whose time has come, and no station has seen.
  [[nodiscard]] nlohmann::json attendance(const Board& board);
  [[nodiscard]] nlohmann::json place(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json seat(const nlohmann::json& asked, const Account& by);
  /// Candidate cards, or the sign-in sheet: PDF of all tickets that are good.
  [[nodiscard]] std::string cards();
  [[nodiscard]] std::string sign_in_sheet();
  [[nodiscard]] nlohmann::json queue();
  [[nodiscard]] nlohmann::json decide(const nlohmann::json& asked, const Account& by);
  /// With names where `names`.
  [[nodiscard]] nlohmann::json results(bool names);
  [[nodiscard]] nlohmann::json release(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json retract(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json appeals();
  /// The ledger's entries in words, the newest first, up to 200: {"about","before"} asks for those of a pseudonym (or number, with `names`) and
  /// before an entry. `earlier` of the answer is the next `before`, null at the beginning. Names, and what was said of incidents, where `names`.
  [[nodiscard]] nlohmann::json trail(const nlohmann::json& asked, bool names);
  [[nodiscard]] nlohmann::json open_appeal(const nlohmann::json& asked, const Account& by);
  [[nodiscard]] nlohmann::json answer_appeal(const nlohmann::json& asked, const Account& by);
  /// Who would be marked anew by `basis`; `entries`: of the ledger then.
  [[nodiscard]] ledger::ClassRegrade plan_regrade(const std::string& exam, ledger::RegradeBasis basis, std::uint64_t& entries);
  /// All of it counts from now on. Returns how many were entered, from entry `first` on.
  std::size_t count_regrade(const ledger::ClassRegrade& plan, const std::string& reason, const Account& by, std::uint64_t& first);
  /// How many results of an exam this person has entered by this rubric since the ledger had so many entries; `first`: the first of them.
  [[nodiscard]] std::uint64_t counted_regrades(const std::string& exam, const std::string& rubric_sha256, const std::string& by,
                                               std::uint64_t entries, std::uint64_t& first);
  /// {"id","sessions"} of each exam that has something filed.
  [[nodiscard]] nlohmann::json filed_exams();
  /// A filed recording. Throws Error when there is none, or it was erased.
  [[nodiscard]] Recording recording(const std::string& file_sha256);
  /// What is released, for Moodle; in a `rehearsal` also what no hand moved, marked, under no number of a candidate.
  [[nodiscard]] std::string gradebook(bool rehearsal);
  [[nodiscard]] std::string criteria();

  // For learning platforms (desk_lti.cpp).
  /// How many entries the ledger has now.
  [[nodiscard]] std::size_t entries();
  /// The school's own numbers of all whom the ledger knows.
  [[nodiscard]] std::set<std::string> numbers();
  [[nodiscard]] std::vector<ledger::ScoreDue> scores_due(const std::string& exam, const std::string& line_item, bool again);
  void enter_passback(const ledger::ScoreDue& sent, const std::string& platform, const std::string& line_item, int status, const std::string& answer);
  /// Sessions whose last score in this column was accepted, and refused.
  [[nodiscard]] std::pair<int, int> passbacks(const std::string& line_item);
  /// Released results of the candidate of that number, of one exam or all: {exam, verdict, points, max, released, sha256}.
  [[nodiscard]] nlohmann::json own_results(const std::string& number, const std::string& exam);
  /// A recording of his whose result is released. Throws Error when there is none.
  [[nodiscard]] Recording own_recording(const std::string& number, const std::string& file_sha256);

  /// Why requests of this key are not taken, in words; empty: it is an enrolled station's.
  [[nodiscard]] std::string station_problem(const std::string& public_key);
  [[nodiscard]] nlohmann::json enrol(const std::string& request);
  [[nodiscard]] nlohmann::json station_tickets();
  [[nodiscard]] nlohmann::json begin(const nlohmann::json& asked, const std::string& station);
  /// What the office has to say to a station that has read announcements up to entry `heard`.
  /// `since_utc_ns`: when its candidate signed in there, 0: nobody did.
  [[nodiscard]] nlohmann::json word_for(const std::string& station, std::uint64_t heard, std::int64_t since_utc_ns);
  /// Whose ticket it is; empty: nobody's.
  [[nodiscard]] std::string candidate_of(const std::string& ticket_nonce);
  /// Entry of a recording; none when it is not filed.
  [[nodiscard]] std::optional<std::uint64_t> filed(const std::string& file_sha256);
  [[nodiscard]] nlohmann::json receipt(std::uint64_t entry);

 private:
  /// The ledger as it is now, for one call, in the name of an actor.
  class Turn;
  /// Accommodations on a ticket's file, as notes of a session; none where the file is not kept any more.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> grant_on(const std::string& nonce) const;
  /// The same for people; empty: none, or the file is not kept any more.
  [[nodiscard]] std::string granted_on(const std::string& nonce) const;
  /// Whether first_grant finds something.
  [[nodiscard]] bool keeps_grant(const ledger::Registry& registry, const ledger::IssuedTicket& ticket) const;
  /// What a ticket's entry grants, by its file or by the recording that was sat with it. Throws Error when neither is kept.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> first_grant(ledger::Ledger& book, std::uint64_t ticket) const;
  /// Removes the files of tickets that can no longer be used: their accommodations tell of health. Of one that ran out it is kept for 60 days, for a
  /// makeup, as long as the candidate is not forgotten.
  void remove_dead_tickets(ledger::Ledger& book, std::int64_t now_utc_ns) const;

  [[nodiscard]] std::vector<Invited> invited_now();

  std::mutex lock_, printing_;
  ledger::Ledger ledger_;
  OfficePlaces places_;
  std::vector<std::string> exams_;
  std::string id_, school_, public_key_;
};

}  // namespace cavum::office
