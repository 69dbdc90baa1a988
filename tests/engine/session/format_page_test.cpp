// The page that specifies the recording's file says what the program writes: its tables to the
// letter, and the frame of a chunk without ticks.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "engine/base/file.h"
#include "engine/session/chunk_codec.h"
#include "engine/session/schema.h"
#include "engine/session/session.h"

namespace cavum {
namespace {

std::string page_of_sessions() {
  return read_text_file(std::string(CAVUM_SOURCE_DIR) + "/docs/formats/session.md");
}

TEST(SessionFormatPage, HoldsTheTablesToTheLetter) {
  std::string all = "```sql\n";
  for (const char* table : k_session_schema) all += std::string(table) + ";\n";
  EXPECT_NE(page_of_sessions().find(all + "```\n"), std::string::npos) << all;
  EXPECT_NE(page_of_sessions().find("`user_version` " + std::to_string(k_session_format) +
                                    " (this format)"),
            std::string::npos);
}

TEST(SessionFormatPage, NamesTheFrameOfAChunkWithoutTicks) {
  std::istringstream bytes(page_of_sessions().substr(page_of_sessions().find("28 b5 2f fd")));
  const Bytes frame = pack_removed({});
  for (const auto byte : frame) {
    std::string digits;
    ASSERT_TRUE(bytes >> digits);
    EXPECT_EQ(std::stoi(digits, nullptr, 16), byte);
  }
  EXPECT_EQ(frame, pack_inputs({}));
  EXPECT_EQ(frame, pack_records({}));
}

}  // namespace
}  // namespace cavum
