#include "engine/tooth/volume/volume_files.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/tooth/volume/tiff_bytes.h"

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

/// A text header: its fields in lower case, and where the data begin when they follow in the same
/// file.
struct Header {
  std::map<std::string, std::string> field;
  std::uint64_t end = 0;
};

/// Looks at the first megabyte only.
Header read_header(const std::string& path, char separator) {
  std::string beginning(1U << 20, 0);
  std::ifstream file(path, std::ios::binary);
  file.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(file.gcount()));
  std::istringstream in(std::move(beginning));
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
    if (!(n >= 1 && n < 1e6))
      throw Error(FileError::malformed, Name{where},
                  msg("impossible size '{}' in the header", numbers), msg("use an intact file"));
    all *= static_cast<std::uint64_t>(n);
    if (all > 1ULL << 40)
      throw Error(FileError::malformed, Name{where},
                  msg("impossible size '{}' in the header", numbers), msg("use an intact file"));
  }
  return all;
}

std::uint64_t bytes_of_type(std::string type) {
  type = lower(type);
  if (type.starts_with("met_")) type = type.substr(4);
  static const std::map<std::string, std::uint64_t> known{
      {"char", 1},         {"uchar", 1},   {"signed char", 1}, {"unsigned char", 1},
      {"int8", 1},         {"uint8", 1},   {"int8_t", 1},      {"uint8_t", 1},
      {"short", 2},        {"ushort", 2},  {"short int", 2},   {"unsigned short", 2},
      {"signed short", 2}, {"int16", 2},   {"uint16", 2},      {"int16_t", 2},
      {"uint16_t", 2},     {"int", 4},     {"uint", 4},        {"unsigned int", 4},
      {"signed int", 4},   {"int32", 4},   {"uint32", 4},      {"int32_t", 4},
      {"uint32_t", 4},     {"float", 4},   {"double", 8},      {"long", 4},
      {"ulong", 4},        {"int64", 8},   {"uint64", 8},      {"long_long", 8},
      {"ulong_long", 8},   {"longlong", 8}};
  const auto it = known.find(type);
  return it == known.end() ? 0 : it->second;
}

void compare(const std::string& header, const std::string& data, std::uint64_t skip,
             std::uint64_t needed) {
  if (!fs::is_regular_file(data))
    throw Error(FileError::missing, Name{header},
                msg("its data file '{}' is missing, or no ordinary file", data),
                msg("put it beside the header"));
  const auto held = static_cast<std::uint64_t>(fs::file_size(data));
  if (held < skip + needed)
    throw Error(FileError::truncated, Name{data},
                msg("truncated: {} promises {} bytes of data, {} are there", header, needed,
                    held > skip ? held - skip : 0),
                msg("use a complete copy"));
}

std::string beside(const std::string& header, const std::string& name) {
  return (fs::path(header).parent_path() / name).string();
}

/// What a file that zlib or gzip packed holds from one of its bytes on, never kept as a whole.
class Inflated {
 public:
  Inflated(const std::string& file, std::uint64_t from) : file_(file), in_(file, std::ios::binary) {
    in_.seekg(static_cast<std::streamoff>(from));
    constexpr int k_zlib_or_gzip = 15 + 32;
    if (::inflateInit2(&stream_, k_zlib_or_gzip) != Z_OK)
      throw Error(file, msg("cannot be unpacked"), msg("use an intact copy"));
  }
  ~Inflated() { ::inflateEnd(&stream_); }
  Inflated(const Inflated&) = delete;
  Inflated& operator=(const Inflated&) = delete;

  /// The next bytes, fewer where the stream ends or breaks.
  std::vector<std::uint8_t> take(std::size_t most) {
    std::vector<std::uint8_t> out(most);
    stream_.next_out = out.data();
    stream_.avail_out = static_cast<uInt>(most);
    while (stream_.avail_out > 0 && !ended_) {
      if (stream_.avail_in == 0) {
        in_.read(reinterpret_cast<char*>(packed_.data()),
                 static_cast<std::streamsize>(packed_.size()));
        stream_.next_in = packed_.data();
        stream_.avail_in = static_cast<uInt>(in_.gcount());
        if (stream_.avail_in == 0) break;
      }
      const int said = ::inflate(&stream_, Z_NO_FLUSH);
      ended_ = said != Z_OK;
      whole_ = said == Z_STREAM_END;
    }
    out.resize(most - stream_.avail_out);
    return out;
  }
  /// All of them, and the sum that the stream ends with. Returns how many packed bytes those are.
  std::uint64_t require(const std::string& header, std::uint64_t needed) {
    constexpr std::uint64_t k_portion = 1U << 20;
    std::uint64_t held = 0;
    while (held < needed) {
      const auto n = take(std::min(k_portion, needed - held)).size();
      held += n;
      if (n == 0)
        throw Error(FileError::truncated, Name{file_},
                    msg("truncated or damaged: {} promises {} bytes of data, {} can be unpacked",
                        header, needed, held),
                    msg("use a complete copy"));
    }
    static_cast<void>(take(k_portion));
    if (ended_ ? !whole_ : stream_.avail_out > 0)
      throw Error(FileError::damaged, Name{file_},
                  msg("truncated or damaged: its checksum is missing or wrong"),
                  msg("use a complete copy"));
    return stream_.total_in;
  }

