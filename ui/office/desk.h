// What people and stations do at the office, each as one call: it reads the ledger or adds to it,
// with who and why in the entry. One at a time; what takes long (a tooth that is made, an exam that
// is verified) happens elsewhere.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grading/records/class_regrade.h"
#include "grading/records/ledger.h"
#include "grading/records/passback.h"
#include "grading/result/result.h"
#include "ui/office/accounts.h"
#include "ui/office/board.h"
#include "ui/office/inbox.h"
#include "ui/office/papers.h"
#include "ui/office/wire.h"

namespace cavum::office {

/// Files that the office keeps beside the ledger, in the school's own folder: office/ID.
struct OfficePaths {
  std::string folder;
  /// A ticket's file with its accommodations, for the stations: there while the ticket is live.
  [[nodiscard]] std::string ticket(const std::string& nonce) const {
    return folder + "/tickets/" + nonce + ".ticket";
  }
  [[nodiscard]] std::string inbox() const { return folder + "/inbox"; }
};

/// A recording that is filed, as of so many entries of the ledger.
struct Recording {
  std::string path;
  std::size_t entries = 0;
};

/// What a candidate sees of a result of his, as it was released.
struct OwnResult {
  std::string exam;
  grading::Verdict verdict{};
  double points = 0, max = 0;
  std::string released;  ///< when, in this computer's time zone
  bool counts = false, simulated = false;
  std::string sha256;  ///< empty: erased
};

class Desk {
 public:
  /// `exams`: scenario files that tickets may be issued for.
  Desk(const std::string& ledger_folder, const SigningKey& school, OfficePaths places,
       std::vector<std::string> exams);

  [[nodiscard]] const std::string& ledger_id() const noexcept { return id_; }
  [[nodiscard]] const std::string& school() const noexcept { return school_; }
  [[nodiscard]] const std::string& public_key() const noexcept { return public_key_; }

  // Each throws Error in the words of what is wrong.
  [[nodiscard]] Exams exams() const;
  [[nodiscard]] Preview preview(const ClassList& asked);
  [[nodiscard]] Issued issue(const Issue& asked, const Account& by);
  /// `grants`: with what each candidate is granted, which may tell of health. `seen`: candidates
  /// whom a station has said it has.
  [[nodiscard]] Tickets tickets(bool grants, const std::set<std::string>& seen);
  [[nodiscard]] MadeUp make_up(const MakeUp& asked, const Account& by);
  /// Of who has begun (`seen`, too) only with `begun`.
  [[nodiscard]] Entered cancel(const CancelTicket& asked, const Account& by,
                               const std::set<std::string>& seen);
  [[nodiscard]] BoardShown board(const Board& board, const Inbox& inbox);
  [[nodiscard]] InviteCode invite(const Invite& asked, const Account& by);
  [[nodiscard]] Entered revoke(const RevokeStation& asked, const Account& by);
  // The day: what candidates are told, pauses, incidents, who is not here, rooms and seats
  // (desk_day.cpp).
  [[nodiscard]] Entered announce(const Announce& asked, const Account& by);
  [[nodiscard]] Entered hold(const Hold& asked, const Account& by);
  [[nodiscard]] Entered go_on(const GoOn& asked, const Account& by);
  [[nodiscard]] Entered note_incident(const NoteIncident& asked, const Account& by);
  [[nodiscard]] Incidents incidents();
  /// Who has a ticket whose time has come, and no station has seen.
  [[nodiscard]] Attendance attendance(const Board& board);
  [[nodiscard]] Entered place(const PlaceStation& asked, const Account& by);
  [[nodiscard]] Seated seat(const SeatThem& asked, const Account& by);
  /// Candidate cards, or the sign-in sheet: PDF of all tickets that are good.
  [[nodiscard]] std::string cards();
  [[nodiscard]] std::string sign_in_sheet();
  [[nodiscard]] Queue queue();
  [[nodiscard]] Entered decide(const Decide& asked, const Account& by);
  /// With names where `names`.
  [[nodiscard]] Results results(bool names);
  [[nodiscard]] Released release(const ReleaseResults& asked, const Account& by);
  [[nodiscard]] Entered retract(const Retract& asked, const Account& by);
  [[nodiscard]] Appeals appeals();
  /// The ledger's entries in words, the newest first, up to 200. Names, and what was said of
  /// incidents, where `names`.
  [[nodiscard]] TrailPage trail(const AskTrail& asked, bool names);
  [[nodiscard]] Entered open_appeal(const OpenAppeal& asked, const Account& by);
  [[nodiscard]] Entered answer_appeal(const AnswerAppeal& asked, const Account& by);
  /// Who would be marked anew by `basis`; `entries`: of the ledger then.
  [[nodiscard]] records::ClassRegrade plan_regrade(const std::string& exam,
                                                   records::RegradeBasis basis,
                                                   std::uint64_t& entries);
  /// All of it counts from now on. Returns how many were entered, from entry `first` on.
  std::size_t count_regrade(const records::ClassRegrade& plan, const std::string& reason,
                            const Account& by, std::uint64_t& first);
  /// How many results of an exam this person has entered by this rubric since the ledger had so
  /// many entries; `first`: the first of them.
  [[nodiscard]] std::uint64_t counted_regrades(const std::string& exam,
                                               const std::string& rubric_sha256,
                                               const std::string& by, std::uint64_t entries,
                                               std::uint64_t& first);
  /// Each exam that has something filed.
  [[nodiscard]] std::vector<FiledExam> filed_exams();
  /// A filed recording. Throws Error when there is none, or it was erased.
  [[nodiscard]] Recording recording(const std::string& file_sha256);
  /// What is released, for Moodle; in a `rehearsal` also what no hand moved, marked, under no
  /// number of a candidate.
  [[nodiscard]] std::string gradebook(bool rehearsal);
  [[nodiscard]] std::string criteria();

