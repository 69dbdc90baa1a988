// What filing a class costs beside replaying it: each recording is simulated, its scenario run, and
// marked, with zones and teeth made once.
//   filing_bench SCENARIO.toml [CANDIDATES]      200 unless told; ends with 1 above 1.3 times
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>

#include "engine/base/file.h"
#include "engine/session/verify.h"
#include "grading/cohort/simulated_class.h"
#include "grading/records/filing.h"
#include "grading/records/identities.h"
#include "grading/records/issue.h"
#include "scenarios/exam/exam.h"

namespace {

/// Time that this program had of the processor: waiting for other programs does not count.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main(int argc, char** argv) {
  using namespace cavum;
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: filing_bench SCENARIO.toml [CANDIDATES]\n");
    return 2;
  }
  char folder[] = "/tmp/cavum-filing-XXXXXX";
  if (::mkdtemp(folder) == nullptr) return 2;
  const std::string home = folder;
  ::setenv("CAVUM_HOME", home.c_str(), 1);
  int code = 0;
  try {
    const SigningKey key = records::load_school_key(records::school_key_path(), true);
    cohort::SimulatedClass wanted;
    wanted.scenario = argv[1];
    wanted.sessions = home + "/sessions";
    wanted.n = argc == 3 ? std::atoi(argv[2]) : 200;
    {
      records::Ledger::create(home + "/sat", "school", key);
      records::Ledger ledger(home + "/sat", key);
      records::Identities identities(home + "/sat/identities.db", true);
      static_cast<void>(cohort::simulate_class(wanted, ledger, identities, [](int) {}));
    }
    // filed in a ledger that has promised as many exams; these are another ledger's, so each is
    // filed with that finding
    records::Ledger::create(home + "/filed", "school", key);
    records::Ledger ledger(home + "/filed", key);
    const records::Ticket ticket =
        records::promise(*scenarios::prepare_exam(wanted.scenario, {}), ledger.content(), 0, 1);
    for (int i = 0; i < wanted.n; ++i)
      static_cast<void>(records::issue(ledger, ticket, "C-" + std::to_string(i)));
    std::set<std::string> files;
    for (const auto& f : std::filesystem::directory_iterator(wanted.sessions))
      files.insert(f.path().string());
    double replay = 0, filing = 0;
    grading::ExamContexts grounds;
    for (const auto& file : files) {  // in turns: a machine that slows down slows both
      const double a = cpu_seconds();
      if (!verify_session(file).verified)
        throw Error(file, msg("is not verified"), msg("this is a defect"));
      const double b = cpu_seconds();
      if (!records::file_session(ledger, file, {true, true, true}, grounds).seq)
        throw Error(file, msg("was not filed"), msg("this is a defect"));
      replay += b - a;
      filing += cpu_seconds() - b;
    }
    std::printf(
        "%zu exams of %s: replayed in %.1f s, filed in %.1f s of the processor: %.3f times\n",
        files.size(), argv[1], replay, filing, filing / replay);
    code = filing / replay <= 1.3 ? 0 : 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "filing_bench: %s\n", e.what());
    code = 2;
  }
  std::filesystem::remove_all(home);
  return code;
}
