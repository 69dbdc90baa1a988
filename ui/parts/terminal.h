// What reaches the terminal: everything that the program prints, with printf or a stream, passes
// one place that takes out what could command a terminal. Files come from strangers, and a verdict
// or a name in one may hold escape sequences.
#pragma once

#include <cstdio>
#include <memory>
#include <streambuf>

namespace cavum::ui {

/// While it lives, stdout and stderr, std::cout and std::cerr write terminal_text() only. Line ends
/// inside a name still make lines: print a text of a file with one_line().
class SafeTerminal {
 public:
  SafeTerminal();
  ~SafeTerminal();
  SafeTerminal(const SafeTerminal&) = delete;
  SafeTerminal& operator=(const SafeTerminal&) = delete;

 private:
  struct Stream;
  std::unique_ptr<Stream> out_, err_;
};

/// Commands for the terminal that are the program's own ("clear the screen"), past SafeTerminal.
void command_terminal(const char* sequence);

}  // namespace cavum::ui
