// The blind test of `cavum explain`: hides effects in recordings, asks the program, and compares
// afterwards.
//   blind CAVUM --sample           one draw of each, mixed evenly, or the first --first of them;
//   fails where rates are worse than promised or than measured before blind CAVUM --table at least
//   --draws (10) draws of each mechanism at sizes 1.0 and 0.35, and everything else blind CAVUM
//   --table --only-simpler   the simpler methods alone, without asking the program blind CAVUM
//   --case KIND NAME[,NAME] SIZE QUANTUM SEED
//   [--keep DIR]   one recording again
// CAVUM_TEST_SEED repeats a run; without it the seed is drawn anew. Cases are the same for any
// number of --jobs.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <mutex>
#include <random>
#include <stdexcept>

#include "engine/base/independent_runs.h"
#include "tests/blind/measured.h"
#include "tests/blind/score.h"

namespace {

using namespace cavum::blind;

const std::vector<double> k_quanta_mm{0.0, 0.01, 0.055};

struct Options {
  std::filesystem::path cavum, keep, log;
  bool table = false, only_simpler = false;
  int draws = 10, jobs = 2;
  std::size_t first = 0;  ///< of the plan; 0: all, as with CAVUM_DEEP
  std::string only;
  std::vector<std::string> one_case;
  std::uint64_t seed = 0;
};

/// The requests of one kind, each with its own seed, in drawn order.
std::vector<Request> requests(Kind kind, int draws, Draw& draw) {
  std::vector<Request> list;
  std::size_t turn = draw.below(3);
  const auto add = [&](std::vector<std::string> names, double size) {
    list.push_back({kind, std::move(names), size, k_quanta_mm[turn++ % 3], draw.bits()});
  };
  for (int d = 0; d < draws; ++d) {
    switch (kind) {
      case Kind::single:
        for (const std::string& name : mechanisms())
          add({name}, 1.0), ++turn, add({name}, 0.35), ++turn;
        ++turn;
        break;
      case Kind::pair:
        for (int i = 0; i < 4; ++i) add(draw_pair(draw), 0.6);
        break;
      case Kind::clean:
        for (int i = 0; i < 9; ++i) add({}, 0.0);
        break;
      case Kind::outside:
        for (const std::string& name : outsiders()) add({name}, 0.6);
        break;
      case Kind::crosshead:
        for (const char* name : {"coulomb_friction", "bias", "edge_force"}) add({name}, 0.0);
        break;
      case Kind::fault:
        for (const std::string& name : faults()) add({name}, 0.0);
        break;
    }
  }
  draw.shuffle(list);
  return list;
}

/// Kinds mixed evenly, so that the first of them are of all kinds.
std::vector<Request> plan(const Options& o, Draw& draw) {
  struct Placed {
    double at;
    Request request;
  };
  std::vector<Placed> placed;
  for (const Kind kind :
       {Kind::single, Kind::pair, Kind::clean, Kind::outside, Kind::crosshead, Kind::fault}) {
    std::vector<Request> list = requests(kind, o.table ? o.draws : 1, draw);
    if (!o.only.empty())
      std::erase_if(list, [&](const Request& r) {
        return o.only != kind_name(kind) &&
               std::find(r.names.begin(), r.names.end(), o.only) == r.names.end();
      });
    for (std::size_t i = 0; i < list.size(); ++i)
      placed.push_back(
          {(static_cast<double>(i) + draw.uniform()) / static_cast<double>(list.size()), list[i]});
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.at < b.at; });
  std::vector<Request> all;
  for (Placed& p : placed) all.push_back(std::move(p.request));
  if (o.first > 0 && o.first < all.size()) all.resize(o.first);
  return all;
}

Outcome run(const Options& o, const Request& request, const std::filesystem::path& folder) {
  Outcome outcome;
  outcome.hidden = write_recording(request, folder);
  if (!o.only_simpler) outcome.verdict = ask(o.cavum, folder, request.seed % 1000000);
  if (request.kind == Kind::single || request.kind == Kind::clean) {
    outcome.simpler = ask_simpler(folder);
    if (!o.only_simpler) {
      std::filesystem::rename(folder / "answer.json", folder / "kept.json");
      outcome.plain = ask(o.cavum, folder, request.seed % 1000000, "--surrogates 0");
      std::filesystem::rename(folder / "kept.json", folder / "answer.json");
    }
  }
  return outcome;
}

std::vector<Outcome> run_all(const Options& o, const std::vector<Request>& list,
                             const std::filesystem::path& scratch) {
  std::vector<Outcome> done;
  std::mutex guard;
  std::ofstream log;
  if (!o.log.empty()) log.open(o.log);
  const auto one = [&](std::size_t i) {
    const std::filesystem::path folder = scratch / std::to_string(i);
    Outcome outcome = run(o, list[i], folder);
    std::filesystem::remove_all(folder);
    const std::scoped_lock lock(guard);
    const std::string line = line_of(outcome);
    std::printf("%zu/%zu %s\n", done.size() + 1, list.size(), line.c_str());
    std::fflush(stdout);
    if (log) log << line << std::endl;
    done.push_back(std::move(outcome));
  };
  cavum::independent_runs(list.size(), one, static_cast<std::size_t>(o.jobs));
  return done;
}

