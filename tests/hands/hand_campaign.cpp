// The detector against hands by others: hand_campaign [--sessions N] [--first SEED] [--hands A,B]
// [--log FILE.csv] [--jobs N] A table by hand, and one line a session in the log, for whoever wants
// to look further. See README.md.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/independent_runs.h"
#include "tests/hands/examine.h"
#include "tests/hands/table.h"

int main(int argc, char** argv) {
  using namespace cavum;
  int sessions = 300, jobs = 2;
  std::uint64_t first = 1;
  std::string only, log;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--sessions") sessions = std::atoi(argv[i + 1]);
    if (name == "--first") first = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--hands") only = argv[i + 1];
    if (name == "--log") log = argv[i + 1];
    if (name == "--jobs") jobs = std::atoi(argv[i + 1]);
  }
  std::vector<std::pair<const hands::HandKind*, std::uint64_t>> tasks;
  for (const auto& k : hands::all_hands())
    if (only.empty() ||
        ("," + only + ",").find("," + std::string(k.name) + ",") != std::string::npos)
      for (int i = 0; i < sessions; ++i)
        tasks.emplace_back(&k, first + static_cast<std::uint64_t>(i));
  std::vector<hands::Examined> all(tasks.size());
  independent_runs(
      tasks.size(),
      [&](std::size_t i) {
        all[i] = hands::examine(hands::drill(*tasks[i].first, tasks[i].second));
      },
      static_cast<std::size_t>(jobs));
  if (!log.empty()) {
    std::ofstream out(log);
    out << hands::log_head() << "\n";
    for (std::size_t i = 0; i < all.size(); ++i)
      out << tasks[i].second << "," << hands::log_line(all[i]) << "\n";
  }
  std::cout << hands::table(all);
  return 0;
}
