#include "grading/records/registry.h"

#include <algorithm>
#include <map>
#include <set>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_from.h"
#include "grading/records/begin.h"
#include "grading/records/erasure.h"
#include "grading/records/ledger_error.h"
#include "grading/result/finding.h"

namespace cavum::records {

using nlohmann::json;

namespace {

/// A result, which exports rely on: null, or in the shape that grading gives it. Throws Error for
/// another one.
const SharedJson& sound_result(const SharedJson& opened) {
  const json& result = *opened;
  if (result.is_null()) return opened;
  const auto text = [](const json& j, const char* name) {
    return j.contains(name) && j[name].is_string();
  };
  const auto number = [](const json& j, const char* name) {
    return j.contains(name) && j[name].is_number();
  };
  const auto criterion = [&](const json& c) {
    return c.is_object() && text(c, "id") && text(c, "metric") && text(c, "unit") &&
           number(c, "points") && number(c, "max") && c.contains("value") &&
           (c["value"].is_null() || c["value"].is_number());
  };
  const json &score = member_of(result, "score"), &criteria = member_of(result, "criteria");
  const bool sound =
      result.is_object() && text(result, "verdict") && score.is_object() &&
      number(score, "points") && number(score, "max") &&
      (!score.contains("pass_percent") || number(score, "pass_percent")) &&
      (!score.contains("borderline_percent") || number(score, "borderline_percent")) &&
      criteria.is_array() && std::all_of(criteria.begin(), criteria.end(), criterion);
  if (!sound)
    throw Error(msg("result"), msg("is none as grading writes it"), msg("use an intact copy"));
  static_cast<void>(grading::verdict_in(result));
  for (const char* list : {"verdict_reasons", "notes"})
    static_cast<void>(grading::findings_in(member_of(result, list)));
  for (const json& c : criteria) static_cast<void>(grading::findings_in(member_of(c, "facts")));
  return opened;
}

bool contest_each_other(const FiledSession& a, const FiledSession& b) {
  return std::find(a.contested_by.begin(), a.contested_by.end(), b.seq) != a.contested_by.end();
}

/// Why a release of these results is none for a session; none: it is one.
std::optional<Finding> why_void(const Registry& r, const FiledSession& s,
                                const std::set<std::uint64_t>& results) {
  if (const FiledSession* other = r.chosen_instead_of(s))
    return finding<FindingKind::release_other_chosen>(s.seq, other->seq);
  if (s.made_up_by) return finding<FindingKind::release_made_up>(s.seq, *s.made_up_by);
  if (const FiledSession* other = r.shown_adjacent(s))
    return finding<FindingKind::release_other_sitting>(s.seq, other->seq);
  for (const FiledSession& other : r.sessions)
    if (contest_each_other(s, other) && results.contains(other.result_seq))
      return finding<FindingKind::release_void>(s.seq, other.seq);
  return std::nullopt;
}

/// What the entry `seq` releases, `results`: of several endings of one exam one, and once a person
/// has chosen, that one.
void release(Registry& r, std::uint64_t seq, std::int64_t utc_ns,
             const std::set<std::uint64_t>& results) {
  for (auto& s : r.sessions) {
    if (!results.contains(s.result_seq)) continue;
    if (const auto why = why_void(r, s, results)) {
      r.remarks.push_back(why->in_entry(seq));
      continue;
    }
    for (auto& o : r.sessions)  // released before anybody knew of this ending
      if (contest_each_other(s, o))
        o.released = false, o.shown = json(), o.shown_seq = 0, o.released_utc_ns = 0;
    s.released = true;
    s.retracted_by.reset();
    s.shown = s.result;
    s.shown_seq = s.result_seq;
    s.released_utc_ns = utc_ns;
    s.chosen = s.questioned();
  }
}

/// The one that an entry made; null: none of the list.
template <class T>
const T* of_entry(const std::vector<T>& list, std::uint64_t seq) {
  const auto found = std::lower_bound(list.begin(), list.end(), seq,
                                      [](const T& one, std::uint64_t at) { return one.seq < at; });
  return found == list.end() || found->seq != seq ? nullptr : &*found;
}

using Documents = std::map<std::string, std::string>;

bool marked_by(const FiledSession& s, const Documents& documents) {
  return std::any_of(s.regrades.begin(), s.regrades.end(),
                     [&](const Regrade& r) { return r.documents == documents; });
}

/// The last documents by which all of an exam was marked, and the first entry of that; none: entry
/// 0.
std::pair<Documents, std::uint64_t> class_documents(const std::vector<const FiledSession*>& exam) {
  std::map<Documents, std::uint64_t> first;
  for (const FiledSession* s : exam)
    for (const Regrade& r : s->regrades)
      if (r.person.empty() && !r.documents.empty()) {
        std::uint64_t& seq = first.try_emplace(r.documents, r.seq).first->second;
        seq = std::min(seq, r.seq);
      }
  std::pair<Documents, std::uint64_t> last;
  for (const auto& one : first) {
    const auto before = [&](const FiledSession* s) { return s->seq < one.second; };
    const bool all = std::all_of(exam.begin(), exam.end(), [&](const FiledSession* s) {
      return !before(s) || marked_by(*s, one.first);
    });
    if (all && one.second > last.second && std::count_if(exam.begin(), exam.end(), before) > 1)
      last = one;
  }
  return last;
}

}  // namespace

const FiledSession* Registry::session(std::uint64_t seq) const { return of_entry(sessions, seq); }

const IssuedTicket* Registry::ticket(std::uint64_t seq) const { return of_entry(tickets, seq); }

const FiledSession* Registry::chosen_instead_of(const FiledSession& session) const {
  for (const auto& o : sessions)
    if (contest_each_other(session, o) && o.chosen) return &o;
  return nullptr;
}

const FiledSession* Registry::shown_adjacent(const FiledSession& session) const {
  for (const auto& o : sessions)
    if (session.first_sitting != 0 && o.first_sitting == session.first_sitting &&
        o.nonce != session.nonce && o.shown_seq != 0)
      return &o;
  return nullptr;
}

std::map<std::pair<std::string, std::string>, std::uint64_t> Registry::counting() const {
  std::map<std::pair<std::string, std::string>, std::uint64_t> last;
  for (const auto& s : sessions)
    if (s.shown->is_object()) last[{s.candidate, s.scenario_id}] = s.seq;
  return last;
}

std::set<std::uint64_t> Registry::marked_otherwise() const {
  std::map<std::string, std::vector<const FiledSession*>> exams;
  for (const auto& s : sessions)
    if (s.result->is_object() && !s.motion_erased_by) exams[s.scenario_id].push_back(&s);
  std::set<std::uint64_t> out;
  for (const auto& [id, exam] : exams)
    if (const auto [documents, seq] = class_documents(exam); seq != 0)
      for (const FiledSession* s : exam)
        if (s->seq > seq && !marked_by(*s, documents)) out.insert(s->seq);
  return out;
}

const IssuedTicket* Registry::live_ticket(const std::string& candidate, const std::string& exam,
                                          std::int64_t utc_ns) const {
  for (const auto& t : tickets)
    if (t.ticket.candidate == candidate && t.ticket.exam == exam && t.live(utc_ns)) return &t;
  return nullptr;
}

std::string recording_of(const LedgerPaths& places, const FiledSession& s) {
  if (s.motion_erased_by)
    throw Error(msg("entry {}", s.seq),
                msg("its recording was erased (entry {})", *s.motion_erased_by),
                msg("its result and its proofs are what is left"));
  return places.session(s.file_sha256);
}

/// Takes one entry after the other into a registry. Each function throws std::exception for what
/// contradicts the entries before.
class RegistryReader {
 public:
  void apply(const LedgerContent& content, const LedgerEntry& e) {
    if (!e.what) return;  // which is a finding of the content
    content_ = &content;
    e_ = &e;
    try {
      std::visit(*this, *e.what);
    } catch (const std::out_of_range&) {
      say(finding<FindingKind::entry_unknown>());
    } catch (const Error& error) {
      say(error.code() == LedgerError::bad_signature
              ? finding<FindingKind::entry_signature>(error.message())
              : finding<FindingKind::entry_contradicts>(error.message()));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      say(finding<FindingKind::entry_contradicts>(message_from(error)));
    }
  }
  [[nodiscard]] const Registry& so_far() const noexcept { return r_; }
  [[nodiscard]] Registry all() && noexcept { return std::move(r_); }

