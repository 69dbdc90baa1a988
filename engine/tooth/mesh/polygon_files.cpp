#include "engine/tooth/mesh/polygon_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <optional>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr std::string_view k_blank = " \t\v\f";

std::string_view view_of(const Bytes& file) {
  return {reinterpret_cast<const char*>(file.data()), file.size()};
}

[[noreturn]] void fail(FileError code, Message where, const Message& what) {
  throw Error(code, std::move(where), what, msg("copy or export the whole file again"));
}

/// Takes the next word of `rest` off; empty at its end.
std::string_view next_word(std::string_view& rest, std::string_view blank = k_blank) {
  rest.remove_prefix(std::min(rest.find_first_not_of(blank), rest.size()));
  const auto word = rest.substr(0, rest.find_first_of(blank));
  rest.remove_prefix(word.size());
  return word;
}

/// Takes the next line off, without its end.
std::string_view next_line(std::string_view& rest) {
  auto line = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

template <class Number>
std::optional<Number> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && !word.empty()
             ? std::optional(value)
             : std::nullopt;
}

double coordinate(std::string_view word, const std::string& where) {
  const auto value = number_in<double>(word);
  if (!value)
    fail(FileError::malformed, Name{where},
         msg("'{}' is no coordinate", one_line(std::string(word.substr(0, 40)))));
  return *value;
}

void add_polygon(Polygons& out, std::vector<std::uint32_t> corners, const std::string& where) {
  if (corners.size() < 3)
    fail(FileError::malformed, Name{where}, msg("has a face of fewer than three corners"));
  out.polygons.push_back(std::move(corners));
}

/// Corner numbers are known to be there only when all is read.
void require_corners(const Polygons& p, const std::string& name) {
  for (std::size_t i = 0; i < p.polygons.size(); ++i)
    for (const auto corner : p.polygons[i])
      if (corner >= p.corners_mm.size())
        fail(FileError::inconsistent, Name{name},
             msg("face {} names a corner that is not there ({} are)", i + 1, p.corners_mm.size()));
}

// --- PLY

enum class PlyFormat { text, little, big };
struct PlyType {
  std::size_t bytes;
  bool real, negative;
};
struct PlyProperty {
  std::string name;
  PlyType type{};
  std::optional<PlyType> count;  ///< of a list
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

PlyType ply_type(std::string_view word, const std::string& where) {
  struct Known {
    std::string_view old_name, new_name;
    PlyType type;
  };
  static constexpr std::array<Known, 8> k_known{{{"char", "int8", {1, false, true}},
                                                 {"uchar", "uint8", {1, false, false}},
                                                 {"short", "int16", {2, false, true}},
                                                 {"ushort", "uint16", {2, false, false}},
                                                 {"int", "int32", {4, false, true}},
                                                 {"uint", "uint32", {4, false, false}},
                                                 {"float", "float32", {4, true, true}},
                                                 {"double", "float64", {8, true, true}}}};
  for (const auto& k : k_known)
    if (word == k.old_name || word == k.new_name) return k.type;
  fail(FileError::malformed, Name{where},
       msg("'{}' is no type of a PLY property", one_line(std::string(word.substr(0, 40)))));
}

/// The values behind a PLY's head, one after the other.
class PlyValues {
 public:
  PlyValues(std::string_view rest, PlyFormat format, const std::string& name)
      : rest_(rest), format_(format), name_(name) {}

  double next(const PlyType& type) {
    if (format_ == PlyFormat::text) {
      const auto word = next_word(rest_, " \t\v\f\r\n");
      if (word.empty()) fail(FileError::truncated, Name{name_}, msg("is cut off"));
      return coordinate(word, name_);
    }
    if (rest_.size() < type.bytes) fail(FileError::truncated, Name{name_}, msg("is cut off"));
    std::array<std::uint8_t, 8> raw{};
    std::copy_n(rest_.begin(), type.bytes, raw.begin());
    if (format_ == PlyFormat::big)
      std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    rest_.remove_prefix(type.bytes);
    const auto bits = std::bit_cast<std::uint64_t>(raw);
    if (type.real)
      return type.bytes == 8
                 ? std::bit_cast<double>(bits)
                 : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    const auto shift = static_cast<int>(64 - 8 * type.bytes);
    return type.negative ? static_cast<double>(static_cast<std::int64_t>(bits << shift) >> shift)
                         : static_cast<double>(bits);
  }
  /// A number of things or of a corner.
  std::uint32_t next_whole(const PlyType& type) {
    const double value = next(type);
    if (!(value >= 0 && value < 4294967295.0) ||
        value != static_cast<double>(static_cast<std::uint32_t>(value)))
      fail(FileError::malformed, Name{name_}, msg("has a list or a face whose numbers are none"));
    return static_cast<std::uint32_t>(value);
  }

