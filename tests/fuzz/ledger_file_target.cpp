// A ledger's database with its write-ahead log, read as `ledger verify` does. The data are a byte
// of flags (1 = the log's checksums are made right again, 2 = from a copy in memory, as where the
// folder may only be read) and edits of the two files as they stood beside one another: which
// (database, log, end of the database, end of the log), where in three bytes, a length, and that
// many bytes.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/base/file.h"
#include "engine/session/session_image.h"
#include "grading/records/check_ledger.h"
#include "grading/records/registry.h"
#include "grading/records/stations.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

struct Files {
  Bytes database, log;
};

const Files& sound_files() {
  static const Files k_files = [] {
    const std::string folder = work_folder() + "/logged";
    records::Ledger::create(folder, "School", school_key());
    records::Ledger ledger(folder, school_key());  // while it is open its log stays
    ledger.append(
        [](const records::LedgerContent&) { return *school_ledger().entries.at(1).what; });
    static_cast<void>(records::invite_station(ledger, "Seat 3", 1'900'000'000'000'000'000));
    const std::string path = ledger.places().database();
    return Files{read_file(path), read_file(path + "-wal")};
  }();
  return k_files;
}

constexpr std::size_t k_log_head = 32, k_frame_head = 24;

std::uint32_t big_endian(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(p[0]) << 24 | static_cast<std::uint32_t>(p[1]) << 16 |
         static_cast<std::uint32_t>(p[2]) << 8 | p[3];
}
void put_big_endian(std::uint8_t* p, std::uint32_t v) {
  for (int i = 3; i >= 0; --i, v >>= 8) p[i] = static_cast<std::uint8_t>(v);
}

/// SQLite's checksum of a log (https://www.sqlite.org/fileformat2.html, 4.2), in the byte order
/// that the log's first bytes name.
void add_up(std::span<const std::uint8_t> bytes, bool big, std::array<std::uint32_t, 2>& sum) {
  const auto word = [&](std::size_t i) {
    std::uint32_t v = 0;
    if (big) return big_endian(bytes.data() + i);
    std::memcpy(&v, bytes.data() + i, sizeof v);
    return v;
  };
  for (std::size_t i = 0; i + 8 <= bytes.size(); i += 8) {
    sum[0] += word(i) + sum[1];
    sum[1] += word(i + 4) + sum[0];
  }
}

void right_checksums(Bytes& log) {
  if (log.size() < k_log_head) return;
  const bool big = (log[3] & 1) != 0;
  const std::uint32_t page = big_endian(log.data() + 8);
  std::array<std::uint32_t, 2> sum{};
  add_up(std::span(log).first(24), big, sum);
  put_big_endian(log.data() + 24, sum[0]);
  put_big_endian(log.data() + 28, sum[1]);
  if (page < 512 || page > 65536 || page % 8 != 0) return;
  for (std::size_t at = k_log_head; at + k_frame_head + page <= log.size();
       at += k_frame_head + page) {
    std::copy_n(log.begin() + 16, 8,
                log.begin() + static_cast<std::ptrdiff_t>(at) + 8);  // the log's salts
    add_up(std::span(log).subspan(at, 8), big, sum);
    add_up(std::span(log).subspan(at + k_frame_head, page), big, sum);
    put_big_endian(log.data() + at + 16, sum[0]);
    put_big_endian(log.data() + at + 20, sum[1]);
  }
}

void write(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

void fuzz_ledger(Data data) {
  if (data.empty()) return;
  Files files = sound_files();
  const std::uint8_t flags = data[0];
  constexpr std::size_t k_head = 5;
  for (data = data.subspan(1); data.size() >= k_head;) {
    Bytes& file = data[0] % 2 == 0 ? files.database : files.log;
    std::size_t at = file.empty() ? 0
                                  : (data[1] | static_cast<std::size_t>(data[2]) << 8 |
                                     static_cast<std::size_t>(data[3]) << 16) %
                                        file.size();
    const std::size_t length = std::min<std::size_t>(data[4], data.size() - k_head);
    if (data[0] % 4 >= 2)
      file.resize(at);
    else
      for (const auto b : data.subspan(k_head, length))
        if (at < file.size()) file[at++] = b;
    data = data.subspan(k_head + length);
  }
  if ((flags & 1) != 0) right_checksums(files.log);
  const records::LedgerPaths places{work_folder() + "/read"};
  std::filesystem::create_directories(places.folder);
  std::filesystem::remove(places.database() + "-shm");
  write(places.database(), files.database);
  write(places.database() + "-wal", files.log);
  try {
    if ((flags & 2) != 0) {
      Damages findings;
      Database copy =
          Database::from_image(read_session_image(places.database(), findings), places.database());
      static_cast<void>(records::read_registry(
          records::read_content(copy, places.database(), records::AskWitness::no)));
    } else {
      static_cast<void>(
          records::read_registry(records::read_ledger(places, records::AskWitness::no)));
    }
  } catch (const Error&) {
  }
}

std::vector<Bytes> ledger_seeds() {
  std::vector<Bytes> seeds{{0}, {1}, {2}, {3}};
  const Files& files = sound_files();
  for (const std::uint8_t flags : {std::uint8_t{1}, std::uint8_t{3}})
    for (const bool log : {false, true}) {
      const Bytes& file = log ? files.log : files.database;
      const auto edit = [&](std::uint8_t kind, std::size_t at, const Bytes& payload) {
        Bytes seed{flags,
                   static_cast<std::uint8_t>(kind + (log ? 1 : 0)),
                   static_cast<std::uint8_t>(at),
                   static_cast<std::uint8_t>(at >> 8),
                   static_cast<std::uint8_t>(at >> 16),
                   static_cast<std::uint8_t>(payload.size())};
        seed.insert(seed.end(), payload.begin(), payload.end());
        seeds.push_back(std::move(seed));
      };
      for (std::size_t at = 0; at < file.size(); at += file.size() / 16 + 1)
        edit(0, at, {0xff, 0, 0x7f});
      const std::string sought = "\"kind\":";  // into the entries themselves
      for (auto found = file.begin();
           (found = std::search(found, file.end(), sought.begin(), sought.end())) != file.end();
           ++found)
        edit(0, static_cast<std::size_t>(found - file.begin()), bytes_of("\"kind\":7"));
      edit(2, file.size() / 2, {});
      edit(2, 4096, {});
    }
  return seeds;
}

}  // namespace cavum::fuzz
