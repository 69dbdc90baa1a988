// Landmarks of teeth that were imported: ones that stand askew or have a rough surface, and human
// ones against marks by eye.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numeric>
#include <optional>

#include "engine/base/det_math.h"
#include "engine/base/random.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/import/import_volume.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "tests/engine/tooth/import/imported_surfaces.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using namespace testing_import;

constexpr double k_fine_mm = 0.1;

/// Molar, premolar or incisor with fine leaves, and its landmarks as it stands.
struct FineTooth {
  Surfaces surfaces;
  Landmarks landmarks;
};
constexpr std::size_t k_fine_teeth = 3, k_fine_premolar = 1;

Mat3 turn_about(Vec3 axis, double deg) {
  const SinCos half = det_sincos(0.5 * deg * k_pi / 180);
  const Vec3 a = normalized(axis) * half.sin;
  return rotation({half.cos, a.x, a.y, a.z});
}

/// Largest distance between the landmarks of two imports of one tooth, once the second is turned
/// back; counts those that only one has.
struct Compared {
  double worst_mm = 0;
  double worst_horn_mm = 0;  ///< a horn ends 0.2 mm wide, two leaves: its last leaves come and go
  double worst_slid_mm = 0;  ///< of a ridge's lowest place, along its crest
  int lost = 0, all = 0;
  std::string worst;
};
Compared compare(const Landmarks& a, const Landmarks& b, const Mat3& back, Vec3 shift) {
  Compared c;
  const auto theirs = named_points(b);
  for (const auto& [name, at] : named_points(a)) {
    ++c.all;
    double best = 1e9;
    const std::string kind = name.substr(0, name.find_last_of('_'));
    for (const auto& [other, place] : theirs)
      if (other.substr(0, other.find_last_of('_')) == kind)
        best = std::min(best, length(at - (back.transposed(place + shift))));
    // a level crest has its lowest place anywhere along it: across the crest it must stay
    if (name.ends_with("_ridge") && best < 1e6) {
      c.worst_slid_mm = std::max(c.worst_slid_mm, best);
      for (const Vec3 p :
           name == "mesial_ridge" ? b.mesial_ridge.crest_mm : b.distal_ridge.crest_mm)
        best = std::min(best, length(at - back.transposed(p + shift)));
    }
    if (best > 1e6) {
      ++c.lost;
    } else if (kind == "pulp_horn") {
      c.worst_horn_mm = std::max(c.worst_horn_mm, best);
    } else if (best > c.worst_mm) {
      c.worst_mm = best;
      c.worst = name;
    }
  }
  return c;
}

const FineTooth& fine_tooth(std::size_t which) {
  static std::array<std::optional<FineTooth>, k_fine_teeth> teeth;
  auto& tooth = teeth.at(which);
  if (!tooth) {
    const Surfaces s(which == 0                 ? make_molar(shape_of<MolarShape>(k_fine_mm))
                     : which == k_fine_premolar ? make_premolar(shape_of<PremolarShape>(k_fine_mm))
                                                : make_incisor(shape_of<IncisorShape>(k_fine_mm)));
    tooth = FineTooth{
        s, find_landmarks(import_meshes(s.write(fresh_folder()), upright(k_fine_mm)).tooth)};
  }
  return *tooth;
}

/// One of so many that the seed draws; all of them with CAVUM_DEEP, for an import at fine leaves
/// takes some ten seconds of the processor.
std::vector<std::size_t> one_drawn_or_all(Random& random, std::size_t many) {
  std::vector<std::size_t> all(many);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return std::getenv("CAVUM_DEEP") != nullptr
             ? all
             : std::vector<std::size_t>{static_cast<std::size_t>(random.below(many))};
}

TEST(LandmarksTurned, TurnedAndTiltedTeethGiveTheSamePoints) {
  Random random(testing_tooth::drawn_seed("LandmarksTurned.TurnedAndTiltedTeethGiveTheSamePoints"));
  const struct {
    Vec3 axis;
    double deg;
  } turns[] = {{{0, 0, 1}, -17}, {{1, 0, 0}, 8}, {{0, 1, 0}, -10}, {{1, 1, 0.5}, 5}};
  for (const std::size_t which : one_drawn_or_all(random, k_fine_teeth)) {
    const Surfaces& tooth = fine_tooth(which).surfaces;
    for (const std::size_t t : one_drawn_or_all(random, std::size(turns))) {
      const Mat3 turn = turn_about(turns[t].axis, turns[t].deg);
      const Surfaces turned = tooth.changed([&](Vec3 v) { return turn * v; });
      const MeshImport done = import_meshes(turned.write(fresh_folder()), upright(k_fine_mm));
      // each import puts its origin at the middle of its own enamel's box
      Bounds box, box0;
      for (const Vec3 v : turned.enamel.vertices_mm) box.add(v);
      for (const Vec3 v : tooth.enamel.vertices_mm) box0.add(v);
      const Compared c =
          compare(fine_tooth(which).landmarks, find_landmarks(done.tooth), turn,
                  (box.low + box.high) * 0.5 - turn * ((box0.low + box0.high) * 0.5));
      std::cout << "tooth " << which << " turned " << turns[t].deg << " degrees about ("
                << turns[t].axis.x << ' ' << turns[t].axis.y << ' ' << turns[t].axis.z
                << "): " << c.all << " points, worst " << c.worst_mm << " mm (" << c.worst
                << "), horns " << c.worst_horn_mm << " mm, along crests " << c.worst_slid_mm
                << " mm, lost " << c.lost << '\n';
      EXPECT_EQ(c.lost, 0);
      EXPECT_LT(c.worst_mm, 0.3) << c.worst;
      EXPECT_LT(c.worst_horn_mm, 0.4);
    }
  }
}

