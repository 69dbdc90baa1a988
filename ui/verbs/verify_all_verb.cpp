// `cavum verify-all`: a folder of sessions, or a whole ledger, simulated and marked again by threads, a cluster or the shards of a CI.
#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/servo/tick.h"
#include "grading/ledger/check_ledger.h"
#include "grading/ledger/regrade.h"
#include "ui/parts/own_places.h"
#include "ui/parts/print_json.h"
#include "ui/verbs/pool_options.h"
#include "ui/verbs/session_files.h"
#include "ui/verbs/verbs.h"

namespace cavum::ui {
namespace {

using nlohmann::json;

constexpr std::size_t k_named = 20;  // of those that do not hold

struct VerifyAll {
  PoolOptions pool;
  std::string target, rubric, scenario, out, shard, task;
  std::vector<std::string> merge;
  int attempt = 1;
  bool mark = false, another_task = false, as_json = false;
};

bool is_ledger(const std::string& folder) { return std::filesystem::exists(ledger::LedgerPlaces{folder}.database()); }

pool::Work work_of(const VerifyAll& o) {
  pool::Work work;
  work.folder = o.target;
  const std::string below = is_ledger(o.target) ? o.target + "/sessions" : o.target;
  for (const auto& path : sessions_in(below)) work.sessions.push_back(std::filesystem::path(path).lexically_relative(o.target).string());
  const bool anew = !o.rubric.empty() || !o.scenario.empty();
  if (anew && o.mark) throw Error("--mark", "is given with a rubric or scenario", "give either: --mark marks by the session's own");
  work.what = anew ? pool::What::regrade : o.mark ? pool::What::mark : pool::What::verify;
  ledger::RegradeBasis basis = ledger::read_basis(o.rubric, o.scenario);
  work.rubric_toml = std::move(basis.rubric_toml);
  work.scenario_toml = std::move(basis.scenario_toml);
  work.surfaces = std::move(basis.surfaces);
  work.another_task = o.another_task;
  return work;
}

/// "3/8"
std::pair<std::size_t, std::size_t> parse_shard(const std::string& text) {
  std::size_t shard = 0, of = 0;
  const auto slash = text.find('/');
  const auto whole = [](const std::string& word, std::size_t& n) {
    const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), n);
    return !word.empty() && wrong == std::errc() && end == word.data() + word.size();
  };
  if (slash == std::string::npos || !whole(text.substr(0, slash), shard) || !whole(text.substr(slash + 1), of) || shard < 1 || shard > of)
    throw Error("--shard " + text, "is no shard", "give its number and how many there are: 1/8 to 8/8");
  return {shard, of};
}

void write_lines(const std::string& path, const std::vector<std::string>& lines) {
  std::string all;
  for (const auto& l : lines)
    if (!l.empty()) all += l + "\n";
  write_text_file(path, all);
}

int write_shard(const VerifyAll& o) {
  if (o.out.empty()) throw Error("--shard", "has no file for its part", "name it by --out");
  const auto [shard, of] = parse_shard(o.shard);
  pool::Run run;
  run.threads = o.pool.threads;
  run.told = shown_progress();
  const std::size_t made = pool::make_shard(work_of(o), shard, of, o.out, run);
  std::cout << "written: " << one_line(o.out) << ", " << made << (made == 1 ? " line" : " lines") << "\n";
  return 0;
}

/// Lines out of parts that others made; what is missing is named.
pool::Made merged(const VerifyAll& o, const pool::Work& work) {
  pool::Parts parts = pool::read_parts(work, o.merge);
  pool::leave_out_changed(work, parts);
  pool::Made made;
  made.missing = parts.missing();
  made.found = work.sessions.size() - made.missing.size();
  for (const auto& r : parts.remarks) std::cerr << "cavum: notice: " << one_line(r) << "\n";
  for (const auto i : made.missing) std::cerr << "cavum: " << one_line(work.sessions[i]) << ": is missing in the parts, or damaged there\n";
  for (auto& line : parts.lines) made.lines.push_back(line ? std::move(*line) : std::string());
  for (const auto& s : parts.spent) made.spent += s;
  return made;
}

struct Sums {
  std::size_t sound = 0;
  std::int64_t ticks = 0;
  std::vector<std::string> wrong;  ///< in words
};
Sums sums_of(const pool::Made& made) {
  Sums sums;
  for (const auto& text : made.lines) {
    if (text.empty()) continue;
    const json line = parse_json_or_null(text, k_json_part);
    sums.ticks += whole_in(line, "ticks");
    const json &verified = member_of(line, "verified"), &findings = member_of(line, "findings");
    if (line.contains("error"))
      sums.wrong.push_back(text_in(line, "session") + ": " + text_in(line, "error"));
    else if (verified.is_boolean() && !verified.get<bool>())
      sums.wrong.push_back(text_in(line, "session") + ": " + (findings.empty() ? "does not hold" : findings[0].get<std::string>()));
    else
      ++sums.sound;
  }
  return sums;
}

