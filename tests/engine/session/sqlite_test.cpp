#include "engine/session/sqlite.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>

#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using test::Folder;
using namespace testing_basics;

/// A process of its own that does something in a Database and tells with a byte when it holds it;
/// ends when this goes.
class OtherProcess {
 public:
  OtherProcess(const std::string& path, std::chrono::milliseconds holds_for) {
    int pipe[2];
    if (::pipe(pipe) != 0) throw std::runtime_error("no pipe");
    child_ = ::fork();
    if (child_ == 0) {
      try {
        Database db = Database::open(path, false);
        db.run("BEGIN IMMEDIATE; INSERT INTO t VALUES (1)");
        static_cast<void>(::write(pipe[1], "x", 1));
        ::usleep(static_cast<useconds_t>(std::chrono::microseconds(holds_for).count()));
        db.run("COMMIT");
        ::_exit(0);
      } catch (const std::exception&) {
        ::_exit(1);
      }
    }
    ::close(pipe[1]);
    char told = 0;
    began_ = ::read(pipe[0], &told, 1) == 1;
    ::close(pipe[0]);
  }
  ~OtherProcess() {
    if (child_ > 0) ::kill(child_, SIGKILL);
    static_cast<void>(::waitpid(child_, nullptr, 0));
  }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;
  [[nodiscard]] bool began() const { return began_; }
  [[nodiscard]] ::pid_t id() const { return child_; }

 private:
  ::pid_t child_ = -1;
  bool began_ = false;
};

TEST(Database, IsItsUsersAloneWithItsLogAndFollowsNoPlantedLink) {
  const Folder folder;
  const ::mode_t before = ::umask(0);
  Database db = Database::open(folder.file("a.db"), true);
  db.run("PRAGMA journal_mode = WAL; CREATE TABLE t (x)");
  ::umask(before);
  for (const char* end : {"", "-wal", "-shm"})
    EXPECT_EQ(mode_of(folder.file("a.db") + end), 0600u) << end;
  EXPECT_EQ(code_of([&] { static_cast<void>(Database::open(folder.file("a.db"), true)); }),
            FileError::exists);
  std::filesystem::create_symlink(folder.file("victim"), folder.file("link"));
  EXPECT_THROW(static_cast<void>(Database::open(folder.file("link"), true)), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.file("victim")));
}

TEST(Database, AFileThatTheSystemRefusesIsRefusedAsADatabase) {
  const Folder folder;  // who records asks for another place then
  try {
    static_cast<void>(Database::open(folder.file("no/such/folder/a.db"), true));
    FAIL() << "there is no such folder";
  } catch (const DatabaseError& e) {
    EXPECT_EQ(place_of(e.where()), folder.file("no/such/folder/a.db"));
    EXPECT_EQ(e.refusal().fault, DiskFault::not_opened);
  }
}

class HeldDatabase : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    Database db = Database::open(path_, true);
    db.run((std::string("PRAGMA journal_mode = ") + GetParam() + "; CREATE TABLE t (x)").c_str());
  }
  Folder folder_;
  std::string path_ = folder_.file("a.db");
};

TEST_P(HeldDatabase, IsWaitedForWhenThereIsPatience) {
  const OtherProcess other(path_, 600ms);
  ASSERT_TRUE(other.began());
  EXPECT_THROW(Database::open(path_, false).run("INSERT INTO t VALUES (2)"), DatabaseError)
      << "a recording waits 200 ms only";
  Database db = Database::open(path_, false, k_long_wait);
  EXPECT_NO_THROW(db.run("INSERT INTO t VALUES (2)"));
  EXPECT_EQ(db.integer("SELECT count(*) FROM t"), 2);
}

TEST_P(HeldDatabase, NamesWhoHoldsIt) {
  const OtherProcess other(path_, 20s);
  ASSERT_TRUE(other.began());
  const auto error =
      thrown_by([&] { Database::open(path_, false).run("INSERT INTO t VALUES (2)"); });
  EXPECT_EQ(place_of(error), path_);
  if (read_text_file("/proc/locks").find(" " + std::to_string(other.id()) + " ") ==
      std::string::npos)
    return;  // a system that does not tell
  EXPECT_TRUE(tells(error, "session_test") && tells(error, other.id())) << error->what();
}

INSTANTIATE_TEST_SUITE_P(, HeldDatabase, ::testing::Values("DELETE", "WAL"),
                         [](const auto& of) { return std::string(of.param); });

}  // namespace
}  // namespace cavum
