#include "engine/base/write_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;
using namespace testing_basics;

std::size_t entries_in(const Folder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

/// Sets the process's umask while it lives.
struct Umask {
  ::mode_t before;
  explicit Umask(::mode_t mask) : before(::umask(mask)) {}
  ~Umask() { ::umask(before); }
};

TEST(WriteFile, FollowsNoLinkThatIsPlantedUnderATemporaryName) {
  const Folder folder, elsewhere;
  write_text_file(elsewhere.file("victim"), "precious");
  fs::create_symlink(elsewhere.file("victim"), folder.file("a.part"));
  write_text_file(folder.file("a"), "new");
  EXPECT_EQ(read_text_file(folder.file("a")), "new");
  EXPECT_EQ(read_text_file(elsewhere.file("victim")), "precious");
  EXPECT_TRUE(fs::is_symlink(folder.file("a.part"))) << "somebody else's, and left alone";
}

TEST(WriteFile, ReplacesALinkAndLeavesWhatItLedTo) {
  const Folder folder, elsewhere;
  write_text_file(elsewhere.file("victim"), "precious");
  fs::create_symlink(elsewhere.file("victim"), folder.file("a"));
  fs::create_symlink(elsewhere.file("nothing"), folder.file("b"));
  for (const std::string name : {"a", "b"}) {
    write_text_file(folder.file(name), "new");
    EXPECT_FALSE(fs::is_symlink(folder.file(name)));
    EXPECT_EQ(read_text_file(folder.file(name)), "new");
  }
  EXPECT_EQ(read_text_file(elsewhere.file("victim")), "precious");
  EXPECT_EQ(entries_in(elsewhere), 1u);
}

TEST(WriteFile, WritersOfOneFileAtOnceAllSucceedAndOneOfThemStandsWhole) {
  constexpr int k_writers = 8, k_times = 40;
  const Folder folder;
  std::vector<::pid_t> children;
  for (int w = 0; w < k_writers; ++w) {
    const ::pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (int i = 0; i < k_times; ++i) {
        try {
          write_text_file(folder.file("a"), std::string(static_cast<std::size_t>(1000 + 70000 * w),
                                                        static_cast<char>('a' + w)));
          const std::string seen = read_text_file(folder.file("a"));  // of whoever was last
          const auto whose = static_cast<std::size_t>(seen.at(0) - 'a');
          if (seen != std::string(1000 + 70000 * whose, seen[0])) ::_exit(2);
        } catch (const std::exception&) {
          ::_exit(1);
        }
      }
      ::_exit(0);
    }
    children.push_back(child);
  }
  for (const ::pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << (WEXITSTATUS(status) == 2 ? "half a file was seen" : "a writer was refused");
  }
  EXPECT_EQ(entries_in(folder), 1u);
}

TEST(WriteFile, WhatIsPrivateIsItsUsersAloneAndTheRestFollowsTheUmask) {
  const Folder folder;
  const Umask open(0);
  write_private_text_file(folder.file("private"), "x");
  make_private_file(folder.file("made"));
  write_text_file(folder.file("open"), "x");
  make_private_folder(folder.file("one/two"));
  EXPECT_EQ(mode_of(folder.file("private")), 0600u);
  EXPECT_EQ(mode_of(folder.file("made")), 0600u);
  EXPECT_EQ(mode_of(folder.file("open")), 0666u);
  EXPECT_EQ(mode_of(folder.file("one")), 0700u);
  EXPECT_EQ(mode_of(folder.file("one/two")), 0700u);
  write_private_text_file(folder.file("open"), "x");
  EXPECT_EQ(mode_of(folder.file("open")), 0600u) << "what others could read before";
  const Umask closed(027);
  write_text_file(folder.file("group"), "x");
  EXPECT_EQ(mode_of(folder.file("group")), 0640u);
}

TEST(WriteFile, APrivateFolderThatIsThereStaysAsItIsAndOneThatCannotBeIsNamed) {
  const Folder folder;
  fs::create_directory(folder.file("kept"));
  fs::permissions(folder.file("kept"), fs::perms(0755));
  make_private_folder(folder.file("kept"));
  make_private_folder("");
  EXPECT_EQ(mode_of(folder.file("kept")), 0755u);
  write_text_file(folder.file("file"), "x");
  const auto error = thrown_by([&] { make_private_folder(folder.file("file/below")); });
  EXPECT_EQ(code_of(error), FileError::not_written);
  EXPECT_EQ(place_of(error), folder.file("file/below"));
}

TEST(WriteFile, NothingGoesOverWhatCameMeanwhileWhenItMayNotReplace) {
  const Folder folder;
  write_text_file(folder.file("a"), "old");
  fs::create_symlink(folder.file("nothing"), folder.file("link"));
  for (const std::string name : {"a", "link"}) {
    const auto error =
        thrown_by([&] { write_text_file(folder.file(name), "new", {.may_replace = false}); });
    EXPECT_EQ(code_of(error), FileError::exists);
    EXPECT_EQ(place_of(error), folder.file(name));
    EXPECT_EQ(code_of([&] { make_private_file(folder.file(name)); }), FileError::exists);
  }
  EXPECT_EQ(read_text_file(folder.file("a")), "old");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  write_text_file(folder.file("b"), "new", {.may_replace = false});
  EXPECT_FALSE(put_in_place(folder.file("b"), folder.file("a")));
  EXPECT_TRUE(put_in_place(folder.file("b"), folder.file("c")));
  EXPECT_EQ(read_text_file(folder.file("c")), "new");
  EXPECT_EQ(entries_in(folder), 3u) << "no temporary file is left behind";
}

TEST(WriteFile, AFailureLeavesNothingBehindAndALongNameIsNone) {
  const Folder folder;
  fs::create_directories(folder.file("a/b"));
  EXPECT_EQ(code_of([&] { write_text_file(folder.file("a"), "new"); }), FileError::not_written);
  EXPECT_EQ(entries_in(folder), 1u);
  const std::string longest(255, 'n');
  write_text_file(folder.file(longest), "new");
  EXPECT_EQ(read_text_file(folder.file(longest)), "new");
}

TEST(WriteFile, TheFolderIsSyncedOrTheDiskIsBlamed) {
  const Folder folder;
  EXPECT_NO_THROW(sync_folder_of(folder.file("a")));
  EXPECT_EQ(code_of([&] { sync_folder_of(folder.file("none/a")); }), FileError::not_written);
}

TEST(WriteFile, TemporaryNamesAreNeverTheSame) {
  EXPECT_NE(temporary_name_next_to("a"), temporary_name_next_to("a"));
}

}  // namespace
}  // namespace cavum
