// What an import says of a tooth, and what it refuses: our makers as STL in other units, upside
// down, with layers exchanged, mirrored.
#include "engine/tooth/import/sense.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/import/hollows.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/import/import_meshes.h"
#include "engine/tooth/import/layers_fit.h"
#include "engine/tooth/make/grow_teeth.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/make/periodontium.h"
#include "tests/engine/tooth/import/import_testing.h"
#include "tests/engine/tooth/import/imported_surfaces.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using namespace testing_import;

constexpr double k_sensed_mm = 0.2;  // leaves of what is refused or told

const Surfaces& molar() {
  static const Surfaces s(make_molar(shape_of<MolarShape>(k_sensed_mm)));
  return s;
}
const Surfaces& premolar() {
  static const Surfaces s(make_premolar(shape_of<PremolarShape>(k_sensed_mm)));
  return s;
}
const Surfaces& incisor() {
  static const Surfaces s(make_incisor(shape_of<IncisorShape>(k_sensed_mm)));
  return s;
}

std::optional<Error> refusal(const Surfaces& s, const MeshImportOptions& o) {
  const auto paths = s.write(fresh_folder());
  return thrown_by([&] { (void)import_meshes(paths, o); });
}
/// What contradicts the measure of this name, which is what --confirm takes.
bool contradicts(const std::optional<Error>& refusal, const char* measure) {
  return code_of(refusal) == ImportError::contradicted && tells(refusal->advice(), measure);
}
/// The turn that mends a frame, of the error or the warning that names one.
std::optional<double> turn_in(const Message& m) {
  constexpr std::string_view k_option = "--rotate-deg ";
  for (const Value& v : m.values()) {
    if (const auto* name = std::get_if<Name>(&v);
        name != nullptr && name->text.starts_with(k_option))
      return std::stod(name->text.substr(k_option.size()));
    if (const auto* inner = std::get_if<Message>(&v))
      if (const auto turn = turn_in(*inner)) return turn;
  }
  return std::nullopt;
}
/// Whether one begins with a figure in this unit.
bool any_gives(Unit unit, const std::vector<Message>& list) {
  return std::any_of(list.begin(), list.end(), [&](const Message& m) {
    const auto* number = m.values().empty() ? nullptr : std::get_if<Number>(&m.values()[0]);
    return number != nullptr && number->unit == unit;
  });
}
bool any_turn_in(const std::vector<Message>& list) {
  return std::any_of(list.begin(), list.end(),
                     [](const Message& m) { return turn_in(m).has_value(); });
}

TEST(Sense, NumbersOfBothSystemsAreTheSameTeeth) {
  for (const auto& [fdi, universal] : {std::pair{18, 1},
                                       {11, 8},
                                       {21, 9},
                                       {28, 16},
                                       {38, 17},
                                       {36, 19},
                                       {31, 24},
                                       {41, 25},
                                       {46, 30},
                                       {48, 32}}) {
    EXPECT_EQ(from_fdi(fdi, "x").universal(), universal) << fdi;
    EXPECT_EQ(from_universal(universal, "x").fdi, fdi) << universal;
  }
  for (int u = 1; u <= 32; ++u) EXPECT_EQ(from_universal(u, "x").universal(), u);
  for (const int bad : {0, 10, 19, 29, 49, 51, 85, -36})
    EXPECT_THROW((void)from_fdi(bad, "x"), Error) << bad;
  for (const int bad : {0, 33, -1}) EXPECT_THROW((void)from_universal(bad, "x"), Error) << bad;
  EXPECT_TRUE(from_fdi(36, "x").text().starts_with("36 (universal 19), "));
  EXPECT_EQ(from_fdi(36, "x").tooth_class(), ToothClass::molar);
  EXPECT_TRUE(from_fdi(36, "x").y_is_buccal());
  EXPECT_FALSE(from_fdi(46, "x").y_is_buccal());
}

