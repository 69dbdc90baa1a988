#include "grading/pool/parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/session_image.h"

namespace cavum::pool {
namespace {

constexpr std::size_t k_seal_digits = 32;

/// Binds a line to its work and its place in it.
std::string seal_of(const std::string& work_id, std::size_t index, std::string_view line) {
  return to_hex(sha256(fmt::format("{} {} {}", work_id, index, line))).substr(0, k_seal_digits);
}

struct Row {
  std::size_t index = 0;
  Spent spent;
  std::string_view line;
};

/// "index wall_us core_us seal line"; none when it is not of this work, or damaged.
std::optional<Row> read_row(std::string_view text, const std::string& work_id,
                            std::size_t sessions) {
  Row row;
  const auto word = [&]() -> std::string_view {
    const auto end = text.find(' ');
    if (end == std::string_view::npos) return {};
    const auto w = text.substr(0, end);
    text.remove_prefix(end + 1);
    return w;
  };
  const auto whole = [&](std::uint64_t& n) {
    const auto w = word();
    const auto [end, wrong] = std::from_chars(w.data(), w.data() + w.size(), n);
    return !w.empty() && wrong == std::errc() && end == w.data() + w.size();
  };
  std::uint64_t index = 0, wall_us = 0, core_us = 0;
  if (!whole(index) || !whole(wall_us) || !whole(core_us) || index >= sessions) return {};
  const auto seal = word();
  if (seal != seal_of(work_id, index, text)) return {};
  row.index = index;
  row.spent = {static_cast<double>(wall_us) * 1e-6, static_cast<double>(core_us) * 1e-6};
  row.line = text;
  return row;
}

/// SHA-256 of the session's file as it is now; empty when it cannot be read.
std::string sha256_now(const Work& work, std::size_t index) {
  const std::string& name = work.sessions[index];
  try {
    Damages ignored;
    return to_hex(
        sha256(read_session_image(work.folder.empty() ? name : work.folder + "/" + name, ignored)));
  } catch (const Error&) {
    return {};
  }
}

std::string sha256_in(std::string_view line) {
  return text_in(parse_json_or_null(line, k_json_part), "sha256");
}

}  // namespace

PartWriter::PartWriter(const std::string& path, std::string work_id)
    : path_(path), work_id_(std::move(work_id)) {
  bool cut = false;  // a row that was cut off must not run into the next
  if (std::ifstream before(path, std::ios::binary | std::ios::ate); before && before.tellg() > 0) {
    before.seekg(-1, std::ios::end);
    cut = before.get() != '\n';
  }
  out_.open(path, std::ios::binary | std::ios::app);
  if (cut) out_ << "\n" << std::flush;
  if (!out_)
    throw Error(path, msg("cannot be written"), msg("name a folder that is writable and has room"));
}

void PartWriter::add(std::size_t index, const std::string& line, const Spent& spent) {
  out_ << fmt::format("{} {} {} {} {}\n", index, static_cast<std::uint64_t>(spent.wall_s * 1e6),
                      static_cast<std::uint64_t>(spent.core_s * 1e6),
                      seal_of(work_id_, index, line), line)
       << std::flush;
  if (!out_)
    throw Error(
        path_, msg("cannot be written to its end"),
        msg("make room on the disk, and run the same command again: it goes on where it stood"));
}

std::vector<std::size_t> Parts::missing() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!lines[i]) out.push_back(i);
  return out;
}

Parts read_parts(const Work& work, const std::vector<std::string>& files) {
  Parts parts{std::vector<std::optional<std::string>>(work.sessions.size()),
              std::vector<Spent>(work.sessions.size()),
              {}};
  const std::string id = id_of(work);
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error(file, msg("cannot be read"), msg("check its name and permissions"));
    std::size_t wrong = 0, rows = 0;
    for (std::string text; std::getline(in, text); ++rows) {
      const auto row = read_row(text, id, work.sessions.size());
      if (!row) {
        wrong += text.empty() ? 0 : 1;
        continue;
      }
      auto& kept = parts.lines[row->index];
      if (kept && *kept != row->line) {
        if (sha256_in(*kept) == sha256_in(row->line))
          throw Error(
              file,
              msg("its line of {} is another one than that of a part before it",
                  work.sessions[row->index]),
              msg("two machines do not compute the same: run `cavum replay --verify` on it on both, and remove the parts of the one that is wrong"));
        if (sha256_in(row->line) != sha256_now(work, row->index))
          continue;  // of the file as it was once
      }
      kept = std::string(row->line);
      parts.spent[row->index] = row->spent;
    }
    if (wrong > 0)
      parts.remarks.push_back(
          msg("{}: {} of {} rows are damaged, or of other work", file, wrong, rows));
  }
  return parts;
}

std::vector<std::string> part_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& f : std::filesystem::directory_iterator(folder, none))
    if (f.path().extension() == ".part") files.push_back(f.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

void leave_out_changed(const Work& work, Parts& parts) {
  for (std::size_t i = 0; i < parts.lines.size(); ++i) {
    if (!parts.lines[i]) continue;
    if (sha256_in(*parts.lines[i]) == sha256_now(work, i))
      continue;  // both are empty of a file that is gone: its line says so
    parts.lines[i].reset();
    parts.spent[i] = {};
  }
}

}  // namespace cavum::pool
