// The numbers that a report's page draws, unpacked by a decoder of the test's own and compared with
// the octree leaf by leaf and with the recording tick by tick.
#include "ui/report/report_data.h"

#include <cmath>
#include <map>
#include <random>

#include "engine/session/session_reader.h"
#include "grading/measures/motion.h"
#include "tests/ui/program.h"
#include "tests/ui/report/unpack.h"
#include "ui/report/figures/packed_array.h"
#include "ui/report/figures/tooth_grid.h"

namespace cavum::report {
namespace {

using nlohmann::json;
using testing_report::unpack;
using testing_ui::k_block;

std::uint64_t solid_leaves(const Octree& tree) {
  std::uint64_t n = 0;
  const auto counts = tree.count_leaves();
  for (std::size_t t = 1; t < counts.size(); ++t)
    if (tree.is_solid(static_cast<std::uint8_t>(t))) n += counts[t];
  return n;
}

class ReportData : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    const auto r = run("exam " + k_block + " --candidate A --operator perforator --quiet --out " +
                       path("s.cavum"));
    ASSERT_EQ(r.exit_code, 0) << r.err;
    session_ = grading::load_for_grading(path("s.cavum"));
    const grading::GradeInput input = session_->input();
    result_ = grading::grade(input, session_->rubric);
    data_ = report_data(report_source(result_, input, session_->facts, session_->rubric));
  }
  std::unique_ptr<grading::GradedSession> session_;
  grading::Result result_;
  json data_;
};

/// A cell of the data's grid, counted leaf by leaf.
struct Counted {
  long solid = 0;
  std::map<int, int> tissues;
};
Counted count(const Octree& tree, const json& grid, IVec3 cell) {
  const double size = grid["cell_mm"];
  const int edge = static_cast<int>(std::lround(size / tree.leaf_mm()));
  const Vec3 centre{grid["origin_mm"][0].get<double>() + cell.x * size,
                    grid["origin_mm"][1].get<double>() + cell.y * size,
                    grid["origin_mm"][2].get<double>() + cell.z * size};
  Counted c;
  for (int i = 0; i < edge * edge * edge; ++i) {
    const Vec3 leaf{i % edge + 0.5, i / edge % edge + 0.5, i / edge / edge + 0.5};
    const Vec3 at = centre + (leaf - Vec3{edge * 0.5, edge * 0.5, edge * 0.5}) * tree.leaf_mm();
    const std::uint8_t t = tree.tissue_at(at);
    c.solid += tree.is_solid(t) ? 1 : 0;
    ++c.tissues[t];
  }
  return c;
}

