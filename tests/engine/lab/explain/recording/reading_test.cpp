// Tables as others write them: each is written by hand here, and read to s, mm, mm/s and N.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/file_error.h"
#include "engine/lab/explain/recording/date_time.h"
#include "engine/lab/explain/recording/recording.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

std::optional<Error> refusal(const std::string& table, const ReadingOptions& options = {}) {
  return testing_basics::thrown_by(
      [&] { static_cast<void>(parse_recording_as(table, "r.csv", options)); });
}

/// Whether it is this error and holds all of these names.
bool is(const std::optional<Error>& error, ErrorCode code,
        std::initializer_list<const char*> names = {}) {
  return testing_basics::code_of(error) == code &&
         std::all_of(names.begin(), names.end(), [&](const char* n) {
           return std::string(error->what()).find(n) != std::string::npos;
         });
}

void expect_motion(const Recording& r, double t_s, double x_mm, double f_n) {
  ASSERT_GE(r.rows(), 2);
  EXPECT_NEAR(r.t_s[1] - r.t_s[0], t_s, 1e-9);
  EXPECT_NEAR(r.x_mm[1], x_mm, 1e-9);
  EXPECT_NEAR(r.f_n[1], f_n, 1e-9);
}

TEST(Units, OfEveryQuantityAreKnownByTheirFactors) {
  const std::vector<std::tuple<const char*, Role, double>> known{
      {"kN", Role::force, 1000},           {"mN", Role::force, 1e-3},
      {"gf", Role::force, 0.00980665},     {"g", Role::force, 0.00980665},
      {"kgf", Role::force, 9.80665},       {"lbf", Role::force, 4.4482216},
      {"ozf", Role::force, 0.27801385},    {"m", Role::position, 1000},
      {"cm", Role::position, 10},          {"\xc2\xb5m", Role::position, 1e-3},
      {"\xce\xbcm", Role::position, 1e-3}, {"\xb5m", Role::position, 1e-3},
      {"um", Role::position, 1e-3},        {"in", Role::position, 25.4},
      {"mil", Role::position, 0.0254},     {"ms", Role::time, 1e-3},
      {"\xc2\xb5s", Role::time, 1e-6},     {"min", Role::time, 60},
      {"mm/min", Role::speed, 1.0 / 60},   {"m/s", Role::speed, 1000},
      {"um/s", Role::speed, 1e-3},         {"in/s", Role::speed, 25.4},
      {"mm s-1", Role::speed, 1},          {"mm\xc2\xb7s\xe2\x81\xbb\xc2\xb9", Role::speed, 1}};
  for (const auto& [name, role, factor] : known) {
    const auto unit = find_unit(name, role);
    ASSERT_TRUE(unit) << name;
    EXPECT_NEAR(unit->factor, factor, 1e-6 * factor) << name;
    EXPECT_FALSE(unit->on_lever) << name;
  }
  EXPECT_FALSE(find_unit("MN", Role::force)) << "a meganewton is no millinewton";
  EXPECT_FALSE(find_unit("mm", Role::force));
  EXPECT_FALSE(find_unit("furlong", Role::position));
  EXPECT_TRUE(find_unit("g", Role::force)->mass_word);
}

TEST(Units, AnglesAndTorquesGoByTheLever) {
  EXPECT_NEAR(at_lever(*find_unit("rad", Role::position), Role::position, 80.0).factor, 80.0,
              1e-12);
  EXPECT_NEAR(at_lever(*find_unit("deg", Role::position), Role::position, 90.0).factor, 1.5707963,
              1e-6);
  EXPECT_NEAR(at_lever(*find_unit("N\xc2\xb7m", Role::force), Role::force, 50.0).factor, 20.0,
              1e-12);
  EXPECT_NEAR(at_lever(*find_unit("mNm", Role::force), Role::force, 50.0).factor, 0.02, 1e-12);
  EXPECT_NEAR(at_lever(*find_unit("rad/s", Role::speed), Role::speed, 80.0).factor, 80.0, 1e-12);
}

TEST(Reading, UnitsStandInTheHeaderInMoreThanOneForm) {
  for (const std::string header : {"time [ms],pos (\xc2\xb5m),Fz/mN", "time_ms,pos_um,Fz_mN",
                                   "Time (ms),Position [um],Force [mN]", "t in ms,x in um,f in mN",
                                   "t_ms,x_um,f_mn", "Zeit ms,Weg um,Kraft mN"})
    expect_motion(parse_recording(header + "\n0,0,0\n5,250,1500\n", "r.csv"), 0.005, 0.25, 1.5);
}

