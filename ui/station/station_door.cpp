#include "ui/station/station_door.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/system_error.h"

namespace cavum::station {
namespace {

struct DoorAddress {
  sockaddr_un address{};
  socklen_t size = 0;
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }
};

/// In the abstract namespace of Linux: no file, nothing to clean up.
DoorAddress door_address() {
  std::error_code none;
  const std::string folder = std::filesystem::weakly_canonical(
                                 std::filesystem::path(station_path("x")).parent_path(), none)
                                 .string();
  constexpr std::size_t k_digits = 32;
  const std::string name = "cavum-station-" + to_hex(sha256(folder)).substr(0, k_digits);
  DoorAddress a;
  a.address.sun_family = AF_UNIX;
  std::memcpy(a.address.sun_path + 1, name.data(), name.size());  // the first byte stays 0
  a.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return a;
}

int door_socket() { return ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

Error door_is_shut() {
  return {msg("station"), msg("a locked exam runs at this station"),
          msg("wait until it is over, or let the supervisor end it there")};
}

}  // namespace

StationDoor::StationDoor() : socket_(door_socket()) {
  const DoorAddress a = door_address();
  if (socket_ >= 0 && ::bind(socket_, a.get(), a.size) == 0) return;
  const bool taken = errno == EADDRINUSE;
  if (socket_ >= 0) ::close(socket_);
  if (taken) throw door_is_shut();
  throw Error(Name{"--kiosk"}, msg("this computer gives no socket ({})", system_words(errno)),
              msg("start it anew"));
}

StationDoor::~StationDoor() { ::close(socket_); }

int StationDoor::knocks() {
  int count = 0;
  std::array<char, 16> word{};
  while (::recv(socket_, word.data(), word.size(), 0) >= 0) ++count;
  return count;
}

void StationDoor::pass() {
  const int knocking = door_socket();
  if (knocking < 0) return;
  const DoorAddress a = door_address();
  const bool heard = ::sendto(knocking, "start", 5, 0, a.get(), a.size) >= 0 || errno == EAGAIN;
  ::close(knocking);
  if (heard) throw door_is_shut();
}

}  // namespace cavum::station