  // What the content itself is asked for.
  void operator()(const InitEntry&) {}
  void operator()(const KeyEntry&) {}
  void operator()(const RestoreEntry&) {}

  void operator()(const TicketEntry& what) {
    require_signed(what.ticket, what.signature, content_->key_of(e_->seq + 1), msg("ticket"));
    IssuedTicket t{e_->seq, what.ticket, {}, {}, {}};
    t.first_sitting = e_->seq;
    if (what.makes_up) make_up(*what.makes_up, t);
    if (!by_nonce_.emplace(t.ticket.nonce, r_.tickets.size()).second)
      say(finding<FindingKind::ticket_number_taken>());
    by_ticket_[e_->seq] = r_.tickets.size();
    r_.tickets.push_back(std::move(t));
  }

  void operator()(const SeatsEntry& what) {
    for (const Seat& seat : what.seats) {
      if (!seat.station.empty() && r_.stations.of(seat.station) == nullptr)
        say(finding<FindingKind::seat_unknown>());
      r_.tickets.at(by_ticket_.at(seat.ticket)).seat = seat.station;
    }
  }

  void operator()(const CancelEntry& what) {
    IssuedTicket& t = r_.tickets.at(by_ticket_.at(what.ticket));
    if (t.used_by || t.cancelled_by) say(finding<FindingKind::cancels_void>());
    if (!t.cancelled_by) {
      t.cancelled_by = e_->seq;
      unmake(t);
    }
  }

