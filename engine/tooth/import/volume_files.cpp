#include "engine/tooth/import/volume_files.h"

#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "engine/base/error.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string s) {
  for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

std::string trimmed(const std::string& s) {
  const auto from = s.find_first_not_of(" \t\r\n"), to = s.find_last_not_of(" \t\r\n");
  return from == std::string::npos ? "" : s.substr(from, to - from + 1);
}

/// A text header: its fields in lower case, and where the data begin when they follow in the same file.
struct Header {
  std::map<std::string, std::string> field;
  std::uint64_t end = 0;
};

Header read_header(const std::string& path, char separator) {
  std::ifstream in(path, std::ios::binary);
  Header header;
  std::string line;
  for (int lines = 0; lines < 1000 && std::getline(in, line); ++lines) {
    header.end = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
    if (separator == ':' && trimmed(line).empty()) break;  // NRRD: an empty line ends the header
    const auto at = line.find(separator);
    if (at == std::string::npos || line[0] == '#') continue;
    const auto name = lower(trimmed(line.substr(0, at)));
    header.field[name] = trimmed(line.substr(at + 1));
    if (name == "elementdatafile") break;  // MetaImage: always the last line
  }
  return header;
}

std::uint64_t product(const std::string& numbers, const std::string& where) {
  std::istringstream in(numbers);
  std::uint64_t all = 1;
  for (double n = 0; in >> n;) {
    if (!(n >= 1 && n < 1e6)) throw Error(where, "impossible size '" + numbers + "' in the header", "use an intact file");
    all *= static_cast<std::uint64_t>(n);
    if (all > 1ULL << 40) throw Error(where, "impossible size '" + numbers + "' in the header", "use an intact file");
  }
  return all;
}

std::uint64_t bytes_of_type(std::string type) {
  type = lower(type);
  if (type.starts_with("met_")) type = type.substr(4);
  static const std::map<std::string, std::uint64_t> known{
      {"char", 1},    {"uchar", 1},   {"signed char", 1}, {"unsigned char", 1}, {"int8", 1},           {"uint8", 1},        {"int8_t", 1},
      {"uint8_t", 1}, {"short", 2},   {"ushort", 2},      {"short int", 2},     {"unsigned short", 2}, {"signed short", 2}, {"int16", 2},
      {"uint16", 2},  {"int16_t", 2}, {"uint16_t", 2},    {"int", 4},           {"uint", 4},           {"unsigned int", 4}, {"signed int", 4},
      {"int32", 4},   {"uint32", 4},  {"int32_t", 4},     {"uint32_t", 4},      {"float", 4},          {"double", 8},       {"long", 4},
      {"ulong", 4},   {"int64", 8},   {"uint64", 8},      {"long_long", 8},     {"ulong_long", 8},     {"longlong", 8}};
  const auto it = known.find(type);
  return it == known.end() ? 0 : it->second;
}

void compare(const std::string& header, const std::string& data, std::uint64_t skip, std::uint64_t needed) {
  if (!fs::is_regular_file(data)) throw Error(header, "its data file '" + data + "' is missing", "put it beside the header");
  const auto held = static_cast<std::uint64_t>(fs::file_size(data));
  if (held < skip + needed)
    throw Error(data,
                "truncated: " + header + " promises " + std::to_string(needed) + " bytes of data, " + std::to_string(held > skip ? held - skip : 0) +
                    " are there",
                "use a complete copy");
}

std::string beside(const std::string& header, const std::string& name) { return (fs::path(header).parent_path() / name).string(); }

std::string or_empty(const Header& h, const char* name) {
  const auto it = h.field.find(name);
  return it == h.field.end() ? "" : it->second;
}

void check_meta(const std::string& path) {
  const Header h = read_header(path, '=');
  const std::string size = or_empty(h, "dimsize"), type = or_empty(h, "elementtype"), file = or_empty(h, "elementdatafile");
  if (size.empty() || type.empty() || file.empty()) throw Error(path, "not a MetaImage header", "use an intact file");
  if (lower(or_empty(h, "compresseddata")) == "true" || lower(file).starts_with("list") || file.find('%') != std::string::npos) return;
  std::uint64_t needed = product(size, path) * bytes_of_type(type);
  if (const auto channels = or_empty(h, "elementnumberofchannels"); !channels.empty()) needed *= product(channels, path);
  const bool local = lower(file) == "local";
  std::uint64_t skip = local ? h.end : 0;
  if (const auto s = or_empty(h, "headersize"); !s.empty() && s[0] != '-') skip += std::strtoull(s.c_str(), nullptr, 10);
  compare(path, local ? path : beside(path, file), skip, needed);
}

void check_nrrd(const std::string& path) {
  const Header h = read_header(path, ':');
  const std::string size = or_empty(h, "sizes"), type = or_empty(h, "type");
  if (size.empty() || type.empty()) throw Error(path, "not a NRRD header", "use an intact file");
  auto file = or_empty(h, "data file");
  if (file.empty()) file = or_empty(h, "datafile");
  const bool listed = lower(file).starts_with("list") || file.find('%') != std::string::npos;
  if (lower(or_empty(h, "encoding")) != "raw" || listed) {
    if (!file.empty() && !listed && !fs::is_regular_file(beside(path, file))) compare(path, beside(path, file), 0, 0);
    return;
  }
  std::uint64_t skip = file.empty() ? h.end : 0;
  for (const char* name : {"byte skip", "byteskip"})
    if (const auto s = or_empty(h, name); !s.empty() && s[0] != '-') skip += std::strtoull(s.c_str(), nullptr, 10);
  compare(path, file.empty() ? path : beside(path, file), skip, product(size, path) * bytes_of_type(type));
}

void check_nifti(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<char> b(352, 0);
  in.read(b.data(), static_cast<std::streamsize>(b.size()));
  std::int32_t header_size = 0;
  std::memcpy(&header_size, b.data(), 4);
  if (in.gcount() < 348) throw Error(path, "truncated inside the NIfTI header", "use a complete copy");
  if (header_size != 348) return;  // NIfTI-2 or the other byte order: its own reader checks
  std::int16_t dim[8], bits = 0;
  float offset = 0;
  std::memcpy(dim, b.data() + 40, sizeof dim);
  std::memcpy(&bits, b.data() + 72, 2);
  std::memcpy(&offset, b.data() + 108, 4);
  if (dim[0] < 1 || dim[0] > 7 || bits < 1 || !(offset >= 0 && offset < 1e9f))
    throw Error(path, "impossible values in the NIfTI header", "use an intact file");
  std::uint64_t needed = static_cast<std::uint64_t>(bits);
  for (int i = 1; i <= dim[0]; ++i) needed *= static_cast<std::uint64_t>(std::max<std::int16_t>(dim[i], 1));
  compare(path, path, static_cast<std::uint64_t>(offset), needed / 8);
}

}  // namespace

void check_volume_bytes(const std::string& path) {
  const auto extension = lower(fs::path(path).extension().string());
  if (extension == ".mhd" || extension == ".mha") check_meta(path);
  if (extension == ".nhdr" || extension == ".nrrd") check_nrrd(path);
  if (extension == ".nii") check_nifti(path);
}

}  // namespace cavum
