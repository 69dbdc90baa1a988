#include "engine/tooth/import/import_volume.h"

#include <gtest/gtest.h>

#include "engine/base/file_error.h"
#include "engine/base/random.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/import/segment.h"
#include "tests/engine/tooth/import/import_testing.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::volume_mm3;

using namespace testing_import;

/// A ball-headed pillar: crown = ball of radius 4 mm, root = cylinder of radius 2.6 mm downwards,
/// broken off flat; pulp = ball of radius 1.5 mm with a canal of radius 0.4 mm that is open at the
/// broken end; enamel 1.2 mm thick around the crown.
std::uint8_t tissue_of_phantom(Vec3 p) {
  const double r = length(p), across = std::sqrt(p.x * p.x + p.y * p.y);
  const bool root = across < 2.6 && p.z < 0 && p.z > -8;
  if (r > 4 && !root) return k_air;
  if (r < 1.5 || (across < 0.4 && p.z < 0 && p.z > -8)) return k_pulp;
  return r < 4 && r > 2.8 && p.z > -1.5 ? k_enamel : k_dentin;
}

constexpr double k_spacing_mm = 0.2;

Voxels phantom(const std::function<double(std::uint8_t)>& gray, bool partial_volume, double noise) {
  Voxels v{50, 50, 70, k_spacing_mm, {}};
  v.gray.resize(static_cast<std::size_t>(v.nx * v.ny * v.nz));
  Random random(7);
  for (int z = 0; z < v.nz; ++z)
    for (int y = 0; y < v.ny; ++y)
      for (int x = 0; x < v.nx; ++x) {
        double sum = 0;
        const int n = partial_volume ? 3 : 1;
        for (int i = 0; i < n * n * n; ++i) {
          const Vec3 sub{(i % n + 0.5) / n - 0.5, (i / n % n + 0.5) / n - 0.5,
                         (i / n / n + 0.5) / n - 0.5};
          // partial volumes reach over 1.6 voxels, as a scanner blurs them
          const Vec3 at =
              Vec3{double(x), double(y), double(z)} + sub * (partial_volume ? 1.6 : 1.0);
          sum += gray(tissue_of_phantom(Vec3{at.x - 24.5, at.y - 24.5, at.z - 45} * k_spacing_mm));
        }
        v.gray[v.index(x, y, z)] = static_cast<std::uint8_t>(
            std::lround(std::clamp(sum / (n * n * n) + noise * random.normal(), 0.0, 255.0)));
      }
  return v;
}

/// Dry tooth: the pulp is darker than the medium.
Voxels ct() {
  return phantom(
      [](std::uint8_t t) {
        return t == k_air ? 78.0 : t == k_pulp ? 26.0 : t == k_dentin ? 162.0 : 235.0;
      },
      true, 3.0);
}
Voxels labels() {
  return phantom([](std::uint8_t t) { return static_cast<double>(t); }, false, 0);
}

/// Volumes of the phantom, counted on a fine grid.
std::array<double, 4> phantom_mm3() {
  std::array<double, 4> v{};
  const double h = 0.05;
  for (double z = -8.2; z < 4.2; z += h)
    for (double y = -4.2; y < 4.2; y += h)
      for (double x = -4.2; x < 4.2; x += h)
        v[tissue_of_phantom({x + h / 2, y + h / 2, z + h / 2})] += h * h * h;
  return v;
}

VolumeImportOptions volume_options(double leaf_mm = 0.1) {
  VolumeImportOptions o;
  o.leaf_mm = leaf_mm;
  o.periodontium_mm = 0;
  return o;
}

void expect_spacing_of_the_file(const VolumeImport& done) {
  const VoxelSpacing& spacing = std::get<ImportedVolume>(done.tooth.source.at(0)).spacing;
  EXPECT_EQ(spacing.by, VoxelSpacing::By::file);
  for (const double mm : {spacing.mm.x, spacing.mm.y, spacing.mm.z}) EXPECT_NEAR(mm, 0.2, 1e-7);
}

TEST(ImportCt, FindsTissuesWithADarkPulpAndAPartialVolumeRim) {
  const auto done = import_volume(write_mhd(fresh_folder(), ct(), "0.2 0.2 0.2"), volume_options());
  const auto truth = phantom_mm3();
  EXPECT_NEAR(volume_mm3(done.tooth, k_enamel), truth[k_enamel], 0.04 * truth[k_enamel]);
  EXPECT_NEAR(volume_mm3(done.tooth, k_dentin), truth[k_dentin], 0.04 * truth[k_dentin]);
  EXPECT_NEAR(volume_mm3(done.tooth, k_pulp), truth[k_pulp], 0.06 * truth[k_pulp]);
  EXPECT_EQ(done.pulp_bodies, 1u);
  EXPECT_LT(done.rim_percent, 1.0);
  EXPECT_EQ(done.spacing.by, VoxelSpacing::By::file);
  // Straight down through the crown there is enamel first, not a rim of dentin.
  std::uint8_t before = k_air;
  std::vector<std::uint8_t> order;
  for (double z = 5; z > -3.5; z -= 0.02) {
    const auto t = done.tooth.octree.tissue_at({0.3, 0.2, z});
    if (t != before) order.push_back(t);
    before = t;
  }
  ASSERT_GE(order.size(), 3u);
  EXPECT_EQ(order[0], k_enamel);
  EXPECT_EQ(order[1], k_dentin);
  EXPECT_EQ(order[2], k_pulp);
  // The canal stays pulp down to near the broken end.
  EXPECT_EQ(done.tooth.octree.tissue_at(Vec3{0, 0, -7} - Vec3{0, 0, 1.2}), k_pulp);
}

