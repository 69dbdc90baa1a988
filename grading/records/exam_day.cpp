#include "grading/records/exam_day.h"

#include <algorithm>

#include "engine/base/text.h"
#include "engine/base/where.h"
#include "grading/records/candidate_id.h"
#include "grading/records/ledger.h"

namespace cavum::records {
namespace {

void require_words(const Where& what, const std::string& text) {
  if (text.size() > k_longest_words || !is_seen_text(text))
    throw Error(what, msg("is no line of text of at most {} bytes", k_longest_words),
                msg("say it in one line, without names: it is kept"));
}

void require_station(const Registry& registry, const std::string& key) {
  const Station* s = registry.stations.of(key);
  if (s == nullptr || s->revoked_utc_ns)
    throw Error(msg("station {}", one_line(key)), msg("is none that is enrolled"),
                msg("choose one of the list"));
}

void require_audience(const Registry& registry, const Audience& audience) {
  for (const auto& key : audience.stations) require_station(registry, key);
  if (audience.stations.empty() && !audience.room.empty())
    throw Error(msg("room {}", one_line(audience.room)), msg("has no station"),
                msg("choose another, or all"));
}

Hold* lasting(ExamDay& day, std::uint64_t seq) {
  const auto found = std::find_if(day.holds.begin(), day.holds.end(),
                                  [&](const Hold& h) { return h.seq == seq && !h.ended_by; });
  return found == day.holds.end() ? nullptr : &*found;
}

}  // namespace

bool Audience::holds(const std::string& station) const {
  return stations.empty() || std::find(stations.begin(), stations.end(), station) != stations.end();
}

const Hold* ExamDay::hold_of(const std::string& station) const {
  const auto found = std::find_if(holds.begin(), holds.end(), [&](const Hold& h) {
    return !h.ended_by && h.audience.holds(station);
  });
  return found == holds.end() ? nullptr : &*found;
}

void take_go_on(ExamDay& day, const LedgerEntry& e, const GoOnEntry& what) {
  Hold* hold = lasting(day, what.hold);
  if (hold == nullptr)
    throw Error(msg("go_on"), msg("lets exams go on that were not held"),
                msg("use an intact copy"));
  hold->ended_by = e.seq;
  hold->ended_utc_ns = e.utc_ns;
}

const LedgerEntry& announce(Ledger& ledger, const std::string& words, const Audience& audience) {
  require_words(msg("the announcement"), words);
  return ledger.append([&](const LedgerContent&) {
    require_audience(ledger.registry(), audience);
    return AnnounceEntry{words, audience};
  });
}

const LedgerEntry& hold_exams(Ledger& ledger, const std::string& reason, const Audience& audience) {
  require_words(msg("the reason"), reason);
  return ledger.append(
      [&](const LedgerContent&) {
        require_audience(ledger.registry(), audience);
        return HoldEntry{audience};
      },
      reason);
}

const LedgerEntry& let_go_on(Ledger& ledger, std::uint64_t hold, const std::string& reason) {
  require_words(msg("the reason"), reason);
  return ledger.append(
      [&](const LedgerContent&) {
        ExamDay day = ledger.registry().day;
        if (lasting(day, hold) == nullptr)
          throw Error(msg("entry {}", hold), msg("holds no exam, or not any more"),
                      msg("look at the board again"));
        return GoOnEntry{hold};
      },
      reason);
}

const LedgerEntry& note_incident(Ledger& ledger, const std::string& station,
                                 const std::string& candidate, const std::string& words) {
  require_words(msg("the incident"), words);
  if (!candidate.empty() && !is_pseudonym(candidate))
    throw Error(msg("the candidate"), msg("is no pseudonym"), msg("choose one of the list"));
  return ledger.append([&](const LedgerContent&) {
    const Registry& registry = ledger.registry();
    if (!station.empty()) require_station(registry, station);
    const auto& tickets = registry.tickets;
    if (!candidate.empty() &&
        std::none_of(tickets.begin(), tickets.end(),
                     [&](const IssuedTicket& t) { return t.ticket.candidate == candidate; }))
      throw Error(msg("candidate {}", candidate), msg("has no ticket here"),
                  msg("choose one of the list"));
    return IncidentEntry{station, candidate, make_opening(words)};
  });
}

Findings unexplained_holds(const ExamDay& day, const std::string& station,
                           std::span<const HeldTime> held, std::int64_t received_utc_ns) {
  constexpr std::int64_t k_clocks_ns =
      300'000'000'000;  // by which the clocks of station and ledger may differ
  constexpr std::int64_t k_network_ns = 60'000'000'000;  // for word of the end to come
  Findings findings;
  for (const auto& [begun, ended] : held) {
    const bool known = std::any_of(
        day.holds.begin(), day.holds.end(), [&, from = begun, to = ended](const Hold& h) {
          const std::int64_t until = h.ended_by ? h.ended_utc_ns : received_utc_ns;
          return h.audience.holds(station) && from >= h.utc_ns - k_clocks_ns &&
                 to <= until + k_clocks_ns && to - from <= until - h.utc_ns + k_network_ns;
        });
    if (!known)
      findings.push_back(finding<FindingKind::pause_unknown>(utc_text(begun), utc_text(ended)));
  }
  return findings;
}

}  // namespace cavum::records
