// Every reader of files that come from elsewhere, under its seeds, under all that ever was a
// finding (seeds/NAME), and under some thousand random changes of both: the short form of `./dev
// fuzz`, in every build. That nothing ends the program is the claim.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"
#include "tests/fuzz/changes.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

class Readers : public ::testing::TestWithParam<Target> {};

std::vector<Bytes> findings_of(const std::string& name) {
  std::vector<Bytes> out;
  std::vector<std::filesystem::path> paths;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(CAVUM_SOURCE_DIR "/tests/fuzz/seeds/" + name, none))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const auto& p : paths) out.push_back(read_file(p.string()));
  return out;
}

TEST_P(Readers, AnswerAnyBytes) {
  const Target& target = GetParam();
  std::vector<Bytes> seeds = target.seeds();
  ASSERT_FALSE(seeds.empty());
  for (auto& f : findings_of(target.name)) seeds.push_back(std::move(f));
  target.run({});
  for (const auto& seed : seeds) target.run(seed);
  std::mt19937_64 draw(testing_basics::drawn_seed(target.name));
  const auto began = std::chrono::steady_clock::now();
  int runs = 0;
  for (; runs < 3000 && std::chrono::steady_clock::now() - began < std::chrono::seconds(4); ++runs)
    target.run(changed(seeds[draw() % seeds.size()], seeds[draw() % seeds.size()], draw));
  std::printf("%s: %zu seeds, %d changes\n", target.name, seeds.size(), runs);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers, ::testing::ValuesIn(targets()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace cavum::fuzz
