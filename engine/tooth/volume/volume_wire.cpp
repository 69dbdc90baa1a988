#include "engine/tooth/volume/volume_wire.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <nlohmann/json.hpp>

#include "engine/base/bytes.h"
#include "engine/base/file_error.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_json.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr std::string_view k_magic = "CVVOLUME";
constexpr std::uint32_t k_error = 0, k_volume = 1, k_file_error = 2 /* and its code above it */,
                        k_longest_text = 4096;
constexpr const char* k_intact =
    noop("give an intact MetaImage, NRRD, NIfTI, TIFF or DICOM series");
constexpr std::size_t k_head_bytes = 3 * 4 + 15 * 8;

bool send(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const auto n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

ByteWriter begun(std::uint32_t kind) {
  ByteWriter out;
  for (const char c : k_magic) out.put(c);
  out.put(kind);
  return out;
}

/// What comes from one descriptor, until a moment.
class Incoming {
 public:
  Incoming(int fd, std::string path, int seconds)
      : fd_(fd),
        path_(std::move(path)),
        seconds_(seconds),
        until_(std::chrono::steady_clock::now() + std::chrono::seconds(seconds)) {}

  void fill(std::span<std::uint8_t> to) {
    while (!to.empty()) {
      const auto n = some(to);
      if (n == 0)
        throw VolumeCutOff(FileError::truncated, Name{path_},
                           msg("cannot be read as a volume: the reading ended early"),
                           msg(k_intact));
      to = to.subspan(n);
    }
  }
  void require_end() {
    std::array<std::uint8_t, 1> more{};
    if (some(more) != 0) fail(msg("gave more than a volume"));
  }
  [[noreturn]] void fail(const Message& what, FileError code = FileError::malformed) const {
    throw Error(code, Name{path_}, msg("cannot be read as a volume: the reading {}", what),
                msg(k_intact));
  }

 private:
  /// 0 at the end.
  std::size_t some(std::span<std::uint8_t> to) {
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                            until_ - std::chrono::steady_clock::now())
                            .count();
      pollfd ready{fd_, POLLIN, 0};
      const int events = left > 0 ? ::poll(&ready, 1, static_cast<int>(left)) : 0;
      if (events < 0 && errno == EINTR) continue;
      if (events == 0)
        fail(msg("took longer than the limit of {} s", seconds_), FileError::unsupported);
      const auto n = ::read(fd_, to.data(), to.size());
      if (n >= 0) return static_cast<std::size_t>(n);
      if (errno != EINTR && errno != EAGAIN) fail(msg("broke off"));
    }
  }

  int fd_;
  std::string path_;
  int seconds_;
  std::chrono::steady_clock::time_point until_;
};

}  // namespace

bool send_volume_error(int fd, const Error& error) {
  std::uint32_t kind = k_error;
  for (std::uint32_t code = 0; code < k_file_errors; ++code)
    if (error.code() == static_cast<FileError>(code)) kind = k_file_error + code;
  ByteWriter out = begun(kind);
  for (const Message* part : {&error.where(), &error.problem(), &error.advice()})
    out.put_string(
        encode(*part).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  return send(fd, out.bytes());
}

bool send_volume(int fd, const Volume& head, std::span<const float> gray) {
  ByteWriter out = begun(k_volume);
  for (const auto n : {head.size.x, head.size.y, head.size.z}) out.put(n);
  for (const double s : head.spacing_mm) out.put(s);
  for (const Vec3& v : {head.axis[0], head.axis[1], head.axis[2], head.origin_mm})
    for (const double x : {v.x, v.y, v.z}) out.put(x);
  return send(fd, out.bytes()) &&
         send(fd, {reinterpret_cast<const std::uint8_t*>(gray.data()), gray.size_bytes()});
}

Volume receive_volume(int fd, const std::string& path, std::uint64_t most, int seconds) {
  Incoming in(fd, path, seconds);
  std::array<std::uint8_t, k_head_bytes> head{};
  const std::span<std::uint8_t> begin(head.data(), k_magic.size() + 8);
  in.fill(begin);
  ByteReader first(begin, path);
  const auto magic = first.get_bytes(k_magic.size());
  if (!std::equal(magic.begin(), magic.end(), k_magic.begin())) in.fail(msg("gave no volume"));
  const auto kind = first.get<std::uint32_t>();
  if (kind == k_error || (kind >= k_file_error && kind < k_file_error + k_file_errors)) {
    std::array<Message, 3> parts;
    std::uint32_t length = first.get<std::uint32_t>();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) in.fill({reinterpret_cast<std::uint8_t*>(&length), sizeof length});
      std::string text(std::min(length, k_longest_text), ' ');
      in.fill({reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
      try {
        parts[i] = decode_message(parse_json_or_null(text, k_json_part));
      } catch (const std::invalid_argument&) {
        in.fail(msg("gave no volume"));
      }
    }
    throw Error(
        kind == k_error ? ErrorCode(General::error) : static_cast<FileError>(kind - k_file_error),
        parts[0], parts[1], parts[2]);
  }
  if (kind != k_volume) in.fail(msg("gave no volume"));
  std::copy_n(head.begin() + k_magic.size() + 4, 4,
              head.begin());  // of the size, which has come already
  in.fill(std::span(head).subspan(4));
  ByteReader rest(head, path);
  Volume v;
  for (auto* n : {&v.size.x, &v.size.y, &v.size.z}) {
    *n = rest.get<std::int32_t>();
    if (*n < 1 || *n > 1 << 16) in.fail(msg("gave an impossible size"));
  }
  if (v.voxels() > most)
    in.fail(msg("gave {} voxels, more than the limit of {}", v.voxels(), most),
            FileError::too_large);
  for (double& s : v.spacing_mm) s = rest.get<double>();
  for (Vec3* p : {&v.axis[0], &v.axis[1], &v.axis[2], &v.origin_mm}) {
    for (double* x : {&p->x, &p->y, &p->z}) *x = rest.get<double>();
    if (!is_finite(*p)) in.fail(msg("gave a place that is none"));
  }
  v.gray.resize(v.voxels());
  in.fill({reinterpret_cast<std::uint8_t*>(v.gray.data()), v.gray.size() * sizeof(float)});
  in.require_end();
  return v;
}

}  // namespace cavum
