// `cavum verify-all`: a folder of sessions, or a whole ledger, simulated and marked again by
// threads, a cluster or the shards of a CI.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/physics/servo/tick.h"
#include "grading/records/check_ledger.h"
#include "grading/records/regrade.h"
#include "ui/cli/pool_options.h"
#include "ui/cli/session_files.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

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

bool is_ledger(const std::string& folder) {
  return std::filesystem::exists(records::LedgerPaths{folder}.database());
}

pool::Work work_of(const VerifyAll& o) {
  pool::Work work;
  const bool anew = !o.rubric.empty() || !o.scenario.empty();
  if (anew && o.mark)
    throw Error(Name{"--mark"}, msg("is given with a rubric or scenario"),
                msg("give either: --mark marks by the session's own"));
  const pool::What what = anew     ? pool::What::regrade
                          : o.mark ? pool::What::mark
                                   : pool::What::verify;
  if (is_ledger(o.target)) {
    work = records::filed_work({o.target}, what);
  } else {
    work.what = what;
    work.folder = o.target;
    for (const auto& path : sessions_in(o.target))
      work.sessions.push_back(std::filesystem::path(path).lexically_relative(o.target).string());
  }
  records::RegradeBasis basis = records::read_basis(o.rubric, o.scenario);
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
  if (slash == std::string::npos || !whole(text.substr(0, slash), shard) ||
      !whole(text.substr(slash + 1), of) || shard < 1 || shard > of)
    throw Error(Name{"--shard " + text}, msg("is no shard"),
                msg("give its number and how many there are: 1/8 to 8/8"));
  return {shard, of};
}

void write_lines(const std::string& path, const std::vector<std::string>& lines) {
  std::string all;
  for (const auto& l : lines)
    if (!l.empty()) all += l + "\n";
  write_text_file(path, all);
}

int write_shard(const VerifyAll& o, const pool::Work& work) {
  if (o.out.empty())
    throw Error(Name{"--shard"}, msg("has no file for its part"), msg("name it by --out"));
  const auto [shard, of] = parse_shard(o.shard);
  pool::Run run;
  run.threads = o.pool.threads;
  run.told = shown_progress();
  const std::size_t made = pool::make_shard(work, shard, of, o.out, run);
  say(msgn("written: {}, {} line", "written: {}, {} lines", static_cast<std::int64_t>(made), o.out,
           made));
  return 0;
}

/// "--shard 2/3, --shard 3/3", where just these shards' lines are missing; else empty.
std::string missing_shards(const pool::Made& made, std::size_t parts) {
  const std::size_t lines = made.lines.size();
  std::vector<bool> missing(lines);
  for (const auto i : made.missing) missing[i] = true;
  for (std::size_t of = parts + 1; of <= std::min(lines, parts + k_named); ++of) {
    std::string names;
    std::size_t whole = 0;
    bool fits = true;
    for (std::size_t shard = 0; shard < of && fits; ++shard) {
      std::size_t gone = 0, all = 0;
      for (std::size_t i = shard; i < lines; i += of) ++all, gone += missing[i] ? 1 : 0;
      fits = gone == 0 || gone == all;
      if (gone > 0)
        names += fmt::format("{}--shard {}/{}", names.empty() ? "" : ", ", shard + 1, of);
      whole += gone == 0 ? 1 : 0;
    }
    if (fits && whole == parts) return names;
  }
  return {};
}

/// Lines out of parts that others made; what is missing is named.
pool::Made merged(const VerifyAll& o, const pool::Work& work) {
  pool::Parts parts = pool::read_parts(work, o.merge);
  pool::leave_out_changed(work, parts);
  pool::Made made;
  made.missing = parts.missing();
  made.found = work.sessions.size() - made.missing.size();
  for (auto& line : parts.lines) made.lines.push_back(line ? std::move(*line) : std::string());
  for (const auto& s : parts.spent) made.spent += s;
  for (const auto& r : parts.remarks) say_error(msg("notice: {}", r));
  if (const std::string shards = missing_shards(made, o.merge.size());
      !made.missing.empty() && !shards.empty())
    say_error(msg("{} of {} sessions have no line: the parts of {} are missing",
                  made.missing.size(), work.sessions.size(), shards));
  for (std::size_t i = 0; i < made.missing.size() && i < k_named; ++i)
    say_error(msg("{}: is missing in the parts, or damaged there", work.sessions[made.missing[i]]));
  if (made.missing.size() > k_named) say_error(msg("{} more", made.missing.size() - k_named));
  return made;
}

