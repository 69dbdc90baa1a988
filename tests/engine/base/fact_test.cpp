// What is said, for programs: kinds, named values and codes.
#include "engine/base/fact.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/base/file_error.h"
#include "engine/base/system_error.h"

namespace cavum {
namespace {

TEST(Fact, GivesItsValuesByNameAlsoThoseThatItsSentenceDoesNotSay) {
  const nlohmann::json j = Fact("lag", {"lag", "of"}, msg("a lag of {} of {}", as_s(0.5, 1), "f_n"))
                               .with("mechanism", Name{"delay"});
  EXPECT_EQ(j["kind"], "lag");
  EXPECT_EQ(j["values"]["lag"]["unit"], "s");
  EXPECT_EQ(j["values"]["of"], "f_n");
  EXPECT_EQ(j["values"]["mechanism"], "delay");
  EXPECT_EQ(nlohmann::json(Fact("alone", msg("nothing")))["values"], nlohmann::json::object());
}

TEST(Fact, WithAnotherNumberOfNamesThanValuesIsAMistakeOfTheProgram) {
  EXPECT_THROW(static_cast<void>(Fact("lag", {"lag", "of"}, msg("a lag of {}", as_s(0.5, 1)))),
               std::logic_error);
}

TEST(ErrorCode, HasTheNameOfItsValueAndTellsRoomsApart) {
  EXPECT_EQ(ErrorCode(FileError::too_large).name(), "too_large");
  EXPECT_EQ(ErrorCode(General::error).name(), "error");
  EXPECT_NE(ErrorCode(FileError::missing), ErrorCode(SystemError::system_error))
      << "both are the first of their room";
  EXPECT_EQ(ErrorCode(FileError::missing).as<FileError>(), FileError::missing);
  EXPECT_FALSE(ErrorCode(FileError::missing).as<SystemError>());
}

TEST(SystemError, OfTheCommonReasonsHasAKindAndASentenceAndOfOthersTheNumber) {
  for (const int number : {ENOENT, EACCES, EPERM, ENOSPC, EDQUOT, EROFS, EMFILE, ENFILE, EIO,
                           EEXIST, ENOTDIR, EISDIR, ENAMETOOLONG, ENOMEM}) {
    EXPECT_NE(system_code(number), SystemError::system_error) << number;
    EXPECT_TRUE(system_words(number).values().empty()) << number;
  }
  EXPECT_EQ(system_code(ENOENT), FileError::missing);
  EXPECT_EQ(system_code(EPROTO), SystemError::system_error);
  EXPECT_EQ(system_words(EPROTO).values().at(0), Value(std::int64_t{EPROTO}));
}

}  // namespace
}  // namespace cavum
