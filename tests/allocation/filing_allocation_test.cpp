// Memory runs out once, at every request in turn, while an exam is filed. Each time there is a
// clear error and the ledger is what it was, or the exam is filed as without it; never a crash, and
// never a finding against the candidate. Afterwards the same exam is filed. CAVUM_ALLOCATION_EVERY
// says at each how many'th request (1: all of them); which ones are drawn, CAVUM_TEST_SEED repeats
// them.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iostream>

#include "engine/base/memory_reserve.h"
#include "engine/base/random.h"
#include "tests/allocation/failing_memory.h"
#include "tests/grading/records/school.h"
#include "tests/grading/records/short_exam.h"

namespace cavum {
namespace {

using namespace testing_ledger;

std::vector<std::string> texts_of(const records::LedgerContent& c) {
  std::vector<std::string> out;
  for (const auto& e : c.entries) out.push_back(e.text);
  return out;
}

class FilingWithoutMemory : public ::testing::Test {
 protected:
  FilingWithoutMemory() {
    school_.emplace();
    exam_ = school_->file("short.cavum");
    sit_shortly(k_scenario, exam_, school_->ticket("4711"));
    before_ = texts_of(records::read_ledger(school_->places()));
  }

  /// One filing, as `cavum ledger add` does it, with the n-th request refused. What is wrong, in
  /// words; the requests that there were.
  std::pair<std::string, std::uint64_t> file_once(std::uint64_t n) {
    const School copy(*school_);
    const std::string exam = copy.file("short.cavum");
    std::string said;
    std::optional<records::Filing> filing;
    const records::LedgerPaths places = copy.places();
    const std::string folder = copy.ledger_folder();
    keep_memory_reserve();
    testing_allocation::begin_counting(n);
    try {
      records::Ledger ledger(folder, records::load_school_key(records::school_key_path()));
      grading::ExamContexts grounds;
      filing = records::file_session(ledger, exam, {}, grounds);
    } catch (const std::bad_alloc&) {
      said = "memory: there is not enough; close other programs, and try again";
    } catch (const Error& e) {
      said = (e.code() == MemoryError::ran_out ? "memory: " : "") + std::string(e.what());
    } catch (const std::exception& e) {
      said = e.what();
    }
    const std::uint64_t requests = testing_allocation::end_counting();
    const std::string at = "request " + std::to_string(n) + ": ";
    if (filing && !filing->findings.empty())
      return {at + "a sound exam is refused: " + english_text(filing->findings[0].message()),
              requests};
    if (!filing && said.find("; ") == std::string::npos)
      return {at + "does not say what to do: " + said, requests};
    if (!filing && said.find("memory") == std::string::npos)
      return {at + "does not say that memory is short: " + said, requests};
    const records::LedgerCheck check = records::check_ledger(places, false);
    if (!check.findings.empty())
      return {at + "the ledger does not hold: " + english_text(check.findings[0].message()) + " (" +
                  said + ")",
              requests};
    auto now = texts_of(records::read_ledger(places));
    if (!filing && now != before_)
      return {at + "the ledger was changed, and yet: " + said, requests};
    if (!filing) {
      keep_memory_reserve();  // the next program
      records::Ledger ledger(folder, records::load_school_key(records::school_key_path()));
      const records::Filing again = records::file_session(ledger, exam, {}, grounds_);
      if (!again.seq)
        return {at + "afterwards it cannot be filed: " + english_text(again.findings[0].message()),
                requests};
      now = texts_of(records::read_ledger(places));
    }
    if (now.size() != before_.size() + 1 || !records::check_ledger(places, false).findings.empty())
      return {at + "it was not filed", requests};
    return {"", requests};
  }

  std::optional<School> school_;
  std::string exam_;
  std::vector<std::string> before_;
  grading::ExamContexts grounds_;
};

TEST_F(FilingWithoutMemory, SaysSoAndLeavesTheLedgerAsItWas) {
  const auto [wrong, requests] = file_once(0);
  ASSERT_EQ(wrong, "");
  const char* asked = std::getenv("CAVUM_ALLOCATION_EVERY");
  const std::uint64_t wanted = asked != nullptr ? std::strtoull(asked, nullptr, 10)
                               : std::getenv("CAVUM_DEEP") != nullptr ? 1
                                                                      : requests / 40;
  const std::uint64_t every = std::max<std::uint64_t>(1, wanted);
  Random random(test::drawn_seed("filing without memory"));
  const std::uint64_t first = 1 + random.below(every);
  std::cout << requests << " requests, every " << every << " from " << first << "\n";
  const std::string told = school_->file("told");
  std::uint64_t tried = 0, failed = 0;
  const auto begun = std::chrono::steady_clock::now();
  for (std::uint64_t n = first; n <= requests; n += every) {
    // a process of its own for many: a crash is seen, and the rest goes on behind it
    std::cout.flush();
    const pid_t child = ::fork();
    if (child == 0) {
      std::ofstream out(told);
      for (std::uint64_t k = n, i = 0; k <= requests && i < 200; k += every, ++i) {
        out << "at " << k << std::endl;
        try {
          if (const std::string what = file_once(k).first; !what.empty())
            out << "wrong " << what << std::endl;
        } catch (const std::exception& e) {
          out << "wrong request " << k << ": afterwards " << e.what() << std::endl;
        }
      }
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    std::ifstream in(told);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("at ")) n = std::stoull(line.substr(3)), ++tried;
      if (line.starts_with("wrong ") && ++failed <= 40) ADD_FAILURE() << line.substr(6);
    }
    if (status != 0 && ++failed <= 40)
      ADD_FAILURE() << "request " << n << ": the program ended, status " << status;
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::cout << tried << " of " << requests << " tried in " << seconds << " s, " << failed
            << " findings\n";
}

}  // namespace
}  // namespace cavum
