// Random changes of an input, where no fuzzer chooses them.
#pragma once

#include <random>

#include "engine/base/bytes.h"

namespace cavum::fuzz {

/// A few of the changes that a fuzzer makes: bits, bytes, runs of bytes out of one place or another
/// input into another place, an end cut off.
[[nodiscard]] Bytes changed(Bytes input, const Bytes& other, std::mt19937_64& draw);

}  // namespace cavum::fuzz