// A ball cut from voxels twice the leaf: the surface must lie on the sphere, without steps.
TEST(ImportCt, TheSurfaceShowsNoSteps) {
  const auto volume = phantom(
      [](std::uint8_t t) {
        return t == k_air ? 78.0 : t == k_pulp ? 26.0 : t == k_dentin ? 162.0 : 235.0;
      },
      true, 0.0);
  const auto done =
      import_volume(write_mhd(fresh_folder(), volume, "0.2 0.2 0.2"), volume_options());
  Octree::Cursor cursor;
  // The frame's origin comes from the enamel's voxels, so the ball's centre is known to a voxel
  // only: fit its height.
  std::vector<std::pair<double, double>> seen;  // cosine of the polar angle, distance
  double sum_c = 0, sum_d = 0, sum_cc = 0, sum_cd = 0;
  for (int i = 0; i < 4000; ++i) {
    const double u = 0.3 + 0.9 * (i % 61) / 61.0, w = 6.283 * (i % 97) / 97.0;
    const Vec3 n{std::sin(u) * std::cos(w), std::sin(u) * std::sin(w), std::cos(u)};
    const double d = done.tooth.octree.sample(Vec3{0, 0, -1.25} + n * 4.0, cursor).distance_mm;
    seen.emplace_back(n.z, d);
    sum_c += n.z;
    sum_d += d;
    sum_cc += n.z * n.z;
    sum_cd += n.z * d;
  }
  const double k = static_cast<double>(seen.size()),
               slope = (k * sum_cd - sum_c * sum_d) / (k * sum_cc - sum_c * sum_c);
  double low = 1e9, high = -1e9;
  for (const auto& [c, d] : seen) {
    low = std::min(low, d - sum_d / k - slope * (c - sum_c / k));
    high = std::max(high, d - sum_d / k - slope * (c - sum_c / k));
  }
  std::cout << "surface on the ball: " << low << " to " << high << " mm about its mean\n";
  EXPECT_LT(high - low, 0.06) << "0.3 of a voxel; steps would show a whole one";
}

TEST(ImportCt, MissingSpacingIsAssumedAndSaid) {
  const auto done = import_volume(write_mhd(fresh_folder(), ct(), "1 1 1"), volume_options());
  EXPECT_EQ(done.spacing.by, VoxelSpacing::By::assumed);
  EXPECT_EQ(std::get<ImportedVolume>(done.tooth.source.at(0)).spacing.by,
            VoxelSpacing::By::assumed);
  auto given = volume_options();
  given.spacing_mm = Vec3{0.2, 0.2, 0.2};
  const auto told = import_volume(write_mhd(fresh_folder(), ct(), "1 1 1"), given);
  EXPECT_EQ(told.spacing.by, VoxelSpacing::By::given);
  EXPECT_EQ(std::get<ImportedVolume>(told.tooth.source.at(0)).spacing.mm, (Vec3{0.2, 0.2, 0.2}));
}

TEST(ImportCt, ExplicitThresholdsAreObeyed) {
  const auto path = write_mhd(fresh_folder(), ct(), "0.2 0.2 0.2");
  auto o = volume_options(0.2);
  o.thresholds.dentin = 120;
  o.thresholds.enamel = 250;
  EXPECT_EQ(code_of([&] { (void)import_volume(path, o); }), ImportError::no_tissue);
  o.thresholds.enamel = 100;
  EXPECT_EQ(place_of(thrown_by([&] { (void)import_volume(path, o); })), "--enamel-threshold");
  o.thresholds.enamel = 200;
  EXPECT_NEAR(volume_mm3(import_volume(path, o).tooth, k_enamel), phantom_mm3()[k_enamel],
              0.12 * phantom_mm3()[k_enamel]);
}

