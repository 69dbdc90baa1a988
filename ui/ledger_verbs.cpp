// `cavum ledger`: tickets, filing, release and export of results, and what holds of them.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/ledger/exports.h"
#include "grading/ledger/filing.h"
#include "grading/ledger/identities.h"
#include "grading/ledger/issue.h"
#include "grading/result_json.h"
#include "grading/session_input.h"
#include "scenarios/exam.h"
#include "ui/grant_options.h"
#include "ui/own_places.h"
#include "ui/print_json.h"
#include "ui/session_files.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

using nlohmann::json;

struct Options {
  std::string folder, key, school = "school", scenario, candidate, name, candidates, from, until, out, tooth, rubric, model = "consistent", format,
                           receipt, reason;
  std::vector<std::string> sessions, chosen;
  Grant grant;
  std::int64_t session_seq = -1;
  bool as_json = false, without_ticket = false, with_findings = false, simulated = false, all = false, replay = false, overwrite = false,
       another_task = false;
};

SigningKey key_of(const Options& o) { return load_school_key(o.key.empty() ? school_key_path() : o.key); }

void init(const Options& o) {
  if (o.folder.empty()) throw Error("cavum ledger init", "names no folder", "name one for the ledger");
  const SigningKey key = load_school_key(o.key.empty() ? school_key_path() : o.key, true);
  Ledger::create(o.folder, o.school, key);
  static_cast<void>(Identities(LedgerPlaces{o.folder}.identities(), true));
  const std::string known = school_public_key_path();
  if (!std::filesystem::exists(known)) write_text_file(known, to_hex(key.public_key) + "\n");
  const LedgerContent content = read_ledger({o.folder});
  if (o.as_json) {
    print_json(json{{"ledger", content.id}, {"public_key", content.public_key}, {"folder", o.folder}});
    return;
  }
  std::cout << "ledger " << content.id << " in " << o.folder << "\nthe school's public key: " << content.public_key
            << "\nkeep apart from it, and in a backup: " << (o.key.empty() ? school_key_path() : o.key) << " (signs), " << witness_path(content.id)
            << " (shows when an older copy is put back)\nto each station's own folder goes a copy of " << known << "\n";
}

/// A file that is not there yet, unless --overwrite allows it.
void require_new(const Options& o, const std::string& path) {
  require_writable(path);
  const LedgerPlaces places{o.folder};
  std::error_code none;
  for (const std::string& kept : {places.database(), places.identities(), school_key_path(), school_public_key_path(), o.key,
                                  station_path("station.key"), station_path("used_tickets")})
    if (!kept.empty() && std::filesystem::weakly_canonical(path, none) == std::filesystem::weakly_canonical(kept, none))
      throw Error("--out " + path, "holds a key, identities or entries", "name another file: it is never written over");
  if (!o.overwrite && std::filesystem::exists(path)) throw Error("--out " + path, "is there already", "name another file, or add --overwrite");
}

/// The ledger's identities, none of them changed by hand.
Identities sound_identities(const Ledger& ledger) {
  Identities identities(ledger.places().identities());
  if (const auto wrong = identities.check(ledger.key()); !wrong.empty())
    throw Error(ledger.places().identities(), wrong[0], "restore the file from its backup: marks would go to somebody else");
  return identities;
}