 private:
  std::string file_;
  std::ifstream in_;
  z_stream stream_{};
  std::array<std::uint8_t, 1 << 16> packed_{};
  bool ended_ = false, whole_ = false;
};

std::string or_empty(const Header& h, const char* name) {
  const auto it = h.field.find(name);
  return it == h.field.end() ? "" : it->second;
}

/// The file with the voxels: the header itself, or another that it names.
std::string data_file(const std::string& path, const std::string& named) {
  if (lower(named).starts_with("list") || named.find('%') != std::string::npos)
    throw Error(FileError::unsupported, Name{path}, msg("spreads its data over several files"),
                msg("save the volume with its data in one file"));
  const std::string data = named.empty() || lower(named) == "local" ? path : beside(path, named);
  compare(path, data, 0, 0);
  return data;
}

std::string data_of_meta(const std::string& path, const Header& h) {
  if (or_empty(h, "dimsize").empty() || or_empty(h, "elementtype").empty() ||
      or_empty(h, "elementdatafile").empty())
    throw Error(FileError::malformed, Name{path}, msg("not a MetaImage header"),
                msg("use an intact file"));
  return data_file(path, or_empty(h, "elementdatafile"));
}

std::string data_of_nrrd(const std::string& path, const Header& h) {
  if (or_empty(h, "sizes").empty() || or_empty(h, "type").empty())
    throw Error(FileError::malformed, Name{path}, msg("not a NRRD header"),
                msg("use an intact file"));
  const auto file = or_empty(h, "data file");
  return data_file(path, file.empty() ? or_empty(h, "datafile") : file);
}

std::uint64_t skipped(const Header& h, const char* name) {
  const auto s = or_empty(h, name);
  return s.empty() || s[0] == '-' ? 0 : std::strtoull(s.c_str(), nullptr, 10) & 0xffffffff;
}

void check_meta(const std::string& path) {
  const Header h = read_header(path, '=');
  const std::string data = data_of_meta(path, h);
  std::uint64_t needed =
      product(or_empty(h, "dimsize"), path) * bytes_of_type(or_empty(h, "elementtype"));
  if (const auto channels = or_empty(h, "elementnumberofchannels"); !channels.empty())
    needed *= std::min<std::uint64_t>(product(channels, path), 1 << 16);
  const std::uint64_t skip = (data == path ? h.end : 0) + skipped(h, "headersize");
  if (lower(or_empty(h, "compresseddata")) != "true") return compare(path, data, skip, needed);
  const std::uint64_t packed = Inflated(data, skip).require(path, needed);
  // MetaIO unpacks as many bytes as the header says, and from the header itself when it says
  // nothing
  const auto said = or_empty(h, "compresseddatasize");
  if (said.empty() && data != path) return;
  if (const std::uint64_t size = std::strtoull(said.c_str(), nullptr, 10);
      said.empty() || size < packed || size > fs::file_size(data) - skip)
    throw Error(FileError::inconsistent, Name{path},
                msg("its CompressedDataSize is {}, the data have {} bytes",
                    said.empty() ? "missing" : std::to_string(size), packed),
                msg("use an intact file"));
}

void check_nrrd(const std::string& path) {
  const Header h = read_header(path, ':');
  const std::string data = data_of_nrrd(path, h);
  const std::string encoding = lower(or_empty(h, "encoding"));
  const std::uint64_t from = data == path ? h.end : 0,
                      skip = skipped(h, "byte skip") + skipped(h, "byteskip");
  const std::uint64_t needed =
      product(or_empty(h, "sizes"), path) * bytes_of_type(or_empty(h, "type"));
  if (encoding == "raw") compare(path, data, from + skip, needed);
  if (encoding == "gzip" || encoding == "gz")
    static_cast<void>(Inflated(data, from).require(path, skip + needed));
}

