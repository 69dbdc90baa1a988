// Writes the seeds of one target into a folder, a file each: make_seeds NAME FOLDER
#include <cstdio>
#include <exception>
#include <string>

#include "engine/base/file.h"
#include "tests/fuzz/targets.h"

int main(int argc, char** argv) {
  try {
    for (const auto& target : cavum::fuzz::targets())
      if (argc == 3 && target.name == std::string(argv[1])) {
        int number = 0;
        for (const auto& seed : target.seeds())
          cavum::write_file(std::string(argv[2]) + "/made-" + std::to_string(number++), seed);
        return 0;
      }
    std::fprintf(stderr, "make_seeds NAME FOLDER\n");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make_seeds: %s\n", e.what());
  }
  return 2;
}