void issue_tickets(const Options& o) {
  if (o.candidate.empty() == o.candidates.empty())
    throw Error("cavum ledger ticket", "needs to know for whom", "give either --candidate ID or --candidates FILE.csv");
  const std::vector<Person> people =
      o.candidates.empty() ? std::vector<Person>{{o.candidate, o.name}} : parse_people(read_text_file(o.candidates), o.candidates);
  const std::int64_t from = parse_utc(o.from, "--from"), until = parse_utc(o.until, "--until");
  if (until <= from) throw Error("--until", "is not after --from", "give the last moment at which the exam may begin");
  ExamOptions exam;
  exam.tooth_file = o.tooth;
  exam.rubric_file = o.rubric;
  exam.force_model = o.model;
  exam.grant = o.grant;
  const auto setup = prepare_exam(o.scenario, exam);
  Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  const Ticket ticket = promise(*setup, ledger.content(), from, until);
  const bool folder = !o.candidates.empty();
  if (until < read_clocks().utc_ns) std::fprintf(stderr, "cavum: --until %s: is past already\n", o.until.c_str());
  if (folder) std::filesystem::create_directories(o.out);
  json printed = json::array();
  for (const auto& p : people) {
    const std::string candidate = identities.enrol(p.id, p.name, ledger.key()), file = folder ? o.out + "/" + candidate + ".ticket" : o.out;
    require_new(o, file);
    write_text_file(file, issue(ledger, ticket, candidate) + "\n");
    printed.push_back({{"candidate", candidate}, {"id", p.id}, {"name", p.name}, {"file", file}});
    if (!o.as_json) std::cout << candidate << "  " << file << "  " << p.id << (p.name.empty() ? "" : ", " + p.name) << "\n";
  }
  if (o.as_json) print_json(json{{"tickets", printed}});
}

int add(const Options& o) {
  Ledger ledger(o.folder, key_of(o));
  if (!o.out.empty()) {  // before anything is entered: a receipt that cannot be written is no receipt
    std::error_code none;
    std::filesystem::create_directories(o.out, none);
    require_writable(o.out + "/receipt.json");
  }
  json printed = json::array();
  bool all = true;
  for (const auto& path : session_files(o.sessions)) {
    Filing filing;
    try {
      filing = file_session(ledger, path, {o.without_ticket, o.simulated, o.with_findings});
    } catch (const DatabaseError&) {
      throw;  // the disk: what was acknowledged stands, and nothing more can be
    } catch (const Error& e) {
      if (o.sessions.size() == 1 && !std::filesystem::is_directory(o.sessions[0])) throw;
      filing.findings.emplace_back(e.what());
    }
    all = all && filing.seq && filing.findings.empty();
    json one = {{"file", path}, {"filed", filing.seq.has_value()}, {"findings", filing.findings}};
    if (filing.seq) {
      one["receipt"] = ledger.receipt(*filing.seq);
      if (!o.out.empty()) write_text_file(o.out + "/receipt-" + std::to_string(*filing.seq) + ".json", one["receipt"].dump(2) + "\n");
    }
    if (!o.as_json) {
      std::cout << path << ": " << (filing.seq ? "entry " + std::to_string(*filing.seq) : std::string("NOT FILED")) << "\n";
      for (const auto& f : filing.findings) std::cout << "  - " << f << "\n";
    }
    printed.push_back(std::move(one));
  }
  if (o.as_json) print_json(json{{"sessions", printed}});
  return all ? 0 : 1;
}

void write_receipt(const Options& o) {
  const Ledger ledger(o.folder, key_of(o));
  if (o.session_seq < 0 || o.session_seq >= static_cast<std::int64_t>(ledger.content().entries.size()))
    throw Error("--entry " + std::to_string(o.session_seq), "is no entry of this ledger", "see `cavum ledger show " + o.folder + "`");
  require_new(o, o.out);
  write_text_file(o.out, ledger.receipt(static_cast<std::uint64_t>(o.session_seq)).dump(2) + "\n");
  std::cout << "written: " << o.out << "\n";
}

void candidates(const Options& o) {
  const Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  json all = json::array();
  for (const auto& i : identities.all()) {
    all.push_back({{"candidate", i.pseudonym}, {"id", i.id}, {"name", i.name}});
    if (!o.as_json) std::cout << i.pseudonym << "  " << i.id << (i.name.empty() ? "" : ", " + i.name) << "\n";
  }
  if (o.as_json) print_json(json{{"candidates", all}});
}

void release(const Options& o) {
  if (!o.all && o.chosen.empty()) throw Error("cavum ledger release", "needs to know whose results", "give --all, or --candidate for each");
  Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  std::vector<std::string> wanted = o.chosen;
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
    if (!s.findings.empty() && !(o.with_findings && !o.all)) {
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
                                      " kept back: filed with findings (--candidate with --with-findings releases them after an appeal)"
                                : "")
              << "\n";
}

