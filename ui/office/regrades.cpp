#include "ui/office/regrades.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/session.h"
#include "grading/pool/makers.h"
#include "scenarios/file/parse.h"
#include "ui/language/say.h"
#include "ui/office/desk_parts.h"

namespace cavum::office {
namespace {

using nlohmann::json;

constexpr char k_note_format[] = "cavum regrade note 1";
constexpr std::size_t k_id_bytes = 8;

/// Requests go first.
void work_behind_requests() noexcept {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 10);
}

double of_score(const json& result, const char* what) {
  return number_in(member_of(member_of(result, "score"), what)).value_or(0);
}

}  // namespace

Regrades::Regrades(Desk& desk, std::string ledger_folder, std::string note)
    : desk_(desk), ledger_folder_(std::move(ledger_folder)), note_(std::move(note)) {
  read_note();
}

Regrades::~Regrades() { end_marking(); }

void Regrades::end_marking() {
  {
    const std::lock_guard guard(lock_);
    stop_ = true;
  }
  if (worker_.joinable()) worker_.join();
}

void Regrades::change(State state, const Message& problem) {
  state_ = state;
  problem_ = problem;
  ++version_;
  changed_.notify_all();
}

RegradeId Regrades::begin(const BeginRegrade& asked, const Account& by) {
  const std::lock_guard one(one_at_a_time_);
  {
    const std::lock_guard guard(lock_);
    if (state_ == State::marking || (state_ == State::ready && by_ != by.name))
      throw Error(msg("the new rubric"), msg("is not begun: another one is on its way"),
                  msg("wait until that one counts or is dropped"));
  }
  records::RegradeBasis basis;
  basis.rubric_toml = asked.rubric;
  if (basis.rubric_toml.empty())
    throw Error(msg("the rubric"), msg("is empty"), msg("choose a file of a rubric (TOML)"));
  static_cast<void>(scenarios::parse_rubric(basis.rubric_toml, "rubric.toml"));
  std::uint64_t entries = 0;
  records::ClassRegrade plan = desk_.plan_regrade(asked.exam, std::move(basis), entries);
  end_marking();
  const std::lock_guard guard(lock_);
  plan_ = std::move(plan);
  id_ = records::random_hex(k_id_bytes);
  by_ = by.name;
  begun_ = utc_text(read_clocks().utc_ns);
  rubric_sha256_ = to_hex(sha256(plan_.basis.rubric_toml));
  entries_ = entries;
  done_ = first_entry_ = counted_ = 0;
  of_ = plan_.sessions.size();
  left_s_ = -1;
  stop_ = false;
  write_note();
  change(State::marking);
  worker_ = std::thread([this] { mark(); });
  return {id_};
}

void Regrades::mark() {
  work_behind_requests();
  records::ClassRegrade plan;
  {
    const std::lock_guard guard(lock_);
    plan = plan_;
  }
  const auto begun = std::chrono::steady_clock::now();
  Message problem;
  try {
    pool::Run run;
    run.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
    run.stop = [this] {
      const std::lock_guard guard(lock_);
      return stop_;
    };
    run.told = [&](std::size_t done, std::size_t of) {
      const double s =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      const std::lock_guard guard(lock_);
      done_ = done;
      left_s_ = s / static_cast<double>(done) * static_cast<double>(of - done);
      ++version_;
      changed_.notify_all();
    };
    const pool::Made made = pool::by_threads(records::work_of(plan, ledger_folder_), run);
    if (run.stop()) return;
    records::take_lines(plan, made.lines, ledger_folder_);
  } catch (const std::bad_alloc&) {
    problem = msg("there is not enough memory");
  } catch (const Error& wrong) {
    problem = wrong.where_and_problem();
  } catch (const std::exception& wrong) {
    problem = Name{wrong.what()};
  }
  const std::lock_guard guard(lock_);
  if (stop_) return;
  plan_ = std::move(plan);
  change(problem.empty() ? State::ready : State::failed, problem);
}