constexpr std::size_t k_nifti_head = 544;

/// Bytes of a NIfTI file from its beginning, as its head (k_nifti_head bytes at most) has them:
/// version 1 or 2, either byte order.
std::uint64_t nifti_bytes(const std::string& path, const std::vector<std::uint8_t>& head) {
  const auto fail = [&path](FileError code, const Message& what) {
    throw Error(code, Name{path}, what, msg("use an intact file"));
  };
  bool swapped = false;
  const auto get = [&]<class T>(std::size_t at, T value) {
    std::array<std::uint8_t, sizeof(T)> b{};
    if (at + sizeof(T) > head.size())
      fail(FileError::truncated, msg("truncated inside the NIfTI header"));
    std::copy_n(head.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), b.begin());
    if (swapped) std::reverse(b.begin(), b.end());
    std::memcpy(&value, b.data(), sizeof(T));
    return value;
  };
  const auto is_head = [&] {
    return get(0, std::int32_t{}) == 348 || get(0, std::int32_t{}) == 540;
  };
  if (!is_head()) {
    swapped = true;
    if (!is_head()) fail(FileError::malformed, msg("not a NIfTI header"));
  }
  const bool second = get(0, std::int32_t{}) == 540;
  if (!second && head.size() < 348)
    fail(FileError::truncated, msg("truncated inside the NIfTI header"));
  const auto dim = [&](std::size_t i) {
    return second ? get(16 + 8 * i, std::int64_t{}) : get(40 + 2 * i, std::int16_t{});
  };
  const std::int64_t bits = get(second ? 14 : 72, std::int16_t{});
  const double offset = second ? static_cast<double>(get(168, std::int64_t{}))
                               : static_cast<double>(get(108, float{}));
  if (dim(0) < 1 || dim(0) > 7 || bits < 1 || !(offset >= 0 && offset < 1e9))
    fail(FileError::malformed, msg("impossible values in the NIfTI header"));
  std::uint64_t needed = static_cast<std::uint64_t>(bits);
  for (std::size_t i = 1; i <= static_cast<std::size_t>(dim(0)); ++i) {
    const auto n = static_cast<std::uint64_t>(std::max<std::int64_t>(dim(i), 1));
    if (n > 1U << 20 || (needed *= n) > 1ULL << 46)
      fail(FileError::malformed, msg("impossible values in the NIfTI header"));
  }
  return static_cast<std::uint64_t>(offset) + needed / 8;
}

void check_nifti(const std::string& path) {
  std::vector<std::uint8_t> head(k_nifti_head);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  compare(path, path, 0, nifti_bytes(path, head));
}

void check_packed_nifti(const std::string& path) {
  static_cast<void>(
      Inflated(path, 0).require(path, nifti_bytes(path, Inflated(path, 0).take(k_nifti_head))));
}

std::string lower_path(const std::string& path) {
  return lower(fs::path(path).filename().string());
}

}  // namespace

std::uint64_t bytes_of_volume(const std::string& path) {
  const std::string name = lower_path(path);
  std::string data = path;
  if (name.ends_with(".mhd") || name.ends_with(".mha"))
    data = data_of_meta(path, read_header(path, '='));
  if (name.ends_with(".nhdr") || name.ends_with(".nrrd"))
    data = data_of_nrrd(path, read_header(path, ':'));
  return fs::file_size(path) + (data == path ? 0 : fs::file_size(data));
}

void check_volume_bytes(const std::string& path) {
  const std::string name = lower_path(path);
  if (name.ends_with(".mhd") || name.ends_with(".mha")) check_meta(path);
  if (name.ends_with(".nhdr") || name.ends_with(".nrrd")) check_nrrd(path);
  if (name.ends_with(".nii")) check_nifti(path);
  if (name.ends_with(".nii.gz")) check_packed_nifti(path);
  if (name.ends_with(".tif") || name.ends_with(".tiff")) check_tiff_bytes(read_file(path), path);
}

void require_no_neighbour(const std::string& path) {
  if (!lower_path(path).ends_with(".nii.gz")) return;
  const std::string beside = path.substr(0, path.size() - 3);
  if (std::error_code none; std::filesystem::exists(beside, none))
    throw Error(FileError::inconsistent, Name{path},
                msg("lies beside {}, and ITK would read that instead", beside),
                msg("move one of the two into another folder"));
}

}  // namespace cavum
