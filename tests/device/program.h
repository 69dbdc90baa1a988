// The built program under the same emulation as the test.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace cavum::testing_device {

struct Ran {
  int code = -1;
  std::string out;  ///< standard output and errors
};
/// `cavum ARGUMENTS`, through the shell.
inline Ran run(const std::string& arguments) {
  Ran r;
  FILE* pipe = ::popen((std::string(CAVUM_BINARY) + " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return r;
  char text[4096];
  while (const std::size_t n = std::fread(text, 1, sizeof text, pipe)) r.out.append(text, n);
  r.code = WEXITSTATUS(::pclose(pipe));
  return r;
}

}  // namespace cavum::testing_device
