// The C library's calls for files, locks, clocks, sleep and random numbers, in the place of its
// own: SQLite, libsodium and the C++ library come here, too. While a process of a World runs, what
// concerns /sim/ is answered from its disks; everything else, and everybody else, gets the real
// machine.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <set>
#include <string>

#include "tests/simulation/sim_world.h"

namespace cavum::simulation {
namespace {

/// The C library's own function of this name.
template <class F>
F real(const char* name) {
  return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}

bool ours(const char* path) {
  return World::here() != nullptr && path != nullptr &&
         (std::strncmp(path, k_root, sizeof k_root - 1) == 0 || std::string(path) + "/" == k_root);
}
OpenFile* ours(int fd) {
  World* w = World::here();
  if (w == nullptr || fd < 1 << 20) return nullptr;
  const auto found = w->files.find(fd);
  return found == w->files.end() ? nullptr : &found->second;
}
int fail(int error) {
  errno = error;
  return -1;
}
World& world() { return *World::here(); }
Computer& computer() { return *world().process().computer; }
bool full() { return computer().full_until_ns > world().true_ns(); }

std::uint8_t random_byte() { return static_cast<std::uint8_t>(world().given_out().next() >> 20); }
void fill(void* to, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) static_cast<std::uint8_t*>(to)[i] = random_byte();
}

int new_file(NodePtr node, int flags) {
  const int fd = ++world().last_file;
  world().files[fd] = {world().process().number, std::move(node), 0, flags, false};
  return fd;
}

int open_node(NodePtr node, const NodePtr& folder, const std::string& name, int flags,
              mode_t mode) {
  if (node && (flags & O_CREAT) != 0 && (flags & O_EXCL) != 0) return fail(EEXIST);
  if (!node) {
    if ((flags & O_CREAT) == 0 || !folder || !folder->is_folder()) return fail(ENOENT);
    if (full()) return fail(ENOSPC);
    node = computer().disk.make(S_IFREG | (mode & 0777));
    folder->names[name] = node;
    folder->names_changed();
  }
  if (node->is_folder() && (flags & O_ACCMODE) != O_RDONLY) return fail(EISDIR);
  if (!node->is_folder() && (flags & O_DIRECTORY) != 0) return fail(ENOTDIR);
  if ((flags & O_TRUNC) != 0) node->resize(0);
  return new_file(std::move(node), flags);
}

int open_path(const char* path, int flags, mode_t mode) {
  world().pause();
  NodePtr folder;
  std::string name;
  NodePtr node = world().find(path, &folder, &name);
  return open_node(std::move(node), folder, name, flags, mode);
}

ssize_t read_at(OpenFile& f, void* to, std::size_t n, std::int64_t at) {
  const std::string what = f.node->read(at, static_cast<std::int64_t>(n));
  std::memcpy(to, what.data(), what.size());
  return static_cast<ssize_t>(what.size());
}

ssize_t write_at(OpenFile& f, const void* from, std::size_t n, std::int64_t at) {
  if ((f.flags & O_ACCMODE) == O_RDONLY) return fail(EBADF);
  if (full() && at + static_cast<std::int64_t>(n) > f.node->promised) {
    // what fits before the disk is full is written
    const std::size_t fits = n > 1 ? world().random().below(n) : 0;
    if (fits == 0 || world().random().below(2) == 0) return fail(ENOSPC);
    n = fits;
  }
  f.node->write(at, std::string(static_cast<const char*>(from), n));
  return static_cast<ssize_t>(n);
}

int sync_file(OpenFile& f) {
  if (computer().next_sync_fails) {
    computer().next_sync_fails = false;
    return fail(EIO);
  }
  world().wait(1'000'000);
  f.node->sync();
  return 0;
}

void tell(const Node& n, struct stat* out) {
  std::memset(out, 0, sizeof *out);
  // SQLite shares what it knows of a file between all connections of a process; a device of its own
  // keeps these processes apart
  out->st_dev = world().process().device;
  out->st_ino = n.number;
  out->st_mode = n.mode;
  out->st_nlink = 1;
  out->st_size = n.size();
  out->st_blksize = 4096;
  out->st_uid = ::getuid();
}

int stat_path(const char* path, struct stat* out) {
  world().pause();
  const NodePtr node = world().find(path, nullptr, nullptr);
  if (!node) return fail(ENOENT);
  tell(*node, out);
  return 0;
}

bool overlap(const ByteLock& a, const ByteLock& b) {
  return a.first <= b.last && b.first <= a.last;
}

/// POSIX locks: those of one process never stand in its own way, and a new one takes the place of
/// what it covers.
int lock_bytes(OpenFile& f, int command, struct flock* asked) {
  ByteLock wanted{f.process, asked->l_type == F_WRLCK, asked->l_start,
                  asked->l_len == 0 ? INT64_MAX : asked->l_start + asked->l_len - 1};
  auto& locks = f.node->locks;
  if (asked->l_type != F_UNLCK)
    for (const ByteLock& l : locks)
      if (l.process != wanted.process && overlap(l, wanted) && (l.exclusive || wanted.exclusive)) {
        if (command != F_GETLK) return fail(EAGAIN);
        asked->l_type = l.exclusive ? F_WRLCK : F_RDLCK;
        asked->l_pid = 100000 + l.process;
        return 0;
      }
  if (command == F_GETLK) {
    asked->l_type = F_UNLCK;
    return 0;
  }
  std::vector<ByteLock> now;
  for (const ByteLock& l : locks) {
    if (l.process != wanted.process || !overlap(l, wanted)) {
      now.push_back(l);
      continue;
    }
    if (l.first < wanted.first) now.push_back({l.process, l.exclusive, l.first, wanted.first - 1});
    if (l.last > wanted.last) now.push_back({l.process, l.exclusive, wanted.last + 1, l.last});
  }
  if (asked->l_type != F_UNLCK) now.push_back(wanted);
  locks = std::move(now);
  return 0;
}

int control(OpenFile& f, int command, void* argument) {
  if (command == F_GETLK || command == F_SETLK) {
    world().pause();
    return lock_bytes(f, command, static_cast<struct flock*>(argument));
  }
  if (command == F_GETFL) return f.flags;
  if (command == F_GETFD || command == F_SETFD || command == F_SETFL) return 0;
  return fail(EINVAL);
}

int rename_path(const char* from, const char* to, bool may_replace) {
  world().pause();
  NodePtr from_folder, to_folder;
  std::string from_name, to_name;
  const NodePtr node = world().find(from, &from_folder, &from_name),
                there = world().find(to, &to_folder, &to_name);
  if (!node || !to_folder) return fail(ENOENT);
  if (there && !may_replace) return fail(EEXIST);
  if (there && there->is_folder()) return fail(EISDIR);
  from_folder->names.erase(from_name);
  to_folder->names[to_name] = node;
  to_folder->names_changed();
  if (from_folder != to_folder) from_folder->names_changed();
  return 0;
}

int second_name(const char* from, const char* to) {
  world().pause();
  NodePtr folder;
  std::string name;
  const NodePtr node = world().find(from, nullptr, nullptr);
  if (world().find(to, &folder, &name)) return fail(EEXIST);
  if (!node || !folder) return fail(ENOENT);
  if (full()) return fail(ENOSPC);
  folder->names[name] = node;
  folder->names_changed();
  return 0;
}

int take_name(const NodePtr& folder, const std::string& name, bool is_folder) {
  const auto found = folder->names.find(name);
  if (found == folder->names.end()) return fail(ENOENT);
  if (found->second->is_folder() != is_folder) return fail(is_folder ? ENOTDIR : EISDIR);
  if (is_folder && !found->second->names.empty()) return fail(ENOTEMPTY);
  folder->names.erase(found);
  folder->names_changed();
  return 0;
}

int remove_path(const char* path, int kinds) {  // 1: files, 2: folders, 3: both
  world().pause();
  NodePtr folder;
  std::string name;
  const NodePtr node = world().find(path, &folder, &name);
  if (!node) return fail(ENOENT);
  return take_name(folder, name, kinds == 2 || (kinds == 3 && node->is_folder()));
}

int make_folder(const char* path, mode_t mode) {
  world().pause();
  NodePtr folder;
  std::string name;
  if (world().find(path, &folder, &name)) return fail(EEXIST);
  if (name.empty()) return fail(EEXIST);  // the computer's root
  if (!folder) return fail(ENOENT);
  if (full()) return fail(ENOSPC);
  folder->names[name] = computer().disk.make(S_IFDIR | (mode & 0777));
  folder->names_changed();
  return 0;
}

/// A folder that is being listed: the names that it had when it was opened.
struct Listing {
  int fd = -1;
  std::vector<std::pair<std::string, bool>> names;
  std::size_t next = 0;
  dirent entry{};
};
std::set<Listing*>& listings() {
  static std::set<Listing*> all;
  return all;
}
Listing* listing_of(DIR* d) {
  auto* l = reinterpret_cast<Listing*>(d);
  return listings().contains(l) ? l : nullptr;
}
DIR* list(int fd) {
  auto* l = new Listing;
  l->fd = fd;
  for (const auto& [name, node] : ours(fd)->node->names)
    l->names.emplace_back(name, node->is_folder());
  listings().insert(l);
  return reinterpret_cast<DIR*>(l);
}

int close_file(int fd) {
  world().pause();
  const OpenFile f = world().files.at(fd);
  world().files.erase(fd);
  if (!f.node) return 0;
  // closing any descriptor of a file ends all of a process's locks on it
  std::erase_if(f.node->locks, [&](const ByteLock& l) { return l.process == f.process; });
  if (f.node->whole_lock_holder == fd) f.node->whole_lock_holder = 0;
  return 0;
}

std::int64_t sleep_ns(const timespec* t) {
  return static_cast<std::int64_t>(t->tv_sec) * 1'000'000'000 + t->tv_nsec;
}
void set(timespec* t, std::int64_t ns) {
  t->tv_sec = ns / 1'000'000'000;
  t->tv_nsec = ns % 1'000'000'000;
}

mode_t mode_of(int flags, va_list& more) {
  return (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(more, int)) : 0;
}

}  // namespace
}  // namespace cavum::simulation