/// Noise of 20 micrometres each way on every corner: a sum of four uniform draws is nearly normal.
Vec3 noise_mm(Random& random) {
  const auto draw = [&] {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += static_cast<double>(random.below(1'000'001)) / 1e6 - 0.5;
    return sum * 0.020 * 1.7320508;
  };
  const double x = draw(), y = draw(), z = draw();
  return {x, y, z};
}

void expect_the_same_points_with_noise(std::size_t which, Random& random) {
  const Surfaces rough =
      fine_tooth(which).surfaces.changed([&](Vec3 v) { return v + noise_mm(random); });
  const Landmarks theirs =
      find_landmarks(import_meshes(rough.write(fresh_folder()), upright(k_fine_mm)).tooth);
  const Compared c = compare(fine_tooth(which).landmarks, theirs, Mat3{}, {});
  std::cout << "tooth " << which << " rough by 20 um: " << c.all << " points, worst " << c.worst_mm
            << " mm (" << c.worst << "), horns " << c.worst_horn_mm << " mm, along crests "
            << c.worst_slid_mm << " mm, lost " << c.lost << '\n';
  EXPECT_LE(c.lost, c.all / 5) << "absent is honest, elsewhere is not; but not much of it";
  EXPECT_LT(c.worst_mm, 0.3) << c.worst;
  EXPECT_LT(c.worst_horn_mm, 0.4);
}

TEST(LandmarksTurned, ARoughSurfaceGivesTheSamePoints) {
  Random random(testing_tooth::drawn_seed("LandmarksTurned.ARoughSurfaceGivesTheSamePoints"));
  for (const std::size_t which : one_drawn_or_all(random, k_fine_teeth))
    expect_the_same_points_with_noise(which, random);
}

// The premolar's fissure is highest in its middle and hardly hollow at its ends: with this noise
// one half of it was taken for the whole table, and its middle for the distal ridge.
TEST(LandmarksTurned, ARoughPremolarKeepsBothEndsOfItsTable) {
  Random random(52211589897249755u);
  for (int corner = 0; corner < 509002; ++corner)
    (void)noise_mm(random);  // a molar had been drawn before it
  expect_the_same_points_with_noise(k_fine_premolar, random);
  EXPECT_GT(fine_tooth(k_fine_premolar).landmarks.mesial_ridge.lowest_mm->x, 1.5);
  EXPECT_LT(fine_tooth(k_fine_premolar).landmarks.distal_ridge.lowest_mm->x, -1.4);
}

// The buccal cusps are worn down to a plateau above the groove: no cusp tells that side any more,
// and the groove is where it was.
TEST(LandmarksWorn, ACrownWithoutBuccalCuspsKeepsItsGrooveAndRidges) {
  constexpr double k_coarse_mm = 0.2, k_plateau_mm = 2.12;
  const Surfaces whole(make_molar(shape_of<MolarShape>(k_coarse_mm)));
  const Surfaces worn = whole.changed([&](Vec3 v) {
    if (v.y > 0 && v.z > k_plateau_mm) v.z = k_plateau_mm + 0.03 * (v.z - k_plateau_mm);
    return v;
  });
  const auto found = [&](const Surfaces& s) {
    return find_landmarks(import_meshes(s.write(fresh_folder()), upright(k_coarse_mm)).tooth);
  };
  const Landmarks before = found(whole), after = found(worn);
  for (const auto& c : after.cusps)
    EXPECT_TRUE(c.tip_mm.y < 0 || c.prominence_mm < 0.15) << c.name << ' ' << c.prominence_mm;
  ASSERT_GT(after.central_fissure_mm.size(), 15u);
  ASSERT_GT(before.central_fissure_mm.size(), 15u);
  ASSERT_TRUE(after.mesial_ridge.lowest_mm && after.distal_ridge.lowest_mm);
  EXPECT_GT(after.mesial_ridge.lowest_mm->x, 3.4);
  EXPECT_LT(after.distal_ridge.lowest_mm->x, -3.4);
  for (const Vec3 p : after.central_fissure_mm) {
    if (std::fabs(p.x) > 2.5) continue;  // at its ends the ridges' slopes were worn, too
    double nearest = 1e9;
    for (const Vec3 q : before.central_fissure_mm)
      nearest = std::min(nearest, length({p.x - q.x, p.y - q.y, 0}));
    EXPECT_LT(nearest, 0.3) << p.x << ' ' << p.y;
  }
}

