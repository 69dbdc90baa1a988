#include "tests/ui/station/virtual_screen.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

namespace cavum::testing_station {

VirtualScreen::VirtualScreen() {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return;
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    const std::string number = std::to_string(ends[1]);
    const int quiet = ::open("/dev/null", O_WRONLY);
    ::dup2(quiet, STDERR_FILENO);
    ::execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1280x800x24",
             "-nolisten", "tcp", static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(ends[1]);
  // its number comes when it is ready; the end of the pipe when it never will be
  std::string display;
  constexpr int k_patience_ms = 60000;
  pollfd wait{ends[0], POLLIN, 0};
  char c = 0;
  while (::poll(&wait, 1, k_patience_ms) > 0 && ::read(ends[0], &c, 1) == 1 && c != '\n')
    display += c;
  ::close(ends[0]);
  if (display.empty()) {
    ::kill(child, SIGTERM);
    ::waitpid(child, nullptr, 0);
    return;
  }
  server_ = child;
  ::setenv("DISPLAY", (":" + display).c_str(), 1);
}

VirtualScreen::~VirtualScreen() {
  if (server_ <= 0) return;
  ::kill(server_, SIGTERM);
  ::waitpid(server_, nullptr, 0);
}

}  // namespace cavum::testing_station