  /// Whoever is forgotten sits no more exams under that pseudonym.
  void operator()(const ForgetEntry& what) {
    for (auto& t : r_.tickets)
      if (t.ticket.candidate == what.candidate && !t.used_by && !t.cancelled_by)
        t.cancelled_by = e_->seq;
    erase();
  }
  void operator()(const EraseEntry&) { erase(); }

  void operator()(const BeginEntry& what) {
    const Begin& b = what.begin;
    require_signed(b, what.signature, content_->key_of(e_->seq + 1), msg("word to begin"));
    IssuedTicket& t = r_.tickets.at(by_nonce_.at(b.ticket));
    constexpr std::int64_t k_moment_ns = 60'000'000'000;
    if (std::abs(b.utc_ns - e_->utc_ns) > k_moment_ns)
      say(finding<FindingKind::begins_otherwise>());
    if (b.ledger != content_->id) say(finding<FindingKind::begins_other_ledger>());
    t.begins.push_back({e_->seq, b.nonce, b.utc_ns});
  }

  void operator()(const SessionEntry& what) {
    FiledSession s;
    s.seq = s.result_seq = e_->seq;
    s.received_utc_ns = e_->utc_ns;
    s.file_sha256 = what.file_sha256;
    s.chain_sha256 = what.chain_sha256;
    s.candidate = what.candidate;
    s.scenario_id = what.scenario_id;
    s.station_key = what.station_key;
    s.nonce = what.nonce;
    s.result = s.filed = sound_result(what.result.value);
    s.motion_erased_by = erased_by(content_->erased, e_->seq, Part::motion);
    s.result_erased_by = erased_by(content_->erased, e_->seq, Part::result);
    if (what.sealed) s.sealed = parse_json_or_null(what.sealed->words(), k_json_part);
    s.grading_version = what.grading_version;
    s.simulated = what.simulated;
    s.findings = what.findings;
    if (const auto [chain, first] = chains_.emplace(s.chain_sha256, s.seq);
        !first && s.findings.empty())
      say(finding<FindingKind::submitted_twice>(chain->second));
    if (!s.nonce.empty() && s.findings.empty()) use_ticket(s);
    if (const auto t = by_nonce_.find(s.nonce); t != by_nonce_.end()) {
      const IssuedTicket& ticket = r_.tickets[t->second];
      s.made_up_by = ticket.made_up_by, s.makes_up = ticket.makes_up,
      s.first_sitting = ticket.first_sitting;
    }
    for (auto& other : r_.sessions)  // two endings of one exam: the one that was filed as sound may
                                     // be the wrong one
      if (!s.nonce.empty() && other.nonce == s.nonce && other.chain_sha256 != s.chain_sha256) {
        other.contested_by.push_back(s.seq);
        s.contested_by.push_back(other.seq);
      }
    by_session_[e_->seq] = r_.sessions.size();
    r_.sessions.push_back(std::move(s));
  }