void regrade(const Options& o) {
  if (o.rubric.empty() && o.scenario.empty())
    throw Error("cavum ledger regrade", "needs to know by what", "give --rubric R.toml or --scenario S.toml");
  Ledger ledger(o.folder, key_of(o));
  const Registry registry = read_registry(ledger.content());
  const auto found = std::find_if(registry.sessions.begin(), registry.sessions.end(),
                                  [&](const FiledSession& s) { return static_cast<std::int64_t>(s.seq) == o.session_seq; });
  if (found == registry.sessions.end())
    throw Error("--session " + std::to_string(o.session_seq), "is no session's entry", "see `cavum ledger show " + o.folder + "`");
  const auto graded = load_for_grading(ledger.places().session(found->file_sha256));
  json by = json::object();
  if (!o.scenario.empty()) {
    const std::string text = read_text_file(o.scenario);
    use_scenario(*graded, load_scenario(o.scenario), o.another_task);
    use_rubric(*graded, graded->scenario.rubric);
    by["scenario_sha256"] = to_hex(sha256(text));
  }
  if (!o.rubric.empty()) {
    const std::string text = read_text_file(o.rubric);
    use_rubric(*graded, parse_rubric(text, o.rubric));
    by["rubric_sha256"] = to_hex(sha256(text));
  }
  const json result = to_json(grade(graded->input(), graded->rubric));
  const auto& entry = ledger.append("regrade", [&](const LedgerContent&) {
    return json{{"session", found->seq}, {"result", result}, {"by", by}, {"reason", o.reason}};
  });
  if (o.as_json)
    print_json(
        json{{"seq", entry.seq}, {"before", found->result.value("score", json())}, {"after", result.at("score")}, {"verdict", result.at("verdict")}});
  else
    std::cout << "entry " << entry.seq << ": " << found->result.at("score").at("points") << " points before, " << result.at("score").at("points")
              << " now; the old result stands until the new one is released\n";
}

int verify_all(const Options& o) {
  const LedgerPlaces places{o.folder};
  LedgerCheck check = check_ledger(places, o.replay);
  const LedgerContent content = read_ledger(places);
  // whose ledger is it? the key at hand says so, if there is one
  if (const std::string path = o.key.empty() ? school_key_path() : o.key; !o.key.empty() || std::filesystem::exists(path)) {
    const SigningKey key = load_school_key(path);
    if (to_hex(key.public_key) != content.public_key)
      check.findings.push_back("the ledger is of another school than the key at hand (" + path + ", " + to_hex(key.public_key) + ")");
    else
      for (auto& f : Identities(places.identities()).check(key)) check.findings.push_back(std::move(f));
  } else {
    check.remarks.push_back("the school's key is not at hand: that the ledger is this school's, and its identities unchanged, is not checked");
  }
  if (!content.witnessed) check.remarks.push_back("no witness on this computer: an older copy put back would not be seen here");
  if (!o.receipt.empty()) {
    const json receipt = json::parse(read_text_file(o.receipt), nullptr, false);
    for (auto& f : check_receipt(receipt, content.public_key, &content)) check.findings.push_back(o.receipt + ": " + f);
  }
  if (o.as_json) {
    print_json(json{{"verified", check.findings.empty()},
                    {"ledger", content.id},
                    {"school", content.school},
                    {"public_key", content.public_key},
                    {"entries", content.entries.size()},
                    {"findings", check.findings},
                    {"remarks", check.remarks}});
  } else {
    std::cout << o.folder << ": " << (check.findings.empty() ? "verified" : "NOT VERIFIED") << ", " << content.entries.size() << " entries of "
              << one_line(content.school) << ", key " << content.public_key << "\n";
    for (const auto& f : check.findings) std::cout << "  - " << f << "\n";
    for (const auto& r : check.remarks) std::cout << "  (" << r << ")\n";
  }
  return check.findings.empty() ? 0 : 1;
}

