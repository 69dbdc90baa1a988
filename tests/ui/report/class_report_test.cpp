// The class report's data, unpacked by a decoder of the test's own and counted again leaf by leaf;
// and the same words in HTML and PDF.
#include "ui/report/class_report.h"

#include <cmath>
#include <random>

#include "scenarios/exam/exam.h"
#include "scenarios/file/parse.h"
#include "tests/engine/support/basics.h"
#include "tests/ui/program.h"
#include "tests/ui/report/kinds.h"
#include "tests/ui/report/unpack.h"

namespace cavum::report {
namespace {

using testing_report::holds;
using testing_report::of_kind;
using testing_report::times;
using testing_report::unpack;

/// A class whose cavities are known: each removes some leaves of the target and some beside it, by
/// chance.
class ClassReport : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto setup = scenarios::prepare_exam(
        std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml", {});
    tooth_.scenario = setup->scenario;
    tooth_.tooth = load_tooth(setup->session.tooth, "block");
    tooth_.zones = scenarios::build_zones(tooth_.scenario, tooth_.tooth);
    tooth_.map = std::make_unique<cohort::ClassMap>(tooth_.zones);
    std::mt19937_64 random(testing_basics::drawn_seed("ClassReport"));
    for (int i = 0; i < 7; ++i) {
      std::vector<IVec3> removed;
      const Vec3 middle = (tooth_.zones.target_low_mm() + tooth_.zones.target_high_mm()) * 0.5;
      // one leaves much, one takes too much, the others by chance
      const double more_mm = i == 0   ? -0.3
                             : i == 6 ? 0.4
                                      : 0.1 * static_cast<double>(random() % 8) - 0.3;
      tooth_.zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone) {
        if (tooth_.tooth.octree.tissue(leaf) == k_air || tooth_.zones.distance_mm(leaf) > more_mm)
          return;
        if (tooth_.zones.centre_mm(leaf).x < middle.x + 0.3 * i) removed.push_back(leaf);
      });
      tooth_.map->add(removed);
    }
    figures_.exam = tooth_.scenario.id;
    figures_.n = 7;
    figures_.max_points = 100;
    figures_.pass_points = 60;
    figures_.points = {20, 40, 55, 61, 70, 90, 100};
    figures_.criteria = {{"floor <depth>", "floor_max_over_mm", 0.5, 0.25}};
  }
  cohort::ClassTooth tooth_;
  cohort::ClassFigures figures_;
};

TEST_F(ClassReport, ItsCellsAreThePlannedCavityAndTheShareOfTheClassThatDeviated) {
  const nlohmann::json data = class_data(figures_, tooth_);
  EXPECT_EQ(data["kind"], "class");
  const auto& grid = data["grid"];
  const Octree& tree = tooth_.tooth.octree;
  const int edge = static_cast<int>(std::lround(grid["cell_mm"].get<double>() / tree.leaf_mm()));
  const auto three = [](const nlohmann::json& j) {
    return IVec3{j[0].get<int>(), j[1].get<int>(), j[2].get<int>()};
  };
  const IVec3 low = three(grid["box"]["low"]), size = three(grid["box"]["size"]),
              all = three(grid["size"]);
  const auto before = unpack(grid["before"]), after = unpack(grid["after"]),
             heat = unpack(grid["heat"]);
  ASSERT_EQ(heat.size(), cells_of(size));
  const auto origin = grid["origin_mm"];
  long planned = 0, warm = 0, cold = 0;
  std::size_t i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const IVec3 cell = low + IVec3{x, y, z};
        long target = 0, other = 0;
        double left = 0, cut = 0;
        for (int k = 0; k < edge * edge * edge; ++k) {
          const auto at = [&](int axis, int step) {
            return origin[static_cast<std::size_t>(axis)].get<double>() +
                   ((axis == 0   ? cell.x
                     : axis == 1 ? cell.y
                                 : cell.z) +
                    (step + 0.5) / edge - 0.5) *
                       edge * tree.leaf_mm();
          };
          const IVec3 leaf =
              tree.leaf_at({at(0, k % edge), at(1, k / edge % edge), at(2, k / edge / edge)});
          if (tree.tissue(leaf) == k_air) continue;
          if (tooth_.zones.zone(leaf) == scenarios::Zone::target) {
            ++target;
            left -= tooth_.map->percent(leaf);
          } else {
            ++other;
            cut += tooth_.map->percent(leaf);
          }
        }
        const long whole = edge * edge * edge;
        const auto index = cell_index(cell, all);
        planned += target;
        ASSERT_EQ(before[index], std::lround(255.0 * static_cast<double>(target + other) /
                                             static_cast<double>(whole)));
        ASSERT_EQ(after[i],
                  std::lround(255.0 * static_cast<double>(other) / static_cast<double>(whole)));
        const double expected = target > other ? -left / static_cast<double>(target)
                                : other > 0    ? cut / static_cast<double>(other)
                                               : 0;
        ASSERT_NEAR(static_cast<double>(heat[i]), expected, 0.5 + 1e-9);
        warm += heat[i] > 0 ? 1 : 0;
        cold += heat[i] < 0 ? 1 : 0;
      }
  EXPECT_EQ(planned, static_cast<long>(tooth_.zones.count(scenarios::Zone::target)))
      << "the whole target lies in the box";
  EXPECT_GT(warm, 0);
  EXPECT_GT(cold, 0);
}