TEST(Reading, UnitsStandOnALineBelowTheHeader) {
  const Recording r = parse_recording(
      "session;time;position;force;note\n-;s;in;lbf;\na;0;0;0;dry\na;0.5;0.1;2;dry\n", "r.csv");
  expect_motion(r, 0.5, 2.54, 2 * 4.4482216152605);
  EXPECT_EQ(r.sessions[0].name, "a");
  expect_motion(parse_recording("Zeit;Weg;Kraft\n[s];[mm];[kN]\n0;0;0\n0,5;1,5;0,002\n", "r.csv"),
                0.5, 1.5, 2.0);
}

TEST(Reading, AnOptionsUnitGoesBeforeTheFiles) {
  ReadingOptions options;
  options.units = {{"f", "gf"}, {"x_mm", "cm"}};
  expect_motion(parse_recording_as("t_s,x_mm,f_n\n0,0,0\n1,0.2,100\n", "r.csv", options), 1.0, 2.0,
                0.980665);
}

TEST(Reading, AnUnknownUnitIsRefusedWithThoseThatAreKnown) {
  EXPECT_TRUE(is(refusal("t_s,x_mm,Force [dyn]\n0,0,0\n1,1,1\n"), FileError::unknown,
                 {"dyn", "mN", "lbf"}));
  ReadingOptions options;
  options.units = {{"f", "stone"}};
  EXPECT_TRUE(is(refusal("t_s,x_mm,f_n\n0,0,0\n1,1,1\n", options), FileError::unknown, {"stone"}));
  options.units = {{"w", "N"}};
  EXPECT_TRUE(is(refusal("t_s,x_mm,f_n\n0,0,0\n1,1,1\n", options), FileError::unknown));
}

TEST(Reading, GramsAreTakenAsWhatTheyWeighAndSaidLoudly) {
  const Recording r = parse_recording("t_s,x_mm,load [g]\n0,0,0\n1,1,100\n", "r.csv");
  EXPECT_NEAR(r.f_n[1], 0.980665, 1e-9);
  EXPECT_TRUE(std::any_of(r.notes.begin(), r.notes.end(), [](const Fact& n) {
    return n.kind() == "unit_of_mass" && testing_basics::tells(n.what(), "g");
  })) << "the unit";
}

TEST(Reading, AJointNeedsItsLever) {
  const std::string table = "time_s,angle [rad],torque [N m]\n0,0,0\n0.01,0.1,0.5\n";
  EXPECT_TRUE(refusal(table));
  ReadingOptions options;
  options.lever_mm = 100.0;
  expect_motion(parse_recording_as(table, "r.csv", options), 0.01, 10.0, 5.0);
}

TEST(Reading, DecimalCommasGoWithSemicolonsTabsAndWhiteSpace) {
  for (const std::string s : {";", "\t", "   ", " ; "})
    expect_motion(parse_recording("t_s" + s + "x_mm" + s + "f_n\r\n0" + s + "0" + s + "0\r\n0,5" +
                                      s + "-1,25" + s + "1,5e-1\r\n",
                                  "r.csv"),
                  0.5, -1.25, 0.15);
  expect_motion(
      parse_recording("t_s,x_mm,f_n\n\"0\",\"0\",\"0\"\n\"0,5\",\"1,25\",\"2,5\"\n", "r.csv"), 0.5,
      1.25, 2.5);
}

TEST(Reading, CommasThatPartBothAreRefused) {
  EXPECT_TRUE(is(refusal("t_s,x_mm,f_n\n0,0,0,0,0,0\n0,5,1,25,2,5\n"), FileError::unsupported,
                 {"r.csv:2"}));
}

TEST(Reading, ThousandsAreRefusedAndNotGuessed) {
  for (const char* number : {"1.234,5", "1,234,567", "1'234"})
    EXPECT_TRUE(is(refusal("t_s;x_mm;f_n\n0;0;" + std::string(number) + "\n1;1;2\n"),
                   FileError::unsupported, {number}));
  EXPECT_TRUE(is(refusal("t_s;x_mm;f_n\n0;0;1,234\n1;0.5;2\n"), FileError::inconsistent));
}

