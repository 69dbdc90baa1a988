#include "scenarios/file/accommodations.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

TEST(Accommodations, WhatIsGrantedReplacesWhatTheFileSaysAndNothingElse) {
  Accommodations file;
  file.extra_time_percent = 25;
  file.high_contrast = true;
  EXPECT_EQ(granted(file, {}, "test"), file);
  Grant grant;
  grant.extra_time_s = 0.1 + 0.2;  // no short decimal: must come back to the bit
  grant.high_contrast = false;
  const Accommodations a = granted(file, notes_of(grant), "test");
  EXPECT_EQ(a.extra_time_percent, 25);
  EXPECT_EQ(a.extra_time_s, 0.1 + 0.2);
  EXPECT_FALSE(a.high_contrast);
  EXPECT_FALSE(a.left_handed);
}

TEST(Accommodations, RefusesNotesAndGrantsThatAreNone) {
  for (const char* text : {"", "-1", "nan", "401", "12 ", "1e9"})
    EXPECT_THROW(
        static_cast<void>(granted({}, {{"accommodation.extra_time_percent", text}}, "test")), Error)
        << text;
  EXPECT_THROW(static_cast<void>(granted({}, {{"accommodation.left_handed", "yes"}}, "test")),
               Error);
  EXPECT_EQ(granted({}, {{"operator", "expert"}, {"accommodation.shoe_size", "43"}}, "test"),
            Accommodations{});
  Grant grant;
  grant.extra_time_percent = -5;
  EXPECT_THROW(require_sound(grant, "test"), Error);
}

TEST(Accommodations, AreSaidInWords) {
  using testing_basics::figures_in;
  EXPECT_TRUE(accommodations_text({}).empty());
  const Message all = accommodations_text({25, 60, true, true});
  EXPECT_EQ(figures_in(all), (std::vector<double>{25, 60}));
  EXPECT_EQ(std::get<List>(all.values().at(0)).items.size(), 3u)
      << "the time, the hand and the colours";
  EXPECT_EQ(figures_in(accommodations_text({0, 90.5, false, false})), (std::vector<double>{90.5}));
}

}  // namespace
}  // namespace cavum::scenarios
