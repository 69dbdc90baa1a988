#include "engine/session/sqlite.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <thread>

#include "engine/base/system_error.h"
#include "engine/base/write_file.h"
#include "engine/session/lock_holder.h"

namespace cavum {
namespace {

// Bounds what a damaged file can make SQLite do: about ten seconds of work in one connection on an
// image.
constexpr int k_steps_per_call = 1'000'000;
constexpr int k_max_calls = 2000;

[[noreturn]] void fail(sqlite3* db, const std::string& where, int code) {
  if ((code & 0xff) == SQLITE_NOMEM) throw std::bad_alloc();  // nothing is wrong with the file
  const std::string what = db != nullptr ? sqlite3_errmsg(db) : sqlite3_errstr(code);
  const int system_error = db != nullptr ? sqlite3_system_errno(db) : 0;
  DiskRefusal refusal{DiskFault::other, system_error};
  Message detail = Name{what},
          to_do = msg("try again; if it stays, copy the file elsewhere and report this");
  switch (code & 0xff) {
    case SQLITE_FULL:
      refusal.fault = DiskFault::full;
      to_do = msg("make room on the disk and try again: nothing recorded so far is lost");
      break;
    case SQLITE_IOERR:
      refusal.fault = DiskFault::input_output;
      if (system_error != 0) detail = msg("{} ({})", what, system_words(system_error));
      to_do = msg(
          "make room on the disk, check that it is still there, and try again: nothing recorded so far is lost");
      break;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      refusal.fault = DiskFault::held;
      detail = holder_of(where);
      to_do = msg("try again when it is done, or close it");
      break;
    case SQLITE_CANTOPEN:
      refusal.fault = DiskFault::not_opened;
      to_do = msg("check that the path exists and is writable");
      break;
    case SQLITE_READONLY:
    case SQLITE_PERM:
      refusal.fault = DiskFault::read_only;
      to_do = msg("make the file and its folder writable");
      break;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      refusal.fault = DiskFault::damaged;
      to_do = msg("use an intact copy");
      break;
    default:
      break;
  }
  throw DatabaseError(where, detail, to_do, refusal);
}

int limit_work(void* calls) { return ++*static_cast<int*>(calls) > k_max_calls ? 1 : 0; }

}  // namespace

Statement::Statement(sqlite3* db, sqlite3_stmt* statement, std::string where)
    : db_(db), statement_(statement, sqlite3_finalize), where_(std::move(where)) {}

void Statement::check(int code) {
  if (code != SQLITE_OK) fail(db_, where_, code);
}

Statement& Statement::bind(int index, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), index, value));
  return *this;
}
Statement& Statement::bind(int index, const std::string& text) {
  check(sqlite3_bind_text64(statement_.get(), index, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}
Statement& Statement::bind(int index, std::span<const std::uint8_t> blob) {
  // a null pointer would bind NULL, and an empty blob is a value
  check(sqlite3_bind_blob64(statement_.get(), index,
                            blob.empty() ? "" : reinterpret_cast<const char*>(blob.data()),
                            blob.size(), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  fail(db_, where_, code);
}

void Statement::run() {
  const int code = sqlite3_step(statement_.get());
  sqlite3_reset(statement_.get());
  if (code != SQLITE_DONE && code != SQLITE_ROW) fail(db_, where_, code);
}

void Statement::wrong_type(int column, const Message& wanted) const {
  const char* name = sqlite3_column_name(statement_.get(), column);
  if (name == nullptr) throw std::bad_alloc();
  throw DatabaseError(where_, msg("column {} does not hold {}", name, wanted),
                      msg("the file was damaged or edited: use an intact copy"),
                      {DiskFault::damaged});
}

std::int64_t Statement::integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER)
    wrong_type(column, msg("a whole number"));
  return sqlite3_column_int64(statement_.get(), column);
}
std::string Statement::text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_TEXT) wrong_type(column, msg("text"));
  const auto* p = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (p == nullptr) throw std::bad_alloc();  // a text that is there and cannot be given
  return {p, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}
Bytes Statement::blob(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_BLOB)
    wrong_type(column, msg("bytes"));
  const auto* p = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  if (p == nullptr && sqlite3_errcode(db_) == SQLITE_NOMEM) throw std::bad_alloc();
  return p == nullptr ? Bytes() : Bytes(p, p + sqlite3_column_bytes(statement_.get(), column));
}

