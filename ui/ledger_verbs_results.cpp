// `cavum ledger release | regrade | export | candidates | forget`: what becomes of the results.
#include <algorithm>
#include <iostream>

#include "engine/base/file.h"
#include "grading/ledger/candidate_id.h"
#include "grading/ledger/exports.h"
#include "grading/ledger/regrade.h"
#include "grading/result_json.h"
#include "grading/session_input.h"
#include "ui/ledger_verbs_parts.h"
#include "ui/own_places.h"
#include "ui/print_json.h"

namespace cavum {

using nlohmann::json;

void ledger_release(const LedgerOptions& o) {
  if (!o.all && o.chosen.empty()) throw Error("cavum ledger release", "needs to know whose results", "give --all, or --candidate for each");
  Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  std::vector<std::string> wanted = o.chosen;
  for (const auto& w : wanted) require_candidate_id("--candidate", w);
  for (auto& w : wanted)
    if (const auto known = identities.of_id(w)) w = known->pseudonym;
  std::size_t kept_back = 0;
  std::vector<std::string> unknown = wanted;
  const Registry before = read_registry(ledger.content());
  json results = json::array();
  for (const auto& s : before.sessions) {
    const bool chosen = o.all || std::find(wanted.begin(), wanted.end(), s.candidate) != wanted.end();
    unknown.erase(std::remove(unknown.begin(), unknown.end(), s.candidate), unknown.end());
    if (!chosen || s.released) continue;
    if (s.doubtful() && !(o.with_findings && !o.all)) {
      ++kept_back;
      continue;
    }
    results.push_back(s.result_seq);
  }
  if (!unknown.empty()) throw Error("--candidate " + unknown[0], "has no session in this ledger", "see `cavum ledger show " + o.folder + "`");
  if (!results.empty()) ledger.append("release", [&](const LedgerContent&) { return json{{"results", results}}; });
  if (o.as_json)
    print_json(json{{"released", results.size()}, {"kept_back", kept_back}});
  else
    std::cout << results.size() << " results released"
              << (kept_back > 0 ? ", " + std::to_string(kept_back) +
                                      " kept back: filed with findings, or contested by another ending of the same exam (--candidate with "
                                      "--with-findings releases them after an appeal)"
                                : "")
              << "\n";
}

void ledger_regrade(const LedgerOptions& o) {
  if (o.rubric.empty() && o.scenario.empty())
    throw Error("cavum ledger regrade", "needs to know by what", "give --rubric R.toml or --scenario S.toml");
  Ledger ledger(o.folder, key_of(o));
  const Registry registry = read_registry(ledger.content());
  const auto found = std::find_if(registry.sessions.begin(), registry.sessions.end(),
                                  [&](const FiledSession& s) { return static_cast<std::int64_t>(s.seq) == o.session_seq; });
  if (found == registry.sessions.end())
    throw Error("--session " + std::to_string(o.session_seq), "is no session's entry", "see `cavum ledger show " + o.folder + "`");
  const RegradeBasis basis = read_basis(o.rubric, o.scenario);
  const auto graded = load_for_grading(ledger.places().session(found->file_sha256));
  if (auto scenario = scenario_of(basis, o.scenario)) {
    use_scenario(*graded, std::move(*scenario), o.another_task);
    use_rubric(*graded, graded->scenario.rubric);
  }
  if (auto rubric = rubric_of(basis, o.rubric)) use_rubric(*graded, std::move(*rubric));
  const json result = to_json(grade(graded->input(), graded->rubric));
  const auto& entry = enter_regrade(ledger, found->seq, result, basis, o.reason);
  if (o.as_json)
    print_json(
        json{{"seq", entry.seq}, {"before", found->result.value("score", json())}, {"after", result.at("score")}, {"verdict", result.at("verdict")}});
  else
    std::cout << "entry " << entry.seq << ": " << found->result.at("score").at("points") << " points before, " << result.at("score").at("points")
              << " now; the old result stands until the new one is released\n";
}

void ledger_export(const LedgerOptions& o) {
  Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  const Registry registry = read_registry(ledger.content());
  int left_out = 0;
  std::string text;
  if (o.format == "moodle") text = moodle_csv(registry, identities, left_out, o.with_simulated);
  if (o.format == "lti") text = lti_scores(registry, identities, o.with_simulated).dump(2) + "\n";
  if (o.format == "json") text = signed_results(registry, ledger) + "\n";
  if (o.format == "csv") text = tidy_csv(registry);
  require_own_places({{"--out " + o.out, o.out}}, {{"", ledger.places().database()}, {"", ledger.places().identities()}});
  require_new(o, o.out);
  write_text_file(o.out, text);
  std::cout << "written: " << o.out << "\n";
  if (const auto simulated = released_simulated(registry); simulated > 0 && (o.format == "moodle" || o.format == "lti"))
    std::cout << simulated << " released results of simulated operators are "
              << (o.with_simulated ? "in it, marked SIMULATED, under no student's number\n" : "left out (--with-simulated writes them, marked)\n");
  if (left_out > 0) std::cout << left_out << " released results have no candidate that is known by name and are left out\n";
}

void ledger_candidates(const LedgerOptions& o) {
  const Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  json all = json::array();
  for (const auto& i : identities.all()) {
    all.push_back({{"candidate", i.pseudonym}, {"id", i.id}, {"name", i.name}});
    if (!o.as_json) std::cout << i.pseudonym << "  " << i.id << (i.name.empty() ? "" : ", " + i.name) << "\n";
  }
  if (o.as_json) print_json(json{{"candidates", all}});
}

void ledger_forget(const LedgerOptions& o) {
  require_candidate_id("--candidate", o.candidate);
  Ledger ledger(o.folder, key_of(o));
  Identities identities(ledger.places().identities());
  const auto known = identities.of_id(o.candidate);
  const std::string pseudonym = known ? known->pseudonym : o.candidate;
  if (!identities.of_pseudonym(pseudonym))
    throw Error("--candidate " + o.candidate, "is not among the identities", "nothing is known of that candidate, or it was forgotten before");
  ledger.append("forget", [&](const LedgerContent&) { return json{{"candidate", pseudonym}}; });
  identities.forget(pseudonym);
  std::cout << pseudonym << ": the identity is removed; sessions, results and proofs stay\n";
}

}  // namespace cavum
