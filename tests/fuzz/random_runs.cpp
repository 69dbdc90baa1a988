// Runs one target on random changes of its seeds and of the inputs in some folders: random_runs
// NAME RUNS [FOLDER...]. For what libFuzzer cannot be compiled with: the whole reading of volumes.
// A finding ends it; the input lies in the present folder, as last-input.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <random>
#include <string>

#include "engine/base/file.h"
#include "tests/fuzz/changes.h"
#include "tests/fuzz/targets.h"

namespace {

int run(const cavum::fuzz::Target& target, long runs, int folders, char** folder) {
  std::vector<cavum::Bytes> seeds = target.seeds();
  for (int i = 0; i < folders; ++i)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder[i]))
      if (entry.is_regular_file()) seeds.push_back(cavum::read_file(entry.path().string()));
  const unsigned long long seed = std::random_device()();
  std::mt19937_64 draw(seed);
  const auto began = std::chrono::steady_clock::now();
  for (long i = 0; i < runs; ++i) {
    const auto input =
        cavum::fuzz::changed(seeds[draw() % seeds.size()], seeds[draw() % seeds.size()], draw);
    cavum::write_file("last-input", input);
    target.run(input);
  }
  std::filesystem::remove("last-input");
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - began)
          .count();
  std::printf("%s: %zu seeds, %ld runs, %lld s, drawn from %llu\n", target.name, seeds.size(), runs,
              static_cast<long long>(seconds), seed);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    for (const auto& target : cavum::fuzz::targets())
      if (argc >= 3 && target.name == std::string(argv[1]))
        return run(target, std::atol(argv[2]), argc - 3, argv + 3);
    std::fprintf(stderr, "random_runs NAME RUNS [FOLDER...]\n");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "random_runs: %s\n", e.what());
  }
  return 2;
}