TEST_F(ClassReport, WarnsBesideEachFigureThatComesFromFew) {
  figures_.alpha = 0.5;
  figures_.agreement.n = 7;
  figures_.agreement.kappa = 0.4;
  const std::string enough = class_html(figures_, tooth_);
  figures_.few = {{"alpha", 7, 30}, {"weighted_kappa", 7, 18}};
  const std::string few = class_html(figures_, tooth_);
  for (const char* figure : {"alpha", "weighted_kappa"}) {
    const std::string words = english_text(few_words(figures_, figure));
    EXPECT_NE(words, "");
    EXPECT_EQ(times(few, words), 1u) << words;
    EXPECT_EQ(times(enough, words), 0u) << "nothing is said of what comes from enough";
  }
}

TEST_F(ClassReport, HasNoLineAndNoFigureAtAPassMarkThatIsNoneAndNamesStations) {
  figures_.pass_points = 70;
  figures_.stations = {{"4ab3f3a9d0c1b2a3f4e5", "Seat <1>", 4, 61.0},
                       {"5ab3f3a9d0c1b2a3f4e5", "Seat 2", 3, 62.0}};
  const std::string one = class_html(figures_, tooth_);
  const std::string mark = "stroke-dasharray='3 3'";
  EXPECT_EQ(times(one, mark), 1u) << "a line in the chart";
  EXPECT_TRUE(holds(of_kind(one, "figures"), "<td class='n'>70.0</td>"));
  EXPECT_EQ(of_kind(one, "marked_differently"), "");
  EXPECT_TRUE(holds(of_kind(one, "stations"), "<td>Seat &lt;1&gt;</td>"));
  EXPECT_EQ(one.find("4ab3f3a9"), std::string::npos) << "a key tells nobody anything";
  figures_.marked_by = {{0, 60, 2, {}, {}, 5}, {37, 70, 2, {{"rubric.toml", "aa"}}, {}, 2}};
  figures_.pass_points.reset();
  const std::string several = class_html(figures_, tooth_);
  EXPECT_EQ(times(several, mark), 0u);
  EXPECT_FALSE(holds(of_kind(several, "figures"), "70.0"));
  EXPECT_TRUE(holds(of_kind(several, "marked_differently"), "5 ", "60 %", "2 ", " 37 ", "70 %"));
}

TEST_F(ClassReport, SaysTheSameInHtmlAndPdf) {
  const std::string html = class_html(figures_, tooth_);
  EXPECT_NE(of_kind(html, "one_station"), "");
  EXPECT_NE(html.find("floor &lt;depth&gt;"), std::string::npos) << "texts are made safe";
  EXPECT_LT(html.size(), 3'000'000u);
  const testing_basics::Folder folder;
  write_text_file(folder.file("c.pdf"), class_pdf(figures_, tooth_));
  ASSERT_EQ(std::system(
                ("pdftotext -layout " + folder.file("c.pdf") + " " + folder.file("c.txt")).c_str()),
            0);
  const std::string text = read_text_file(folder.file("c.txt"));
  EXPECT_NE(text.find("floor <depth>"), std::string::npos) << text;
}

}  // namespace
}  // namespace cavum::report