 private:
  std::string_view rest_;
  PlyFormat format_;
  const std::string& name_;
};

/// The elements that the head promises; takes the head off `rest`.
std::vector<PlyElement> read_ply_head(std::string_view& rest, PlyFormat& format,
                                      const std::string& name) {
  std::vector<PlyElement> elements;
  bool formatted = false;
  if (next_line(rest) != "ply")
    fail(FileError::malformed, Name{name}, msg("is no PLY: it does not begin with 'ply'"));
  for (int number = 2;; ++number) {
    if (rest.empty()) fail(FileError::truncated, Name{name}, msg("is cut off within its head"));
    std::string_view line = next_line(rest);
    const std::string where = fmt::format("{}:{}", name, number);
    const auto word = next_word(line);
    if (word == "end_header") break;
    if (word.empty() || word == "comment" || word == "obj_info") continue;
    if (word == "format") {
      const auto kind = next_word(line);
      formatted = kind == "ascii" || kind == "binary_little_endian" || kind == "binary_big_endian";
      format = kind == "ascii"                  ? PlyFormat::text
               : kind == "binary_little_endian" ? PlyFormat::little
                                                : PlyFormat::big;
    } else if (word == "element") {
      const auto element = next_word(line);
      const auto count = number_in<std::uint64_t>(next_word(line));
      if (element.empty() || !count)
        fail(FileError::malformed, Name{where}, msg("has an element without a name or a number"));
      elements.push_back({std::string(element), *count, {}});
    } else if (word == "property") {
      if (elements.empty())
        fail(FileError::inconsistent, Name{where}, msg("has a property of no element"));
      PlyProperty p;
      auto type = next_word(line);
      if (type == "list") {
        p.count = ply_type(next_word(line), where);
        type = next_word(line);
      }
      p.type = ply_type(type, where);
      p.name = next_word(line);
      elements.back().properties.push_back(std::move(p));
    } else {
      fail(FileError::malformed, Name{where},
           msg("'{}' means nothing in a PLY's head", one_line(std::string(word.substr(0, 40)))));
    }
  }
  if (!formatted)
    fail(FileError::malformed, Name{name},
         msg("does not say whether it is ascii, binary_little_endian or binary_big_endian"));
  for (const auto& e : elements)
    if (e.properties.empty() && e.count > 0)
      fail(FileError::inconsistent, Name{name},
           msg("promises {} of '{}' without a property", e.count, one_line(e.name)));
  return elements;
}

}  // namespace

