// `cavum ledger verify | show`: does a ledger hold, and what is in it.
#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "grading/ledger/check_ledger.h"
#include "grading/ledger/cosign.h"
#include "grading/ledger/exports.h"
#include "grading/ledger/registry.h"
#include "ui/parts/print_json.h"
#include "ui/verbs/ledger_verbs_parts.h"

namespace cavum::ui {

using nlohmann::json;

int ledger_verify(const LedgerOptions& o) {
  const ledger::LedgerPlaces places{o.folder};
  if (!o.key.empty()) static_cast<void>(ledger::load_school_key(o.key));  // one that was named has to be there
  const pool::Maker by = o.replay ? pool::Maker([&](const pool::Work& work) { return make_lines(work, o.pool); }) : pool::Maker();
  ledger::LedgerCheck check = ledger::check_ledger(places, by);
  check.findings.insert(check.findings.end(), check.not_made.begin(), check.not_made.end());
  const ledger::LedgerContent content = ledger::read_ledger(places);
  ledger::check_owner(check, places, content, o.key.empty() ? ledger::school_key_path() : o.key, ledger::school_public_key_path());
  for (const auto& path : o.receipts) {
    const json receipt = parse_json_or_null(read_text_file(path));
    for (auto& f : ledger::check_receipt(receipt, content.public_key, &content)) check.findings.push_back(fmt::format("{}: {}", path, f));
  }
  const auto cosigners = cosigners_of(o);
  ledger::check_cosignatures(content, cosigners, check.findings, check.not_checked);
  for (const auto& path : o.cosigned) {
    const auto note = ledger::check_cosigned(read_text_file(path), cosigners, content);
    for (const auto& f : note.findings) check.findings.push_back(fmt::format("{}: {}", path, f));
    for (const auto& n : note.not_checked) check.not_checked.push_back(fmt::format("{}: {}", path, n));
  }
  if (!o.results.empty())
    for (auto& f : ledger::check_results(read_text_file(o.results), content.public_key, &content))
      check.findings.push_back(fmt::format("{}: {}", o.results, f));
  if (o.as_json) {
    print_json(json{{"verified", check.findings.empty()},
                    {"ledger", content.id},
                    {"school", content.school},
                    {"public_key", content.public_key},
                    {"entries", content.entries.size()},
                    {"findings", check.findings},
                    {"not_checked", check.not_checked},
                    {"remarks", check.remarks}});
  } else {
    std::cout << one_line(o.folder) << ": " << (check.findings.empty() ? "verified" : "NOT VERIFIED") << ", " << content.entries.size()
              << (content.entries.size() == 1 ? " entry" : " entries") << (content.school.empty() ? "" : " of " + one_line(content.school))
              << (content.public_key.empty() ? ", whose they are could not be read" : ", key " + one_line(content.public_key)) << "\n";
    for (const auto& f : check.findings) std::cout << "  - " << one_line(f) << "\n";
    for (const auto& n : check.not_checked) std::cout << "  not checked: " << one_line(n) << "\n";
    for (const auto& r : check.remarks) std::cout << "  (" << one_line(r) << ")\n";
  }
  return check.findings.empty() ? 0 : 1;
}

namespace {

const char* state_in_words(const ledger::FiledSession& s) {
  if (s.made_up_by) return "counts no more";
  return s.released ? "released" : s.shown_seq != 0 ? "pending, an earlier result is out" : "pending";
}

}  // namespace

int ledger_show(const LedgerOptions& o) {
  const ledger::LedgerContent content = ledger::read_ledger({o.folder});
  const ledger::Registry registry = ledger::read_registry(content);
  std::vector<std::string> findings = content.findings;
  findings.insert(findings.end(), registry.findings.begin(), registry.findings.end());
  if (!findings.empty())
    std::cerr << "cavum: " << one_line(o.folder) << ": WARNING: this ledger does not hold, and what it shows may be made up (" << findings.size()
              << (findings.size() == 1 ? " finding" : " findings") << ", first: " << one_line(findings.front()) << "); run `cavum ledger verify "
              << one_line(o.folder) << " --replay`\n";
  const int code = findings.empty() ? 0 : 1;
  if (o.as_json) {
    json sessions = json::array();
    for (const auto& s : registry.sessions)
      sessions.push_back({{"seq", s.seq},
                          {"candidate", s.candidate},
                          {"scenario", s.scenario_id},
                          {"verdict", s.result->is_object() ? s.result->value("verdict", "") : ""},
                          {"points", s.result->is_object() ? s.result->at("score").at("points") : json()},
                          {"released", s.released},
                          {"shown", s.shown_seq != 0},
                          {"motion_erased", s.motion_erased_by.has_value()},
                          {"result_erased", s.result_erased_by.has_value()},
                          {"simulated", s.simulated},
                          {"regraded", s.result_seq != s.seq},
                          {"contested_by", s.contested_by},
                          {"chosen", s.chosen},
                          {"findings", s.findings}});
    print_json(json{{"ledger", content.id},
                    {"entries", content.entries.size()},
                    {"tickets", registry.tickets.size()},
                    {"sessions", sessions},
                    {"findings", findings}});
    return code;
  }
  const auto open = std::count_if(registry.tickets.begin(), registry.tickets.end(),
                                  [](const ledger::IssuedTicket& t) { return !t.used_by && !t.cancelled_by && !t.made_up_by; });
  std::printf("ledger %s: %zu entries, %zu tickets (%td not used), %zu sessions\n",
              content.id.empty() ? "whose id could not be read" : one_line(content.id).c_str(), content.entries.size(), registry.tickets.size(), open,
              registry.sessions.size());
  for (const auto& s : registry.sessions)
    std::printf("%6llu  %-16s %-28s %-7s %6s  %s%s%s\n", static_cast<unsigned long long>(s.seq), one_line(s.candidate).c_str(),
                one_line(s.scenario_id).c_str(),
                one_line(s.result->is_object() ? s.result->value("verdict", "")
                         : s.result_erased_by  ? "erased"
                                               : "?")
                    .c_str(),
                s.result->is_object() ? fixed(s.result->at("score").at("points").get<double>(), 1).c_str() : "-", state_in_words(s),
                (std::string(s.result_seq != s.seq ? ", regraded" : "") + (s.simulated.empty() ? "" : ", simulated")).c_str(),
                ((s.findings.empty() ? std::string() : ", with findings") +
                 (s.contested_by.empty() ? "" : fmt::format(", contested by entry {}", s.contested_by.back())) + (s.chosen ? ", chosen" : ""))
                    .c_str());
  return code;
}

}  // namespace cavum::ui