TEST(Reading, WhatAMachineWritesBeforeTheHeaderIsPassedOver) {
  const Recording r = parse_recording(
      "\xef\xbb\xbfPress 3000\r\nOperator: A. B.\r\nSpecimen;7\r\nDate;24.11.2026\r\n\r\n% a comment\r\n// another\r\n"
      "Pr\xc3\xbc"
      "fzeit;Standardweg;Standardkraft\r\ns;mm;N\r\n0,0;0,0;0,0\r\n0,1;0,2;0,3\r\n",
      "r.csv");
  expect_motion(r, 0.1, 0.2, 0.3);
  ASSERT_TRUE(r.reading);
  EXPECT_EQ(r.reading->form.before.size(), 4U);
  EXPECT_EQ(r.reading->form.header_line, 8);
  std::string long_one;
  for (int i = 0; i < 60; ++i) long_one += "a line of words\n";
  EXPECT_TRUE(refusal(long_one + "t_s,x_mm,f_n\n0,0,0\n1,1,1\n")) << "at most 50 lines";
}

TEST(Reading, LinesOfErrorsCountFromTheTopOfTheFile) {
  EXPECT_TRUE(is(refusal("Press\n# note\nt_s;x_mm;f_n\n0;0;0\n\n1;oops;1\n"), FileError::malformed,
                 {"r.csv:6", "oops", "x_mm"}));
  EXPECT_TRUE(
      is(refusal("Press\nt_s;x_mm;f_n\n0;0;0\n1;1\n"), FileError::inconsistent, {"r.csv:4"}));
  EXPECT_TRUE(is(refusal("t_s,x_mm,f_n\n0,0,0\n1,\"1,1\n"), FileError::malformed, {"r.csv:3"}));
}

TEST(Reading, Latin1IsRead) {
  expect_motion(parse_recording("Zeit [s];Weg [\xb5m];Pr\xfc"
                                "fkraft [mN]\n0;0;0\n1;500;250\n",
                                "r.csv"),
                1.0, 0.5, 0.25);
}

TEST(Reading, AHeaderMayStandInACommentRightAboveTheNumbers) {
  expect_motion(
      parse_recording("# made by a script\n# t_s x_mm f_n\n0 0 0\n0.5 1.5 2.5\n", "r.csv"), 0.5,
      1.5, 2.5);
  EXPECT_TRUE(is(refusal("# t_s x_mm f_n\n0 0 0\n0.5 oops 2.5\n"), FileError::malformed,
                 {"r.csv:3", "oops"}));
}

TEST(Reading, NumbersWithoutAHeaderAreRefused) {
  for (const char* table : {"0,0,0\n1,1,1\n", "\n\n# only\n"})
    EXPECT_TRUE(is(refusal(table), FileError::missing)) << table;
}

TEST(Reading, ColumnsAreNamedByOptionsInMoreThanOneForm) {
  for (const std::string key : {"f", "f_n"})
    for (const std::string name : {"My Sensor [mN]", "My Sensor", "my sensor"}) {
      ReadingOptions options;
      options.names = {{key, name}};
      expect_motion(
          parse_recording_as("t_s,x_mm,My Sensor [mN],Fz\n0,0,0,7\n1,2,3000,7\n", "r.csv", options),
          1.0, 2.0, 3.0);
    }
}

TEST(Reading, AMissingColumnIsToldWithTheHeaderAndTheNearestName) {
  EXPECT_TRUE(is(refusal("t_s,x_mm,Frce [N],humidity\n0,0,0,1\n1,1,1,1\n"), FileError::missing,
                 {"'f_n'", "'Frce [N]'", "'humidity'"}));
  ReadingOptions options;
  options.names = {{"f", "Standardkaft"}};
  EXPECT_TRUE(is(refusal("t_s,x_mm,Standardkraft\n0,0,0\n1,1,1\n", options), FileError::missing,
                 {"'Standardkaft'", "'Standardkraft'"}));
}

