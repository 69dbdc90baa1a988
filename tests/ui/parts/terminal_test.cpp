#include "ui/parts/terminal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <iostream>

#include "engine/base/file.h"
#include "tests/engine/support/basics.h"

namespace cavum::ui {
namespace {

struct Printed {
  std::string out, err;
};

/// What a process that prints through SafeTerminal writes.
Printed printed(const std::function<void()>& print) {
  const testing_basics::Folder folder;
  std::fflush(nullptr);
  const ::pid_t child = ::fork();
  if (child == 0) {
    if (std::freopen(folder.file("out").c_str(), "w", stdout) == nullptr ||
        std::freopen(folder.file("err").c_str(), "w", stderr) == nullptr)
      ::_exit(1);
    {
      const SafeTerminal terminal;
      print();
    }
    std::printf("after\x1b");
    std::fflush(nullptr);
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return {read_text_file(folder.file("out")), read_text_file(folder.file("err"))};
}

TEST(Terminal, NoCommandPassesByAnyWayOfPrinting) {
  const Printed p = printed([] {
    std::printf("%s\n", "printf \x1b[31m");
    std::cout << "cout \xc2\x9b"
                 "2J \xe2\x80\xae"
                 "ssap\n";
    std::fprintf(stderr, "%s\n", "fprintf \x07");
    std::cerr << "cerr \x1b]0;x\x07\n";
    std::puts("p\xc3\xa4uts");
  });
  EXPECT_EQ(p.out, "printf ?[31m\ncout ?2J ?ssap\np\xc3\xa4uts\nafter\x1b")
      << "in order, and as before afterwards";
  EXPECT_EQ(p.err, "fprintf ?\ncerr ?]0;x?\n");
}

TEST(Terminal, ACharacterThatIsPrintedInPiecesStaysOne) {
  const Printed p = printed([] {
    for (const char* piece : {"\xf0", "\x9f\xa6", "\xb7", " \xe2\x80"}) std::fputs(piece, stderr);
    for (int i = 0; i < 5000; ++i)
      std::cout << "\xe2\x82\xac";  // past any buffer's end in the middle of one
  });
  EXPECT_EQ(p.err, "\xf0\x9f\xa6\xb7 ??") << "what never became one is shown as that";
  std::string euros;
  for (int i = 0; i < 5000; ++i) euros += "\xe2\x82\xac";
  EXPECT_EQ(p.out, euros + "after\x1b");
}

TEST(Terminal, TheProgramsOwnCommandsPassInTheirPlace) {
  const Printed p = printed([] {
    std::cout << "before ";
    command_terminal("\033[H");
    std::cout << "behind";
  });
  EXPECT_EQ(p.out, "before \033[Hbehindafter\x1b");
}

}  // namespace
}  // namespace cavum::ui
