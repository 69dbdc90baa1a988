#include "grading/records/claims.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_from.h"
#include "engine/session/chain.h"
#include "engine/session/clock_check.h"
#include "engine/session/motion_source.h"
#include "engine/session/station_check.h"
#include "grading/records/begin.h"
#include "grading/records/candidate_id.h"
#include "scenarios/exam/runner.h"

namespace cavum::records {
namespace {

using nlohmann::json;

std::string ticket_text_in(const SessionSetup& setup) {
  for (const auto& [key, value] : setup.notes)
    if (key == k_ticket_note) return value;
  return {};
}

/// "device falcon"
std::string name_of(const MotionSource& source) {
  return fmt::format("{}{}{}",
                     source.kind == SourceKind::unnamed ? "unnamed" : text_of(source.kind),
                     source.name.empty() ? "" : " ", source.name);
}

constexpr std::int64_t k_patience_ns =
    300'000'000'000;  // by which the clocks of station and ledger may differ
constexpr std::int64_t k_hand_in_ns =
    86'400'000'000'000;  // within which a finished exam reaches the ledger

/// Times that contradict one another, and a gap that changed who or what sat the exam.
Findings check_course(const SessionReader& session, const SessionSetup& setup,
                      const std::optional<IssuedTicket>& ticket, std::int64_t issued_utc_ns,
                      std::int64_t received_utc_ns) {
  Findings findings;
  const std::int64_t begun = session.created().utc_ns, closed = session.seal()->clocks.utc_ns;
  if (closed > received_utc_ns + k_patience_ns)
    findings.push_back(finding<FindingKind::ended_after_filing>(utc_text(closed)));
  if (closed < begun)
    findings.push_back(finding<FindingKind::ended_before_begin>(utc_text(closed)));
  if (ticket && begun < issued_utc_ns - k_patience_ns)
    findings.push_back(finding<FindingKind::begun_before_issue>(utc_text(begun)));
  // A clock that was set back puts an exam into its window; that it reaches the ledger late is what
  // is left to see.
  if (ticket && received_utc_ns > std::max(closed, ticket->ticket.not_after_utc_ns) + k_hand_in_ns)
    findings.push_back(
        finding<FindingKind::handed_in_late>(utc_text(received_utc_ns), utc_text(closed)));
  for (const auto& e : session.event_rows()) {
    const auto* gap = e.as<RecordingGap>();
    if (gap == nullptr) continue;
    if (ticket && gap->resumed_utc_ns > ticket->ticket.not_after_utc_ns)
      findings.push_back(finding<FindingKind::ticket_time_resumed>(utc_text(gap->resumed_utc_ns)));
    const std::optional<MotionSource>& source = gap->by.source;
    if (source && (source->kind != setup.source.kind || source->name != setup.source.name))
      findings.push_back(
          finding<FindingKind::device_changed>(name_of(setup.source), name_of(*source)));
  }
  return findings;
}

/// Was it begun with the ledger's word, and with the last one that was given for its ticket?
Findings check_begin(const LedgerContent& content, const SessionReader& session,
                     const SessionSetup& setup, const IssuedTicket& ticket) {
  Findings findings;
  std::string text;
  for (const auto& [key, value] : setup.notes)
    if (key == k_begin_note) text = value;
  if (text.empty()) {
    if (!ticket.begins.empty())
      findings.push_back(finding<FindingKind::begin_missing>(utc_text(ticket.begins.back().utc_ns),
                                                             ticket.begins.back().seq));
    else if (ticket.ticket.begun_at_ledger)
      findings.push_back(finding<FindingKind::begin_not_asked>());
    return findings;
  }
  Begin b;
  try {
    b = parse_begin(text, "", msg("the ledger's word to begin"));
  } catch (const Error& e) {
    return {finding<FindingKind::begin_invalid>(e.message())};
  }
  if (b.ledger != content.id || !content.has_key(b.public_key) || b.ticket != ticket.ticket.nonce)
    return {finding<FindingKind::begin_of_other>()};
  const auto found = std::find_if(ticket.begins.begin(), ticket.begins.end(),
                                  [&](const LetBegin& l) { return l.nonce == b.nonce; });
  if (found == ticket.begins.end()) return {finding<FindingKind::begin_not_given>()};
  if (found + 1 != ticket.begins.end())
    findings.push_back(finding<FindingKind::begin_not_last>(utc_text(b.utc_ns),
                                                            utc_text(ticket.begins.back().utc_ns)));
  if (session.created().utc_ns < b.utc_ns - k_patience_ns)
    findings.push_back(finding<FindingKind::begun_before_let>(utc_text(session.created().utc_ns),
                                                              utc_text(b.utc_ns)));
  return findings;
}

/// When the recording's clock stood still because of the office, by the clocks of its seconds.
std::vector<HeldTime> held_times(const SessionReader& session) {
  const auto utc_at = [&](std::int64_t tick) {
    std::int64_t utc_ns = session.created().utc_ns;
    for (const auto& chunk : session.chunks())
      if (chunk.first_tick + chunk.ticks <= tick) utc_ns = chunk.clocks.utc_ns;
    return utc_ns;
  };
  std::vector<HeldTime> held;
  for (const auto& e : session.event_rows()) {
    if (e.as<HoldStarted>() != nullptr) held.emplace_back(utc_at(e.tick), 0);
    if (e.as<HoldEnded>() != nullptr && !held.empty()) held.back().second = utc_at(e.tick);
  }
  if (!held.empty() && held.back().second == 0) held.back().second = session.seal()->clocks.utc_ns;
  return held;
}

/// What moved the stylus, at which station, and what the clocks say of it. What no hand moved is
/// nobody's exam: no station has to answer for it.
Findings check_hand(const Registry& registry, const SessionReader& session,
                    const SessionSetup& setup, std::int64_t received_utc_ns,
                    const FilingOptions& options) {
  Findings findings;
  if (const std::string by = simulated_by(session, setup); !by.empty()) {
    if (!options.simulated) findings.push_back(finding<FindingKind::no_hand>(by));
    return findings;
  }
  if (session.fact(k_station_fact).empty())
    findings.push_back(finding<FindingKind::beginning_unsigned>());
  const std::string key = to_hex(session.seal()->public_key);
  if (auto why = registry.stations.problem(key, session.seal()->clocks.utc_ns, received_utc_ns)) {
    findings.push_back(std::move(*why));
  } else if (const auto& known = registry.stations.of(key)->devices; !known.empty()) {
    for (const auto& [tick, source] : sources_of(session))
      if (std::find(known.begin(), known.end(), source) == known.end())
        findings.push_back(finding<FindingKind::device_other>(source.name, source.serial));
  }
  for (const auto& remark : check_clocks(session))
    if (remark.doubtful) findings.push_back(static_cast<const Damage&>(remark));
  return findings;
}

/// How far a session and one that was filed with the same ticket are one recording: an exam that
/// was ended twice is so up to where one was cut back.
Finding other_ending(const SessionReader& session, std::uint64_t seq,
                     const std::string& filed_path) {
  try {
    const SessionReader filed(filed_path);
    const auto &mine = session.chunks(), &theirs = filed.chunks();
    std::size_t same = 0;
    while (same < std::min(mine.size(), theirs.size()) && mine[same].sha256 == theirs[same].sha256)
      ++same;
    if (same == 0) return finding<FindingKind::ticket_used_recording>(seq);
    const std::int64_t tick = mine[same - 1].first_tick + mine[same - 1].ticks;
    return finding<FindingKind::ticket_used_ending>(seq, tick, filed.ticks(), session.ticks());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return finding<FindingKind::ticket_used_unread>(seq, message_from(e));
  }
}

/// What of the beginning is entered in the ledger.
void check_texts(const SessionSetup& setup, Findings& findings) {
  const std::string &name = setup.source.name, &serial = setup.source.serial;
  if (!is_plain_text(setup.candidate))
    findings.push_back(finding<FindingKind::text_unclean>(setup.candidate));
  if (!is_plain_text(name)) findings.push_back(finding<FindingKind::source_unclean>(name));
  if (!is_plain_text(serial)) findings.push_back(finding<FindingKind::serial_unclean>(serial));
}

}  // namespace

std::string ticket_nonce_in(const SessionSetup& setup) {
  const std::string text = ticket_text_in(setup);
  if (text.empty()) return {};
  const json j = parse_json_or_null(text);
  return text_in(member_of(j, "ticket"), "nonce");
}

std::string simulated_by(const SessionReader& session, const SessionSetup& setup) {
  for (const auto& [tick, source] : sources_of(session)) {
    if (source.kind == SourceKind::simulated_operator)
      return source.name.empty() ? text_of(source.kind) : source.name;
    if (!source.is_hand()) return name_of(source);
  }
  for (const auto& [key, value] : setup.notes)  // beside a source that says otherwise
    if (key == "operator" || key == "practice" || key == "motion_file")
      return key == "operator" && !value.empty() ? value : fmt::format("{} {}", key, value);
  return {};
}

Findings check_claims(const LedgerContent& content, const Registry& registry,
                      const SessionReader& session, std::int64_t received_utc_ns,
                      const FilingOptions& options, const LedgerPaths* filed) {
  if (!session.closed()) return {damage<DamageKind::not_closed>(session.ticks())};
  const SessionSetup setup = session.setup();
  const std::string chain_sha256 = to_hex(session.seal()->chain_sha256),
                    nonce = ticket_nonce_in(setup);
  Findings findings;
  check_texts(setup, findings);
  append(findings, check_stations(session));
  for (const auto& s : registry.sessions)
    if (s.chain_sha256 == chain_sha256)
      findings.push_back(finding<FindingKind::submitted_twice>(s.seq));
  const std::string text = ticket_text_in(setup);
  append(findings, check_hand(registry, session, setup, received_utc_ns, options));
  append(findings, unexplained_holds(registry.day, to_hex(session.seal()->public_key),
                                     held_times(session), received_utc_ns));
  if (text.empty()) {
    if (!options.without_ticket) findings.push_back(finding<FindingKind::ticket_missing>());
    if (is_pseudonym(setup.candidate))
      findings.push_back(finding<FindingKind::ticket_of_pseudonym>());
    append(findings, check_course(session, setup, {}, 0, received_utc_ns));
    return findings;
  }
  try {
    const Ticket ticket = parse_ticket(text, "", msg("the session's ticket"));
    if (!content.has_key(ticket.public_key))
      findings.push_back(finding<FindingKind::ticket_other_school>());
    append(findings, check_ticket(ticket, setup, session.created().utc_ns));
    if (ticket.ledger != content.id)
      findings.push_back(finding<FindingKind::ticket_other_ledger>());
    bool issued = false;
    for (const auto& t : registry.tickets) {
      if (t.ticket.nonce != nonce) continue;
      issued = true;
      if (t.cancelled_by)
        findings.push_back(finding<FindingKind::ticket_cancelled>(
            utc_text(content.entries.at(*t.cancelled_by).utc_ns), *t.cancelled_by));
      if (t.made_up_by) findings.push_back(finding<FindingKind::ticket_made_up>(*t.made_up_by));
      append(findings, check_begin(content, session, setup, t));
      append(findings,
             check_course(session, setup, t, content.entries.at(t.seq).utc_ns, received_utc_ns));
      if (t.used_by) {
        const auto other = std::find_if(registry.sessions.begin(), registry.sessions.end(),
                                        [&](const FiledSession& s) { return s.seq == *t.used_by; });
        findings.push_back(
            filed == nullptr || other == registry.sessions.end() || other->motion_erased_by ||
                    other->chain_sha256 == chain_sha256
                ? finding<FindingKind::ticket_used>(*t.used_by)
                : other_ending(session, *t.used_by, filed->session(other->file_sha256)));
      }
    }
    if (!issued) findings.push_back(finding<FindingKind::ticket_unknown>());
  } catch (const Error& e) {
    findings.push_back(finding<FindingKind::ticket_invalid>(e.message()));
  }
  return findings;
}

}  // namespace cavum::records
