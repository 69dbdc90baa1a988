// The little of SQLite that a session needs: a connection that writes safely, a connection on bytes
// in memory that can change nothing, and statements whose columns must have the type the schema
// promises.
#pragma once

#include <fmt/core.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/base/bytes.h"
#include "engine/base/error.h"
#include "engine/session/disk_refusal.h"

namespace cavum {

/// SQLite, or the disk below it, said no.
class DatabaseError : public Error {
 public:
  DatabaseError(const std::string& where, Message what_happened, Message what_to_do,
                DiskRefusal refusal)
      : Error(Name{where}, std::move(what_happened), std::move(what_to_do)), refusal_(refusal) {}
  /// A file of a database that the system refused before SQLite saw it.
  DatabaseError(const Error& error, DiskFault fault) : Error(error), refusal_{fault} {}
  [[nodiscard]] const DiskRefusal& refusal() const noexcept { return refusal_; }

 private:
  DiskRefusal refusal_;
};

/// One prepared statement. Bind from 1, step, read columns from 0.
class Statement {
 public:
  Statement& bind(int index, std::int64_t value);
  Statement& bind(int index, const std::string& text);
  Statement& bind(int index, std::span<const std::uint8_t> blob);
  /// True while there is a row.
  [[nodiscard]] bool step();
  /// For statements without rows; ready to be bound anew afterwards.
  void run();

  // Throw DatabaseError when the column holds another type, as a damaged or edited file may.
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] Bytes blob(int column) const;
  /// A blob of exactly N bytes.
  template <std::size_t N>
  [[nodiscard]] std::array<std::uint8_t, N> fixed_blob(int column) const {
    const Bytes b = blob(column);
    if (b.size() != N) wrong_type(column, msg("{} bytes", N));
    std::array<std::uint8_t, N> out{};
    std::copy(b.begin(), b.end(), out.begin());
    return out;
  }

 private:
  friend class Database;
  Statement(sqlite3* db, sqlite3_stmt* statement, std::string where);
  [[noreturn]] void wrong_type(int column, const Message& wanted) const;
  void check(int code);

  sqlite3* db_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
  std::string where_;
};

/// For a file that one program records into: another has no business there.
inline constexpr std::chrono::milliseconds k_short_wait{200};
/// For a file that many programs add to: each holds it for milliseconds.
inline constexpr std::chrono::milliseconds k_long_wait{30'000};

class Database {
 public:
  /// An existing or (`make`) new file, for writing; a new one is its user's alone (mode 0600, and
  /// so its logs), and Error when there is something at the path already. While another program
  /// holds it this waits and tries again, for as long as `wait`; then it says who that is, if it
  /// can be known.
  [[nodiscard]] static Database open(const std::string& path, bool make,
                                     std::chrono::milliseconds wait = k_short_wait);
  /// A whole database file held in memory, read-only. Damage shows as DatabaseError while reading.
  [[nodiscard]] static Database from_image(Bytes image, const std::string& where);

  void run(const char* sql);
  [[nodiscard]] Statement prepare(const char* sql);
  /// First column of the first row.
  [[nodiscard]] std::int64_t integer(const char* sql);
  [[nodiscard]] std::string text(const char* sql);
  [[nodiscard]] bool in_transaction() const noexcept {
    return sqlite3_get_autocommit(db_.get()) == 0;
  }
  /// The whole database, a log's content included, page by page into an empty one. Throws
  /// DatabaseError of whichever refuses.
  void copy_to(Database& other);
  /// The same as the bytes of a single file.
  [[nodiscard]] Bytes image();
  /// Closes; statements must be gone. Throws nothing: what was committed is on disk already.
  void close() noexcept { db_.reset(); }
  [[nodiscard]] bool is_open() const noexcept { return db_ != nullptr; }

 private:
  Database() = default;
  void connect(const std::string& name, int flags);

  std::unique_ptr<Bytes> image_;  // both must outlive the connection
  std::unique_ptr<int> work_;     // calls of the progress handler
  std::chrono::milliseconds wait_{0};
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> db_{nullptr, sqlite3_close_v2};
  std::string where_;
};

/// Begins a transaction, and leaves it again unless it was committed.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {
    database_.run("BEGIN IMMEDIATE");
  }
  ~Transaction() {
    try {
      if (database_.in_transaction()) database_.run("ROLLBACK");
    } catch (const Error&) {  // SQLite has rolled back by itself
    }
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() { database_.run("COMMIT"); }

 private:
  Database& database_;
};

}  // namespace cavum