void Regrades::require_ready(const std::string& id, const Account& by) const {
  const std::lock_guard guard(lock_);
  if (state_ != State::ready || id != id_)
    throw Error(
        msg("the new rubric"),
        msg("is not the one that waits: it counts already, was dropped, or another was begun"),
        msg("look at it again"));
  if (by_ != by.name)
    throw Error(msg("the new rubric"), msg("was looked at by somebody else"),
                msg("who looked at it lets it count; or begin anew"));
}

RegradeCounted Regrades::count(const CountRegrade& asked, const Account& by) {
  const std::lock_guard one(one_at_a_time_);
  require_ready(asked.id, by);
  std::uint64_t first = 0;
  const std::size_t counted =
      desk_.count_regrade(plan_, asked.reason, by, first);  // plan_ is changed by begin() alone
  const std::lock_guard guard(lock_);
  first_entry_ = first;
  counted_ = counted;
  change(State::counted);
  return {counted, first};
}

void Regrades::drop(const std::string& id, const Account& by) {
  const std::lock_guard one(one_at_a_time_);
  {
    const std::lock_guard guard(lock_);
    if (state_ == State::none || id != id_)
      throw Error(msg("the new rubric"), msg("is not the one that was begun"),
                  msg("look at it again"));
    if (by_ != by.name && (state_ == State::marking || state_ == State::ready))
      throw Error(msg("the new rubric"), msg("was begun by somebody else"),
                  msg("who began it drops it"));
  }
  end_marking();
  const std::lock_guard guard(lock_);
  std::filesystem::remove(note_);
  plan_ = {};
  id_.clear();
  change(State::none);
}

RegradeShown Regrades::state() const {
  const std::lock_guard guard(lock_);
  return {state_,         id_,
          plan_.exam,     by_,
          begun_,         tr(problem_),
          done_,          of_,
          plan_.left_out, left_s_ < 0 ? std::nullopt : std::optional(left_s_),
          counted_,       first_entry_};
}

std::optional<std::vector<RegradeRow>> Regrades::rows() const {
  const std::lock_guard guard(lock_);
  if (state_ != State::ready) return std::nullopt;
  std::vector<RegradeRow> out;
  for (const auto& s : plan_.sessions)
    out.push_back(
        {s.session, s.candidate, text_in(*s.before, "verdict"), text_in(s.after, "verdict"),
         of_score(*s.before, "points"), of_score(*s.before, "max"), of_score(s.after, "points"),
         of_score(s.after, "max"), s.other_verdict(), s.other_points(), s.decided, s.shown});
  return out;
}

std::uint64_t Regrades::wait(std::uint64_t seen, int patience_ms) const {
  std::unique_lock guard(lock_);
  changed_.wait_for(guard, std::chrono::milliseconds(patience_ms),
                    [&] { return version_ != seen; });
  return version_;
}

void Regrades::write_note() const {
  write_private_text_file(note_, json{{"format", k_note_format},
                                      {"id", id_},
                                      {"exam", plan_.exam},
                                      {"by", by_},
                                      {"begun", begun_},
                                      {"sessions", of_},
                                      {"entries", entries_},
                                      {"rubric_sha256", rubric_sha256_}}
                                         .dump(1) +
                                     "\n");
}

void Regrades::read_note() {
  if (!std::filesystem::exists(note_)) return;
  const json note = parse_json_or_null(read_text_file(note_), k_json_part);
  if (text_in(note, "format") != k_note_format)
    return;  // cut off as the server ended: nothing had begun
  id_ = text_in(note, "id");
  by_ = text_in(note, "by");
  begun_ = text_in(note, "begun");
  plan_.exam = text_in(note, "exam");
  of_ = static_cast<std::size_t>(whole_in(note, "sessions"));
  entries_ = static_cast<std::uint64_t>(whole_in(note, "entries"));
  rubric_sha256_ = text_in(note, "rubric_sha256");
  counted_ = desk_.counted_regrades(plan_.exam, rubric_sha256_, by_, entries_, first_entry_);
  done_ = counted_ > 0 ? of_ : 0;
  state_ = counted_ > 0 ? State::counted : State::lost;
}

}  // namespace cavum::office