  // For learning platforms (desk_lti.cpp).
  /// How many entries the ledger has now.
  [[nodiscard]] std::size_t entries();
  /// The school's own numbers of all whom the ledger knows.
  [[nodiscard]] std::set<std::string> numbers();
  [[nodiscard]] std::vector<records::ScoreDue> scores_due(const std::string& exam,
                                                          const std::string& line_item, bool again);
  void enter_passback(const records::ScoreDue& sent, const std::string& platform,
                      const std::string& line_item, int status, const std::string& answer);
  /// Sessions whose last score in this column was accepted, and refused.
  [[nodiscard]] std::pair<int, int> passbacks(const std::string& line_item);
  /// Released results of the candidate of that number, of one exam or all.
  [[nodiscard]] std::vector<OwnResult> own_results(const std::string& number,
                                                   const std::string& exam);
  /// A recording of his whose result is released. Throws Error when there is none.
  [[nodiscard]] Recording own_recording(const std::string& number, const std::string& file_sha256);

  /// Why requests of this key are not taken, in words; empty: it is an enrolled station's.
  [[nodiscard]] Message station_problem(const std::string& public_key);
  [[nodiscard]] Enrolled enrol(const std::string& request);
  [[nodiscard]] StationTickets station_tickets();
  [[nodiscard]] WordToBegin begin(const AskBegin& asked, const std::string& station);
  /// What the office has to say to a station that has read announcements up to entry `heard`.
  /// `since_utc_ns`: when its candidate signed in there, 0: nobody did.
  [[nodiscard]] OfficeWord word_for(const std::string& station, std::uint64_t heard,
                                    std::int64_t since_utc_ns);
  /// Whose ticket it is; empty: nobody's.
  [[nodiscard]] std::string candidate_of(const std::string& ticket_nonce);
  /// Entry of a recording; none when it is not filed.
  [[nodiscard]] std::optional<std::uint64_t> filed(const std::string& file_sha256);
  [[nodiscard]] nlohmann::json receipt(std::uint64_t entry);

 private:
  /// The ledger as it is now, for one call, in the name of an actor.
  class Turn;
  /// Accommodations on a ticket's file, as notes of a session; none where the file is not kept any
  /// more.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> grant_on(
      const std::string& nonce) const;
  /// The same for people; empty: none, or the file is not kept any more.
  [[nodiscard]] std::string granted_on(const std::string& nonce) const;
  /// Whether first_grant finds something.
  [[nodiscard]] bool keeps_grant(const records::Registry& registry,
                                 const records::IssuedTicket& ticket) const;
  /// What a ticket's entry grants, by its file or by the recording that was sat with it. Throws
  /// Error when neither is kept.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> first_grant(
      records::Ledger& book, std::uint64_t ticket) const;
  /// Removes the files of tickets that can no longer be used: their accommodations tell of health.
  /// Of one that ran out it is kept for 60 days, for a makeup, as long as the candidate is not
  /// forgotten.
  void remove_dead_tickets(records::Ledger& book, std::int64_t now_utc_ns) const;

  [[nodiscard]] std::vector<Invited> invited_now();

  std::mutex lock_, printing_;
  records::Ledger ledger_;
  OfficePaths places_;
  std::vector<std::string> exams_;
  std::string id_, school_, public_key_;
};

}  // namespace cavum::office