// z cross mesial, in the patient: outwards at the molars of quadrants 1 and 3, inwards at those of
// 2 and 4.
TEST(Sense, MesialInThePatientGivesTheHandednessOfTheQuadrant) {
  for (const int fdi : {16, 26, 36, 46, 18, 47}) {
    const ToothNumber n = from_fdi(fdi, "x");
    const Vec3 mesial = mesial_in_patient(n, "lps"), occlusal{0, 0, n.upper() ? -1.0 : 1.0},
               outwards{n.left() ? 1.0 : -1.0, 0, 0};
    EXPECT_EQ(dot(cross(occlusal, mesial), outwards) > 0, n.y_is_buccal()) << fdi;
    EXPECT_LT(mesial.y, -0.9) << "forwards";
    const Vec3 ras = mesial_in_patient(n, "ras");
    EXPECT_EQ(ras, (Vec3{-mesial.x, -mesial.y, mesial.z}));
  }
  EXPECT_GT(mesial_in_patient(from_fdi(11, "x"), "lps").x, 0.9) << "from the right to the midline";
  EXPECT_THROW((void)mesial_in_patient(from_fdi(11, "x"), "xyz"), Error);
}

TEST(Sense, OtherUnitsAreRefusedWithTheirNameAndTakenWhenSaid) {
  const struct {
    const char* unit;
    double mm;
  } units[] = {{"in", 25.4}, {"m", 1000}, {"cm", 10}, {"um", 0.001}};
  for (const auto& u : units) {
    const Surfaces scaled = molar().changed([&](Vec3 v) { return v / u.mm; });
    MeshImportOptions o = upright(k_sensed_mm);
    const auto refused = refusal(scaled, o);
    EXPECT_TRUE(contradicts(refused, "size") && tells(refused, u.unit)) << u.unit;
    o.sense.units = u.unit;
    const auto done = import_meshes(scaled.write(fresh_folder()), o);
    EXPECT_EQ(done.sense.tooth_class.kind, ToothClass::molar) << u.unit;
    EXPECT_EQ(std::get<ImportedMeshes>(done.tooth.source.at(0)).unit, u.unit);
  }
  MeshImportOptions wrong = upright(k_sensed_mm);
  wrong.sense.units = "cm";
  EXPECT_TRUE(tells(refusal(molar(), wrong), "mm"));
  wrong.sense.units = "furlong";
  EXPECT_EQ(place_of(refusal(molar(), wrong)), "--units");
}

TEST(Sense, CrownsOfNoHumanAreRefusedUnlessConfirmed) {
  const Surfaces horse = molar().changed([](Vec3 v) { return v * 2.0; });
  MeshImportOptions o = upright(k_sensed_mm);
  o.leaf_mm = 0.2;
  const auto refused = refusal(horse, o);
  EXPECT_TRUE(contradicts(refused, "size") && tells(refused, 4.5) && tells(refused, 14.0));
  o.sense.confirmed = {"class", "mesial"};
  EXPECT_TRUE(contradicts(refusal(horse, o), "size")) << "another name confirms nothing of this";
  o.sense.confirmed = {"size"};
  EXPECT_TRUE(tells(import_meshes(horse.write(fresh_folder()), o).sense.warnings, "size"));
}

TEST(Sense, UpsideDownAndAcrossAreRefused) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.frame.occlusal_axis = Vec3{0, 0, -1};
  for (const Surfaces* s : {&molar(), &incisor()})
    EXPECT_TRUE(contradicts(refusal(*s, o), "upright"));
  o.frame.occlusal_axis = Vec3{0, 1, 0};
  EXPECT_TRUE(contradicts(refusal(molar(), o), "upright"));
  MeshImportOptions patient = upright(k_sensed_mm);
  patient.sense.number = from_fdi(16, "x");
  patient.sense.patient_frame = "lps";
  EXPECT_TRUE(contradicts(refusal(molar(), patient), "upright"));
}

TEST(Sense, ExchangedLayersAreRefused) {
  Surfaces s = molar();
  std::swap(s.enamel, s.dentin);
  MeshImportOptions o = upright(k_sensed_mm);
  EXPECT_EQ(code_of(refusal(s, o)), ImportError::layers_exchanged);
  s = molar();
  std::swap(s.dentin, s.pulp);
  EXPECT_TRUE(refusal(s, o));
  s = molar();
  std::swap(s.enamel, s.pulp);
  EXPECT_TRUE(refusal(s, o));
}

