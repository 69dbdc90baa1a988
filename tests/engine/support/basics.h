// What tests of every part share: seeds that are drawn anew and printed, the text of an error, a
// folder that goes away, and the files that ship.
#pragma once

#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/error.h"
#include "engine/base/lines.h"
#include "engine/base/random.h"

namespace cavum {

/// For what a failed test prints.
inline std::ostream& operator<<(std::ostream& out, const Message& message) {
  return out << english_text(message);
}

}  // namespace cavum

namespace cavum::testing_basics {

/// Seed drawn anew in every run, or taken from CAVUM_TEST_SEED; prints it.
inline std::uint64_t drawn_seed(const char* test) {
  const char* fixed = std::getenv("CAVUM_TEST_SEED");
  std::random_device device;
  const std::uint64_t seed = fixed != nullptr
                                 ? std::strtoull(fixed, nullptr, 10)
                                 : static_cast<std::uint64_t>(device()) << 32 | device();
  std::printf("%s: CAVUM_TEST_SEED=%llu\n", test, static_cast<unsigned long long>(seed));
  return seed;
}

/// Of a list whose members each take long: `most` of them, drawn by the seed, in their order; all
/// with CAVUM_DEEP.
template <class Member>
std::vector<Member> some_of(std::vector<Member> list, std::size_t most, const char* test) {
  if (std::getenv("CAVUM_DEEP") != nullptr) return list;
  Random random(drawn_seed(test));
  while (list.size() > most)
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(random.below(list.size())));
  return list;
}

/// Which Error `action` throws; none.
template <class Action>
std::optional<ErrorCode> code_of(const Action& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.code();
  }
  return {};
}

