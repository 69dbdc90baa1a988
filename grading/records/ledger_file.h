// A ledger's database file: made, opened for adding, written to, and compared with the tables that
// it should have.
#pragma once

#include "grading/records/ledger_content.h"
#include "grading/records/ledger_error.h"

namespace cavum::records {

/// Version of the ledger's tables (SQLite `user_version`).
inline constexpr int k_ledger_format = 1;
/// SQLite `application_id`: "CavL".
inline constexpr std::int64_t k_ledger_application_id = 0x4361764c;

/// With a write-ahead log, synced at each commit. Throws Error when there is none and `make` does
/// not ask for one.
[[nodiscard]] Database open_for_adding(const std::string& path, bool make);
/// What to do where a ledger is absent or empty: restore it where others of its files are, else
/// make one. Of an error that bears it: lost, where there was one.
[[nodiscard]] LedgerError code_of_none(const std::string& database_path);
[[nodiscard]] Message instead_of_none(const std::string& database_path);
/// Throws Error unless it is a ledger's, of this format.
void require_ledger(Database& database, const std::string& where);
/// The tables of a new ledger, in one transaction.
void make_tables(Database& database);
/// Adds an entry with its openings, the note of its checkpoint, and the documents that the entry
/// names, each unless it is there already; takes out the openings of these hashes.
void insert(Database& database, const LedgerEntry& entry, std::span<const std::string> erases,
            const std::string& note, std::span<const Bytes> documents);
/// Writes over on disk, in file and log, what was taken out. Throws Error when a program that reads
/// the ledger keeps the log in use for 30 s.
void wipe_erased(Database& database, const std::string& where);
/// Adds what another party signed of a checkpoint, unless it is there already.
void insert_cosignature(Database& database, std::uint64_t size, const std::string& line);
/// Tables, triggers, views and indexes that are not those that this version made: a view that shows
/// people other figures, a trigger that is gone.
void check_schema(Database& database, Findings& findings);
/// The same of a database that could not be read: nothing when not even that can be told.
[[nodiscard]] Findings schema_findings(Database& database) noexcept;

}  // namespace cavum::records