TEST(Sense, LayersThatDoNotFitUponEachOtherAreRefused) {
  const MeshImportOptions o = upright(k_sensed_mm);
  for (const Vec3 by : {Vec3{0, 0, 1.0}, Vec3{1, 0, 0}, Vec3{0, -1, 0}}) {
    Surfaces s = molar();
    for (auto& v : s.enamel.vertices_mm) v += by;
    EXPECT_EQ(code_of(refusal(s, o)), ImportError::layers_apart)
        << by.x << " " << by.y << " " << by.z;
  }
}

TEST(Sense, SurfacesOfAnotherToothAreRefused) {
  const MeshImportOptions o = upright(k_sensed_mm);
  Surfaces s = molar();
  for (auto& v : s.enamel.vertices_mm) v.z += 16;  // above all dentin: they nowhere face each other
  EXPECT_EQ(code_of(refusal(s, o)), ImportError::layers_apart);

  // a pulp of which a half lies in the dentin's surface, too: there is room for it, or none
  EXPECT_NO_THROW(require_layers_that_fit({0.8, 0.001, 0.5}, {0, 0.0, 0.02}, "x"));
  EXPECT_NO_THROW(require_layers_that_fit({0.8, 0.001, 0.5}, {0, 0.0, 0.97}, "x"));
  EXPECT_THROW(require_layers_that_fit({0.8, 0.001, 0.5}, {0, 0.0, 0.5}, "x"), Error);
  // where the dentin has a chamber of its own, the pulp lies in that
  EXPECT_NO_THROW(require_layers_that_fit({0.8, 0.001, 0.5}, {0, 0.0, 0.02, 1.0}, "x"));
  EXPECT_THROW(require_layers_that_fit({0.8, 0.001, 0.5}, {0, 0.0, 0.97, 1.0}, "x"), Error);
}

void append(TriangleMesh& to, const TriangleMesh& part, bool inside_out) {
  const auto first = static_cast<std::uint32_t>(to.vertices_mm.size());
  to.vertices_mm.insert(to.vertices_mm.end(), part.vertices_mm.begin(), part.vertices_mm.end());
  for (const auto& t : part.triangles)
    to.triangles.push_back(
        {t[0] + first, t[inside_out ? 2 : 1] + first, t[inside_out ? 1 : 2] + first});
}

// A ball with a hollow ball in it, of which a filling knows nothing: the hollow has the inner
// ball's volume, whichever way its faces look.
TEST(Sense, AHollowIsFoundByTheSurfacesAboveAndBelow) {
  for (const bool inside_out : {false, true}) {
    const double outer_mm = 3.0, inner_mm = 1.7;
    TriangleMesh mesh = ball({0.1, -0.2, 0.3}, outer_mm, 96);
    append(mesh, ball({0.3, 0.1, 0.0}, inner_mm, 96), inside_out);
    TissueGrid lattice;
    lattice.allocate({80, 80, 80}, 0.1, {-4, -4, -4});
    std::vector<float> filled(lattice.count());
    for (int z = 0; z < 80; ++z)
      for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 80; ++x)
          filled[lattice.index({x, y, z})] = static_cast<float>(
              length(lattice.centre_mm({x, y, z}) - Vec3{0.1, -0.2, 0.3}) - (outer_mm - 0.1));
    const auto hollow = hollows(mesh, filled, lattice);
    const auto leaves = static_cast<double>(std::count(hollow.begin(), hollow.end(), 1));
    EXPECT_NEAR(leaves * 0.001, 4.0 / 3.0 * std::acos(-1.0) * inner_mm * inner_mm * inner_mm, 0.2)
        << inside_out;
  }
}

TEST(Sense, LayersThatFitLooselyAreTold) {
  ToothSense sense;
  tell_loose_layers({0.8, 0.004, 0.5}, {0, 0.002, 0.003, 1.0},
                    sense);  // the worst of thirteen human teeth
  EXPECT_TRUE(sense.warnings.empty());
  tell_loose_layers({0.8, 0.019, 0.5}, {0, 0.002, 0.003, 1.0}, sense);
  tell_loose_layers({0.8, 0.004, 0.5}, {0, 0.034, 0.003, 1.0}, sense);
  tell_loose_layers({0.8, 0.004, 0.5}, {0, 0.002, 0.07, 1.0}, sense);
  EXPECT_EQ(sense.warnings.size(), 3u);
  tell_loose_layers({0.8, 0.004, 0.5}, {0, 0.002, 0.98, 0.0}, sense);  // dentin without a chamber
  EXPECT_EQ(sense.warnings.size(), 3u);
}