/// Prints promise, measured before and today's count; true if today's is no evidence of a rate
/// worse than both allow.
bool hold(const std::vector<Outcome>& outcomes) {
  bool good = true;
  std::printf(
      "\nrate                                         promise  measured before   today       least at p = 0.001   (measured before: %s)\n",
      k_measured_by);
  const std::vector<Rate> today = rates(outcomes);
  for (std::size_t i = 0; i < today.size(); ++i) {
    const Rate& r = today[i];
    const Counted before = k_measured[i];
    const double measured =
        before.trials > 0 ? static_cast<double>(before.successes) / before.trials : 0.0;
    // a count that chance explains (1 in 20) leaves the promise standing; otherwise what was
    // measured is held
    const bool is_short =
        before.trials > 0 && binomial_at_most(before.successes, before.trials, r.promise) < 0.05;
    const double bound = is_short ? measured : r.promise;
    const int least = least_expected(r.trials, bound);
    const bool ok = r.successes >= least;
    good = good && ok;
    if (r.trials == 0) continue;  // not asked for today
    std::printf("%-46s %5.2f %8d/%-4d %5.2f %6d/%-4d %5.2f %8d  %s%s\n", r.name.c_str(), r.promise,
                before.successes, before.trials, measured, r.successes, r.trials, r.value(), least,
                ok ? "" : "WORSE",
                is_short               ? "  short of the promise"
                : measured < r.promise ? "  below the promise, within chance"
                                       : "");
  }
  int unanswered = 0;
  for (const Outcome& o : outcomes) unanswered += !o.verdict.answered;
  if (unanswered > 0) std::printf("%d recordings without an answer\n", unanswered);
  return good && unanswered == 0 && !outcomes.empty();
}

Options parse(int argc, char** argv) {
  if (argc < 3)
    throw std::invalid_argument(
        "usage: blind CAVUM (--sample | --table | --case KIND NAMES SIZE QUANTUM SEED) [--draws N] [--jobs N] [--first N] [--only NAME] [--keep "
        "DIR] [--log FILE]");
  Options o;
  o.cavum = argv[1];
  if (const char* seed = std::getenv("CAVUM_TEST_SEED"))
    o.seed = std::strtoull(seed, nullptr, 10);
  else
    o.seed = std::random_device{}();
  for (int i = 2; i < argc; ++i) {
    const std::string a = argv[i];
    const auto value = [&]() -> std::string {
      if (++i >= argc) throw std::invalid_argument("blind: " + a + " needs a value");
      return argv[i];
    };
    if (a == "--sample")
      o.table = false;
    else if (a == "--table")
      o.table = true;
    else if (a == "--only-simpler")
      o.only_simpler = true;
    else if (a == "--draws")
      o.draws = std::stoi(value());
    else if (a == "--jobs")
      o.jobs = std::stoi(value());
    else if (a == "--first")
      o.first = std::stoul(value());
    else if (a == "--only")
      o.only = value();
    else if (a == "--keep")
      o.keep = value();
    else if (a == "--log")
      o.log = value();
    else if (a == "--case")
      for (int part = 0; part < 5; ++part) o.one_case.push_back(value());
    else
      throw std::invalid_argument("blind: unknown option " + a);
  }
  if (std::getenv("CAVUM_DEEP") != nullptr) o.first = 0;
  return o;
}

Request request_of(const std::vector<std::string>& parts) {
  Request r;
  bool known = false;
  for (const Kind kind :
       {Kind::single, Kind::pair, Kind::clean, Kind::outside, Kind::crosshead, Kind::fault})
    if (parts[0] == kind_name(kind)) r.kind = kind, known = true;
  if (!known) throw std::invalid_argument("blind: no kind of recording is called " + parts[0]);
  for (std::size_t begin = 0; r.kind != Kind::clean && begin <= parts[1].size();) {
    const std::size_t end = std::min(parts[1].find(',', begin), parts[1].size());
    r.names.push_back(parts[1].substr(begin, end - begin));
    begin = end + 1;
  }
  r.size = std::stod(parts[2]), r.quantum_mm = std::stod(parts[3]), r.seed = std::stoull(parts[4]);
  return r;
}

int go(const Options& o) {
  const std::filesystem::path scratch =
      o.keep.empty() ? std::filesystem::temp_directory_path() /
                           ("cavum-blind-" + std::to_string(std::random_device{}()))
                     : o.keep;
  struct Remove {
    std::filesystem::path folder;
    ~Remove() {
      std::error_code ignored;
      if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
    }
  } remove{o.keep.empty() ? scratch : std::filesystem::path{}};
  if (!o.one_case.empty()) {
    std::printf("%s\n", line_of(run(o, request_of(o.one_case), scratch)).c_str());
    return 0;
  }
  std::printf("CAVUM_TEST_SEED=%llu\n", static_cast<unsigned long long>(o.seed));
  Draw draw(o.seed);
  const std::vector<Outcome> done = run_all(o, plan(o, draw), scratch);
  print_simpler(done);
  if (o.only_simpler) return 0;
  print_table(done);
  return hold(done) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return go(parse(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