TEST(ImportCt, DamagedOrEmptyVolumesAreErrors) {
  const auto folder = fresh_folder();
  const auto path = write_mhd(folder, ct(), "0.2 0.2 0.2");
  fs::resize_file(folder / "v.raw", fs::file_size(folder / "v.raw") - 1);
  const auto refused = [](const std::string& file) {
    return thrown_by([&] { (void)import_volume(file, volume_options()); });
  };
  EXPECT_EQ(code_of(refused(path)), FileError::truncated);
  EXPECT_EQ(place_of(refused(path)), (folder / "v.raw").string());
  fs::remove(folder / "v.raw");
  EXPECT_EQ(code_of(refused(path)), FileError::missing);
  EXPECT_EQ(code_of(refused((folder / "none.nrrd").string())), FileError::missing);
  const auto nrrd = write_nrrd(folder / "l.nrrd", labels());
  fs::resize_file(nrrd, fs::file_size(nrrd) / 2);
  EXPECT_EQ(code_of(refused(nrrd)), FileError::truncated);
  const auto nifti = write_nifti(folder / "l.nii", labels());
  fs::resize_file(nifti, fs::file_size(nifti) - 100);
  EXPECT_EQ(code_of(refused(nifti)), FileError::truncated);
  std::ofstream(folder / "text.nrrd") << "hello";
  EXPECT_TRUE(refused((folder / "text.nrrd").string()));

  Voxels flat = ct();
  std::fill(flat.gray.begin(), flat.gray.end(), std::uint8_t{78});
  EXPECT_EQ(code_of(refused(write_mhd(folder, flat, "0.2 0.2 0.2"))), ImportError::no_tooth);
  Random random(3);
  for (auto& g : flat.gray) g = static_cast<std::uint8_t>(70 + random.below(17));
  EXPECT_EQ(code_of(refused(write_mhd(folder, flat, "0.2 0.2 0.2"))), ImportError::no_tooth);
}

TEST(ImportDicom, ASeriesIsReadAndAHoleIsAnError) {
  const auto folder = fresh_folder();
  const Voxels v = ct();
  for (int z = 0; z < v.nz; ++z)
    write_dicom_slice(folder / ("s" + std::to_string(z) + ".dcm"), v, z);
  const auto done = import_volume(folder.string(), volume_options(0.2));
  const auto truth = phantom_mm3();
  EXPECT_NEAR(volume_mm3(done.tooth, k_dentin), truth[k_dentin], 0.06 * truth[k_dentin]);
  expect_spacing_of_the_file(done);
  fs::remove(folder / "s33.dcm");
  const auto hole = thrown_by([&] { (void)import_volume(folder.string(), volume_options(0.2)); });
  EXPECT_EQ(code_of(hole), FileError::inconsistent);
  for (const char* slice : {"s32.dcm", "s34.dcm"}) EXPECT_TRUE(tells(hole, slice)) << slice;
}

TEST(ImportLabelMap, NrrdAndNiftiGiveTheirTissues) {
  const auto folder = fresh_folder();
  const auto truth = phantom_mm3();
  auto o = volume_options();
  o.labels = parse_label_map("1=enamel,2=dentin,3=pulp");
  for (const auto& path :
       {write_nrrd(folder / "l.nrrd", labels()), write_nifti(folder / "l.nii", labels())}) {
    const auto done = import_volume(path, o);
    EXPECT_NEAR(volume_mm3(done.tooth, k_enamel), truth[k_enamel], 0.05 * truth[k_enamel]) << path;
    EXPECT_NEAR(volume_mm3(done.tooth, k_dentin), truth[k_dentin], 0.05 * truth[k_dentin]) << path;
    EXPECT_NEAR(volume_mm3(done.tooth, k_pulp), truth[k_pulp], 0.08 * truth[k_pulp]) << path;
    expect_spacing_of_the_file(done);
    EXPECT_EQ(done.tooth.octree.tissue_at({0, 0, 2.0}), k_enamel);
    EXPECT_EQ(done.tooth.octree.tissue_at({0, 0, -1.3}), k_pulp);
  }
}

TEST(ImportLabelMap, ExchangedLayersAreTheSameErrorAsForMeshes) {
  const auto path = write_nrrd(fresh_folder() / "l.nrrd", labels());
  auto o = volume_options();
  o.labels = parse_label_map("2=enamel,1=dentin,3=pulp");
  EXPECT_EQ(code_of([&] { (void)import_volume(path, o); }), ImportError::layers_exchanged);
  o.labels = parse_label_map("1=enamel,2=dentin,3=air");
  EXPECT_NO_THROW((void)import_volume(path, o))
      << "a tooth without pulp says nothing about the order";
}

TEST(ImportLabelMap, LabelsWithoutMeaningAreListed) {
  const auto path = write_nrrd(fresh_folder() / "l.nrrd", labels());
  auto o = volume_options();
  o.labels = parse_label_map("1=enamel");
  const auto error = thrown_by([&] { (void)import_volume(path, o); });
  EXPECT_EQ(code_of(error), ImportError::unknown_labels);
  EXPECT_TRUE(tells(error, 2) && tells(error, 3)) << error->what();
  for (const char* bad : {"", "1", "1=bone", "x=enamel", "1=enamel,1=dentin"})
    EXPECT_EQ(code_of([&] { (void)parse_label_map(bad); }), ImportError::bad_option) << bad;
}

}  // namespace
}  // namespace cavum