TEST(Sense, EnamelThatFloatsIsRefusedAndAPearlIsTold) {
  const MeshImportOptions o = upright(k_sensed_mm);
  Surfaces s = molar();
  Vec3 top{0, 0, -1e9}, side{-1e9, 0, 0};
  for (const auto& v : s.enamel.vertices_mm) top = v.z > top.z ? v : top;
  for (const auto& v : s.dentin.vertices_mm)
    if (std::fabs(v.z + 9) < 0.2) side = v.x > side.x ? v : side;
  const auto with = [&](Vec3 centre) {
    Surfaces more = s;
    const TriangleMesh extra = ball(centre, 0.6, 12);
    const auto first = static_cast<std::uint32_t>(more.enamel.vertices_mm.size());
    more.enamel.vertices_mm.insert(more.enamel.vertices_mm.end(), extra.vertices_mm.begin(),
                                   extra.vertices_mm.end());
    for (const auto& t : extra.triangles)
      more.enamel.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return more;
  };
  EXPECT_EQ(code_of(refusal(with(top + Vec3{0, 0, 2}), o)), ImportError::layers_apart);
  const Surfaces pearl = with(side + Vec3{0.2, 0, 0});
  const auto warnings = import_meshes(pearl.write(fresh_folder()), o).sense.warnings;
  EXPECT_TRUE(any_gives(Unit::mm3, warnings)) << "the pearl's volume";
  EXPECT_FALSE(any_gives(Unit::mm2, warnings))
      << "bare dentin";  // the crown does not end where the pearl does
}

/// A crown of enamel 1 mm thick on dentin, and what is not enamel of it.
template <class Bare>
TissueGrid crown_without(const Bare& bare) {
  TissueGrid grid;
  grid.allocate({120, 120, 200}, 0.1, {-6, -6, -12});
  for (int z = 20; z < 180; ++z)
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 120; ++x) {
        const Vec3 p = grid.centre_mm({x, y, z});
        const double r = length({p.x, p.y, 0});
        grid.tissue[grid.index({x, y, z})] = r < 3 && p.z < 5               ? k_dentin
                                             : r < 4 && p.z > 0 && !bare(p) ? k_enamel
                                                                            : k_air;
      }
  return grid;
}

TEST(Sense, DentinThatLiesBareInTheCrownIsMeasured) {
  EXPECT_EQ(bare_dentin(crown_without([](Vec3) { return false; })).mm2, 0.0);
  // a hole 1.2 mm wide through the top, and a crack 0.3 mm wide down the side to the neck, of which
  // the last millimetre may be a notch of the neck
  const BareDentin hole =
      bare_dentin(crown_without([](Vec3 p) { return p.z > 5 && p.x * p.x + p.y * p.y < 0.36; }));
  EXPECT_NEAR(hole.largest_mm2, 3.14159265 * 0.36, 0.15);
  EXPECT_LT(length(hole.at_mm - Vec3{0, 0, 4.95}), 0.1);
  const BareDentin crack = bare_dentin(
      crown_without([](Vec3 p) { return p.y > 0 && std::fabs(p.x) < 0.15 && p.z > 1 && p.z < 5; }));
  EXPECT_NEAR(crack.mm2, 0.3 * 4, 0.4);
  EXPECT_NEAR(crack.at_mm.y, 2.95, 0.1);
  ToothSense sense;
  tell_bare_dentin(crack, sense);
  EXPECT_TRUE(any_gives(Unit::mm2, sense.warnings));
  sense = {};
  tell_bare_dentin({0.2, 0.1, {}}, sense);
  EXPECT_TRUE(sense.warnings.empty());
}