TEST(Reading, SeveralThatCouldBeItAreListedAndNotGuessed) {
  EXPECT_TRUE(is(refusal("t_s,x_mm,Fz [N],Load [N]\n0,0,0,1\n1,1,1,1\n"), FileError::inconsistent,
                 {"'Fz [N]'", "'Load [N]'"}));
  EXPECT_TRUE(is(refusal("t_s,x [mm],y [mm],z [mm],f_n\n0,0,0,0,0\n1,1,1,1,1\n"),
                 FileError::inconsistent, {"'x [mm]'", "'y [mm]'"}));
  // our own names go first, and lateral forces are no candidates beside them
  EXPECT_EQ(
      parse_recording("t_s,x_mm,f_n,fy_n,fz_n,Load\n0,0,1,2,3,4\n1,1,1,2,3,4\n", "r.csv").f_n[0],
      1.0);
  // a speed of a spindle is no speed of the feed
  EXPECT_EQ(
      parse_recording("t_s,x_mm,f_n,speed [rpm]\n0,0,1,200\n1,1,1,200\n", "r.csv").v_mm_s.size(),
      0);
}

TEST(Stamps, AreReadInAllTheirForms) {
  for (const auto& [first, second, apart] :
       std::vector<std::tuple<const char*, const char*, double>>{
           {"2026-11-24T10:15:30.123", "2026-11-24T10:15:30.625", 0.502},
           {"2026-11-24 10:15:30Z", "2026-11-24 10:15:31.5Z", 1.5},
           {"2026-11-24T10:15:30+01:00", "2026-11-24T09:15:31Z", 1.0},
           {"24.11.2026 10:15:30,123", "24.11.2026 10:15:30,223", 0.1},
           {"2024-02-28 23:59:59", "2024-02-29 00:00:01", 2.0},
           {"2023-02-28 23:59:59", "2023-03-01 00:00:01", 2.0},
           {"23:59:59.5", "00:00:00.25", 0.75},
           {"11:59:59 PM", "12:00:01 AM", 2.0},
           {"11/24/2026 10:15:30", "11/24/2026 10:15:32", 2.0},
           {"24/11/2026 10:15:30", "24/11/2026 10:15:32", 2.0},
           {"1764000000.25", "1764000001.5", 1.25},
           {"1764000000250", "1764000001500", 1.25},
           {"1764000000250000", "1764000001500000", 1.25},
           {"1000.5", "1000.75", 0.25}}) {
    const bool comma = std::string(first).find(',') != std::string::npos;
    const std::string zero = comma ? "0,5" : "0.5";
    const Recording r = parse_recording(
        "time;x_mm;f_n\n" + std::string(first) + ";0;" + zero + "\n" + second + ";0;" + zero + "\n",
        "r.csv");
    EXPECT_NEAR(r.t_s[1] - r.t_s[0], apart, 1e-6) << first;
  }
}

TEST(Stamps, ThatMayMeanTwoDaysAreRefused) {
  EXPECT_TRUE(is(refusal("time;x_mm;f_n\n04/11/2026 10:15:30;0;0\n04/11/2026 10:15:31;0;0\n"),
                 FileError::inconsistent, {"04/11/2026"}));
}

TEST(Stamps, NoDayOfTheCalendarIsRefused) {
  for (const char* wrong : {"2026-02-30T10:00:00", "2026-13-01T10:00:00", "2026-11-24T25:00:00",
                            "2026-11-24T10:61:00", "31.04.2026 10:00:00"})
    EXPECT_FALSE(parse_stamp(wrong)) << wrong;
  EXPECT_TRUE(refusal("time;x_mm;f_n\n2026-11-24T10:00:00;0;0\n2026-02-30T10:00:00;0;0\n"));
}

TEST(Stamps, ADateAndATimeOfDayMayHaveColumnsOfTheirOwn) {
  const Recording r = parse_recording(
      "Date,Time,x_mm,f_n\n2026-11-24,23:59:59.5,0,0\n2026-11-25,00:00:00.5,0,0\n2026-11-27,00:00:00.5,0,0\n",
      "r.csv");
  EXPECT_NEAR(r.t_s[1] - r.t_s[0], 1.0, 1e-9);
  EXPECT_NEAR(r.t_s[2] - r.t_s[1], 2 * 86400.0, 1e-9);
}

TEST(Stamps, ADeclaredUnitHoldsForAMachineThatHasRunForWeeks) {
  const Recording r =
      parse_recording("time_ms,x_mm,f_n\n1700000000,0,0\n1700000250,0,0\n", "r.csv");
  EXPECT_NEAR(r.t_s[1] - r.t_s[0], 0.25, 1e-6);
  EXPECT_FALSE(r.reading->stamped);
}

}  // namespace
}  // namespace cavum::explain
