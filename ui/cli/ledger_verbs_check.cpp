// `cavum ledger verify | show`: does a ledger hold, and what is in it.
#include <fmt/core.h>

#include <algorithm>

#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "grading/records/check_ledger.h"
#include "grading/records/cosign.h"
#include "grading/records/exports.h"
#include "grading/records/registry.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

int ledger_verify(const LedgerOptions& o) {
  const records::LedgerPaths places{o.folder};
  if (!o.key.empty())
    static_cast<void>(records::load_school_key(o.key));  // one that was named has to be there
  const pool::Maker by =
      o.replay ? pool::Maker([&](const pool::Work& work) { return make_lines(work, o.pool); })
               : pool::Maker();
  records::LedgerCheck check = records::check_ledger(places, by);
  append(check.findings, check.not_made);
  const records::LedgerContent content = records::read_ledger(places);
  records::check_owner(check, places, content, o.key.empty() ? records::school_key_path() : o.key,
                       records::school_public_key_path());
  for (const auto& path : o.receipts) {
    const json receipt = parse_json_or_null(read_text_file(path));
    append(check.findings,
           named(path, records::check_receipt(receipt, content.public_key, &content)));
  }
  const auto cosigners = cosigners_of(o);
  records::check_cosignatures(content, cosigners, check.findings, check.not_checked);
  for (const auto& path : o.cosigned) {
    const auto note = records::check_cosigned(read_text_file(path), cosigners, content);
    append(check.findings, named(path, note.findings));
    append(check.not_checked, named(path, note.not_checked));
  }
  if (!o.results.empty())
    append(check.findings, named(o.results, records::check_results(read_text_file(o.results),
                                                                   content.public_key, &content)));
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
    const auto n = static_cast<std::int64_t>(content.entries.size());
    const Message entries = content.school.empty()
                                ? msgn("{} entry", "{} entries", n, n)
                                : msgn("{} entry of {}", "{} entries of {}", n, n, content.school);
    const Message whose = content.public_key.empty()
                              ? msg("{}, whose they are could not be read", entries)
                              : msg("{}, key {}", entries, content.public_key);
    say(check.findings.empty() ? msg("{}: verified, {}", o.folder, whose)
                               : msg("{}: NOT VERIFIED, {}", o.folder, whose));
    for (const auto& f : check.findings) say(msg("- {}", f.message()), 2);
    for (const auto& m : check.not_checked) say(msg("not checked: {}", m.message()), 2);
    for (const auto& r : check.remarks) say(msg("({})", r.message()), 2);
  }
  return check.findings.empty() ? 0 : 1;
}

namespace {

Message state_in_words(const records::FiledSession& s) {
  if (s.made_up_by) return msg("counts no more");
  return s.released         ? msg("released")
         : s.shown_seq != 0 ? msg("pending, an earlier result is out")
                            : msg("pending");
}

/// "released, regraded, with findings"
List all_of_it(const records::FiledSession& s) {
  List said{{state_in_words(s)}, false};
  if (s.result_seq != s.seq) said.items.push_back(msg("regraded"));
  if (!s.simulated.empty()) said.items.push_back(msg("simulated"));
  if (!s.findings.empty()) said.items.push_back(msg("with findings"));
  if (!s.contested_by.empty())
    said.items.push_back(msg("contested by entry {}", s.contested_by.back()));
  if (s.chosen) said.items.push_back(msg("chosen"));
  return said;
}

}  // namespace

int ledger_show(const LedgerOptions& o) {
  const records::LedgerContent content = records::read_ledger({o.folder});
  const records::Registry registry = records::read_registry(content);
  records::Findings findings = content.findings;
  append(findings, registry.findings);
  if (!findings.empty())
    say_error(msg(
        "{0}: WARNING: this ledger does not hold, and what it shows may be made up (findings: {1}, first: {2}); run `cavum ledger verify {0} "
        "--replay`",
        o.folder, findings.size(), findings.front().message()));
  const int code = findings.empty() ? 0 : 1;
  if (o.as_json) {
    json sessions = json::array();
    for (const auto& s : registry.sessions)
      sessions.push_back(
          {{"seq", s.seq},
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
                                  [](const records::IssuedTicket& t) {
                                    return !t.used_by && !t.cancelled_by && !t.made_up_by;
                                  });
  const Message id = content.id.empty() ? msg("whose id could not be read") : msg("{}", content.id);
  say(msg("ledger {}: {} entries, {} tickets ({} not used), {} sessions", id,
          content.entries.size(), registry.tickets.size(), open, registry.sessions.size()));
  Lines rows;
  for (const auto& s : registry.sessions) {
    const bool there = s.result->is_object();
    rows.row(
        {msg("{}", s.seq), Name{s.candidate}, Name{s.scenario_id},
         there                ? msg("{}", Term{s.result->value("verdict", "")})
         : s.result_erased_by ? msg("erased")
                              : msg("?"),
         there ? msg("{}", as_points(s.result->at("score").at("points").get<double>())) : msg("-"),
         msg("{}", all_of_it(s))},
        2);
  }
  say(rows);
  return code;
}

}  // namespace cavum::ui