TEST(Sense, APulpThatLiesOpenInTheCrownIsRefusedUnlessConfirmed) {
  const auto with_pulp_up_to = [](int top) {
    TissueGrid grid = crown_without([](Vec3) { return false; });
    for (int z = 40; z < top; ++z)
      for (int y = 56; y < 64; ++y)
        for (int x = 56; x < 64; ++x) grid.tissue[grid.index({x, y, z})] = k_pulp;
    return open_pulp(grid);
  };
  SenseOptions options;
  ToothSense sense;
  EXPECT_EQ(with_pulp_up_to(170).mm2, 0.0);
  EXPECT_NO_THROW(check_closed_pulp(with_pulp_up_to(170), options, "pulp.stl", sense));
  const OpenPulp open = with_pulp_up_to(180);  // to the crown's top
  EXPECT_NEAR(open.mm2, 0.64, 1e-9);
  EXPECT_THROW(check_closed_pulp(open, options, "pulp.stl", sense), Error);
  options.confirmed = {"pulp"};
  check_closed_pulp(open, options, "pulp.stl", sense);
  EXPECT_TRUE(tells(sense.warnings, "pulp"));
}

TEST(Sense, APulpMayEndAtTheApexAndNotHangOutOfIt) {
  for (const int out : {-3, 0, 3, 8}) {  // leaves
    TissueGrid grid = crown_without([](Vec3) { return false; });
    for (int z = 20 - out; z < 140; ++z)
      for (int y = 56; y < 64; ++y)
        for (int x = 56; x < 64; ++x) grid.tissue[grid.index({x, y, z})] = k_pulp;
    EXPECT_NEAR(pulp_below_dentin_mm(grid), 0.1 * out, 1e-9);
  }
  EXPECT_NO_THROW(require_pulp_in_root(0.3, "pulp.stl"));
  EXPECT_THROW(require_pulp_in_root(0.8, "pulp.stl"), Error);
}

TEST(Sense, ACleftInTheCrownHoldsNoPeriodontium) {
  TissueGrid grid =
      crown_without([](Vec3 p) { return std::fabs(p.x) < 0.15 && p.y > 0 && p.z > 1.0; });
  EXPECT_GT(add_periodontium(grid, 1.0), 0u);
  double highest = -1e9;
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x)
        if (grid.tissue[grid.index({x, y, z})] == k_periodontium)
          highest = std::max(highest, grid.centre_mm({x, y, z}).z);
  EXPECT_LT(highest, 1.1);
  EXPECT_GT(highest, -0.2) << "it reaches up to the neck";
}

// The pulp alone turned over inside its dentin: wide where the root's end is.
TEST(Sense, APulpThatIsWideTowardsTheRootIsRefused) {
  TissueGrid grid;
  grid.allocate({80, 80, 160}, 0.1, {-4, -4, -12});
  Tooth tooth;
  const auto fill = [&](bool over) {
    for (int z = 0; z < 160; ++z)
      for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 80; ++x) {
          const Vec3 p = grid.centre_mm({x, y, z});
          const double r = length({p.x, p.y, 0}), up = (p.z + 9) / 9,
                       wide = 0.3 + 1.2 * (over ? 1 - up : up);
          auto& t = grid.tissue[grid.index({x, y, z})];
          t = r > 3.5 || p.z < -11.5 || p.z > 3.5 ? k_air : p.z > 1 ? k_enamel : k_dentin;
          if (p.z > -9 && p.z < 0 && r < wide) t = k_pulp;
          grid.distance[grid.index({x, y, z})] =
              encode_distance(t == k_air || t == k_pulp ? 2 : -2);
        }
    tooth.octree = Octree(grid, tooth.tissues);
  };
  ToothSense sense;
  fill(false);
  sense_tooth(tooth, {}, {}, "t", sense);
  fill(true);
  EXPECT_TRUE(contradicts(thrown_by([&] { sense_tooth(tooth, {}, {}, "t", sense); }), "pulp"));
}

