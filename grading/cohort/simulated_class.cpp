#include "grading/cohort/simulated_class.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <vector>

#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/base/independent_runs.h"
#include "engine/base/random.h"
#include "grading/marking/close_exam.h"
#include "grading/records/filing.h"
#include "grading/records/issue.h"
#include "scenarios/operators/simulated_exam.h"

namespace cavum::cohort {
namespace {

constexpr std::int64_t k_day_ns = 86'400'000'000'000;

struct Student {
  std::string ticket, candidate, skill, path;
  std::uint64_t seed = 0;
};

void sit(const Student& student, const std::string& scenario) {
  scenarios::ExamOptions options;
  options.candidate = student.candidate;
  options.source = {SourceKind::simulated_operator, student.skill};
  options.position_quantum_mm = OmniModel{}.quantum_mm;
  options.notes = {{"operator", student.skill},
                   {"operator_seed", std::to_string(student.seed)},
                   {records::k_ticket_note, student.ticket}};
  const auto setup = scenarios::prepare_exam(scenario, options);
  auto hands =
      scenarios::make_simulated_candidate(*setup, student.skill, student.seed, OmniModel{});
  const auto exam = scenarios::Exam::start(*setup, student.path, hands.start_mm());
  scenarios::run_exam(*exam, hands);
  static_cast<void>(grading::grade_and_close(*exam));
}

}  // namespace

ClassSat simulate_class(const SimulatedClass& wanted, records::Ledger& ledger,
                        records::Identities& identities, const std::function<void(int)>& done) {
  make_private_folder(wanted.sessions);
  const auto setup = scenarios::prepare_exam(wanted.scenario, {});
  const std::int64_t now = read_clocks().utc_ns;
  const records::Ticket ticket =
      records::promise(*setup, ledger.content(), now - k_day_ns, now + k_day_ns);

  Random random(wanted.seed);
  std::vector<int> level(static_cast<std::size_t>(wanted.n));
  for (std::size_t i = 0; i < level.size(); ++i)
    level[i] = static_cast<int>((2 * i + 1) * 50 / level.size());
  for (std::size_t i = level.size(); i-- > 1;) std::swap(level[i], level[random.below(i + 1)]);
  std::vector<Student> students;
  for (int i = 0; i < wanted.n; ++i) {
    Student s;
    s.seed = random.next() >> 1;
    s.skill = fmt::format("student-{}", level[static_cast<std::size_t>(i)]);
    s.candidate = identities.enrol(fmt::format("simulated-{}-{}", wanted.seed, i + 1), "",
                                   ticket.exam, ledger.key());
    s.path = fmt::format("{}/{}.cavum", wanted.sessions, file_name_of(s.candidate));
    if (std::filesystem::exists(s.path))
      throw Error(s.path, msg("is there already"), msg("name another folder, or another --seed"));
    s.ticket = records::issue(ledger, ticket, s.candidate);
    students.push_back(std::move(s));
  }

  ClassSat out;
  grading::ExamContexts grounds;  // of the class
  std::mutex mutex;               // of `out` and the ledger
  independent_runs(
      students.size(),
      [&](std::size_t i) {
        sit(students[i], wanted.scenario);
        const records::MarkedRecording marked(students[i].path, grounds);
        const std::lock_guard lock(mutex);
        ++out.sat;
        out.bytes += static_cast<std::int64_t>(std::filesystem::file_size(students[i].path));
        if (records::file_session(ledger, marked, {.simulated = true}).seq) ++out.filed;
        done(out.sat);
      },
      static_cast<std::size_t>(std::clamp(wanted.at_once, 1, 16)));
  return out;
}

}  // namespace cavum::cohort
