// Each kind of entry is written and read by one pair of functions: what was written is read back,
// and what is no entry is refused.
#include "grading/records/entry_text.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/base/error.h"

namespace cavum::records {
namespace {

using nlohmann::json;

/// One entry of each kind, with as little as it can have.
std::vector<LedgerEntry> one_of_each() {
  std::vector<LedgerEntry> out(std::variant_size_v<Entry>);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (out[I].what.emplace(std::in_place_index<I>), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Entry>>());
  for (auto& e : out)
    for (const auto& [part, opening] : openings_of(*e.what)) *opening = make_opening(word_of(part));
  return out;
}

TEST(EntryText, OfEachKindIsReadBackUnderANameOfItsOwn) {
  std::set<std::string> kinds;
  for (auto& e : one_of_each()) {
    e.seq = 7;
    e.utc_ns = 1'800'000'000'000'000'000;
    e.by = {"Eva Examiner", "looked at it", ""};
    const std::string text = entry_text(e);
    const LedgerEntry read = read_entry(text, "entry");
    EXPECT_EQ(entry_text(read), text);
    EXPECT_EQ(read.what->index(), e.what->index());
    EXPECT_EQ(read.by.reason, "looked at it");
    for (const auto& [part, opening] : openings_of(*read.what))
      EXPECT_EQ(opening->sha256, openings_of(*e.what).at(part)->sha256);
    EXPECT_TRUE(kinds.insert(kind_name(*e.what)).second) << text;
  }
}

TEST(EntryText, ThatLacksAMemberOrHasAnotherOrAnotherTypeIsRefused) {
  for (const auto& e : one_of_each()) {
    const json whole = json::parse(entry_text(e));
    const auto refused = [&](const char* how, const auto& change) {
      json spoilt = whole;
      change(spoilt);
      EXPECT_THROW(static_cast<void>(read_entry(spoilt.dump(), "entry")), Error)
          << how << ": " << spoilt;
    };
    refused("one more", [](json& j) { j["body"]["more"] = 1; });
    refused("no time", [](json& j) { j.erase("utc_ns"); });
    refused("another kind", [](json& j) { j["kind"] = "pardon"; });
    refused("a fraction", [](json& j) { j["seq"] = 1.5; });
    refused("no text", [](json& j) { j["body"]["reason"] = 7; });
    if (e.as<InitEntry>() != nullptr)
      refused("too long", [](json& j) { j["body"]["reason"] = std::string((1U << 20) + 1, 'x'); });
    refused("an opening more",
            [](json& j) { j["body"]["opens"]["motion"] = std::string(64, 'a'); });
    for (const auto& [name, value] : whole["body"].items()) {
      refused("without", [&, n = name](json& j) { j["body"].erase(n); });
      refused("null", [&, n = name](json& j) { j["body"][n] = nullptr; });
    }
  }
}

}  // namespace
}  // namespace cavum::records
