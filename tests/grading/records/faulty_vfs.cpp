#include "tests/grading/records/faulty_vfs.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "engine/base/random.h"

namespace cavum::testing_ledger {
namespace {

/// What a write or truncation replaced, until the file is synced.
struct Undo {
  std::string path;
  sqlite3_int64 offset = 0, size_before = 0;
  std::vector<char> before;
};

struct State {
  InjectedFault fault = InjectedFault::none;
  int at = 0, changes = 0;
  bool happened = false;
  Random random{1};
  std::vector<Undo> undo;
};
State* g_state = nullptr;  // SQLite's callbacks have nowhere else to look
sqlite3_vfs* g_disk = nullptr;
sqlite3_vfs g_shim;
sqlite3_io_methods g_methods;

struct File {
  sqlite3_file base;
  sqlite3_file* real;
  char path[512];
};
File* file_of(sqlite3_file* f) { return reinterpret_cast<File*>(f); }
sqlite3_file* real_of(sqlite3_file* f) { return file_of(f)->real; }

void lose_what_was_not_synced() {
  for (auto u = g_state->undo.rbegin(); u != g_state->undo.rend(); ++u) {
    if (g_state->random.below(2) == 0) continue;
    const int fd = ::open(u->path.c_str(), O_WRONLY);
    if (fd < 0) continue;
    if (!u->before.empty() && ::pwrite(fd, u->before.data(), u->before.size(), u->offset) < 0)
      std::abort();
    if (u == g_state->undo.rend() - 1 && ::ftruncate(fd, u->size_before) != 0) std::abort();
    ::close(fd);
  }
  g_state->undo.clear();
}

/// True when this change does not happen.
bool fails() {
  if (g_state == nullptr) return false;
  if (g_state->happened && g_state->fault == InjectedFault::power_cut) return true;
  if (++g_state->changes != g_state->at || g_state->fault == InjectedFault::none) return false;
  g_state->happened = true;
  if (g_state->fault == InjectedFault::power_cut) lose_what_was_not_synced();
  return true;
}
bool dark() {
  return g_state != nullptr && g_state->happened && g_state->fault == InjectedFault::power_cut;
}

void remember(sqlite3_file* f, sqlite3_int64 offset, int bytes) {
  if (g_state == nullptr) return;
  Undo u;
  u.path = file_of(f)->path;
  u.offset = offset;
  real_of(f)->pMethods->xFileSize(real_of(f), &u.size_before);
  const auto there = std::clamp<sqlite3_int64>(u.size_before - offset, 0, bytes);
  u.before.resize(static_cast<std::size_t>(there));
  if (there > 0 && real_of(f)->pMethods->xRead(real_of(f), u.before.data(), static_cast<int>(there),
                                               offset) != SQLITE_OK)
    u.before.clear();
  g_state->undo.push_back(std::move(u));
}

int x_close(sqlite3_file* f) { return real_of(f)->pMethods->xClose(real_of(f)); }
int x_read(sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
  return dark() ? SQLITE_IOERR_READ : real_of(f)->pMethods->xRead(real_of(f), to, n, at);
}
int x_write(sqlite3_file* f, const void* from, int n, sqlite3_int64 at) {
  if (fails()) return SQLITE_FULL;
  remember(f, at, n);
  return real_of(f)->pMethods->xWrite(real_of(f), from, n, at);
}
int x_truncate(sqlite3_file* f, sqlite3_int64 size) {
  if (fails()) return SQLITE_IOERR_TRUNCATE;
  sqlite3_int64 now = 0;
  real_of(f)->pMethods->xFileSize(real_of(f), &now);
  if (now > size) remember(f, size, static_cast<int>(now - size));
  return real_of(f)->pMethods->xTruncate(real_of(f), size);
}
int x_sync(sqlite3_file* f, int flags) {
  if (fails()) return SQLITE_IOERR_FSYNC;
  if (g_state != nullptr)
    std::erase_if(g_state->undo, [&](const Undo& u) { return u.path == file_of(f)->path; });
  return real_of(f)->pMethods->xSync(real_of(f), flags);
}
int x_file_size(sqlite3_file* f, sqlite3_int64* size) {
  return real_of(f)->pMethods->xFileSize(real_of(f), size);
}
int x_lock(sqlite3_file* f, int l) { return real_of(f)->pMethods->xLock(real_of(f), l); }
int x_unlock(sqlite3_file* f, int l) { return real_of(f)->pMethods->xUnlock(real_of(f), l); }
int x_check(sqlite3_file* f, int* out) {
  return real_of(f)->pMethods->xCheckReservedLock(real_of(f), out);
}
int x_control(sqlite3_file* f, int op, void* arg) {
  return real_of(f)->pMethods->xFileControl(real_of(f), op, arg);
}
int x_sector(sqlite3_file* f) { return real_of(f)->pMethods->xSectorSize(real_of(f)); }
int x_device(sqlite3_file* f) { return real_of(f)->pMethods->xDeviceCharacteristics(real_of(f)); }
int x_shm_map(sqlite3_file* f, int page, int size, int extend, void volatile** out) {
  return real_of(f)->pMethods->xShmMap(real_of(f), page, size, extend, out);
}
int x_shm_lock(sqlite3_file* f, int offset, int n, int flags) {
  return real_of(f)->pMethods->xShmLock(real_of(f), offset, n, flags);
}
void x_shm_barrier(sqlite3_file* f) { real_of(f)->pMethods->xShmBarrier(real_of(f)); }
int x_shm_unmap(sqlite3_file* f, int remove) {
  return real_of(f)->pMethods->xShmUnmap(real_of(f), remove);
}

int x_open(sqlite3_vfs* /*vfs*/, const char* name, sqlite3_file* out, int flags, int* out_flags) {
  File* f = file_of(out);
  f->real = reinterpret_cast<sqlite3_file*>(f + 1);
  std::memset(f->path, 0, sizeof f->path);
  if (name != nullptr) std::strncpy(f->path, name, sizeof f->path - 1);
  const int code =
      dark() ? SQLITE_CANTOPEN : g_disk->xOpen(g_disk, name, f->real, flags, out_flags);
  f->base.pMethods = code == SQLITE_OK ? &g_methods : nullptr;
  return code;
}
int x_delete(sqlite3_vfs* /*vfs*/, const char* name, int sync) {
  return fails() ? SQLITE_IOERR_DELETE : g_disk->xDelete(g_disk, name, sync);
}

void set_up() {
  if (g_disk != nullptr) return;
  g_disk = sqlite3_vfs_find(nullptr);
  g_shim = *g_disk;
  g_shim.zName = "faulty";
  g_shim.pNext = nullptr;
  g_shim.szOsFile = static_cast<int>(sizeof(File)) + g_disk->szOsFile;
  g_shim.xOpen = x_open;
  g_shim.xDelete = x_delete;
  g_methods = {2,          x_close,       x_read,      x_write,   x_truncate, x_sync,   x_file_size,
               x_lock,     x_unlock,      x_check,     x_control, x_sector,   x_device, x_shm_map,
               x_shm_lock, x_shm_barrier, x_shm_unmap, nullptr,   nullptr};
}

}  // namespace

FaultyDisk::FaultyDisk(InjectedFault fault, int at, std::uint64_t seed) {
  sqlite3_initialize();
  set_up();
  g_state = new State;
  g_state->fault = fault;
  g_state->at = at;
  g_state->random = Random(seed);
  sqlite3_vfs_register(&g_shim, 1);
}

FaultyDisk::~FaultyDisk() {
  sqlite3_vfs_register(g_disk, 1);
  sqlite3_vfs_unregister(&g_shim);
  delete g_state;
  g_state = nullptr;
}

bool FaultyDisk::happened() { return g_state->happened; }
int FaultyDisk::changes() { return g_state->changes; }

}  // namespace cavum::testing_ledger