struct Sums {
  std::size_t sound = 0;
  std::int64_t ticks = 0;
  std::vector<Message> wrong;
};
Sums sums_of(const pool::Made& made) {
  Sums sums;
  for (const auto& text : made.lines) {
    if (text.empty()) continue;
    const json line = parse_json_or_null(text, k_json_part);
    sums.ticks += whole_in(line, "ticks");
    const json& verified = member_of(line, "verified");
    if (const auto found = pool::findings_in(line); !found.empty())
      sums.wrong.push_back(msg("{}: {}", text_in(line, "session"), found[0].message()));
    else if (const Message error = pool::error_in(line); !error.empty())
      sums.wrong.push_back(msg("{}: {}", text_in(line, "session"), error));
    else if (verified.is_boolean() && !verified.get<bool>())
      sums.wrong.push_back(msg("{}: does not hold", text_in(line, "session")));
    else
      ++sums.sound;
  }
  return sums;
}

int tell(const VerifyAll& o, const pool::Work& work, const pool::Made& made,
         const records::LedgerCheck* ledger) {
  const Sums sums = sums_of(made);
  if (!o.out.empty()) write_lines(o.out, made.lines);
  const bool none_wrong = sums.wrong.empty() && (ledger == nullptr || ledger->findings.empty()),
             sound = none_wrong && made.missing.empty();
  const double session_s = static_cast<double>(sums.ticks) * k_tick_s;
  const double real_time = made.spent.core_s > 0 ? session_s / made.spent.core_s : 0.0;
  const double efficiency =
      made.workers > 0 && made.found == 0
          ? made.spent.wall_s / (made.wall_s * static_cast<double>(made.workers))
          : 0.0;
  if (o.as_json) {
    json all{{"sessions", work.sessions.size()},
             {"sound", sums.sound},
             {"wrong", sums.wrong},
             {"missing", json::array()},
             {"session_s", session_s},
             {"tasks_s", made.spent.wall_s},
             {"cores_s", made.spent.core_s},
             {"wall_s", made.wall_s},
             {"workers", made.workers},
             {"found", made.found},
             {"x_realtime_core", real_time},
             {"efficiency", efficiency}};
    for (const auto i : made.missing) all["missing"].push_back(work.sessions[i]);
    if (ledger != nullptr)
      all["ledger"] = {{"findings", ledger->findings},
                       {"not_checked", ledger->not_checked},
                       {"remarks", ledger->remarks}};
    print_json(all);
    return sound ? 0 : 1;
  }
  List sum{{sound        ? msg("{}: all hold", o.target)
            : none_wrong ? msg("{}: NOT COMPLETE", o.target)
                         : msg("{}: NOT ALL HOLD", o.target),
            msg("{} of {} sessions sound", sums.sound, work.sessions.size())},
           false};
  if (!made.missing.empty()) sum.items.push_back(msg("{} without a line", made.missing.size()));
  say(msg("{}", sum));
  for (std::size_t i = 0; i < sums.wrong.size() && i < k_named; ++i)
    say(msg("- {}", sums.wrong[i]), 2);
  if (sums.wrong.size() > k_named)
    say(msg("- and {} more, in the lines of --out", sums.wrong.size() - k_named), 2);
  if (ledger != nullptr) {
    for (const auto& f : ledger->findings) say(msg("- {}", f.message()), 2);
    for (const auto& n : ledger->not_checked) say(msg("not checked: {}", n.message()), 2);
    for (const auto& r : ledger->remarks) say(msg("({})", r.message()), 2);
  }
  if (made.spent.core_s > 0)
    say(msg("{} of exams in {} of a core: {} times real time", as_s(session_s, 0),
            as_s(made.spent.core_s, 1), as_number(real_time, 0)),
        2);
  if (efficiency > 0)
    say(msg("{} by {} at once, {} of it work", as_s(made.wall_s, 1), made.workers,
            as_number(efficiency, 2)),
        2);
  if (!o.out.empty()) say(msg("written: {}", o.out));
  return sound ? 0 : 1;
}