TEST_F(ReportData, SharesAreThoseOfTheOctreesLeavesBeforeAndAfter) {
  const std::uint64_t seed =
      testing_basics::drawn_seed("SharesAreThoseOfTheOctreesLeavesBeforeAndAfter");
  std::mt19937_64 random(seed);
  const json& g = data_["grid"];
  const Octree &before = session_->before->octree, &after = session_->after.octree;
  const std::vector<long> was = unpack(g["before"]), tissue = unpack(g["tissue"]),
                          is = unpack(g["after"]);
  const int nx = g["size"][0], ny = g["size"][1], nz = g["size"][2];
  ASSERT_EQ(was.size(), static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
                            static_cast<std::size_t>(nz));
  ASSERT_LE(was.size(), 3'000'000u);
  const int edge = static_cast<int>(std::lround(g["cell_mm"].get<double>() / before.leaf_mm())),
            leaves = edge * edge * edge;
  const auto leaves_of = [&](long share) {
    return std::lround(static_cast<double>(share) * leaves / 255.0);
  };
  std::uint64_t sum = 0;
  for (const long s : was) sum += static_cast<std::uint64_t>(leaves_of(s));
  EXPECT_EQ(sum, solid_leaves(before)) << "all shares together are the tooth";
  const auto at = [&](const std::vector<long>& v, IVec3 c, int sx, int sy) {
    return v[(static_cast<std::size_t>(c.z) * static_cast<std::size_t>(sy) +
              static_cast<std::size_t>(c.y)) *
                 static_cast<std::size_t>(sx) +
             static_cast<std::size_t>(c.x)];
  };
  for (int i = 0; i < 20000; ++i) {
    const IVec3 c{static_cast<int>(random() % static_cast<unsigned>(nx)),
                  static_cast<int>(random() % static_cast<unsigned>(ny)),
                  static_cast<int>(random() % static_cast<unsigned>(nz))};
    const Counted counted = count(before, g, c);
    ASSERT_EQ(leaves_of(at(was, c, nx, ny)), counted.solid) << c.x << " " << c.y << " " << c.z;
    const int id = static_cast<int>(at(tissue, c, nx, ny));
    if (counted.solid == 0) {
      int most = 0;
      for (const auto& [t, n] : counted.tissues) most = std::max(most, n);
      ASSERT_EQ(counted.tissues.at(id), most);
    } else {
      for (const auto& [t, n] : counted.tissues)
        if (before.is_solid(static_cast<std::uint8_t>(t))) {
          ASSERT_LE(n, counted.tissues.at(id));
        }
    }
    const int margin = std::min({c.x, c.y, c.z, nx - 1 - c.x, ny - 1 - c.y, nz - 1 - c.z});
    if (margin < 2) {
      ASSERT_EQ(counted.tissues.size(), 1u) << "the margin is empty";
    }
  }
  // the box: everything in it after the exam, and with it the whole change
  const IVec3 low{g["box"]["low"][0], g["box"]["low"][1], g["box"]["low"][2]},
      size{g["box"]["size"][0], g["box"]["size"][1], g["box"]["size"][2]};
  std::uint64_t gone = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const IVec3 in_box{x, y, z};
        const long left = leaves_of(at(is, in_box, size.x, size.y));
        gone += static_cast<std::uint64_t>(leaves_of(at(was, low + in_box, nx, ny)) - left);
        if (random() % 4 == 0) {
          ASSERT_EQ(left, count(after, g, low + in_box).solid);
        }
      }
  EXPECT_EQ(gone, solid_leaves(before) - solid_leaves(after));
  EXPECT_GT(gone, 1000u);
}