TEST(Sense, ANumberOfAnotherClassIsRefusedAndARightOneIsKept) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.sense.number = from_fdi(11, "x");
  for (const Surfaces* s : {&molar(), &premolar()})
    EXPECT_TRUE(contradicts(refusal(*s, o), "class"));
  o.sense.number = from_fdi(36, "x");
  EXPECT_TRUE(contradicts(refusal(incisor(), o), "class"));
  const auto done = import_meshes(molar().write(fresh_folder()), o);
  EXPECT_EQ(done.tooth.kind, ToothKind(from_fdi(36, "x")));
  o.sense.confirmed = {"class"};
  o.sense.number = from_fdi(11, "x");
  EXPECT_TRUE(tells(import_meshes(molar().write(fresh_folder()), o).sense.warnings, "class"));
}

/// The tooth of the other side of the jaw.
Surfaces in_a_mirror(const Surfaces& of) {
  Surfaces s = of.changed([](Vec3 v) { return Vec3{v.x, -v.y, v.z}; });
  for (auto* m : {&s.enamel, &s.dentin, &s.pulp}) turn_inside_out(*m);
  return s;
}

// A lower right molar is the mirror image of our lower left one: its +y is lingual, and every later
// task takes +y for buccal.
TEST(Sense, AToothOfTheOtherSideIsTakenAsItsMirrorImageAndSaysSo) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.sense.number = from_fdi(46, "x");
  const auto mirrored = import_meshes(in_a_mirror(molar()).write(fresh_folder()), o);
  EXPECT_TRUE(tells(mirrored.sense.warnings, 46));
  EXPECT_EQ(mirrored.tooth.kind, ToothKind(from_fdi(46, "x")));
  EXPECT_EQ(mirrored.tooth.notes_of(ToothNote::Kind::mirror_image).size(), 1u);
  EXPECT_EQ(mirrored.tooth.notes_of(ToothNote::Kind::warning), mirrored.sense.warnings);
  const Tooth again = load_tooth(save_tooth(mirrored.tooth), "again");
  EXPECT_EQ(again.notes, mirrored.tooth.notes);
  const Landmarks ours = find_landmarks(
                      import_meshes(molar().write(fresh_folder()), upright(k_sensed_mm)).tooth),
                  theirs = find_landmarks(mirrored.tooth);
  ASSERT_EQ(ours.cusps.size(), theirs.cusps.size());
  for (std::size_t i = 0; i < ours.cusps.size(); ++i) {
    EXPECT_EQ(ours.cusps[i].name, theirs.cusps[i].name);
    EXPECT_LT(length(ours.cusps[i].tip_mm - theirs.cusps[i].tip_mm), 0.3) << ours.cusps[i].name;
  }
  o.frame.mirror = true;
  EXPECT_EQ(tooth_hash(import_meshes(in_a_mirror(molar()).write(fresh_folder()), o).tooth),
            tooth_hash(mirrored.tooth))
      << "--mirror says it once more";
  o.sense.number = from_fdi(36, "x");
  EXPECT_EQ(place_of(refusal(molar(), o)), "--mirror");
}

/// A grown molar's surfaces: its sides differ as those of a human one do.
const Surfaces& grown_molar() {
  static const Surfaces s(grow_molar({7, k_sensed_mm, 0}));
  return s;
}

TEST(Sense, AMolarTurnedAboutItsLongAxisIsRefusedWithTheTurnThatMendsIt) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.sense.number = from_fdi(36, "x");
  EXPECT_FALSE(refusal(grown_molar(), o));
  for (const int deg : {90, 180, -90}) {
    MeshImportOptions turned = o;
    turned.frame.mesial_axis.reset();
    turned.frame.rotate_deg = deg;
    const auto refused = refusal(grown_molar(), turned);
    EXPECT_TRUE(contradicts(refused, "mesial")) << deg;
    const auto turn = turn_in(refused->advice());
    ASSERT_TRUE(turn) << deg;
    turned.frame.rotate_deg = *turn;
    EXPECT_LT(std::fabs(*turn), 30) << "the tooth lies upright in its file";
    EXPECT_FALSE(refusal(grown_molar(), turned)) << deg;
    turned.frame.rotate_deg = deg;
    turned.sense.confirmed = {"mesial"};
    EXPECT_TRUE(tells(import_meshes(grown_molar().write(fresh_folder()), turned)
                          .tooth.notes_of(ToothNote::Kind::warning),
                      "mesial"))
        << deg;
  }
  // where nothing is said of sides there is nothing to contradict: it is taken, and the tooth bears
  // the warning
  MeshImportOptions silent = o;
  silent.sense.number.reset();
  silent.frame.mesial_axis.reset();
  const auto taken = import_meshes(grown_molar()
                                       .changed([](Vec3 p) {
                                         return Vec3{p.y, -p.x, p.z};
                                       })
                                       .write(fresh_folder()),
                                   silent);
  EXPECT_TRUE(any_turn_in(taken.tooth.notes_of(ToothNote::Kind::warning)));
  // the plain molar is alike on both sides: its canals tell the line
  o.frame.mesial_axis = Vec3{0, 1, 0};
  EXPECT_TRUE(contradicts(refusal(molar(), o), "mesial"));
}