/// Throws Error where --out or --work is something that is read: a session, a part, a ledger, a
/// rubric.
void require_apart(const VerifyAll& o, const pool::Work& work) {
  namespace fs = std::filesystem;
  std::error_code none;
  const auto within = [&](const std::string& path) {  // the folder that is read
    const auto rest =
        fs::weakly_canonical(path, none).lexically_relative(fs::weakly_canonical(o.target, none));
    return !rest.empty() && *rest.begin() != "..";
  };
  const auto is = [&](const std::string& written, const std::string& read) {
    return !read.empty() && fs::equivalent(written, read, none);
  };
  std::vector<std::string> read = o.merge;
  read.insert(read.end(), {o.rubric, o.scenario});
  for (const auto& [option, path] : {std::pair{"--out", o.out}, std::pair{"--work", o.pool.work}}) {
    if (path.empty()) continue;
    const std::string named = fmt::format("{} {}", option, path);
    if (is_ledger(o.target) && within(path))
      throw Error(Name{named}, msg("lies in the ledger that is read"), msg("write outside of it"));
    if (path.ends_with(".cavum"))
      throw Error(Name{named}, msg("is a name of a recording"),
                  msg("write to a file with another ending"));
    bool taken = is(path, o.target);
    for (const auto& r : read) taken = taken || is(path, r);
    if (fs::exists(path, none))
      for (const auto& session : work.sessions) {
        const fs::path file = fs::path(work.folder) / session;
        taken = taken || is(path, file.string()) ||
                (fs::is_directory(path, none) && is(path, file.parent_path().string()));
      }
    if (taken)
      throw Error(Name{named}, msg("is also what is read"), msg("write to another file or folder"));
  }
  require_distinct_paths({{"--out " + o.out, o.out}}, {});
}

int verify_all(const VerifyAll& o) {
  if (!o.task.empty()) {
    pool::slurm_task(o.task, o.attempt, o.target);
    return 0;
  }
  if (!std::filesystem::is_directory(o.target))
    throw Error(Name{o.target}, msg("is no folder"), msg("name a folder of sessions, or a ledger"));
  pool::Work work = work_of(o);
  require_apart(o, work);
  if (!o.shard.empty()) return write_shard(o, work);
  const pool::Maker by = [&](const pool::Work& wanted) {
    return o.merge.empty() ? make_lines(wanted, o.pool) : merged(o, wanted);
  };
  pool::Made made;
  if (!is_ledger(o.target)) return tell(o, work, made = by(work), nullptr);
  // A ledger's own check says whether the files are those that were filed, whoever makes the lines.
  const bool verify = work.what == pool::What::verify;
  const auto check =
      records::check_ledger({o.target}, verify ? pool::Maker([&](const pool::Work& wanted) {
                              work = wanted;
                              return made = by(wanted);
                            })
                                               : pool::Maker());
  if (!verify) made = by(work);
  return tell(o, work, made, &check);
}

}  // namespace

void add_verify_all_verb(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<VerifyAll>();
  auto* v = app.add_subcommand(
      "verify-all",
      tr("Simulate and mark many sessions again, on all cores, a Slurm cluster, or in shards of a CI"));
  v->add_option("target", o->target, tr("a folder of sessions, or a ledger"))->required();
  add_pool_options(*v, o->pool);
  v->add_flag("--mark", o->mark, tr("mark only, without simulating"));
  v->add_option("--rubric", o->rubric, tr("mark only, by this rubric (TOML)"));
  v->add_option("--scenario", o->scenario, tr("mark only, by this corrected scenario (TOML)"));
  v->add_flag("--another-task", o->another_task,
              tr("let --scenario be that of another task than the sessions'"));
  auto* shard =
      v->add_option("--shard", o->shard, tr("make a part alone, as 3/8, and write it to --out"));
  v->add_option("--merge", o->merge, tr("put parts together instead, and say what is missing"))
      ->excludes(shard);
  v->add_option("--out", o->out, tr("write a line of JSON for each session, in their order"));
  v->add_option("--task", o->task, tr("what a task of Slurm does"))->group("");
  v->add_option("--attempt", o->attempt, tr("of a task"))->group("");
  v->add_flag("--json", o->as_json, tr("one JSON object on stdout"));
  v->callback([o, &exit_code] { exit_code = verify_all(*o); });
}

}  // namespace cavum::ui
