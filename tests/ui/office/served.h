// `cavum serve` as a process of its own, on a free port, that a test may kill.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <regex>
#include <string>
#include <thread>

#include "tests/ui/office/opened.h"

namespace cavum::testing_office {

class Served {
 public:
  /// `port` 0: any that is free. `most_bytes`: no file of its may grow beyond, as on a disk that is
  /// full; 0: any size.
  explicit Served(const testing_ledger::School& school, std::uint16_t port = 0,
                  std::uintmax_t most_bytes = 0)
      : out_(school.file("served.txt")) {
    const std::string listen = "127.0.0.1:" + std::to_string(port);
    std::filesystem::remove(out_);
    pid_ = ::fork();
    if (pid_ == 0) {
      const int file = ::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(file, STDOUT_FILENO);
      ::dup2(file, STDERR_FILENO);
      if (most_bytes > 0) {
        const rlimit limit{most_bytes, most_bytes};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        ::signal(SIGXFSZ, SIG_IGN);
      }
      ::execl(CAVUM_BINARY, CAVUM_BINARY, "serve", school.ledger_folder().c_str(), "--listen",
              listen.c_str(), "--exam", testing_ledger::k_scenario.c_str(),
              static_cast<char*>(nullptr));
      ::_exit(127);
    }
    for (int i = 0; i < 600 && port_.empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      const std::string said = std::filesystem::exists(out_) ? read_text_file(out_) : "";
      std::smatch address;
      if (std::regex_search(said, address, std::regex("https://127\\.0\\.0\\.1:(\\d+)\\D")))
        port_ = address[1];
    }
    EXPECT_FALSE(port_.empty()) << read_text_file(out_);
  }
  ~Served() { kill(); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }
  [[nodiscard]] std::uint16_t port() const { return static_cast<std::uint16_t>(std::stoi(port_)); }
  /// Of its memory, kB: the most that it held at once.
  [[nodiscard]] long peak_kb() const {
    const std::string status = read_text_file("/proc/" + std::to_string(pid_) + "/status");
    return std::stol(status.substr(status.find("VmHWM:") + 6));
  }
  [[nodiscard]] std::string address() const { return "https://127.0.0.1:" + port_; }

 private:
  std::string out_, port_;
  pid_t pid_ = 0;
};

}  // namespace cavum::testing_office
