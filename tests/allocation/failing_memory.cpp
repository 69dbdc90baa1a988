#include "tests/allocation/failing_memory.h"

#include <cerrno>
#include <cstdlib>

// what the C library itself calls
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t n, size_t size);
void* __libc_realloc(void* p, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* p);
}

namespace cavum::testing_allocation {
namespace {

bool g_counting = false;
std::uint64_t g_count = 0, g_refused = 0;

bool refused() noexcept {
  if (!g_counting || ++g_count != g_refused) return false;
  errno = ENOMEM;
  return true;
}

}  // namespace

void begin_counting(std::uint64_t at) noexcept {
  g_count = 0;
  g_refused = at;
  g_counting = true;
}

std::uint64_t end_counting() noexcept {
  g_counting = false;
  return g_count;
}

}  // namespace cavum::testing_allocation

using cavum::testing_allocation::refused;

extern "C" {

void* malloc(size_t size) noexcept { return refused() ? nullptr : __libc_malloc(size); }
void* calloc(size_t n, size_t size) noexcept {
  return refused() ? nullptr : __libc_calloc(n, size);
}
void* realloc(void* p, size_t size) noexcept {
  return refused() ? nullptr : __libc_realloc(p, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
  return refused() ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return refused() ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** out, size_t alignment, size_t size) noexcept {
  void* p = refused() ? nullptr : __libc_memalign(alignment, size);
  if (p == nullptr) return ENOMEM;
  *out = p;
  return 0;
}
void free(void* p) noexcept { __libc_free(p); }

}  // extern "C"