Polygons read_ply(const Bytes& file, const std::string& name) {
  std::string_view rest = view_of(file);
  PlyFormat format = PlyFormat::text;
  const auto elements = read_ply_head(rest, format, name);
  PlyValues values(rest, format, name);
  Polygons out;
  for (const auto& e : elements) {
    const bool corner = e.name == "vertex", face = e.name == "face";
    for (std::uint64_t i = 0; i < e.count; ++i) {
      std::array<std::optional<double>, 3> at;
      for (const auto& p : e.properties) {
        if (p.count) {
          const auto n = values.next_whole(*p.count);
          const bool corners = face && (p.name == "vertex_indices" || p.name == "vertex_index");
          std::vector<std::uint32_t> list;
          for (std::uint32_t k = 0; k < n; ++k) {
            if (corners)
              list.push_back(values.next_whole(p.type));
            else
              static_cast<void>(values.next(p.type));
          }
          if (corners) add_polygon(out, std::move(list), name);
          continue;
        }
        const double value = values.next(p.type);
        if (p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
          at[static_cast<std::size_t>(p.name[0] - 'x')] = value;
      }
      if (!corner) continue;
      if (!at[0] || !at[1] || !at[2])
        fail(FileError::inconsistent, Name{name}, msg("has corners without x, y or z"));
      out.corners_mm.push_back({*at[0], *at[1], *at[2]});
    }
  }
  require_corners(out, name);
  return out;
}

Polygons read_obj(const Bytes& file, const std::string& name) {
  Polygons out;
  std::string_view rest = view_of(file);
  for (int number = 1; !rest.empty(); ++number) {
    std::string joined;
    std::string_view line = next_line(rest);
    while (line.ends_with('\\') && !rest.empty()) {  // goes on in the next
      joined += line.substr(0, line.size() - 1);
      line = next_line(rest);
      ++number;
    }
    if (!joined.empty()) line = joined += line;
    const std::string where = fmt::format("{}:{}", name, number);
    const auto word = next_word(line);
    if (word == "v") {
      Vec3 p;
      for (double* x : {&p.x, &p.y, &p.z}) *x = coordinate(next_word(line), where);
      out.corners_mm.push_back(p);
    } else if (word == "f") {
      std::vector<std::uint32_t> corners;
      for (auto corner = next_word(line); !corner.empty() && corner[0] != '#';
           corner = next_word(line)) {
        const auto n = number_in<std::int32_t>(corner.substr(0, corner.find('/')));
        const auto known = static_cast<std::int64_t>(out.corners_mm.size());
        const std::int64_t index = !n || *n == 0 ? -1 : *n > 0 ? *n - std::int64_t{1} : known + *n;
        if (index < 0)
          fail(FileError::malformed, Name{where},
               msg("'{}' is no corner", one_line(std::string(corner.substr(0, 40)))));
        corners.push_back(static_cast<std::uint32_t>(index));
      }
      add_polygon(out, std::move(corners), where);
    }
  }
  require_corners(out, name);
  return out;
}

Polygons read_off(const Bytes& file, const std::string& name) {
  std::string_view rest = view_of(file);
  int number = 0;
  const auto line_with_words = [&]() -> std::string_view {
    while (!rest.empty()) {
      ++number;
      auto line = next_line(rest);
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(k_blank) != std::string_view::npos) return line;
    }
    fail(FileError::truncated, Name{name}, msg("is cut off"));
  };
  std::string_view line = line_with_words();
  std::string_view kind = next_word(line);
  if (!kind.ends_with("OFF"))
    fail(FileError::malformed, Name{name}, msg("is no OFF: it does not begin with OFF"));
  kind.remove_suffix(3);
  if (kind.find_first_not_of("STCN") != std::string_view::npos || !next_word(line).empty())
    fail(FileError::unsupported, Name{name},
         msg("is an OFF of another kind than text in three dimensions"));
  line = line_with_words();
  const auto corners = number_in<std::uint64_t>(next_word(line)),
             faces = number_in<std::uint64_t>(next_word(line));
  if (!corners || !faces)
    fail(FileError::malformed, Name{name}, msg("does not say how many corners and faces it holds"));
  Polygons out;
  const auto where = [&] { return fmt::format("{}:{}", name, number); };
  for (std::uint64_t i = 0; i < *corners; ++i) {
    line = line_with_words();
    Vec3 p;
    for (double* x : {&p.x, &p.y, &p.z}) *x = coordinate(next_word(line), where());
    out.corners_mm.push_back(p);
  }
  for (std::uint64_t i = 0; i < *faces; ++i) {
    line = line_with_words();
    const auto n = number_in<std::uint32_t>(next_word(line));
    if (!n)
      fail(FileError::malformed, Name{where()}, msg("has a face without its number of corners"));
    std::vector<std::uint32_t> list;
    for (std::uint32_t k = 0; k < *n; ++k) {
      const auto corner = number_in<std::uint32_t>(next_word(line));
      if (!corner)
        fail(FileError::malformed, Name{where()}, msg("has a face whose corners are no numbers"));
      list.push_back(*corner);
    }
    add_polygon(out, std::move(list), where());
  }
  require_corners(out, name);
  return out;
}

}  // namespace cavum