  void operator()(const RegradeEntry& what) {
    FiledSession& s = session(what.session);
    s.result = sound_result(what.result.value);
    s.result_seq = e_->seq;
    s.result_erased_by = erased_by(content_->erased, e_->seq, Part::result);
    s.regrades.push_back({e_->seq, e_->utc_ns, e_->by.reason, what.person, what.by, s.result});
    s.released =
        false;  // a new result waits for its own release, and the old one stands until then
  }

  void operator()(const ReleaseEntry& what) {
    const std::set<std::uint64_t> results(what.results.begin(), what.results.end());
    for (const auto seq : results)
      if (std::none_of(r_.sessions.begin(), r_.sessions.end(),
                       [&](const FiledSession& s) { return s.result_seq == seq; }))
        say(finding<FindingKind::releases_void>());
    release(r_, e_->seq, e_->utc_ns, results);
  }

  void operator()(const RetractEntry& what) {
    for (const auto seq : std::set<std::uint64_t>(what.results.begin(), what.results.end())) {
      const auto s = std::find_if(r_.sessions.begin(), r_.sessions.end(),
                                  [&](const FiledSession& one) { return one.shown_seq == seq; });
      if (s == r_.sessions.end() || seq == 0) {
        say(finding<FindingKind::retracts_void>());
        continue;
      }
      s->released = false, s->shown = json(), s->shown_seq = 0, s->released_utc_ns = 0;
      s->retracted_by = e_->seq;
      s->retracted_why = e_->by.reason;
    }
  }

  void operator()(const AppealEntry& what) {
    FiledSession& s = session(what.session);
    if (s.open_appeal() != nullptr) say(finding<FindingKind::appeal_beside>());
    s.appeals.push_back({e_->seq, e_->utc_ns, e_->by.reason, {}, {}, {}});
  }
  void operator()(const AnswerEntry& what) {
    for (auto& a : session(what.session).appeals) {
      if (a.seq != what.answers || a.closed_by) continue;
      a.closed_by = e_->seq, a.outcome = what.outcome, a.answer = e_->by.reason;
      return;
    }
    say(finding<FindingKind::answers_void>());
  }

  void operator()(const PassbackEntry& what) {
    const FiledSession& s = session(what.session);
    if (what.result != 0 && what.result != s.seq && s.regrade(what.result) == nullptr)
      say(finding<FindingKind::sends_void>());
    r_.passbacks.push_back(what);
  }

  void operator()(const AnnounceEntry& what) {
    r_.day.announcements.push_back({e_->seq, e_->utc_ns, what.text, what.audience});
  }
  void operator()(const HoldEntry& what) {
    r_.day.holds.push_back({e_->seq, e_->utc_ns, e_->by.reason, what.audience, {}, 0});
  }
  void operator()(const GoOnEntry& what) { take_go_on(r_.day, *e_, what); }
  void operator()(const IncidentEntry& what) {
    r_.day.incidents.push_back({e_->seq, e_->utc_ns, e_->by.account, what.about_station,
                                what.candidate, what.words.words(),
                                erased_by(content_->erased, e_->seq, Part::words)});
  }