int tell(const VerifyAll& o, const pool::Work& work, const pool::Made& made, const ledger::LedgerCheck* ledger) {
  const Sums sums = sums_of(made);
  if (!o.out.empty()) write_lines(o.out, made.lines);
  const bool sound = sums.wrong.empty() && made.missing.empty() && (ledger == nullptr || ledger->findings.empty());
  const double session_s = static_cast<double>(sums.ticks) * k_tick_s;
  const double real_time = made.spent.core_s > 0 ? session_s / made.spent.core_s : 0.0;
  const double efficiency = made.workers > 0 && made.found == 0 ? made.spent.wall_s / (made.wall_s * static_cast<double>(made.workers)) : 0.0;
  if (o.as_json) {
    json all{{"sessions", work.sessions.size()}, {"sound", sums.sound},          {"wrong", sums.wrong},          {"missing", json::array()},
             {"session_s", session_s},           {"tasks_s", made.spent.wall_s}, {"cores_s", made.spent.core_s}, {"wall_s", made.wall_s},
             {"workers", made.workers},          {"found", made.found},          {"x_realtime_core", real_time}, {"efficiency", efficiency}};
    for (const auto i : made.missing) all["missing"].push_back(work.sessions[i]);
    if (ledger != nullptr) all["ledger"] = {{"findings", ledger->findings}, {"not_checked", ledger->not_checked}, {"remarks", ledger->remarks}};
    print_json(all);
    return sound ? 0 : 1;
  }
  std::cout << one_line(o.target) << ": " << (sound ? "all hold" : "NOT ALL HOLD") << ", " << sums.sound << " of " << work.sessions.size()
            << " sessions sound\n";
  for (std::size_t i = 0; i < sums.wrong.size() && i < k_named; ++i) std::cout << "  - " << one_line(sums.wrong[i]) << "\n";
  if (sums.wrong.size() > k_named) std::cout << "  - and " << sums.wrong.size() - k_named << " more, in the lines of --out\n";
  if (ledger != nullptr) {
    for (const auto& f : ledger->findings) std::cout << "  - " << one_line(f) << "\n";
    for (const auto& n : ledger->not_checked) std::cout << "  not checked: " << one_line(n) << "\n";
    for (const auto& r : ledger->remarks) std::cout << "  (" << one_line(r) << ")\n";
  }
  if (made.spent.core_s > 0)
    std::cout << fmt::format("  {} s of exams in {} s of a core: {} times real time", fixed(session_s, 0), fixed(made.spent.core_s, 1),
                             fixed(real_time, 0));
  if (efficiency > 0) std::cout << fmt::format("; {} s by {} at once, {} of it work", fixed(made.wall_s, 1), made.workers, fixed(efficiency, 2));
  if (made.spent.core_s > 0) std::cout << "\n";
  if (!o.out.empty()) std::cout << "written: " << one_line(o.out) << "\n";
  return sound ? 0 : 1;
}

int verify_all(const VerifyAll& o) {
  if (!o.task.empty()) {
    pool::slurm_task(o.task, o.attempt, o.target);
    return 0;
  }
  if (!std::filesystem::is_directory(o.target)) throw Error(o.target, "is no folder", "name a folder of sessions, or a ledger");
  require_own_places({{"--out " + o.out, o.out}},
                     {{"", ledger::LedgerPlaces{o.target}.database()}, {"", ledger::LedgerPlaces{o.target}.identities()}});
  if (!o.shard.empty()) return write_shard(o);
  if (!o.out.empty()) require_writable(o.out);
  const bool all_of_ledger = is_ledger(o.target) && !o.mark && o.rubric.empty() && o.scenario.empty() && o.merge.empty();
  if (!all_of_ledger) {
    const pool::Work work = work_of(o);
    return tell(o, work, o.merge.empty() ? make_lines(work, o.pool) : merged(o, work), nullptr);
  }
  pool::Work work;
  pool::Made made;
  const auto check = ledger::check_ledger({o.target}, [&](const pool::Work& wanted) {
    work = wanted;
    return made = make_lines(wanted, o.pool);
  });
  return tell(o, work, made, &check);
}

}  // namespace

void add_verify_all_verb(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<VerifyAll>();
  auto* v = app.add_subcommand("verify-all", "Simulate and mark many sessions again, on all cores, a Slurm cluster, or in shards of a CI");
  v->add_option("target", o->target, "a folder of sessions, or a ledger")->required();
  add_pool_options(*v, o->pool);
  v->add_flag("--mark", o->mark, "mark only, without simulating");
  v->add_option("--rubric", o->rubric, "mark only, by this rubric (TOML)");
  v->add_option("--scenario", o->scenario, "mark only, by this corrected scenario (TOML)");
  v->add_flag("--another-task", o->another_task, "let --scenario be that of another task than the sessions'");
  auto* shard = v->add_option("--shard", o->shard, "make a part alone, as 3/8, and write it to --out");
  v->add_option("--merge", o->merge, "put parts together instead, and say what is missing")->excludes(shard);
  v->add_option("--out", o->out, "write a line of JSON for each session, in their order");
  v->add_option("--task", o->task, "what a task of Slurm does")->group("");
  v->add_option("--attempt", o->attempt, "of a task")->group("");
  v->add_flag("--json", o->as_json, "one JSON object on stdout");
  v->callback([o, &exit_code] { exit_code = verify_all(*o); });
}

}  // namespace cavum::ui
