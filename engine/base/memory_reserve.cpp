#include "engine/base/memory_reserve.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include "engine/base/error.h"

namespace cavum {
namespace {

constexpr std::size_t k_reserve_bytes = 16U << 20;
// `new` knows one handler for the whole program, and gives it nothing
std::atomic<void*> g_reserve{nullptr};
std::atomic<bool> g_ran_out{false};

void give_reserve() {
  void* reserve = g_reserve.exchange(nullptr);
  if (reserve == nullptr) throw std::bad_alloc();
  g_ran_out = true;
  std::free(reserve);
}

}  // namespace

void keep_memory_reserve() noexcept {
  void* none = nullptr;
  if (g_reserve.load() == nullptr) {
    void* fresh = std::malloc(k_reserve_bytes);
    if (!g_reserve.compare_exchange_strong(none, fresh)) std::free(fresh);
  }
  g_ran_out = g_reserve.load() == nullptr;
  std::set_new_handler(give_reserve);
}

bool memory_ran_out() noexcept { return g_ran_out; }

void require_memory(const std::string& where) {
  if (memory_ran_out())
    throw Error(MemoryError::ran_out, Name{where},
                msg("there was not enough memory, and nothing was entered"),
                msg("close other programs, and try again"));
}

}  // namespace cavum
