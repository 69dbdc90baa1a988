#include "engine/base/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "engine/base/file_error.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(File, WritesAndReadsBackEveryByte) {
  const Folder folder;
  Bytes bytes(200000);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  write_file(folder.file("a"), bytes);
  EXPECT_EQ(read_file(folder.file("a")), bytes);
  write_text_file(folder.file("a"), "short");
  EXPECT_EQ(read_text_file(folder.file("a")), "short");
  write_file(folder.file("empty"), {});
  EXPECT_TRUE(read_file(folder.file("empty")).empty());
}

TEST(File, ADeviceOrAPipeIsNotReplacedByAFile) {
  const Folder folder;
  const std::string pipe = folder.file("pipe"), link = folder.file("link");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/null", link);
  for (const std::string& node : {pipe, link}) {
    EXPECT_EQ(code_of([&] { require_writable(node); }), FileError::not_a_file);
    EXPECT_EQ(code_of([&] { write_text_file(node, "text"); }), FileError::not_a_file);
  }
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST(File, MissingFileAndFolderAreErrorsThatNameThem) {
  const Folder folder;
  for (const auto& [path, code] : {std::pair(folder.file("none"), FileError::missing),
                                   std::pair(folder.path().string(), FileError::not_a_file)}) {
    const auto error = thrown_by([&, name = path] { (void)read_file(name); });
    EXPECT_EQ(code_of(error), code);
    EXPECT_EQ(place_of(error), path);
  }
}

TEST(File, OnlyOrdinaryFilesAreRead) {
  const Folder folder;
  const std::string pipe = folder.file("pipe"), link = folder.file("link");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", link);
  for (const std::string& node : {pipe, link, std::string("/dev/zero"), std::string("/dev/null")}) {
    EXPECT_EQ(code_of([&] { (void)read_file(node); }), FileError::not_a_file) << node;
    EXPECT_EQ(code_of([&] { (void)read_text_file(node); }), FileError::not_a_file) << node;
  }
  EXPECT_FALSE(read_file("/proc/self/cmdline").empty()) << "fstat says that it has no bytes";
}

TEST(File, LargerThanTheCallersLimitIsRefusedWithTheLimitNamed) {
  const Folder folder;
  write_text_file(folder.file("a"), std::string(1000, 'x'));
  EXPECT_EQ(read_file(folder.file("a"), 1000).size(), 1000u);
  const auto refused = [](int limit, const auto& read) {
    const auto error = thrown_by(read);
    EXPECT_EQ(code_of(error), FileError::too_large);
    EXPECT_TRUE(tells(error, limit)) << limit;
  };
  refused(999, [&] { (void)read_file(folder.file("a"), 999); });
  refused(999, [&] { (void)read_text_file(folder.file("a"), 999); });
  write_text_file(folder.file("sparse"), "");
  std::filesystem::resize_file(folder.file("sparse"),
                               std::uintmax_t{1} << 36);  // 64 GB that take no room on the disk
  refused(1 << 30, [&] { (void)read_file(folder.file("sparse")); });
  refused(1 << 24, [&] { (void)read_text_file(folder.file("sparse")); });
  refused(10, [] { (void)read_file("/proc/self/status", 10); });  // fstat knows no size
}

TEST(File, FolderThatCannotBeWrittenLeavesTheOldFileIntact) {
  const Folder folder;
  EXPECT_EQ(code_of([&] { write_text_file(folder.file("no/such/folder/a"), "new"); }),
            FileError::not_written);
  write_text_file(folder.file("a"), "old");
  std::optional<Error> error;
  if (::geteuid() == 0) {  // root may write everywhere, but open no file beyond its limit
    struct rlimit was {};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &was), 0);
    struct rlimit none = was;
    none.rlim_cur = 0;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    error = thrown_by([&] { write_text_file(folder.file("a"), "new"); });
    ::setrlimit(RLIMIT_NOFILE, &was);
  } else {
    std::filesystem::permissions(
        folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    error = thrown_by([&] { write_text_file(folder.file("a"), "new"); });
  }
  EXPECT_EQ(place_of(error), folder.file("a"));
  EXPECT_EQ(read_text_file(folder.file("a")), "old");
}

TEST(File, RunningOutOfRoomLeavesTheOldFileIntact) {
  const Folder folder;
  write_text_file(folder.file("a"), "old");
  // The largest file this process may write stands in for a full disk: write() fails half way.
  struct rlimit was {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &was), 0);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = was;
  small.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto error = thrown_by([&] { write_file(folder.file("a"), Bytes(100000)); });
  ::setrlimit(RLIMIT_FSIZE, &was);
  std::signal(SIGXFSZ, ignored);
  EXPECT_EQ(code_of(error), FileError::not_written);
  EXPECT_EQ(place_of(error), folder.file("a"));
  EXPECT_EQ(read_text_file(folder.file("a")), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()),
                          std::filesystem::directory_iterator()),
            1)
      << "half a file was left behind";
}

}  // namespace
}  // namespace cavum