  void operator()(const InviteEntry& what) { take_invite(r_.stations, *e_, what); }
  void operator()(const EnrolEntry& what) {
    take_enrol(r_.stations, *e_, what, content_->key_of(e_->seq + 1));
  }
  void operator()(const RevokeEntry& what) { take_revoke(r_.stations, *e_, what); }
  void operator()(const RoomEntry& what) { take_room(r_.stations, what); }

 private:
  void say(const Finding& what) { r_.findings.push_back(what.in_entry(e_->seq)); }
  FiledSession& session(std::uint64_t seq) { return r_.sessions.at(by_session_.at(seq)); }

  /// Of the first sitting nothing counts from now on.
  void make_up(const MakesUp& what, IssuedTicket& t) {
    IssuedTicket& first = r_.tickets.at(by_ticket_.at(what.ticket));
    if (first.ticket.candidate != t.ticket.candidate || first.ticket.exam != t.ticket.exam)
      say(finding<FindingKind::makes_up_other>());
    if (first.made_up_by) say(finding<FindingKind::makes_up_twice>());
    first.made_up_by = e_->seq;
    t.makes_up = what;
    t.why = e_->by.reason;
    t.first_sitting = first.first_sitting;
    for (auto& s : r_.sessions) {
      if (s.nonce.empty() || s.nonce != first.ticket.nonce) continue;
      if (s.shown_seq != 0) say(finding<FindingKind::makes_up_released>());
      s.made_up_by = e_->seq;
    }
  }

  /// A makeup that was cancelled before it was begun is none.
  void unmake(const IssuedTicket& t) {
    if (!t.makes_up || t.made_up_by || !t.begins.empty()) return;
    IssuedTicket& first = r_.tickets.at(by_ticket_.at(t.makes_up->ticket));
    first.made_up_by.reset();
    for (auto& s : r_.sessions)
      if (s.nonce == first.ticket.nonce) s.made_up_by.reset();
  }

  /// Of what was entered before, where the registry grows with the ledger.
  void erase() {
    for (auto& s : r_.sessions) {
      s.motion_erased_by = erased_by(content_->erased, s.seq, Part::motion);
      s.result_erased_by = erased_by(content_->erased, s.result_seq, Part::result);
      if (s.result_erased_by) s.result = json();
    }
    for (auto& i : r_.day.incidents)
      if ((i.erased_by = erased_by(content_->erased, i.seq, Part::words))) i.words.clear();
  }

  void use_ticket(const FiledSession& s) {
    const auto found = by_nonce_.find(s.nonce);
    if (found == by_nonce_.end()) return say(finding<FindingKind::entered_ticket_unknown>());
    IssuedTicket& t = r_.tickets[found->second];
    if (t.used_by) return say(finding<FindingKind::ticket_used>(*t.used_by));
    if (t.cancelled_by) say(finding<FindingKind::entered_ticket_cancelled>(*t.cancelled_by));
    if (t.made_up_by) say(finding<FindingKind::entered_ticket_made_up>(*t.made_up_by));
    t.used_by = e_->seq;
  }

  const LedgerContent* content_ = nullptr;  // of the entry that is applied
  const LedgerEntry* e_ = nullptr;
  Registry r_;
  std::map<std::uint64_t, std::size_t> by_session_, by_ticket_;  // by their entries
  std::map<std::string, std::size_t> by_nonce_;                  // tickets
  std::map<std::string, std::uint64_t> chains_;                  // first entries of recordings
};

Registry read_registry(const LedgerContent& content) {
  RegistryReader reader;
  for (const auto& e : content.entries) reader.apply(content, e);
  return std::move(reader).all();
}

GrowingRegistry::GrowingRegistry() : reader_(std::make_unique<RegistryReader>()) {}
GrowingRegistry::~GrowingRegistry() = default;
GrowingRegistry::GrowingRegistry(GrowingRegistry&&) noexcept = default;
GrowingRegistry& GrowingRegistry::operator=(GrowingRegistry&&) noexcept = default;

const Registry& GrowingRegistry::of(const LedgerContent& content) {
  for (; read_ < content.entries.size(); ++read_) reader_->apply(content, content.entries[read_]);
  return reader_->so_far();
}

}  // namespace cavum::records
