// Every reader of files that come from elsewhere, under its seeds, under all that ever was a finding (seeds/NAME), and under some thousand random
// changes of both: the short form of `./dev fuzz`, in every build. That nothing ends the program is the claim.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <random>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

class Readers : public testing::TestWithParam<Target> {};

/// A few of the changes that a fuzzer makes: bits, bytes, runs of bytes out of one place or another input into another place, an end cut off.
Bytes changed(Bytes b, const Bytes& other, std::mt19937_64& draw) {
  const auto below = [&draw](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(draw() % n); };
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const auto at = static_cast<std::ptrdiff_t>(below(b.size() + 1));
    switch (b.empty() ? 3 : below(6)) {
      case 0:
        b[below(b.size())] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 1:
        b[below(b.size())] = std::array<std::uint8_t, 6>{0, 1, 127, 128, 255, '9'}[below(6)];
        break;
      case 2:
        b.erase(b.begin() + at, b.begin() + std::min<std::ptrdiff_t>(at + static_cast<std::ptrdiff_t>(1 + below(8)), std::ssize(b)));
        break;
      case 3: {
        if (other.empty()) break;
        const std::size_t from = below(other.size()), length = 1 + below(std::min<std::size_t>(64, other.size() - from));
        b.insert(b.begin() + at, other.begin() + static_cast<std::ptrdiff_t>(from), other.begin() + static_cast<std::ptrdiff_t>(from + length));
        break;
      }
      case 4:
        b.resize(static_cast<std::size_t>(at));
        break;
      default:
        std::swap(b[below(b.size())], b[below(b.size())]);
    }
  }
  return b;
}

std::vector<Bytes> findings_of(const std::string& name) {
  std::vector<Bytes> out;
  std::vector<std::filesystem::path> paths;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) + "/tests/fuzz/seeds/" + name, none))
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

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers, testing::ValuesIn(targets()), [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace cavum::fuzz
