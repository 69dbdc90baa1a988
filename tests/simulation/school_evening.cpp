// What is compared at the end of a day with what was acknowledged in its course.
#include <algorithm>
#include <filesystem>

#include "engine/base/file.h"
#include "grading/records/backup.h"
#include "grading/records/check_ledger.h"
#include "grading/records/erasure.h"
#include "grading/records/history.h"
#include "grading/records/identities.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_key.h"
#include "grading/records/registry.h"
#include "grading/records/school_keys.h"
#include "grading/records/witness.h"
#include "tests/engine/support/basics.h"
#include "tests/simulation/school_day.h"

namespace cavum::simulation {
namespace {

using nlohmann::json;
using testing_basics::text_of;

const std::string k_ledger = "/sim/office/ledger", k_backup = "/sim/office/backup";

std::int64_t utc_in(const std::string& entry) {
  return json::parse(entry).at("utc_ns").get<std::int64_t>();
}

/// Whether a remark is of this kind, on an entry from `first` to `last`.
bool names_clock(const records::Findings& remarks, records::FindingKind kind, std::uint64_t first,
                 std::uint64_t last) {
  return std::any_of(remarks.begin(), remarks.end(), [&](const records::Finding& r) {
    return r.kind == kind && r.entry && *r.entry >= first && *r.entry <= last;
  });
}

}  // namespace

void SchoolDay::check_end() {
  records::LedgerContent content;
  world_.calmly("office", [&] {
    content = records::read_ledger({k_ledger});
    records::remove_erased_recordings(content,
                                      {k_ledger});  // an erasure that was cut off is a finding
                                                    // until somebody runs `cavum ledger erase`
    const records::LedgerCheck check = records::check_ledger({k_ledger}, false);
    if (!check.findings.empty()) wrong("the ledger does not hold: " + text_of(check.findings));
    if (!content.witnessed) wrong("the witness is gone");
    check_entries(content);
    check_clocks(check.remarks);
    check_identities();
    check_backup();
    records::Findings findings, not_checked;
    records::check_cosignatures(content, records::read_cosigners(records::known_cosigners_path()),
                                findings, not_checked);
    if (!findings.empty() || !not_checked.empty())
      wrong("cosignatures: " + text_of(findings) + text_of(not_checked));
  });
  check_cosigner(content);
  world_.calmly("office", [&] {  // and work goes on
    records::Ledger ledger(k_ledger, records::load_school_key(records::school_key_path()));
    ledger.append([](const records::LedgerContent&) { return records::ForgetEntry{"nobody", {}}; });
    entered(ledger, ledger.content().entries.size() - 1);
    const records::LedgerCheck check = records::check_ledger({k_ledger}, false);
    if (!check.findings.empty())
      wrong("after the day the ledger does not go on: " + text_of(check.findings));
  });
  counts_["acknowledged"] += entries_.size();
  if (replaces_key_ && !loses_ledger_) replace_key();
  if (loses_ledger_ && backed_up_) restore_from_backup();
}

void SchoolDay::check_entries(const records::LedgerContent& content) {
  records::Findings findings;
  const auto witnessed = records::read_witness(content.id, findings);
  if (!findings.empty()) wrong("the witness: " + text_of(findings));
  std::set<std::uint64_t> seen;
  for (const Entered& e : entries_) {
    const std::string name = "entry " + std::to_string(e.seq);
    if (!seen.insert(e.seq).second) wrong(name + " was acknowledged to two people");
    if (e.seq >= content.entries.size() || content.entries[e.seq].text != e.text) {
      wrong(name + ", which was acknowledged, is lost: " + e.text.substr(0, 80));
      continue;
    }
    if (const auto why = records::check_receipt(e.receipt, content.public_key, &content);
        !why.empty())
      wrong(name + ": its receipt does not hold: " + text_of(why));
    if (std::none_of(witnessed.begin(), witnessed.end(),
                     [&](const records::Checkpoint& p) { return p.size == e.seq + 1; }))
      wrong(name + ", which was acknowledged, is not with the witness");
  }
  for (const auto& [path, receipt] : receipts_) try {
      if (json::parse(read_text_file(path)) != receipt)
        wrong(path + ": another receipt than was written");
    } catch (const std::exception& e) {
      wrong("a receipt that was written is lost: " + std::string(e.what()));
    }
  for (const auto& hash : erased_)
    if (std::filesystem::exists(records::LedgerPaths{k_ledger}.session(hash)))
      wrong("a recording that was erased is there: " + hash);
  for (const auto& [hash, who] : filed_files_) try {
      if (to_erase_.contains(hash)) continue;
      if (to_hex(sha256(read_file(records::LedgerPaths{k_ledger}.session(hash)))) != hash)
        wrong("a filed session's file is not what was filed: " + hash);
    } catch (const std::exception& e) {
      wrong("a filed session's file is lost: " + std::string(e.what()));
    }
  const records::Registry registry = records::read_registry(content);
  std::set<std::string> nonces;
  for (const auto& s : registry.sessions)
    if (s.findings.empty() && !nonces.insert(s.nonce).second)
      wrong("a ticket was used twice: entry " + std::to_string(s.seq));
  for (const auto& [size, line] : kept_cosignatures_)
    if (std::none_of(content.cosignatures.begin(), content.cosignatures.end(),
                     [&, s = size, l = line](const records::Cosignature& c) {
                       return c.size == s && records::signature_line(c.by) == l;
                     }))
      wrong("a cosignature that was kept is lost, under " + std::to_string(size) + " entries");
}

void SchoolDay::check_clocks(const records::Findings& remarks) {
  std::vector<std::pair<std::uint64_t, std::int64_t>> times;
  for (const Entered& e : entries_) times.emplace_back(e.seq, utc_in(e.text));
  std::sort(times.begin(), times.end());
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    for (std::size_t j = i + 1; j < times.size(); ++j)
      if (times[j].second < times[i].second) {
        ++counts_["ledger's clock set back"];
        if (!names_clock(remarks, records::FindingKind::clock_set_back, times[i].first + 1,
                         times[j].first))
          wrong("the clock was set back between entries " + std::to_string(times[i].first) +
                " and " + std::to_string(times[j].first) + ", and nothing says so");
      }
  constexpr std::int64_t k_patience_ns = 300'000'000'000;
  for (const auto& [seq, utc_ns] : times)
    if (utc_ns > k_begin_utc_ns + world_.true_ns() + k_patience_ns) {
      ++counts_["ledger's clock ahead"];
      if (!names_clock(remarks, records::FindingKind::clock_ahead, seq, seq))
        wrong("entry " + std::to_string(seq) +
              " bears a time that is still to come, and nothing says so");
    }
}

void SchoolDay::check_identities() {
  records::Identities identities(records::LedgerPaths{k_ledger}.identities());
  for (const auto& [id, pseudonym] : known_)
    if (!to_forget_.contains(pseudonym) && !identities.of_pseudonym(pseudonym))
      wrong("an identity that was enrolled is lost: " + id + " " + pseudonym);
  for (const auto& pseudonym : forgotten_)
    if (identities.of_pseudonym(pseudonym))
      wrong("an identity that was forgotten is known: " + pseudonym);
  if (const auto why = identities.check(records::load_school_key(records::school_key_path()));
      !why.empty())
    wrong(text_of(why));
}

void SchoolDay::check_backup() {
  if (!backed_up_) return;
  const records::RestorePlan plan = records::plan_restore(k_backup, {}, {});
  if (!plan.findings.empty()) return wrong("the backup does not hold: " + text_of(plan.findings));
  for (const auto& hash : plan.missing_sessions) wrong("the backup lacks a session: " + hash);
  const records::History history(plan.content);
  const auto size = static_cast<std::size_t>(backed_up_->size);
  if (history.roots().size() < size || history.roots()[size - 1] != backed_up_->root)
    wrong("a backup of " + std::to_string(size) + " entries was acknowledged, and has " +
          std::to_string(history.roots().size()));
  if (!plan.identities) wrong("the backup's identities are lost");
}

void SchoolDay::check_cosigner(const records::LedgerContent& content) {
  if (cosigned_size_ == 0) return;
  world_.calmly("cosigner", [&] {
    records::Cosigner cosigner{"cosigner.example",
                               load_signing_key("/sim/cosigner/home/cosigner.key", "cosigner"),
                               records::cosigner_memory_path(), morning_.promise.public_key};
    // an older state than it has signed must be refused: whoever restores an old copy would ask for
    // just that
    records::LedgerContent older = content;
    older.entries.resize(std::min<std::size_t>(older.entries.size(), cosigned_size_ - 1));
    std::erase_if(older.checkpoints,
                  [&](const records::Checkpoint& p) { return p.size > older.entries.size(); });
    if (records::cosign(cosigner, records::cosign_request(older, 0), "request", 1).findings.empty())
      wrong("the cosigner forgot what it had signed");
    std::string words;
    try {
      const records::Cosigned now =
          records::cosign(cosigner, records::cosign_request(content, cosigned_size_), "request", 1);
      words = text_of(now.findings);
    } catch (const Error& e) {  // it signed a later state, and was killed before it could say so
      if (!(e.code() == records::LedgerError::another_state)) words = e.what();
    }
    if (!words.empty()) wrong("the cosigner refuses the honest ledger: " + words);
  });
  world_.calmly("office", [&] {
    for (const auto& note : notes_)
      if (const auto c = records::check_cosigned(
              note, records::read_cosigners(records::known_cosigners_path()), content);
          !c.findings.empty())
        wrong("a cosigned note does not hold: " + text_of(c.findings));
  });
}

void SchoolDay::replace_key() {
  bool replaced = false;
  const auto replace = [&] {
    static_cast<void>(
        records::replace_school_key(k_ledger, records::school_key_path(), 0, "yearly"));
  };
  if (interrupt_key_ > 0) {
    world_.plan({world_.calls() + interrupt_key_, Event::Kind::power_cut, "office", 0});
    world_.start("office", "keeper", [&] {
      try {
        replace();
        replaced = true;
      } catch (
          const std::exception& e) {  // what the day had drawn for later may come now: a full disk
        if (!world_.process().computer->had_faults)
          wrong(std::string("replacing the key: ") + e.what());
      }
    });
    world_.run([](Process&) {});
    put_right();
  }
  if (!replaced) world_.calmly("office", replace);
  ++counts_[replaced || interrupt_key_ == 0 ? "key replaced" : "key replaced after a power cut"];
  world_.cut_power(world_.computer("office"));
  world_.calmly("office", [&] {
    const records::LedgerCheck check = records::check_ledger({k_ledger}, false);
    if (!check.findings.empty())
      wrong("after the key was replaced the ledger does not hold: " + text_of(check.findings));
    const records::LedgerContent content = records::read_ledger({k_ledger});
    check_entries(content);
    check_identities();
    if (content.keys.size() < 2) wrong("the key was replaced, and the ledger does not know it");
    records::Ledger ledger(k_ledger, records::load_school_key(records::school_key_path()));
    ledger.append([](const records::LedgerContent&) { return records::ForgetEntry{"nobody", {}}; });
  });
}

void SchoolDay::restore_from_backup() {
  const auto restore_into = [&](const std::string& folder) {
    std::vector<std::string> paths;
    for (const auto& [path, receipt] : receipts_) paths.push_back(path);
    const records::RestorePlan plan = records::plan_restore(k_backup, paths, {});
    if (!plan.findings.empty())
      return wrong("the backup cannot be restored: " + text_of(plan.findings));
    records::restore(k_backup, folder, plan, plan.last_seen ? "the disk is broken" : "",
                     records::load_school_key(records::school_key_path()));
  };
  std::string folder = "/sim/office/restored";
  if (interrupt_restore_ > 0) {
    bool restored = false;
    world_.plan({world_.calls() + interrupt_restore_, Event::Kind::power_cut, "office", 0});
    world_.start("office", "restorer", [&] {
      try {
        restore_into(folder);
        restored = true;
      } catch (
          const std::exception& e) {  // what the day had drawn for later may come now: a full disk
        if (!world_.process().computer->had_faults) wrong(std::string("restoring: ") + e.what());
      }
    });
    world_.run([](Process&) {});
    put_right();
    if (!restored) folder += "-2";
    if (restored) world_.cut_power(world_.computer("office"));
    ++counts_[restored ? "restored" : "restore interrupted"];
    if (!restored) world_.calmly("office", [&] { restore_into(folder); });
  } else {
    world_.calmly("office", [&] { restore_into(folder); });
    world_.cut_power(world_.computer("office"));
    ++counts_["restored"];
  }
  world_.calmly("office", [&] {
    const records::LedgerContent content = records::read_ledger({folder});
    const records::LedgerCheck check = records::check_ledger({folder}, false);
    if (!check.findings.empty())
      wrong("the restored ledger does not hold: " + text_of(check.findings));
    const records::History history(content);
    for (const Entered& e : entries_) {
      if (e.seq < backed_up_->size) {
        if (e.seq >= content.entries.size() || content.entries[e.seq].text != e.text)
          wrong("entry " + std::to_string(e.seq) + " was in the backup, and is not restored");
        continue;
      }
      if (e.seq < content.entries.size() && content.entries[e.seq].text == e.text) continue;
      const records::Checkpoint seen = records::checkpoint_in(
          e.receipt.at("checkpoint"), content.id, content.public_key, "receipt");
      if (history.recorded_loss(seen) == nullptr)
        wrong("entry " + std::to_string(e.seq) + " is lost, and no restore entry says so");
    }
    records::Ledger ledger(folder, records::load_school_key(records::school_key_path()));
    ledger.append([](const records::LedgerContent&) { return records::ForgetEntry{"nobody", {}}; });
  });
}

}  // namespace cavum::simulation
