#include "grading/records/check_ledger.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_from.h"
#include "grading/marking/grade.h"
#include "grading/marking/school_mark.h"
#include "grading/records/erasure.h"
#include "grading/records/history.h"
#include "grading/records/identities.h"
#include "grading/records/ledger_key.h"
#include "grading/records/registry.h"
#include "grading/records/school_keys.h"

namespace cavum::records {

namespace {

using nlohmann::json;

/// What simulating and marking a filed session again gave: it must hold, and be marked as it was.
void compare_with_line(const FiledSession& s, const std::string& line, LedgerCheck& out) {
  const json again = parse_json_or_null(line, k_json_part);
  if (line.empty() || !again.is_object()) {
    out.not_made.push_back(finding<FindingKind::not_simulated>().in_entry(s.seq));
    return;
  }
  if (const Message error = pool::error_in(again); !error.empty()) {
    out.findings.push_back(finding<FindingKind::file_unreadable>(error).in_entry(s.seq));
    return;
  }
  if (text_in(again, "sha256") != s.file_sha256)
    out.findings.push_back(finding<FindingKind::file_changed_meanwhile>().in_entry(s.seq));
  for (const Damage& d : pool::findings_in(again))
    out.findings.push_back(Finding(d).in_entry(s.seq));
  const json& result = member_of(again, "result");
  const auto differ = s.filed->is_object() && result.is_object()
                          ? grading::result_differences(*s.filed, result)
                          : "";
  if (differ.empty()) return;
  if (s.grading_version == grading::k_grading_version)
    out.findings.push_back(finding<FindingKind::filed_result_differs>(differ).in_entry(s.seq));
  else
    out.remarks.push_back(
        finding<FindingKind::version_differs>(s.grading_version, grading::k_grading_version, differ)
            .in_entry(s.seq));
}

/// An entry made while the computer's clock was ahead is named as soon as that is put right.
void check_times(const LedgerContent& content, Findings& remarks) {
  constexpr std::int64_t k_patience_ns = 300'000'000'000;
  const std::int64_t now_ns = read_clocks().utc_ns;
  for (const auto& e : content.entries)
    if (e.utc_ns > now_ns + k_patience_ns)
      remarks.push_back(finding<FindingKind::clock_ahead>(utc_text(e.utc_ns)).in_entry(e.seq));
}

/// What can never be shown of this ledger here, and why.
void say_not_checked(const LedgerContent& content, const Registry& registry, bool replay,
                     LedgerCheck& out) {
  if (content.id.empty())
    out.not_checked.push_back(finding<FindingKind::older_unread>());
  else if (!content.witnessed)
    out.not_checked.push_back(finding<FindingKind::older_no_witness>());
  if (!replay && !registry.sessions.empty())
    out.not_checked.push_back(finding<FindingKind::not_simulated_unasked>());
}

enum class Recording { there, changed, erased };

/// One filed recording: there and unchanged, or erased as an entry says. `gone`: hashes of the
/// recordings that nothing needs any more.
Recording check_recording(const FiledSession& s, const LedgerPaths& places,
                          const std::set<std::string>& gone, LedgerCheck& out) {
  const std::string path = places.session(s.file_sha256);
  if (s.motion_erased_by) {
    if (std::filesystem::exists(path) && gone.contains(s.file_sha256))
      out.findings.push_back(
          finding<FindingKind::erased_still_there>(*s.motion_erased_by, path).in_entry(s.seq));
    return Recording::erased;
  }
  if (!std::filesystem::exists(path)) {
    if (erased_by(read_ledger(places).erased, s.seq, Part::motion))
      return Recording::erased;  // meanwhile
    out.findings.push_back(finding<FindingKind::file_gone>(path).in_entry(s.seq));
    return Recording::changed;
  } else if (to_hex(sha256(read_file(path))) != s.file_sha256) {
    out.findings.push_back(finding<FindingKind::file_changed>(path).in_entry(s.seq));
    return Recording::changed;
  }
  return Recording::there;
}

pool::Work work_on(const LedgerPaths& places, const Registry& registry, pool::What what) {
  std::set<std::string> names;
  for (const auto& s : registry.sessions)
    if (!s.motion_erased_by && (what != pool::What::verify || s.findings.empty()))
      names.insert(fmt::format("sessions/{}.cavum", s.file_sha256));
  pool::Work work;
  work.what = what;
  work.folder = places.folder;
  work.sessions.assign(names.begin(), names.end());
  return work;
}

/// All of them, and how many could not be shown again.
void check_recordings(const LedgerPaths& places, const LedgerContent& content,
                      const Registry& registry, const pool::Maker& by, LedgerCheck& out) {
  std::vector<const FiledSession*> replayed;
  std::size_t filed_with_findings = 0, erased = 0;
  const auto gone = erased_recordings(content);
  for (const auto& s : registry.sessions) {
    try {
      const Recording recording = check_recording(s, places, gone, out);
      erased += recording == Recording::erased ? 1 : 0;
      if (recording == Recording::there && s.findings.empty()) replayed.push_back(&s);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      out.findings.push_back(
          finding<FindingKind::file_unreadable>(message_from(e)).in_entry(s.seq));
    }
    filed_with_findings += s.findings.empty() ? 0 : 1;
    for (const auto other : s.contested_by)
      if (other > s.seq)
        out.remarks.push_back((s.doubtful() && registry.chosen_instead_of(s) == nullptr
                                   ? finding<FindingKind::contested_open>(other)
                                   : finding<FindingKind::contested>(other))
                                  .in_entry(s.seq));
  }
  const pool::Work work = work_on(places, registry, pool::What::verify);
  if (by && !work.sessions.empty()) {
    const pool::Made made = by(work);
    for (const FiledSession* s : replayed) {
      const auto at = std::lower_bound(work.sessions.begin(), work.sessions.end(),
                                       fmt::format("sessions/{}.cavum", s->file_sha256));
      compare_with_line(*s, made.lines[static_cast<std::size_t>(at - work.sessions.begin())], out);
    }
  }
  if (by && filed_with_findings > 0)
    out.not_checked.push_back(finding<FindingKind::not_simulated_unsound>(filed_with_findings));
  if (erased > 0) out.not_checked.push_back(finding<FindingKind::not_simulated_erased>(erased));
}

/// Files that no entry knows.
void say_strangers(const LedgerPaths& places, const Registry& registry, LedgerCheck& out) {
  std::set<std::string> filed;
  for (const auto& s : registry.sessions) filed.insert(s.file_sha256 + ".cavum");
  std::error_code none;
  for (const auto& f : std::filesystem::directory_iterator(places.folder + "/sessions", none))
    if (!filed.contains(f.path().filename().string()))
      out.remarks.push_back(finding<FindingKind::foreign>(f.path().string()));
}

/// Who has a ticket and is no longer among the identities, though no entry says that he was
/// forgotten.
void say_missing(const LedgerPaths& places, const LedgerContent& content, Identities& identities,
                 LedgerCheck& out) {
  std::map<std::string, std::uint64_t> missing;  // and the entry of the first ticket
  for (const IssuedTicket& t : read_registry(content).tickets)
    if (!identities.of_pseudonym(t.ticket.candidate))
      missing.try_emplace(t.ticket.candidate, t.seq);
  if (missing.empty()) return;
  for (const auto& e : read_ledger(places).entries)  // again: somebody may be forgotten meanwhile
    if (const auto* forgotten = e.as<ForgetEntry>()) missing.erase(forgotten->candidate);
  for (const auto& [who, seq] : missing)
    out.findings.push_back(finding<FindingKind::identity_missing>(who, seq));
}

}  // namespace

pool::Work filed_work(const LedgerPaths& places, pool::What what) {
  return work_on(places, read_registry(read_ledger(places)), what);
}

LedgerCheck check_ledger(const LedgerPaths& places, bool replay) {
  LedgerCheck check = check_ledger(
      places, replay ? pool::Maker([](const pool::Work& work) { return pool::by_threads(work); })
                     : pool::Maker());
  append(check.findings, check.not_made);
  return check;
}

LedgerCheck check_ledger(const LedgerPaths& places, const pool::Maker& by) {
  const LedgerContent content = read_ledger(places);
  LedgerCheck out{content.findings, {}, content.remarks, {}};
  check_times(content, out.remarks);
  const Registry registry = read_registry(content);
  append(out.findings, registry.findings);
  for (const auto& r : restores_of(content)) out.remarks.push_back(finding_of(r));
  append(out.remarks, registry.remarks);
  say_not_checked(content, registry, static_cast<bool>(by), out);
  check_recordings(places, content, registry, by, out);
  if (!content.id.empty()) say_strangers(places, registry, out);
  return out;
}

void check_owner(LedgerCheck& check, const LedgerPaths& places, const LedgerContent& content,
                 const std::string& key_path, const std::string& public_key_path) {
  const bool unread = content.public_key.empty();
  bool known = false;
  if (std::filesystem::exists(next_key_path(key_path)))
    check.findings.push_back(finding<FindingKind::key_half_replaced>(next_key_path(key_path)));
  const auto must_be_ours = [&](const std::string& key, const std::string& path) {
    if (!unread && key != content.public_key)
      check.findings.push_back(finding<FindingKind::other_school>(path, content.public_key, key));
  };
  if (std::filesystem::exists(public_key_path)) {
    known = true;
    try {
      std::string text = read_text_file(public_key_path);
      while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
        text.pop_back();
      must_be_ours(parse_public_key(text, public_key_path), public_key_path);
    } catch (const Error&) {
      check.findings.push_back(finding<FindingKind::key_unreadable>(public_key_path));
    }
  }
  std::optional<SigningKey> key;
  if (std::filesystem::exists(key_path)) {
    known = true;
    try {
      key = load_school_key(key_path);
      must_be_ours(to_hex(key->public_key), key_path);
    } catch (const Error& e) {
      check.not_checked.push_back(finding<FindingKind::key_unusable>(e.message()));
    }
  }
  if (unread) {
    check.not_checked.push_back(finding<FindingKind::school_unread>());
    return;
  }
  if (!known)
    check.not_checked.push_back(finding<FindingKind::school_not_named>(key_path, public_key_path));
  if (!std::filesystem::exists(places.identities())) {
    check.not_checked.push_back(finding<FindingKind::identities_not_there>(places.identities()));
  } else if (!key || to_hex(key->public_key) != content.public_key) {
    check.not_checked.push_back(finding<FindingKind::identities_key_missing>());
  } else {
    try {
      Identities identities(places.identities());
      append(check.findings, identities.check(*key));
      for (const auto& e : content.entries)
        if (const auto* forgotten = e.as<ForgetEntry>();
            forgotten != nullptr && identities.of_pseudonym(forgotten->candidate))
          check.findings.push_back(
              finding<FindingKind::forgotten_still_named>(forgotten->candidate, e.seq));
      say_missing(places, content, identities, check);
    } catch (const Error& e) {
      check.findings.push_back(finding<FindingKind::read_failed>(e.message()));
    }
  }
}

}  // namespace cavum::records