void export_results(const Options& o) {
  Ledger ledger(o.folder, key_of(o));
  Identities identities = sound_identities(ledger);
  const Registry registry = read_registry(ledger.content());
  int left_out = 0;
  std::string text;
  if (o.format == "moodle") text = moodle_csv(registry, identities, left_out);
  if (o.format == "lti") text = lti_scores(registry, identities).dump(2) + "\n";
  if (o.format == "json") text = signed_results(registry, ledger) + "\n";
  if (o.format == "csv") text = tidy_csv(registry);
  require_own_places({{"--out " + o.out, o.out}}, {{"", ledger.places().database()}, {"", ledger.places().identities()}});
  require_new(o, o.out);
  write_text_file(o.out, text);
  std::cout << "written: " << o.out << "\n";
  if (left_out > 0) std::cout << left_out << " released results have no candidate that is known by name and are left out\n";
}

void forget(const Options& o) {
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

void show(const Options& o) {
  const LedgerContent content = read_ledger({o.folder});
  const Registry registry = read_registry(content);
  if (o.as_json) {
    json sessions = json::array();
    for (const auto& s : registry.sessions)
      sessions.push_back({{"seq", s.seq},
                          {"candidate", s.candidate},
                          {"scenario", s.scenario_id},
                          {"verdict", s.result.is_object() ? s.result.value("verdict", "") : ""},
                          {"points", s.result.is_object() ? s.result["score"]["points"] : json()},
                          {"released", s.released},
                          {"simulated", s.simulated},
                          {"regraded", s.result_seq != s.seq},
                          {"findings", s.findings}});
    print_json(json{{"ledger", content.id}, {"entries", content.entries.size()}, {"tickets", registry.tickets.size()}, {"sessions", sessions}});
    return;
  }
  const auto open = std::count_if(registry.tickets.begin(), registry.tickets.end(), [](const IssuedTicket& t) { return !t.used_by; });
  std::printf("ledger %s: %zu entries, %zu tickets (%td not used), %zu sessions\n", content.id.c_str(), content.entries.size(),
              registry.tickets.size(), open, registry.sessions.size());
  for (const auto& s : registry.sessions)
    std::printf("%6llu  %-16s %-28s %-7s %6.1f  %s%s%s\n", static_cast<unsigned long long>(s.seq), s.candidate.c_str(), s.scenario_id.c_str(),
                s.result.is_object() ? s.result.value("verdict", "").c_str() : "?",
                s.result.is_object() ? s.result["score"]["points"].get<double>() : 0.0, s.released ? "released" : "pending",
                (std::string(s.result_seq != s.seq ? ", regraded" : "") + (s.simulated.empty() ? "" : ", simulated")).c_str(),
                s.findings.empty() ? "" : ", with findings");
}

}  // namespace