TEST_F(ReportData, TimesAndDistancesOfACellAreThoseOfItsLeaves) {
  const json& g = data_["grid"];
  const Octree& tree = session_->before->octree;
  const std::vector<long> first = unpack(g["first"]), last = unpack(g["last"]),
                          distance = unpack(g["distance"]);
  const IVec3 low{g["box"]["low"][0], g["box"]["low"][1], g["box"]["low"][2]},
      size{g["box"]["size"][0], g["box"]["size"][1], g["box"]["size"][2]};
  const double cell = g["cell_mm"], duration = data_["duration_s"];
  const Vec3 origin{g["origin_mm"][0], g["origin_mm"][1], g["origin_mm"][2]};
  EXPECT_DOUBLE_EQ(duration, static_cast<double>(SessionReader(path("s.cavum")).ticks()) * 1e-3);
  std::map<IVec3, std::pair<std::int64_t, std::int64_t>> ticks;  // by cell of the box
  for (const auto& r : SessionReader(path("s.cavum")).removed()) {
    if (!tree.is_solid(r.leaf.tissue)) continue;
    const Vec3 at = (tree.centre_mm(r.leaf.leaf()) - origin) / cell;
    const IVec3 c = IVec3{static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)),
                          static_cast<int>(std::lround(at.z))} -
                    low;
    const auto [found, is_new] = ticks.try_emplace(c, r.tick, r.tick);
    if (!is_new)
      found->second = {std::min(found->second.first, r.tick),
                       std::max(found->second.second, r.tick)};
  }
  ASSERT_GT(ticks.size(), 500u);
  const double step_s = duration / 65535;
  std::size_t i = 0, never = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const auto found = ticks.find({x, y, z});
        if (found == ticks.end()) {
          ASSERT_EQ(first[i], 65535);
          ASSERT_EQ(last[i], 65535);
          ++never;
        } else {
          ASSERT_LT(last[i], 65535);
          ASSERT_NEAR(static_cast<double>(first[i]) * step_s,
                      static_cast<double>(found->second.first) * 1e-3, step_s);
          ASSERT_NEAR(static_cast<double>(last[i]) * step_s,
                      static_cast<double>(found->second.second) * 1e-3, step_s);
        }
        // the target is a cylinder of radius 1.1 mm about the axis, 1.6 mm deep from the block's
        // upper face
        const Vec3 at =
            origin + Vec3{double(low.x + x), double(low.y + y), double(low.z + z)} * cell;
        const double floor_z = session_->zones->target_low_mm().z,
                     beside = std::sqrt(at.x * at.x + at.y * at.y) - 1.1, below = floor_z - at.z;
        if (at.z > session_->zones->target_high_mm().z - 0.1) continue;  // above it opens
        const double d = beside > 0 && below > 0 ? std::sqrt(beside * beside + below * below)
                                                 : std::max(beside, below);
        const double expected = std::clamp(d, -2.54, 2.54);
        if (std::fabs(d) > 0.9) continue;  // zones are known near the target
        ASSERT_NEAR(static_cast<double>(distance[i]) * k_distance_step_mm, expected,
                    0.05 + 0.5 * k_distance_step_mm)
            << at.x << " " << at.y << " " << at.z;
      }
  EXPECT_EQ(never + ticks.size(), i);
}

TEST_F(ReportData, MotionKeepsEveryPeakOfTheForceAndThePlaceOfTheTip) {
  const json& m = data_["motion"];
  const SessionReader reader(path("s.cavum"));
  const auto inputs = reader.inputs();
  const auto records = reader.records();
  const std::vector<long> x = unpack(m["x_um"]), z = unpack(m["z_um"]),
                          force = unpack(m["force_cn"]), depth = unpack(m["depth_um"]),
                          rpm = unpack(m["rpm10"]), az = unpack(m["az"]),
                          speed = unpack(m["tip_50um_s"]);
  const auto step = static_cast<std::size_t>(std::lround(m["dt_s"].get<double>() * 1000));
  ASSERT_EQ(m["n"].get<std::size_t>(), (inputs.size() + step - 1) / step);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t begin = i * step, end = std::min(inputs.size(), begin + step);
    double most = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const auto& f = records[k].rendered_un;
      most = std::max(
          most, std::sqrt(double(f[0]) * f[0] + double(f[1]) * f[1] + double(f[2]) * f[2]) * 1e-6);
    }
    ASSERT_NEAR(static_cast<double>(force[i]) * 0.01, most, 0.00501) << i;
    ASSERT_NEAR(static_cast<double>(x[i]) * 1e3, inputs[begin].tip_nm[0], 501);
    ASSERT_NEAR(static_cast<double>(z[i]) * 1e3, inputs[begin].tip_nm[2], 501);
    ASSERT_NEAR(static_cast<double>(depth[i]) * 1e-3,
                session_->zones->opening_z_mm() - inputs[begin].tip_nm[2] * 1e-6, 0.0006);
    ASSERT_NEAR(static_cast<double>(rpm[i]) * 10, records[begin].rpm, 5.01);
    const std::size_t next = std::min(end, inputs.size() - 1);
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k)
      square += std::pow(1e-3 * (inputs[next].tip_nm[k] - inputs[begin].tip_nm[k]), 2);
    if (next > begin) {
      ASSERT_NEAR(static_cast<double>(speed[i]) * 0.05,
                  std::sqrt(square) / static_cast<double>(next - begin), 0.0251)
          << i;  // µm in ms = mm/s
    }
    ASSERT_GT(az[i], 100) << "the handle points up";
  }
  EXPECT_NEAR(static_cast<double>(*std::max_element(force.begin(), force.end())) * 0.01,
              result_.motion.force_peak_n, 0.006);
}

