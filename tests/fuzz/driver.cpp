// One fuzzer: libFuzzer asks for this function, and the program's name for one of the targets.
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cavum::fuzz::CAVUM_FUZZ_TARGET({data, size});
  return 0;
}
