// The table of styluses: what is missing in a record, or asked for and not there, is said at once;
// and a stylus that is only in a table of the test is listed, opened and given force like any
// other.
#include "engine/device/hardware/stylus_kind.h"

#include <gtest/gtest.h>

#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "engine/base/file.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/device/hardware/stylus_probe.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::code_of;

/// A stylus that lies on a spring, for the test alone.
class Toy final : public Stylus {
 public:
  explicit Toy(const StationStylus& station) : station_(station) {}
  [[nodiscard]] DeviceReading read(double) override {
    return {.pose = to_tooth(station_.placement, force_n_ / station_.number("stiffness_n_per_mm")),
            .flags = k_stylus_fresh};
  }
  void send_force(Vec3 force_n) override {
    force_n_ = force_to_device(station_.placement, force_n);
  }
  void cut_force() noexcept override { force_n_ = {}; }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return facts_; }
  [[nodiscard]] StylusHealth health() const override { return {.readings = 1}; }

  static StylusFacts toy_facts() {
    return {.id = "toy",
            .name = cavum::Name{"toy on a spring"},
            .peak_n = 2.0,
            .continuous_n = 1.0,
            .rate_hz = 1000.0,
            .reach_mm = 10.0};
  }

 private:
  StationStylus station_;
  StylusFacts facts_ = toy_facts();
  Vec3 force_n_;
};

StylusKind toy_kind() {
  return {.facts = Toy::toy_facts(),
          .settings = {{.key = "stiffness_n_per_mm", .usual = 2.0, .least = 0.1, .most = 10.0}},
          .look = [](const StationStylus&, bool) { return StylusLook{.there = true}; },
          .open = [](const StylusOptions& o) -> std::unique_ptr<Stylus> {
            return std::make_unique<Toy>(o.station);
          }};
}

std::vector<StylusKind> with_toy() {
  const auto all = stylus_kinds().all();
  std::vector<StylusKind> kinds(all.begin(), all.end());
  kinds.push_back(toy_kind());
  return kinds;
}

TEST(StylusKinds, AStylusOfOneRecordIsListedOpenedPlacedAndGivenForce) {
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("").c_str(), 1);
  const StylusKinds kinds(with_toy());
  EXPECT_EQ(kinds.ids({StylusHand::person}).back(), "toy") << "which is what help and errors say";
  const auto listed = list_styluses(false, kinds);
  EXPECT_EQ(listed.back().id, "toy");
  EXPECT_TRUE(listed.back().there);
  EXPECT_FALSE(listed.back().problem);

  const StylusKind& toy = kinds.at("toy", {}, {StylusHand::person});
  StylusOptions options;
  options.station = parse_station_stylus(
      "rotation = [1, 0, 0, 0]\ntool = [1, 0, 0, 0]\noffset_mm = [0, 0, 5]\nstiffness_n_per_mm = 4\n",
      "toy.toml", toy);
  const auto stylus = open_stylus("toy", options, kinds);
  EXPECT_NEAR(first_pose(*stylus, 1.0).tip_mm.z, 5.0, 1e-12) << "the station's placement";
  stylus->send_force({0, 0, 1});
  EXPECT_NEAR(stylus->read(1e-3).pose.tip_mm.z, 5.25, 1e-12) << "1 N on a spring of 4 N/mm";
  EXPECT_TRUE(code_of([&] {
    static_cast<void>(
        parse_station_stylus(to_toml(options.station) + "stiffness = 1\n", "toy.toml", toy));
  }));
}