TEST_F(ReportData, EventsMomentsAndInstrumentsAreThoseOfTheExam) {
  std::size_t perforations = 0;
  double before = 0;
  for (const auto& e : data_["events"]) {
    EXPECT_GE(e["t_s"].get<double>(), before) << "in order of time";
    before = e["t_s"];
    perforations += e["kind"] == "perforation" ? 1 : 0;
    if (e["kind"] == "perforation") {
      EXPECT_EQ(e["site_mm"].size(), 3u);
    }
  }
  EXPECT_GT(perforations, 0u);
  const json grade = run_json("grade " + path("s.cavum"));
  std::map<std::string, std::size_t> moments;
  for (const auto& m : data_["moments"]) ++moments[m["criterion"]];
  for (const auto& c : grade["criteria"]) {
    const bool lost = c["max"].get<double>() - c["points"].get<double>() > 1e-6;
    std::size_t timed = 0;
    if (lost) {
      const json why =
          run_json("grade " + path("s.cavum") + " --why " + c["id"].get<std::string>());
      for (const auto& m : why["moments"]) timed += m["t_s"].is_null() ? 0 : 1;
    }
    EXPECT_EQ(moments[c["title"]], timed) << c["id"];
  }
  ASSERT_EQ(data_["instruments"].size(), 1u);
  const json& profile = data_["instruments"][0]["profile_mm"];
  EXPECT_EQ(profile[0], (json{0.0, 0.0}));
  double widest = 0;
  for (const auto& p : profile)
    if (p[0].get<double>() < 3) widest = std::max(widest, p[1].get<double>());
  EXPECT_NEAR(widest, 0.5, 0.01) << "a cylinder of 1 mm";
  const json& enamel = data_["tissues"][1];
  EXPECT_EQ(enamel, (json{{"name", "enamel"},
                          {"words", enamel["words"]},
                          {"colour", enamel["colour"]},
                          {"solid", true},
                          {"pulp", false},
                          {"beside", false}}));
}

TEST(PackedArray, GivesEveryValueBackWithAndWithoutDifferences) {
  std::mt19937_64 random(
      testing_basics::drawn_seed("GivesEveryValueBackWithAndWithoutDifferences"));
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
    std::vector<std::int16_t> wide(n);
    std::vector<std::uint8_t> narrow(n);
    for (std::size_t i = 0; i < n; ++i)
      wide[i] = static_cast<std::int16_t>(random()),
      narrow[i] = static_cast<std::uint8_t>(random());
    for (const bool delta : {false, true}) {
      EXPECT_EQ(unpack(packed_array(wide, delta)), std::vector<long>(wide.begin(), wide.end()));
      EXPECT_EQ(unpack(packed_array(narrow, delta)),
                std::vector<long>(narrow.begin(), narrow.end()));
    }
  }
}

TEST(ToothGridTest, LargerCellsHoldTheSameLeavesAndStayWithinWhatIsAllowed) {
  Tooth tooth = load_tooth_file(std::string(CAVUM_SOURCE_DIR) + "/data/teeth/block.cvt");
  for (const std::size_t most :
       {std::size_t{3'000'000}, std::size_t{200'000}, std::size_t{20'000}}) {
    const ToothGrid g = make_tooth_grid(tooth, most);
    EXPECT_LE(g.solid.size(), most);
    std::uint64_t sum = 0;
    for (const auto n : g.solid) sum += n;
    EXPECT_EQ(sum, solid_leaves(tooth.octree));
    const std::vector<std::uint8_t> shares = shares_of(g.solid, g.cell_leaves());
    EXPECT_EQ(*std::max_element(shares.begin(), shares.end()), 255);
  }
}

}  // namespace
}  // namespace cavum::report