using namespace cavum::simulation;

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  if (World::here() != nullptr && std::strcmp(path, "/dev/urandom") == 0) {
    const int fd = new_file(nullptr, flags);
    world().files[fd].random = true;
    return fd;
  }
  if (ours(path)) return open_path(path, flags, mode);
  static const auto f = real<int (*)(const char*, int, ...)>("open");
  return f(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  if (ours(path)) return open_path(path, flags, mode);
  if (const OpenFile* at = ours(folder); at != nullptr && path[0] != '/') {
    world().pause();
    const auto found = at->node->names.find(path);
    return open_node(found == at->node->names.end() ? nullptr : found->second, at->node, path,
                     flags, mode);
  }
  static const auto f = real<int (*)(int, const char*, int, ...)>("openat");
  return f(folder, path, flags, mode);
}
int close(int fd) {
  if (ours(fd) != nullptr) return close_file(fd);
  static const auto f = real<int (*)(int)>("close");
  return f(fd);
}
ssize_t read(int fd, void* to, size_t n) {
  if (OpenFile* o = ours(fd)) {
    if (o->random) {
      fill(to, n);
      return static_cast<ssize_t>(n);
    }
    world().pause();
    const ssize_t got = read_at(*o, to, n, o->offset);
    o->offset += got;
    return got;
  }
  static const auto f = real<ssize_t (*)(int, void*, size_t)>("read");
  return f(fd, to, n);
}
ssize_t write(int fd, const void* from, size_t n) {
  if (OpenFile* o = ours(fd)) {
    world().pause();
    if ((o->flags & O_APPEND) != 0) o->offset = o->node->size();
    const ssize_t put = write_at(*o, from, n, o->offset);
    if (put > 0) o->offset += put;
    return put;
  }
  static const auto f = real<ssize_t (*)(int, const void*, size_t)>("write");
  return f(fd, from, n);
}
ssize_t pread(int fd, void* to, size_t n, off_t at) {
  if (OpenFile* o = ours(fd)) {
    world().pause();
    return read_at(*o, to, n, at);
  }
  static const auto f = real<ssize_t (*)(int, void*, size_t, off_t)>("pread");
  return f(fd, to, n, at);
}
ssize_t pread64(int fd, void* to, size_t n, off64_t at) { return pread(fd, to, n, at); }
ssize_t pwrite(int fd, const void* from, size_t n, off_t at) {
  if (OpenFile* o = ours(fd)) {
    world().pause();
    return write_at(*o, from, n, at);
  }
  static const auto f = real<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return f(fd, from, n, at);
}
ssize_t pwrite64(int fd, const void* from, size_t n, off64_t at) { return pwrite(fd, from, n, at); }
off_t lseek(int fd, off_t to, int whence) noexcept {
  if (OpenFile* o = ours(fd)) {
    o->offset = to + (whence == SEEK_END ? o->node->size() : whence == SEEK_CUR ? o->offset : 0);
    return o->offset;
  }
  static const auto f = real<off_t (*)(int, off_t, int)>("lseek");
  return f(fd, to, whence);
}
off64_t lseek64(int fd, off64_t to, int whence) noexcept { return lseek(fd, to, whence); }
int ftruncate(int fd, off_t size) noexcept {
  if (OpenFile* o = ours(fd)) {
    world().pause();
    if (size > o->node->size() && full()) return fail(ENOSPC);
    o->node->resize(size);
    return 0;
  }
  static const auto f = real<int (*)(int, off_t)>("ftruncate");
  return f(fd, size);
}
int ftruncate64(int fd, off64_t size) noexcept { return ftruncate(fd, size); }
int fallocate(int fd, int mode, off_t at, off_t size) {
  if (OpenFile* o = ours(fd)) {
    world().pause();
    if (mode != FALLOC_FL_KEEP_SIZE) return fail(EOPNOTSUPP);
    if (at + size > o->node->promised && full()) return fail(ENOSPC);
    o->node->promised = std::max<std::int64_t>(o->node->promised, at + size);
    return 0;
  }
  static const auto f = real<int (*)(int, int, off_t, off_t)>("fallocate");
  return f(fd, mode, at, size);
}
int fallocate64(int fd, int mode, off64_t at, off64_t size) {
  return fallocate(fd, mode, at, size);
}
int fsync(int fd) {
  if (OpenFile* o = ours(fd)) {
    world().pause();
    return sync_file(*o);
  }
  static const auto f = real<int (*)(int)>("fsync");
  return f(fd);
}
int fdatasync(int fd) {
  if (ours(fd) != nullptr) return fsync(fd);
  static const auto f = real<int (*)(int)>("fdatasync");
  return f(fd);
}
int stat(const char* path, struct stat* out) noexcept {
  if (ours(path)) return stat_path(path, out);
  static const auto f = real<int (*)(const char*, struct stat*)>("stat");
  return f(path, out);
}
int stat64(const char* path, struct stat64* out) noexcept {
  return stat(path, reinterpret_cast<struct stat*>(out));
}
int lstat(const char* path, struct stat* out) noexcept {
  if (ours(path)) return stat_path(path, out);
  static const auto f = real<int (*)(const char*, struct stat*)>("lstat");
  return f(path, out);
}
int lstat64(const char* path, struct stat64* out) noexcept {
  return lstat(path, reinterpret_cast<struct stat*>(out));
}
int fstat(int fd, struct stat* out) noexcept {
  if (OpenFile* o = ours(fd)) {
    if (o->random) return fail(EINVAL);
    world().pause();
    tell(*o->node, out);
    return 0;
  }
  static const auto f = real<int (*)(int, struct stat*)>("fstat");
  return f(fd, out);
}
int fstat64(int fd, struct stat64* out) noexcept {
  return fstat(fd, reinterpret_cast<struct stat*>(out));
}
int fcntl(int fd, int command, ...) {
  va_list more;
  va_start(more, command);
  void* argument = va_arg(more, void*);
  va_end(more);
  if (OpenFile* o = ours(fd)) return control(*o, command, argument);
  static const auto f = real<int (*)(int, int, ...)>("fcntl");
  return f(fd, command, argument);
}
int fcntl64(int fd, int command, ...) {
  va_list more;
  va_start(more, command);
  void* argument = va_arg(more, void*);
  va_end(more);
  return fcntl(fd, command, argument);
}
int flock(int fd, int how) noexcept {
  if (OpenFile* o = ours(fd)) {
    const NodePtr node = o->node;
    for (world().pause();; world().sleep(1'000'000)) {
      if (how == LOCK_UN) {
        if (node->whole_lock_holder == fd) node->whole_lock_holder = 0;
        return 0;
      }
      if (node->whole_lock_holder == 0 || node->whole_lock_holder == fd) break;
      if ((how & LOCK_NB) != 0) return fail(EWOULDBLOCK);
    }
    node->whole_lock_holder = fd;
    return 0;
  }
  static const auto f = real<int (*)(int, int)>("flock");
  return f(fd, how);
}
int rename(const char* from, const char* to) noexcept {
  if (ours(from)) return rename_path(from, to, true);
  static const auto f = real<int (*)(const char*, const char*)>("rename");
  return f(from, to);
}
int renameat2(int from_at, const char* from, int to_at, const char* to, unsigned flags) noexcept {
  if (ours(from)) return rename_path(from, to, (flags & RENAME_NOREPLACE) == 0);
  static const auto f = real<int (*)(int, const char*, int, const char*, unsigned)>("renameat2");
  return f(from_at, from, to_at, to, flags);
}
int link(const char* from, const char* to) noexcept {
  if (ours(from)) return second_name(from, to);
  static const auto f = real<int (*)(const char*, const char*)>("link");
  return f(from, to);
}
int unlink(const char* path) noexcept {
  if (ours(path)) return remove_path(path, 1);
  static const auto f = real<int (*)(const char*)>("unlink");
  return f(path);
}
int rmdir(const char* path) noexcept {
  if (ours(path)) return remove_path(path, 2);
  static const auto f = real<int (*)(const char*)>("rmdir");
  return f(path);
}
int remove(const char* path) noexcept {
  if (ours(path)) return remove_path(path, 3);
  static const auto f = real<int (*)(const char*)>("remove");
  return f(path);
}
int unlinkat(int folder, const char* path, int flags) noexcept {
  if (ours(path)) return remove_path(path, (flags & AT_REMOVEDIR) != 0 ? 2 : 1);
  if (const OpenFile* at = ours(folder); at != nullptr && path[0] != '/') {
    world().pause();
    return take_name(at->node, path, (flags & AT_REMOVEDIR) != 0);
  }
  static const auto f = real<int (*)(int, const char*, int)>("unlinkat");
  return f(folder, path, flags);
}
int mkdir(const char* path, mode_t mode) noexcept {
  if (ours(path)) return make_folder(path, mode);
  static const auto f = real<int (*)(const char*, mode_t)>("mkdir");
  return f(path, mode);
}
char* mkdtemp(char* path) noexcept {
  if (ours(path)) {
    for (char* x = path + std::strlen(path) - 6; *x != 0; ++x)
      *x = static_cast<char>('a' + random_byte() % 26);
    return make_folder(path, 0700) == 0 ? path : nullptr;
  }
  static const auto f = real<char* (*)(char*)>("mkdtemp");
  return f(path);
}
int access(const char* path, int how) noexcept {
  if (ours(path)) {
    struct stat ignored {};
    return stat_path(path, &ignored);
  }
  static const auto f = real<int (*)(const char*, int)>("access");
  return f(path, how);
}
int chmod(const char* path, mode_t mode) noexcept {
  if (ours(path)) {
    const NodePtr node = world().find(path, nullptr, nullptr);
    if (!node) return fail(ENOENT);
    node->mode = (node->mode & S_IFMT) | (mode & 0777);
    return 0;
  }
  static const auto f = real<int (*)(const char*, mode_t)>("chmod");
  return f(path, mode);
}
int fchmod(int fd, mode_t mode) noexcept {
  if (OpenFile* o = ours(fd)) {
    o->node->mode = (o->node->mode & S_IFMT) | (mode & 0777);
    return 0;
  }
  static const auto f = real<int (*)(int, mode_t)>("fchmod");
  return f(fd, mode);
}
int fchown(int fd, uid_t user, gid_t group) noexcept {
  if (ours(fd) != nullptr) return 0;
  static const auto f = real<int (*)(int, uid_t, gid_t)>("fchown");
  return f(fd, user, group);
}
ssize_t readlink(const char* path, char* out, size_t size) noexcept {
  if (ours(path)) return fail(EINVAL);  // there are no links
  static const auto f = real<ssize_t (*)(const char*, char*, size_t)>("readlink");
  return f(path, out, size);
}
char* realpath(const char* path, char* out) noexcept {
  if (ours(path)) {
    if (!world().find(path, nullptr, nullptr)) {
      errno = ENOENT;
      return nullptr;
    }
    return out == nullptr ? ::strdup(path) : std::strcpy(out, path);
  }
  static const auto f = real<char* (*)(const char*, char*)>("realpath");
  return f(path, out);
}
void* mmap(void* at, size_t n, int protection, int flags, int fd, off_t offset) noexcept {
  if (OpenFile* o = ours(fd)) {
    Node& node = *o->node;
    if (!node.shared) {
      auto memory = std::make_unique<std::array<char, 1 << 19>>();
      memory->fill(0);
      std::memcpy(memory->data(), node.bytes.data(), std::min(node.bytes.size(), memory->size()));
      node.shared_size = node.bytes.size();
      node.shared = std::move(memory);
    }
    if (static_cast<std::size_t>(offset) + n > node.shared->size()) {
      errno = ENOMEM;
      return MAP_FAILED;
    }
    return node.shared->data() + offset;
  }
  static const auto f = real<void* (*)(void*, size_t, int, int, int, off_t)>("mmap");
  return f(at, n, protection, flags, fd, offset);
}
void* mmap64(void* at, size_t n, int protection, int flags, int fd, off64_t offset) noexcept {
  return mmap(at, n, protection, flags, fd, offset);
}
int munmap(void* at, size_t n) noexcept {
  // SQLite unmaps only what it mapped of a simulated file; who maps real memory has no process here
  if (World::here() != nullptr && n <= 1 << 19) return 0;
  static const auto f = real<int (*)(void*, size_t)>("munmap");
  return f(at, n);
}
DIR* opendir(const char* path) {
  if (ours(path)) {
    const int fd = open_path(path, O_RDONLY | O_DIRECTORY, 0);
    return fd < 0 ? nullptr : list(fd);
  }
  static const auto f = real<DIR* (*)(const char*)>("opendir");
  return f(path);
}
DIR* fdopendir(int fd) {
  if (ours(fd) != nullptr) return list(fd);
  static const auto f = real<DIR* (*)(int)>("fdopendir");
  return f(fd);
}
dirent* readdir(DIR* d) {
  if (Listing* l = listing_of(d)) {
    if (l->next == l->names.size()) return nullptr;
    const auto& [name, is_folder] = l->names[l->next++];
    std::strncpy(l->entry.d_name, name.c_str(), sizeof l->entry.d_name - 1);
    l->entry.d_type = is_folder ? DT_DIR : DT_REG;
    return &l->entry;
  }
  static const auto f = real<dirent* (*)(DIR*)>("readdir");
  return f(d);
}
dirent64* readdir64(DIR* d) { return reinterpret_cast<dirent64*>(readdir(d)); }
int dirfd(DIR* d) noexcept {
  if (const Listing* l = listing_of(d)) return l->fd;
  static const auto f = real<int (*)(DIR*)>("dirfd");
  return f(d);
}
int closedir(DIR* d) {
  if (Listing* l = listing_of(d)) {
    const int fd = l->fd;
    listings().erase(l);
    delete l;
    return ours(fd) != nullptr ? close_file(fd) : 0;
  }
  static const auto f = real<int (*)(DIR*)>("closedir");
  return f(d);
}
int clock_gettime(clockid_t clock, timespec* out) noexcept {
  if (World::here() != nullptr) {
    set(out, clock == CLOCK_REALTIME ? world().utc_ns() : 1'000'000'000'000 + world().true_ns());
    return 0;
  }
  return static_cast<int>(::syscall(SYS_clock_gettime, clock, out));
}
int gettimeofday(timeval* out, void* zone) noexcept {
  if (World::here() != nullptr) {
    out->tv_sec = world().utc_ns() / 1'000'000'000;
    out->tv_usec = world().utc_ns() / 1000 % 1'000'000;
    return 0;
  }
  return static_cast<int>(::syscall(SYS_gettimeofday, out, zone));
}
time_t time(time_t* out) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}
int nanosleep(const timespec* how_long, timespec* left) {
  if (World::here() != nullptr) {
    world().sleep(sleep_ns(how_long));
    return 0;
  }
  return static_cast<int>(::syscall(SYS_nanosleep, how_long, left));
}
int usleep(useconds_t us) {
  const timespec t{static_cast<time_t>(us / 1'000'000), static_cast<long>(us % 1'000'000) * 1000};
  return nanosleep(&t, nullptr);
}
ssize_t getrandom(void* to, size_t n, unsigned flags) {
  if (World::here() != nullptr) {
    fill(to, n);
    return static_cast<ssize_t>(n);
  }
  return ::syscall(SYS_getrandom, to, n, flags);
}
int getentropy(void* to, size_t n) {
  return getrandom(to, n, 0) == static_cast<ssize_t>(n) ? 0 : -1;
}
pid_t getpid() noexcept {
  return World::here() != nullptr ? static_cast<pid_t>(world().process().device)
                                  : static_cast<pid_t>(::syscall(SYS_getpid));
}
char* getenv(const char* name) noexcept {
  if (World::here() != nullptr && std::strcmp(name, "CAVUM_HOME") == 0)
    return world().process().home.data();
  static const auto f = real<char* (*)(const char*)>("getenv");
  return f(name);
}
char* secure_getenv(const char* name) noexcept {
  static std::string temporary;
  if (World::here() != nullptr && std::strcmp(name, "TMPDIR") == 0) {
    temporary = k_root + world().process().computer->name + "/tmp";
    return temporary.data();
  }
  static const auto f = real<char* (*)(const char*)>("secure_getenv");
  return f(name);
}

}  // extern "C"