TEST(Sense, ANumberOfTheOtherSideOfTheJawIsRefused) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.sense.number = from_fdi(46, "x");
  const auto refused = refusal(grown_molar(), o);
  EXPECT_TRUE(contradicts(refused, "side") && tells(refused->advice(), 36));
  o.sense.number = from_fdi(36, "x");
  const auto mirrored = refusal(in_a_mirror(grown_molar()), o);
  EXPECT_TRUE(contradicts(mirrored, "side") && tells(mirrored->advice(), 46));
  o.sense.number.reset();
  EXPECT_TRUE(contradicts(refusal(in_a_mirror(grown_molar()), o), "side"));
  o.sense.confirmed = {"side"};
  EXPECT_TRUE(tells(
      import_meshes(in_a_mirror(grown_molar()).write(fresh_folder()), o).sense.warnings, "side"));
}

// A blunt or worn canine has an edge: nobody is refused his canine for it.
TEST(Sense, ACanineWithAnEdgeIsTaken) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.sense.number = from_fdi(33, "x");
  const auto done = import_meshes(incisor().write(fresh_folder()), o);
  EXPECT_TRUE(tells(done.sense.warnings, from_fdi(33, "x").in_words()));
}

TEST(Sense, APieceOfAnotherToothOnTheContactIsRefused) {
  Surfaces s = molar();
  const auto first = static_cast<std::uint32_t>(s.enamel.vertices_mm.size());
  for (int i = 0; i < 8; ++i)
    s.enamel.vertices_mm.push_back({i & 1 ? 7.2 : 4.8, i & 2 ? 1.5 : -1.5, i & 4 ? 2.0 : -1.0});
  for (const auto& [a, b, c] : {std::array{0u, 2u, 1u},
                                {1u, 2u, 3u},
                                {4u, 5u, 6u},
                                {5u, 7u, 6u},
                                {0u, 1u, 4u},
                                {1u, 5u, 4u},
                                {2u, 6u, 3u},
                                {3u, 6u, 7u},
                                {0u, 4u, 2u},
                                {2u, 4u, 6u},
                                {1u, 3u, 5u},
                                {3u, 7u, 5u}})
    s.enamel.triangles.push_back({first + a, first + b, first + c});
  MeshImportOptions o = upright(k_sensed_mm);
  EXPECT_TRUE(contradicts(refusal(s, o), "outline"));
  o.sense.confirmed = {"outline"};
  EXPECT_TRUE(tells(import_meshes(s.write(fresh_folder()), o).sense.warnings, "outline"));
}

TEST(Sense, AFrontToothsEdgeTellsTheMesiodistalLine) {
  MeshImportOptions o = upright(k_sensed_mm);
  o.frame.mesial_axis = Vec3{0, 1, 0};
  for (const Surfaces* s : {&incisor(), &premolar()})
    EXPECT_TRUE(contradicts(refusal(*s, o), "mesial"));
  o.frame.mesial_axis.reset();
  o.frame.rotate_deg = 90;
  const auto refused = refusal(incisor(), o);
  ASSERT_TRUE(refused);
  EXPECT_TRUE(turn_in(refused->advice()))
      << "also where nobody said what is mesial: it was measured";
  o.frame.rotate_deg = 0;
  const auto done = import_meshes(incisor().write(fresh_folder()), o);
  EXPECT_FALSE(done.sense.warnings.empty()) << "which end is mesial";
  EXPECT_FALSE(any_turn_in(done.sense.warnings));
}

}  // namespace
}  // namespace cavum