void Database::connect(const std::string& name, int flags) {
  sqlite3* db = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &db,
                                   flags | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  db_.reset(db);
  if (code != SQLITE_OK) fail(db, where_, code);
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

Database Database::open(const std::string& path, bool make, std::chrono::milliseconds wait) {
  Database database;
  database.where_ = path;
  database.wait_ = wait;
  try {
    if (make && path != ":memory:") make_private_file(path);
  } catch (const Error& refusal) {
    throw DatabaseError(refusal, DiskFault::not_opened);
  }
  if (path != ":memory:")
    for (const char* end : {"", "-wal", "-shm", "-journal"}) {  // a pipe would be waited for
      std::error_code none;
      const auto type = std::filesystem::status(path + end, none).type();
      if (type != std::filesystem::file_type::regular &&
          type != std::filesystem::file_type::not_found && type != std::filesystem::file_type::none)
        throw DatabaseError(path + end, msg("is no regular file"),
                            msg("remove it, or name another place"), {DiskFault::not_opened});
    }
  database.connect(path, SQLITE_OPEN_READWRITE);
  sqlite3_busy_timeout(database.db_.get(), static_cast<int>(wait.count()));
  return database;
}

Database Database::from_image(Bytes image, const std::string& where) {
  Database database;
  database.where_ = where;
  database.image_ = std::make_unique<Bytes>(std::move(image));
  Bytes& bytes = *database.image_;
  // Bytes 18 and 19 say "write-ahead log"; a database in memory has none, and all of it is in the
  // image.
  if (bytes.size() > 19 && bytes[18] == 2) bytes[18] = 1;
  if (bytes.size() > 19 && bytes[19] == 2) bytes[19] = 1;
  database.connect(":memory:", SQLITE_OPEN_READWRITE);
  sqlite3* db = database.db_.get();
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  const int code =
      sqlite3_deserialize(db, "main", bytes.data(), size, size, SQLITE_DESERIALIZE_READONLY);
  if (code != SQLITE_OK) fail(db, where, code);
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::min<sqlite3_int64>(size + 1024, 1'000'000'000)));
  sqlite3_exec(db, "PRAGMA query_only = ON; PRAGMA cell_size_check = ON; PRAGMA foreign_keys = ON",
               nullptr, nullptr, nullptr);
  database.work_ = std::make_unique<int>(0);
  sqlite3_progress_handler(db, k_steps_per_call, limit_work, database.work_.get());
  return database;
}

void Database::run(const char* sql) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + wait_;
  const bool alone = !in_transaction();
  int code = sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr);
  // SQLite does not wait by itself where two that wait could wait for each other, as when both turn
  // a file to its write-ahead log
  while ((code & 0xff) == SQLITE_BUSY && alone && !in_transaction() && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    code = sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr);
  }
  if (code != SQLITE_OK) fail(db_.get(), where_, code);
}

Statement Database::prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(db_.get(), sql, -1, &statement, nullptr);
  if (code != SQLITE_OK) fail(db_.get(), where_, code);
  return {db_.get(), statement, where_};
}

void Database::copy_to(Database& other) {
  sqlite3_backup* copying = sqlite3_backup_init(other.db_.get(), "main", db_.get(), "main");
  if (copying == nullptr) fail(other.db_.get(), other.where_, sqlite3_errcode(other.db_.get()));
  sqlite3_backup_step(copying, -1);
  if (const int code = sqlite3_backup_finish(copying); code != SQLITE_OK)
    fail(other.db_.get(), other.where_, code);
}

Bytes Database::image() {
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
      sqlite3_serialize(db_.get(), "main", &size, 0), sqlite3_free);
  if (bytes == nullptr) fail(db_.get(), where_, SQLITE_NOMEM);
  return {bytes.get(), bytes.get() + size};
}

std::int64_t Database::integer(const char* sql) {
  Statement s = prepare(sql);
  return s.step() ? s.integer(0) : 0;
}
std::string Database::text(const char* sql) {
  Statement s = prepare(sql);
  return s.step() ? s.text(0) : std::string();
}

}  // namespace cavum