/// What a test may ask of a sentence besides its kind: whether a name, a place in a file, a word of
/// data or a figure is among its values, at any depth.
inline bool tells(const Message& message, const Value& wanted) {
  const auto in = [&wanted](const Value& v) {
    if (v == wanted) return true;
    if (const auto* is = std::get_if<Vec3>(&v), *place = std::get_if<Vec3>(&wanted);
        is != nullptr && place != nullptr)
      return length(*is - *place) < 2e-6;  // as a result holds it, to a millionth
    if (const auto* place = std::get_if<FileLocation>(&v))
      return wanted == Value(Name{place->file});
    if (const auto* term = std::get_if<Term>(&v)) return wanted == Value(Name{term->english});
    if (const auto* authored = std::get_if<Authored>(&v))
      return wanted == Value(Name{authored->english});
    if (const auto* is = std::get_if<Number>(&v), *number = std::get_if<Number>(&wanted);
        is != nullptr && number != nullptr)
      return std::fabs(is->value - number->value) < 2e-6;
    if (const auto* inner = std::get_if<Message>(&v)) return tells(*inner, wanted);
    const auto* list = std::get_if<List>(&v);
    return list != nullptr && std::any_of(list->items.begin(), list->items.end(),
                                          [&](const Message& m) { return tells(m, wanted); });
  };
  return std::any_of(message.values().begin(), message.values().end(), in);
}
inline bool tells(const Message& message, const char* name) {
  return tells(message, Value(Name{name}));
}
inline bool tells(const Message& message, const std::string& name) {
  return tells(message, Value(Name{name}));
}
inline bool tells(const Message& message, int whole) {
  return tells(message, Value(std::int64_t{whole}));
}
inline bool tells(const Message& message, double number) {
  return tells(message, Value(as_number(number)));
}
inline bool tells(const Message& message, const Message& part) {
  return message == part || tells(message, Value(part));
}
template <class Wanted>
bool tells(const std::vector<Message>& messages, const Wanted& wanted) {
  return std::any_of(messages.begin(), messages.end(),
                     [&](const Message& m) { return tells(m, wanted); });
}
template <class Wanted>
bool tells(const std::optional<Error>& error, const Wanted& wanted) {
  return error && tells(error->message(), wanted);
}
/// The figures in a message, in their order, at any depth.
inline std::vector<double> figures_in(const Message& message) {
  std::vector<double> all;
  for (const Value& v : message.values()) {
    if (const auto* whole = std::get_if<std::int64_t>(&v))
      all.push_back(static_cast<double>(*whole));
    if (const auto* number = std::get_if<Number>(&v)) all.push_back(number->value);
    std::vector<Message> inner;
    if (const auto* m = std::get_if<Message>(&v)) inner = {*m};
    if (const auto* list = std::get_if<List>(&v)) inner = list->items;
    for (const Message& m : inner)
      for (const double figure : figures_in(m)) all.push_back(figure);
  }
  return all;
}
/// All cells of several lines.
inline std::vector<Message> cells_of(const Lines& lines) {
  std::vector<Message> all;
  for (const Lines::Line& line : lines.all())
    all.insert(all.end(), line.cells.begin(), line.cells.end());
  return all;
}
template <class Wanted>
bool tells(const Lines& lines, const Wanted& wanted) {
  return tells(cells_of(lines), wanted);
}
template <class Wanted>
bool tells(const List& list, const Wanted& wanted) {
  return tells(list.items, wanted);
}
/// The Error that `action` throws; none.
template <class Action>
std::optional<Error> thrown_by(const Action& action) {
  try {
    action();
  } catch (const Error& e) {
    return e;
  }
  return {};
}
/// The file, line and column, or the name, that an error or a finding is about; empty for other
/// places and for none.
inline std::string place_of(const Message& where) {
  return where.values().size() == 1 && std::string_view(where.english()) == "{}"
             ? english_text(where)
             : "";
}
inline std::string place_of(const std::optional<Error>& error) {
  return error ? place_of(error->where()) : "";
}
inline std::optional<ErrorCode> code_of(const std::optional<Error>& problem) {
  return problem ? std::optional(problem->code()) : std::nullopt;
}
inline std::string text_of(const std::optional<Error>& problem) {
  return problem ? problem->what() : "";
}
inline std::string text_of(const Message& message) { return english_text(message); }
/// Of several, each on a line.
template <class Found>
requires(
    requires(const Found& f) { text_of(f.what); } ||
    requires(const Found& f) { f.message(); }) std::string text_of(const std::vector<Found>& all) {
  std::string text;
  for (const Found& f : all) {
    if constexpr (requires { f.what; })
      text += text_of(f.what) + "\n";
    else
      text += text_of(f.message()) + "\n";
  }
  return text;
}
inline std::string text_of(const std::vector<Message>& messages) {
  std::string all;
  for (const Message& m : messages) all += english_text(m) + "\n";
  return all;
}

/// `what`, `times` times in a row.
inline std::string repeated(const std::string& what, std::size_t times) {
  std::string out;
  out.reserve(what.size() * times);
  for (std::size_t i = 0; i < times; ++i) out += what;
  return out;
}

[[nodiscard]] inline Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// Permissions of what stands at `path` itself, be it a link; all bits where nothing does.
inline unsigned mode_of(const std::string& path) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0 ? info.st_mode & 0777u : ~0u;
}

/// Names of the TOML files of a folder, without their ending, sorted.
inline std::vector<std::string> toml_names(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Whether it comes true in time.
inline bool comes_true(const std::function<bool()>& condition,
                       std::chrono::milliseconds within = std::chrono::seconds(20)) {
  for (const auto end = std::chrono::steady_clock::now() + within;
       std::chrono::steady_clock::now() < end;
       std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    if (condition()) return true;
  return condition();
}

/// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "cavum-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Path of a file in data/.
inline std::string data_path(const std::string& name) {
#ifdef CAVUM_SOURCE_DIR
  return std::string(CAVUM_SOURCE_DIR) + "/data/" + name;
#else
  return (std::filesystem::path(__FILE__).parent_path() / "../../../data" / name).string();
#endif
}

}  // namespace cavum::testing_basics
