#include "tests/simulation/school_day.h"

#include <sqlite3.h>

#include <algorithm>

#include "engine/base/file.h"
#include "grading/records/backup.h"
#include "grading/records/begin.h"
#include "grading/records/check_ledger.h"
#include "grading/records/claims.h"
#include "grading/records/erasure.h"
#include "grading/records/filing.h"
#include "grading/records/identities.h"
#include "grading/records/issue.h"
#include "grading/records/ledger_error.h"
#include "grading/records/registry.h"
#include "grading/records/release.h"
#include "grading/records/stations.h"
#include "tests/engine/support/basics.h"

namespace cavum::simulation {
namespace {

using nlohmann::json;
using testing_basics::tells;
using testing_basics::text_of;

constexpr std::int64_t k_s_ns = 1'000'000'000, k_hour_ns = 3600 * k_s_ns;
constexpr std::int64_t k_patience_ns = 300 * k_s_ns, k_margin_ns = 60 * k_s_ns;
const std::string k_ledger = "/sim/office/ledger", k_backup = "/sim/office/backup";

records::Ledger open_ledger(records::LedgerUse use = records::LedgerUse::add) {
  return records::Ledger(k_ledger, records::load_school_key(records::school_key_path()), use);
}

/// The tooth and its zones, made once: days differ in other things.
grading::ExamContexts& grounds() {
  static grading::ExamContexts shared;
  return shared;
}

/// Whether one of `findings` names the clock of a station: by the exam's beginning or end, as the
/// station says, or by the tick from which it was uneven.
bool names_clock(const records::Findings& findings, const SatExam& exam) {
  using Kind = records::FindingKind;
  return std::any_of(findings.begin(), findings.end(), [&](const records::Finding& f) {
    if (exam.clock == WrongClock::uneven) return f.group() == Kind::clock;
    return (f.group() == Kind::clock || f.group() == Kind::handed_in_late ||
            f.group() == Kind::ticket_time) &&
           tells(f.message(), utc_text(exam.clock == WrongClock::behind ? exam.begun_utc_ns
                                                                        : exam.closed_utc_ns));
  });
}

}  // namespace

const char* name_of(Task task) {
  static constexpr const char* k_names[k_tasks] = {
      "issue",   "station", "file",       "release", "forget",
      "receipt", "backup",  "checkpoint", "cosign",  "keep_cosignature",
      "verify",  "cancel",  "begin",      "erase"};
  return k_names[static_cast<int>(task)];
}

SchoolDay::SchoolDay(const Morning& morning, std::uint64_t seed)
    : morning_(morning), world_(seed, morning.disks, morning.true_ns) {
  sqlite3_randomness(0, nullptr);  // its random numbers begin anew, out of this world's: days do
                                   // not depend on those before
}

void SchoolDay::wrong(const std::string& what) { wrong_.push_back(what); }

void SchoolDay::draw() {
  Random& random = world_.random();
  constexpr unsigned k_switch[] = {2, 20, 50, 90};
  world_.switch_percent(k_switch[random.below(4)]);
  const auto people = 1 + random.below(4);
  for (std::uint64_t i = 0; i < people; ++i) {
    std::vector<Task> tasks;
    for (auto n = 1 + random.below(4); n > 0; --n) {
      // filing costs more than the others together
      const auto t = random.below(k_tasks + 3);
      const Task task = t < k_tasks       ? static_cast<Task>(t)
                        : t < k_tasks + 2 ? Task::issue
                                          : Task::backup;
      tasks.push_back(
          task == Task::cosign || (task == Task::file && random.below(3) > 0) ? Task::issue : task);
    }
    give("office " + std::to_string(i + 1), tasks);
    people_["office " + std::to_string(i + 1)].pause_ns =
        random.below(3) == 0 ? random.below(20 * k_s_ns) : random.below(20'000'000);
  }
  if (random.below(2) == 0) {
    give("office 9", {Task::checkpoint, Task::keep_cosignature, Task::issue, Task::checkpoint,
                      Task::keep_cosignature});
    give("cosigner", {Task::cosign, Task::cosign, Task::cosign});
    people_["cosigner"].computer = "cosigner";
  }
  const std::uint64_t about = 400 * (people + 1);
  for (auto n = random.below(4); n > 0; --n) {
    Event e;
    e.at_call = 1 + random.below(about);
    e.computer = random.below(5) == 0 ? "cosigner" : "office";
    switch (random.below(8)) {
      case 0:
      case 1:
        e.kind = Event::Kind::kill;
        break;
      case 2:
      case 3:
        e.kind = Event::Kind::power_cut;
        break;
      case 4:
        e.kind = Event::Kind::disk_full;
        e.ns = static_cast<std::int64_t>(random.below(60'000'000));
        break;
      case 5:
        e.kind = Event::Kind::sync_fails;
        break;
      case 6: {
        constexpr std::int64_t k_steps[] = {-240 * k_hour_ns, -2 * k_hour_ns, -30 * k_s_ns,
                                            2 * k_hour_ns, 240 * k_hour_ns};
        e.kind = Event::Kind::set_clock;
        e.ns = k_steps[random.below(5)];
        break;
      }
      default:
        e.kind = Event::Kind::drift;
        e.ns = static_cast<std::int64_t>(random.below(200'000'000)) - 100'000'000;
    }
    world_.plan(e);
  }
  if (random.below(4) == 0)
    replace_key_at_the_end(random.below(3) == 0 ? 0 : 1 + random.below(200));
  if (random.below(4) == 0)
    lose_ledger_at_the_end(random.below(2) == 0 ? 0 : 1 + random.below(250));
}

void SchoolDay::give(const std::string& person, const std::vector<Task>& tasks) {
  people_[person] = {"office", tasks, 0, 0};
}

void SchoolDay::start(const std::string& name) {
  world_.start(people_.at(name).computer, name, [this, name] { work(name); });
}

void SchoolDay::work(const std::string& name) {
  Person& person = people_.at(name);
  while (person.next < person.tasks.size()) {
    const Task task = person.tasks[person.next++];
    if (person.pause_ns > 0)
      world_.sleep(static_cast<std::int64_t>(world_.random().below(person.pause_ns)));
    try {
      ++counts_[std::string("begun ") + name_of(task)];
      perform(task);
      ++counts_[std::string("done ") + name_of(task)];
    } catch (const Error& e) {
      const std::string what = std::string(name_of(task)) + ": " + e.what();
      ++counts_[std::string("refused ") + name_of(task)];
      if (!world_.process().computer->had_faults) wrong("no disk failed, and yet: " + what);
      if (e.advice().empty()) wrong("does not say what to do: " + what);
    } catch (const std::exception& e) {
      wrong(std::string(name_of(task)) + " ended with an exception that is no Error: " + e.what());
    }
  }
}

void SchoolDay::perform(Task task) {
  switch (task) {
    case Task::issue:
      return issue_ticket();
    case Task::station:
      return enrol_station();
    case Task::file:
      return file_exam();
    case Task::release:
      return release_all();
    case Task::forget:
      return forget_somebody();
    case Task::receipt:
      return write_receipt();
    case Task::backup:
      return take_backup();
    case Task::checkpoint:
      return ask_cosigner();
    case Task::cosign:
      return cosign_here();
    case Task::keep_cosignature:
      return keep_cosignature();
    case Task::verify:
      return verify();
    case Task::cancel:
      return cancel_some_ticket();
    case Task::begin:
      return let_some_exam_begin();
    case Task::erase:
      return erase_some_session();
  }
}

/// Called before anything else can happen: between a function's return and this there is no call to
/// the system.
void SchoolDay::entered(const records::Ledger& ledger, std::uint64_t seq) {
  entries_.push_back(
      {seq, ledger.content().entries.at(seq).text, world_.utc_ns(), ledger.receipt(seq)});
}

void SchoolDay::issue_ticket() {
  records::Ledger ledger = open_ledger();
  records::Identities identities(ledger.places().identities());
  const std::string id =
      "student-" +
      std::to_string(world_.random().below(6));  // two people may well enrol one student
  const std::string pseudonym = identities.enrol(id, "Name", morning_.promise.exam, ledger.key());
  known_[id] = pseudonym;
  try {
    static_cast<void>(records::issue(ledger, morning_.promise, pseudonym));
  } catch (const records::AnotherTicket&) {
    ++counts_["second live ticket refused"];
    return;
  }
  entered(ledger, ledger.content().entries.size() - 1);
}

void SchoolDay::enrol_station() {
  records::Ledger ledger = open_ledger();
  const int changes = world_.process().computer->clock_changes;
  const std::string code =
      records::invite_station(ledger, "Seat", read_clocks().utc_ns + 24 * k_hour_ns);
  entered(ledger, ledger.content().entries.size() - 1);
  // the station's own computer is not here: its key is
  const SigningKey key =
      load_signing_key("/sim/office/tmp/station-" + records::random_hex(8), "station");
  const std::string request = records::station_request(key, ledger.content().public_key, {}, code);
  try {
    const records::LedgerEntry& e = records::enrol_station(ledger, request, 0, "request");
    entered(ledger, e.seq);
  } catch (const Error& e) {
    if (changes == world_.process().computer->clock_changes ||
        !(e.code() == records::LedgerError::ended))
      throw;
  }
}

void SchoolDay::file_exam() {
  const std::size_t number = world_.random().below(morning_.exams.size());
  const SatExam& exam = morning_.exams[number];
  const bool begun_before = filed_exams_[number];
  filed_exams_[number] = true;
  Computer& office = *world_.process().computer;
  const int changes = office.clock_changes;
  const std::int64_t before_utc_ns = world_.utc_ns();
  records::Ledger ledger = open_ledger();
  const records::Filing filing = records::file_session(ledger, exam.path, {}, grounds());
  if (filing.seq) {
    entered(ledger, *filing.seq);
    const auto* filed = ledger.content().entries.at(*filing.seq).as<records::SessionEntry>();
    filed_files_[filed->file_sha256] = filed->candidate;
    ++counts_["filed clean"];
  }
  const std::string what =
      exam.path + " filed " + (filing.seq ? "clean" : "not: " + text_of(filing.findings));
  if (changes != office.clock_changes) return;
  const std::int64_t late_ns = world_.utc_ns() - exam.closed_utc_ns,
                     least_late_ns = before_utc_ns - exam.closed_utc_ns;
  if (exam.clock != WrongClock::none) {
    // a station two hours ahead and an office that is ahead as well agree with one another
    const bool agree = exam.clock == WrongClock::ahead && late_ns > -k_patience_ns - k_margin_ns;
    if (filing.seq && !agree) wrong("a station's wrong clock was not named: " + what);
    if (!filing.seq && !agree && !names_clock(filing.findings, exam))
      wrong("a station's wrong clock was not named: " + what);
    return;
  }
  const bool too_early =
      late_ns<-k_patience_ns - k_margin_ns, too_late = least_late_ns> 120 * k_hour_ns;
  if (too_early && (filing.seq || !names_clock(filing.findings, exam)))
    wrong("the office's clock, behind, was not named: " + what);
  if (too_late && (filing.seq || !names_clock(filing.findings, exam)))
    wrong("the office's clock, ahead, was not named: " + what);
  const bool fits = late_ns > -k_patience_ns + k_margin_ns && late_ns < 24 * k_hour_ns;
  // cancelled: that of a candidate whom somebody forgot meanwhile
  const std::string nonce = records::ticket_nonce_in(SessionReader(exam.path).setup());
  const auto tickets = records::read_registry(ledger.content()).tickets;
  const auto ticket =
      std::find_if(tickets.begin(), tickets.end(),
                   [&](const records::IssuedTicket& t) { return t.ticket.nonce == nonce; });
  const bool gone = ticket != tickets.end() && (ticket->cancelled_by || ticket->used_by);
  if (fits && !filing.seq && !begun_before && !gone) wrong("a sound exam was refused: " + what);
  if (too_early || too_late) ++counts_["office's clock named at filing"];
}

void SchoolDay::release_all() {
  records::Ledger ledger = open_ledger();
  const records::Release released = records::release_results(ledger, {.all = true});
  if (!released.results.empty()) entered(ledger, ledger.content().entries.size() - 1);
}

void SchoolDay::forget_somebody() {
  if (known_.empty()) return;
  auto who = known_.begin();
  std::advance(who, static_cast<long>(world_.random().below(known_.size())));
  const auto [id, pseudonym] = *who;
  records::Ledger ledger = open_ledger();
  records::Identities identities(ledger.places().identities());
  const auto known = identities.of_pseudonym(pseudonym);
  if (!known) {
    if (!to_forget_.contains(pseudonym))
      wrong("an enrolled candidate is unknown: " + id + " " + pseudonym);
    return;
  }
  to_forget_.insert(pseudonym);
  for (const auto& [hash, of] : filed_files_)
    if (of == pseudonym) to_erase_.insert(hash);
  records::forget(ledger, {pseudonym}, {.motion = true, .results = true});
  entered(ledger, ledger.content().entries.size() - 1);
  identities.forget(pseudonym);
  forgotten_.insert(pseudonym);
}

void SchoolDay::cancel_some_ticket() {
  records::Ledger ledger = open_ledger();
  const records::Registry registry = records::read_registry(ledger.content());
  const auto live = [](const records::IssuedTicket& t) {
    return !t.used_by && !t.cancelled_by && !t.ticket.candidate.empty();
  };
  // those of the morning are sat meanwhile: an exam that was filed clean may not be taken back
  const auto t = std::find_if(registry.tickets.rbegin(), registry.tickets.rend(), live);
  if (t == registry.tickets.rend() ||
      static_cast<std::size_t>(registry.tickets.rend() - t) <= morning_.exams.size())
    return;
  try {
    entered(ledger, records::cancel_ticket(ledger, t->seq, "drawn").seq);
  } catch (const Error& e) {  // somebody was quicker
    if (!(e.code() == records::LedgerError::ended)) throw;
  }
}

void SchoolDay::let_some_exam_begin() {
  records::Ledger ledger = open_ledger();
  const records::Registry registry = records::read_registry(ledger.content());
  if (registry.tickets.size() <= morning_.exams.size()) return;
  const records::IssuedTicket& t = registry.tickets.back();
  try {
    const std::string word = records::let_begin(ledger, t.ticket.nonce, "drawn");
    entered(ledger, ledger.content().entries.size() - 1);
    static_cast<void>(records::parse_begin(word, ledger.content().public_key, "word"));
  } catch (const Error& e) {
    const bool clock = e.code() == records::LedgerError::not_now,
               cancelled = e.code() == records::LedgerError::ended;
    if (!clock && !cancelled) throw;
    ++counts_[clock ? "no word outside the ticket's time" : "no word for a cancelled ticket"];
  }
}

void SchoolDay::erase_some_session() {
  if (filed_files_.empty()) return;
  records::Ledger ledger = open_ledger();
  auto some = filed_files_.begin();
  std::advance(some, static_cast<long>(world_.random().below(filed_files_.size())));
  const std::string hash = some->first;
  for (const auto& e : ledger.content().entries) {
    if (const auto* filed = e.as<records::SessionEntry>();
        filed == nullptr || filed->file_sha256 != hash)
      continue;
    to_erase_.insert(hash);
    const std::uint64_t seq = e.seq;
    if (records::erase(ledger, {.sessions = {seq}, .motion = true, .results = true}, "drawn")
            .empty())
      return;
    entered(ledger, ledger.content().entries.size() - 1);
    erased_.insert(hash);
    return;
  }
}

void SchoolDay::write_receipt() {
  const records::Ledger ledger = open_ledger(records::LedgerUse::tell);
  const auto seq = world_.random().below(ledger.content().entries.size());
  const json receipt = ledger.receipt(seq);
  const std::string path = "/sim/office/receipts/" + records::random_hex(8) + ".json";
  write_private_text_file(path, receipt.dump());
  receipts_[path] = receipt;
}

void SchoolDay::take_backup() {
  const records::Backup made = records::back_up({k_ledger}, k_backup, true);
  if (!made.missing.empty())
    wrong("a backup lacks sessions that were filed: " + made.missing.front());
  if (!backed_up_ || made.checkpoint.size > backed_up_->size) backed_up_ = made.checkpoint;
}

void SchoolDay::ask_cosigner() {
  const records::Ledger ledger = open_ledger(records::LedgerUse::tell);
  const auto since = cosigner_asks_since_.value_or(records::last_cosigned(ledger.content()));
  to_cosigner_ = records::cosign_request(ledger.content(), since);
}

void SchoolDay::cosign_here() {
  for (int i = 0; i < 50 && to_cosigner_.empty(); ++i) world_.sleep(20'000'000);
  if (to_cosigner_.empty()) return;
  const std::string request = to_cosigner_;
  records::Cosigner cosigner{"cosigner.example",
                             load_signing_key("/sim/cosigner/home/cosigner.key", "cosigner"),
                             records::cosigner_memory_path(), morning_.promise.public_key};
  try {
    const records::Cosigned signed_note = records::cosign(
        cosigner, request, "request", static_cast<std::uint64_t>(read_clocks().utc_ns / k_s_ns));
    to_cosigner_.clear();
    cosigner_asks_since_.reset();
    if (!signed_note.findings.empty()) {
      // an older request that was overtaken by a newer one
      if (signed_note.findings[0].group() != records::FindingKind::older_copy)
        wrong("the cosigner refused an honest ledger: " + text_of(signed_note.findings));
      return;
    }
    cosigned_size_ = std::max(cosigned_size_, signed_note.size);
    notes_.push_back(signed_note.note);
    to_office_ = signed_note.note;
  } catch (const Error& e) {
    if (!(e.code() == records::LedgerError::another_state)) throw;
    const auto signed_last = std::get<Message>(e.problem().values().at(1));  // "3 entries"
    cosigner_asks_since_ =
        static_cast<std::uint64_t>(std::get<std::int64_t>(signed_last.values().at(0)));
    to_cosigner_.clear();
  }
}

void SchoolDay::keep_cosignature() {
  for (int i = 0; i < 50 && to_office_.empty(); ++i) world_.sleep(20'000'000);
  if (to_office_.empty()) return;
  const std::string note = to_office_;
  records::Ledger ledger = open_ledger();
  const auto checked = records::check_cosigned(
      note, records::read_cosigners(records::known_cosigners_path()), ledger.content());
  if (!checked.findings.empty())
    return wrong("a cosigned note does not hold: " + text_of(checked.findings));
  ledger.keep_cosignatures(checked.checkpoint->size, checked.cosignatures);
  for (const auto& s : checked.cosignatures)
    kept_cosignatures_.emplace(checked.checkpoint->size, records::signature_line(s));
}

void SchoolDay::verify() {
  records::LedgerCheck check = records::check_ledger({k_ledger}, false);
  // between an erasure's entry and the removal of the file somebody else sees both
  for (const auto& s : records::read_registry(records::read_ledger({k_ledger})).sessions)
    if (s.motion_erased_by)
      std::erase_if(check.findings, [&](const records::Finding& f) { return f.entry == s.seq; });
  // a disk that fails meanwhile may well be in the way of looking
  if (!check.findings.empty() && !world_.process().computer->had_faults)
    wrong("while others work the ledger does not hold: " + text_of(check.findings));
}

void SchoolDay::put_right() {
  for (auto& [name, computer] : world_.computers()) {
    computer.clock_ahead_ns = computer.drift_ns_per_s = 0;
    computer.had_faults = false;
    computer.full_until_ns = 0;
    computer.next_sync_fails = false;
  }
}

std::vector<std::string> SchoolDay::run() {
  for (const auto& [name, person] : people_) start(name);
  const auto begun_calls = world_.calls();
  world_.run([&](Process& p) {
    if (p.killed) {
      ++counts_["killed"];
      start(p.name);
    }
  });
  counts_["calls"] += world_.calls() - begun_calls;
  if (world_.stuck()) wrong("the day does not come to an end");
  if (world_.random().below(2) == 0)  // whatever was acknowledged is on disk by now
    for (auto& [name, computer] : world_.computers()) world_.cut_power(computer);
  put_right();
  if (!world_.stuck()) {
    try {
      check_end();
    } catch (const std::exception& e) {
      wrong(std::string("at the end of the day: ") + e.what());
    }
  }
  return wrong_;
}

}  // namespace cavum::simulation