void add_ledger_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<Options>();
  auto* ledger = app.add_subcommand("ledger", "Tickets, filed exams, results and their release, kept so that no change goes unseen");
  ledger->require_subcommand(1);
  const auto verb = [&](const char* name, const char* what, const std::function<int(const Options&)>& run) {
    auto* v = ledger->add_subcommand(name, what);
    v->add_option("folder", o->folder, "the ledger's folder")->required();
    v->add_option("--key", o->key, "the school's signing key (default: $CAVUM_HOME/school.key)");
    v->callback([o, run, &exit_code] { exit_code = run(*o); });
    return v;
  };
  const auto done = [](void (*run)(const Options&)) {
    return [run](const Options& options) {
      run(options);
      return 0;
    };
  };
  const auto json_flag = [&](CLI::App* v) { v->add_flag("--json", o->as_json, "one JSON object on stdout"); };

  auto* v = verb("init", "Make a new ledger", done(init));
  v->add_option("--school", o->school, "name of the school, entered first")->capture_default_str();
  json_flag(v);

  v = verb("ticket", "Promise an exam to a candidate, or to a list of them", done(issue_tickets));
  v->add_option("scenario", o->scenario, "scenario file (.toml)")->required();
  v->add_option("--candidate", o->candidate, "matriculation number or mail address; kept with the identities only");
  v->add_option("--name", o->name, "for people; kept with the identities only");
  v->add_option("--candidates", o->candidates, "CSV of `id,name`, for a whole class; --out is then a folder");
  v->add_option("--from", o->from, "first moment at which the exam may begin, UTC: 2026-11-21T09:00Z")->required();
  v->add_option("--until", o->until, "last moment at which it may begin")->required();
  v->add_option("--tooth", o->tooth, "another tooth than the scenario's");
  v->add_option("--model", o->model, "force model")->capture_default_str();
  v->add_option("--rubric", o->rubric, "mark by this rubric (TOML) instead of the scenario's own");
  add_grant_options(v, o->grant);
  v->add_option("--out", o->out, "ticket to write, or the folder for a class")->required();
  v->add_flag("--overwrite", o->overwrite, "write over a file that is there");
  json_flag(v);

  v = verb("add", "File finished exams: verified tick by tick, checked against their tickets, counter-signed", add);
  v->add_option("sessions", o->sessions, ".cavum files, or folders of them")->required();
  v->add_flag("--without-ticket", o->without_ticket, "also exams that nobody promised");
  v->add_flag("--simulated", o->simulated, "also what a simulated operator sat; it stays marked as that");
  v->add_flag("--with-findings", o->with_findings, "also what does not hold, with what was found: for an appeal");
  v->add_option("--receipts", o->out, "folder for receipts: what a candidate can show without the ledger");
  json_flag(v);

  v = verb("release", "Let results go to candidates and exports", done(release));
  v->add_flag("--all", o->all, "all that are filed without findings");
  v->add_option("--candidate", o->chosen, "pseudonym or the school's own number; may be repeated");
  v->add_flag("--with-findings", o->with_findings, "with --candidate: also one that was filed with findings, after an appeal");
  json_flag(v);

  v = verb("regrade", "Mark a filed exam by another rubric or a corrected scenario: a new result beside the old", done(regrade));
  v->add_option("--session", o->session_seq, "its entry")->required();
  v->add_option("--rubric", o->rubric, "rubric (TOML)");
  v->add_option("--scenario", o->scenario, "corrected scenario (TOML)");
  v->add_option("--reason", o->reason, "why, in words; entered with it")->required();
  v->add_flag("--another-task", o->another_task, "let --scenario be that of another task than the session's");
  json_flag(v);

  v = verb("verify", "Check every entry, signature, ticket and filed session", verify_all);
  v->add_flag("--replay", o->replay, "simulate every session again, too");
  v->add_option("--receipt", o->receipt, "check this receipt, and that the ledger still begins with what it saw");
  json_flag(v);

  v = verb("export", "Write results for other systems", done(export_results));
  v->add_option("--format", o->format,
                "moodle (gradebook CSV), lti (scores of LTI Advantage), json (all results, signed), csv (a row for each criterion)")
      ->required()
      ->check(CLI::IsMember({"moodle", "lti", "json", "csv"}));
  v->add_option("--out", o->out, "file to write")->required();
  v->add_flag("--overwrite", o->overwrite, "write over a file that is there");

  v = verb("receipt", "Write an entry's receipt again", done(write_receipt));
  v->add_option("--entry", o->session_seq, "its number")->required();
  v->add_option("--out", o->out, "file to write")->required();
  v->add_flag("--overwrite", o->overwrite, "write over a file that is there");

  v = verb("candidates", "List who is behind which pseudonym", done(candidates));
  json_flag(v);

  v = verb("forget", "Remove a candidate's identity; all proofs stay valid", done(forget));
  v->add_option("--candidate", o->candidate, "pseudonym or the school's own number")->required();

  v = verb("show", "List what is filed", done(show));
  json_flag(v);
}

}  // namespace cavum