TEST(StylusKinds, TheRecipeNamesTheFieldsOfTheRecord) {
  const std::string root = CAVUM_SOURCE_DIR,
                    page = read_text_file(root + "/docs/howto/add_a_stylus.md");
  const std::string whole = read_text_file(root + "/engine/device/hardware/stylus_kind.h"),
                    record = whole.substr(
                        whole.find("struct StylusKind {"),
                        whole.find("class StylusKinds") - whole.find("struct StylusKind {"));
  const std::regex in_page(R"(`([a-z]+)`)"), in_record(R"( ([a-z]+)(?: =[^;]*)?;)");
  const auto names = [](const std::string& text, const std::regex& pattern) {
    std::set<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i)
      found.insert((*i)[1]);
    return found;
  };
  std::string rows;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("   | `")) rows += line.substr(0, line.find('|', 5)) + "\n";
  std::set<std::string> fields =
      names(std::regex_replace(record, std::regex("//.*"), ""), in_record);
  EXPECT_EQ(fields.erase("hand"), 1u) << "a person's, unless told otherwise";
  EXPECT_EQ(names(rows, in_page), fields);
}

TEST(StylusKinds, ARecordThatLacksSomethingIsSaidAtOnce) {
  const auto said = [](const std::function<void(StylusKind&)>& spoil) {
    std::vector<StylusKind> kinds = with_toy();
    spoil(kinds.back());
    return code_of([&] { const StylusKinds table(kinds); });
  };
  EXPECT_FALSE(said([](StylusKind&) {}));
  const std::vector<std::function<void(StylusKind&)>> spoils{
      [](StylusKind& k) { k.open = nullptr; },         [](StylusKind& k) { k.look = nullptr; },
      [](StylusKind& k) { k.facts.name = {}; },        [](StylusKind& k) { k.facts.peak_n = 0; },
      [](StylusKind& k) { k.facts.continuous_n = 3; }, [](StylusKind& k) { k.facts.rate_hz = 0; },
      [](StylusKind& k) { k.facts.reach_mm = 0; }};
  for (const auto& spoil : spoils)
    EXPECT_EQ(said(spoil), DeviceError::incomplete_record) << &spoil - spoils.data();
  for (const char* id : {"", "Toy", "to y", "../toy"})
    EXPECT_EQ(said([&](StylusKind& k) { k.facts.id = id; }), DeviceError::incomplete_record) << id;
  EXPECT_EQ(said([](StylusKind& k) { k.facts.id = "falcon"; }), DeviceError::name_taken);
}

TEST(StylusKinds, ANameThatIsNoneIsRefused) {
  const auto at = [](const char* id) {
    return code_of([&] { static_cast<void>(stylus_kinds().at(id, {}, {StylusHand::person})); });
  };
  EXPECT_FALSE(at("falcon"));
  EXPECT_EQ(at("phantom"), DeviceError::unknown_stylus);
  EXPECT_EQ(at("mouse"), DeviceError::unknown_stylus) << "which no person's hand holds";
  EXPECT_EQ(code_of([] { static_cast<void>(open_stylus("mouse")); }), DeviceError::unknown_stylus)
      << "needs the exam window";
}

TEST(StylusKinds, WhatIsOpenSaysWhatItsRecordSays) {
  const auto simulated = open_stylus("simulated", {});
  const StylusFacts& record = stylus_kinds().at("simulated", {}, {StylusHand::candidate}).facts;
  EXPECT_EQ(simulated->facts().id, record.id);
  EXPECT_EQ(simulated->facts().peak_n, record.peak_n);
  EXPECT_EQ(simulated->facts().position_quantum_mm, record.position_quantum_mm);
}

TEST(StylusKinds, UsualSettingsAreTheRecordsAndRightIsMesial) {
  for (const auto& kind : stylus_kinds().all()) {
    const StationStylus usual = usual_station_stylus(kind);
    for (const auto& s : kind.settings)
      EXPECT_EQ(usual.settings.at(s.key), s.usual) << kind.facts.id;
    EXPECT_NEAR(length(rotation(kind.placement.rotation) * Vec3{1, 0, 0} - Vec3{1, 0, 0}), 0.0,
                1e-12)
        << kind.facts.id << ": right is mesial";
  }
}

}  // namespace
}  // namespace cavum