// Marks that a person set on pictures of the relief, before the program had said anything about
// fissures, pits and ridges (docs/anatomy.md).
TEST(LandmarksOfRealTeeth, LieWhereTheyWereMarkedByEye) {
  if (shared_folder().empty())
    GTEST_SKIP() << "no shared/ folder beside the repository: real teeth not tested";
  const auto teeth = shared_folder() / "teeth";
  const auto layers = [&](const std::string& tooth) {
    const auto part = [&](const char* name) {
      return (teeth / "openmandible" / ("Tooth_" + tooth + "_" + name + ".stl")).string();
    };
    return MeshPaths{part("Enamel"), part("Dentin"), part("Pulp")};
  };
  const auto import_of = [&](const std::string& tooth, Vec3 mesial) {
    MeshImportOptions o;
    o.leaf_mm = k_fine_mm;
    o.periodontium_mm = 0;
    o.frame.mesial_axis = mesial;
    return import_meshes(layers(tooth), o).tooth;
  };
  const auto check = [](const char* tooth, const Landmarks& l,
                        const std::vector<std::pair<std::string, Vec3>>& marks) {
    const auto found = named_points(l);
    for (const auto& [name, mark] : marks) {
      const auto at = std::find_if(found.begin(), found.end(),
                                   [&, n = name](const NamedPoint& p) { return p.name == n; });
      ASSERT_NE(at, found.end()) << tooth << ' ' << name;
      const double apart = length({at->at_mm.x - mark.x, at->at_mm.y - mark.y, 0});
      std::cout << tooth << ' ' << name << ": " << apart << " mm from the mark\n";
      EXPECT_LT(apart, 0.55) << tooth << ' ' << name;
    }
  };
  const Landmarks molar = find_landmarks(import_of("L6", {0, -1, 0}));
  EXPECT_EQ(molar.tooth_class.kind, ToothClass::molar);
  // its buccal side is worn, but the groove is there: from end to end, over the central pit
  ASSERT_GT(molar.central_fissure_mm.size(), 20u);
  EXPECT_GT(molar.central_fissure_mm.front().x, 2.0);
  EXPECT_LT(molar.central_fissure_mm.back().x, -2.5);
  double past_pit = 1e9;
  for (const Vec3 p : molar.central_fissure_mm)
    past_pit = std::min(past_pit, length({p.x + 0.63, p.y + 0.10, 0}));
  EXPECT_LT(past_pit, 0.3);
  check("L6", molar,
        {{"cusp_1", {2.03, 2.10, 0}},
         {"cusp_2", {0.10, 3.43, 0}},
         {"cusp_3", {1.86, -3.87, 0}},
         {"cusp_4", {-3.87, -2.06, 0}},
         {"central_pit", {-0.63, -0.10, 0}}});
  const Landmarks premolar = find_landmarks(import_of("L4", {-0.8, -0.6, 0}));
  EXPECT_EQ(premolar.tooth_class.kind, ToothClass::premolar);
  check("L4", premolar, {{"cusp_1", {-0.23, 0.86, 0}}});
  const Landmarks incisor = find_landmarks(import_of("L1", {-1, 0, 0}));
  EXPECT_EQ(incisor.tooth_class.kind, ToothClass::incisor);
  ASSERT_FALSE(incisor.incisal_edge_mm.empty());
  EXPECT_TRUE(incisor.cusps.empty() && incisor.occlusal_table_mm.empty());
  VolumeImportOptions o;
  o.leaf_mm = k_fine_mm;
  o.periodontium_mm = 0;
  o.frame.mesial_axis = Vec3{0, -1, 0};
  const Landmarks ct =
      find_landmarks(import_volume((teeth / "ct_tooth_scivis" / "tooth.nhdr").string(), o).tooth);
  EXPECT_EQ(ct.tooth_class.kind, ToothClass::molar);
  check("CT", ct,
        {{"cusp_1", {1.40, 3.40, 0}},
         {"cusp_2", {-2.80, 2.06, 0}},
         {"cusp_3", {0.50, -2.60, 0}},
         {"mesial_ridge", {3.20, 0.60, 0}},
         {"distal_ridge", {-3.10, -0.70, 0}},
         {"mesial_pit", {2.30, 1.90, 0}},
         {"central_pit", {-0.44, 0.44, 0}},
         {"distal_pit", {-2.70, -0.30, 0}}});
}

}  // namespace
}  // namespace cavum
