#include "engine/tooth/import/import_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/import/layers_fit.h"
#include "engine/tooth/import/read_volume.h"
#include "engine/tooth/import/segment.h"
#include "engine/tooth/make/periodontium.h"
#include "engine/tooth/volume/volume_files.h"
#include "engine/tooth/volume/volume_limits.h"

namespace cavum {
namespace {

/// Catmull-Rom weights of the four voxels around a position t in 0..1 between the middle two.
std::array<double, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t),
          0.5 * (t3 - t2)};
}

/// A field on voxels, read between them. Beyond the volume it is `outside`.
class Field {
 public:
  Field(IVec3 size, const std::vector<float>& values, float outside)
      : size_(size), values_(values), outside_(outside) {}

  [[nodiscard]] float at(IVec3 v) const noexcept {
    if (!lies_in(v, size_)) return outside_;
    return values_[cell_index(v, size_)];
  }
  [[nodiscard]] double linear(Vec3 p) const noexcept {
    const IVec3 l = low(p);
    const double fx = p.x - l.x, fy = p.y - l.y, fz = p.z - l.z;
    const auto along = [&](int y, int z) {
      return at(l + IVec3{0, y, z}) * (1 - fx) + at(l + IVec3{1, y, z}) * fx;
    };
    return (along(0, 0) * (1 - fy) + along(1, 0) * fy) * (1 - fz) +
           (along(0, 1) * (1 - fy) + along(1, 1) * fy) * fz;
  }
  [[nodiscard]] double cubic(Vec3 p) const noexcept {
    const IVec3 l = low(p);
    const auto wx = cubic_weights(p.x - l.x), wy = cubic_weights(p.y - l.y),
               wz = cubic_weights(p.z - l.z);
    double sum = 0.0;
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y) {
        double row = 0.0;
        for (int x = 0; x < 4; ++x)
          row += wx[static_cast<std::size_t>(x)] * at(l + IVec3{x - 1, y - 1, z - 1});
        sum += row * wy[static_cast<std::size_t>(y)] * wz[static_cast<std::size_t>(z)];
      }
    return sum;
  }
  [[nodiscard]] static IVec3 low(Vec3 p) noexcept {
    return {static_cast<std::int32_t>(std::floor(p.x)), static_cast<std::int32_t>(std::floor(p.y)),
            static_cast<std::int32_t>(std::floor(p.z))};
  }

 private:
  IVec3 size_;
  const std::vector<float>& values_;
  float outside_;
};

/// Cells (between eight voxels) whose cubic neighbourhood holds both signs; elsewhere one voxel
/// tells the side.
std::vector<std::uint8_t> mixed_cells(IVec3 size, const std::vector<float>& solid) {
  const Field f(size, solid, -1.0f);
  std::vector<std::uint8_t> mixed(solid.size(), 0);
  const auto nx = static_cast<std::size_t>(size.x), nxy = nx * static_cast<std::size_t>(size.y);
  for (std::int32_t z = 0; z < size.z; ++z)
    for (std::int32_t y = 0; y < size.y; ++y)
      for (std::int32_t x = 0; x < size.x; ++x) {
        const bool in = f.at({x, y, z}) > 0;
        if ((f.at({x + 1, y, z}) > 0) == in && (f.at({x, y + 1, z}) > 0) == in &&
            (f.at({x, y, z + 1}) > 0) == in)
          continue;
        for (int dz = -2; dz <= 2; ++dz)
          for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx) {
              const IVec3 c{x + dx, y + dy, z + dz};
              if (lies_in(c, size))
                mixed[static_cast<std::size_t>(c.z) * nxy + static_cast<std::size_t>(c.y) * nx +
                      static_cast<std::size_t>(c.x)] = 1;
            }
      }
  return mixed;
}

struct Extent : Bounds {
  Vec3 sum;
  std::uint64_t n = 0;
  void add(Vec3 p) {
    Bounds::add(p);
    sum += p;
    ++n;
  }
  [[nodiscard]] Vec3 centroid() const { return n > 0 ? sum / static_cast<double>(n) : Vec3{}; }
};

template <class Visit>
void for_voxels(const Segmentation& s, const Visit& visit) {
  std::size_t i = 0;
  for (std::int32_t z = 0; z < s.size.z; ++z)
    for (std::int32_t y = 0; y < s.size.y; ++y)
      for (std::int32_t x = 0; x < s.size.x; ++x, ++i)
        if (s.tissue[i] != k_air) visit(Vec3{double(x), double(y), double(z)}, s.tissue[i]);
}

TissueGrid resample(const Volume& volume, const Segmentation& s, const Mat3& axes, Vec3 origin,
                    const Extent& box, double leaf_mm, const std::string& where) {
  if (!(leaf_mm > 0 && std::isfinite(leaf_mm)))
    throw Error(ImportError::bad_option, Name{"--leaf-mm"},
                msg("the leaf must be larger than 0 mm"), msg("give 0.05, for example"));
  const double reach = std::max({volume.spacing_mm[0], volume.spacing_mm[1], volume.spacing_mm[2]});
  const auto low = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(std::floor((v - reach) / leaf_mm), -1e8, 1e8)) - 4;
  };
  const auto high = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(std::ceil((v + reach) / leaf_mm), -1e8, 1e8)) + 4;
  };
  const IVec3 first{low(box.low.x), low(box.low.y), low(box.low.z)};
  const IVec3 size = IVec3{high(box.high.x), high(box.high.y), high(box.high.z)} - first;
  check_lattice(size, leaf_mm, where);
  TissueGrid grid;
  grid.allocate(size, leaf_mm, to_vec3(first) * leaf_mm);

  // One voxel beyond the volume's edge is outside, so that a tooth cut by the edge is closed there.
  const Field solid(s.size, s.solid, -1.0f);
  auto enamel = smoothed_indicator(s, k_enamel), pulp = smoothed_indicator(s, k_pulp);
  const auto dentin = smoothed_indicator(s, k_dentin), air = smoothed_indicator(s, k_air);
  for (std::size_t i = 0; i < enamel.size(); ++i) {
    enamel[i] -= dentin[i];
    pulp[i] -= air[i];
  }
  const Field enamel_or_dentin(s.size, enamel, 0.0f), pulp_or_air(s.size, pulp, -1.0f);
  const auto mixed = mixed_cells(s.size, s.solid);
  const auto voxel_of = [&](Vec3 tooth_mm) {
    return volume.voxel_at(axes.transposed(tooth_mm + origin));
  };
  std::vector<float> field(grid.count());
  for (std::int32_t z = 0; z < size.z; ++z)
    for (std::int32_t y = 0; y < size.y; ++y)
      for (std::int32_t x = 0; x < size.x; ++x) {
        const auto i = grid.index({x, y, z});
        const Vec3 p = voxel_of(grid.centre_mm({x, y, z}));
        const IVec3 cell = Field::low(p);
        const bool within = lies_in(cell, s.size);
        const double value = !within || mixed[volume.index(cell)] ? solid.cubic(p) : solid.at(cell);
        field[i] = static_cast<float>(-value);
        if (field[i] < 0)
          grid.tissue[i] = enamel_or_dentin.linear(p) > 0 ? k_enamel : k_dentin;
        else
          grid.tissue[i] = pulp_or_air.linear(p) > 0 ? k_pulp : k_air;
      }
  set_surface_from_field(grid, standard_tissues(), field,
                         [&](Vec3 mm) { return -solid.cubic(voxel_of(mm)); });
  return grid;
}

void require_few_gray(const Volume& volume, const std::string& path) {
  std::uint64_t bytes = 0;
  if (std::filesystem::is_directory(path))
    for (const auto& entry : std::filesystem::directory_iterator(path))
      bytes += entry.is_regular_file() ? entry.file_size() : 0;
  else
    bytes = bytes_of_volume(path);
  if (volume.voxels() > most_gray_voxels(bytes))
    throw Error(path,
                msg("has {} voxels of gray, more than {}, the most for {} bytes of files",
                    volume.voxels(), most_gray_voxels(bytes), bytes),
                msg("crop the volume to the tooth, or save it uncompressed"));
}

/// A volume's tissues, and how they were told apart by gray.
struct Reading {
  Segmentation tissues;
  std::optional<GrayReading> gray;
};
Reading read_tissues(const Volume& volume, const VolumeImportOptions& options,
                     const std::string& path) {
  if (options.labels.empty()) {
    require_few_gray(volume, path);
    const auto levels = find_gray_levels(volume, options.thresholds, path);
    Segmentation s = segment(volume, levels, path);
    const GrayReading gray{.dentin_from = levels.hard,
                           .enamel_from = levels.enamel,
                           .dentin_given = options.thresholds.dentin.has_value(),
                           .enamel_given = options.thresholds.enamel.has_value(),
                           .peaks = levels.peaks,
                           .specks = s.specks,
                           .pores = s.pores,
                           .rim_percent = s.rim_percent};
    return {std::move(s), gray};
  }
  Segmentation s = from_labels(volume, options.labels, path);
  if (s.voxels[k_enamel] > 0 && s.voxels[k_dentin] > 0)
    require_layer_order(pulp_faces(s.size, s.tissue), path,
                        msg("exchange enamel and dentin in --map"));
  return {std::move(s), std::nullopt};
}

/// Where the tooth stands in its own frame: z towards the occlusal surface, the middle of the crown
/// at the origin.
struct Placement {
  ToothAxes frame;
  Vec3 origin;                            // of the tooth, in the turned frame of the volume, mm
  Extent box;                             // of the tooth, in its own frame, mm
  Vec3 crown;                             // widths and height of the enamel, mm
  Vec3 enamel_centroid, dentin_centroid;  // in the volume's frame, mm
};
Placement place_tooth(const Volume& volume, const Segmentation& s, const FrameOptions& options,
                      const std::string& path) {
  Extent enamel, dentin;
  for_voxels(s, [&](Vec3 v, std::uint8_t t) {
    if (t == k_enamel) enamel.add(volume.place_mm(v));
    if (t == k_dentin) dentin.add(volume.place_mm(v));
  });
  if ((enamel.n == 0 || dentin.n == 0) && !options.occlusal_axis)
    throw Error(ImportError::no_tissue, Name{path},
                msg("holds no {}, so there is no occlusal direction",
                    enamel.n == 0 ? msg("enamel") : msg("dentin")),
                msg("give --occlusal-axis x,y,z"));
  Placement out{.frame = tooth_axes(dentin.centroid(), enamel.centroid(), options),
                .origin = {},
                .box = {},
                .crown = {},
                .enamel_centroid = enamel.centroid(),
                .dentin_centroid = dentin.centroid()};
  Extent crown;
  for_voxels(s, [&](Vec3 v, std::uint8_t t) {
    const Vec3 p = out.frame.axes * volume.place_mm(v);
    if (t == k_enamel) crown.add(p);
    if (t != k_periodontium) out.box.add(p);
  });
  if (enamel.n > 0) out.crown = crown.high - crown.low;
  out.origin = enamel.n > 0 ? (crown.low + crown.high) * 0.5 : (out.box.low + out.box.high) * 0.5;
  out.box.low = out.box.low - out.origin;
  out.box.high = out.box.high - out.origin;
  return out;
}

/// Throws Error where a spacing that was assumed makes a tooth that nobody has.
void require_size_of_a_tooth(const Volume& volume, const Extent& box, const std::string& path) {
  const Vec3 extent = box.high - box.low;
  if (const double longest = std::max({extent.x, extent.y, extent.z});
      volume.spacing_assumed && !(longest > 4 && longest < 45))
    throw Error(path,
                msg("the file gives no spacing, and the assumed 0.125 mm would make a tooth of {}",
                    as_mm(longest, k_as_needed)),
                msg("give --spacing-mm"));
}

}  // namespace

VolumeImport import_volume(const std::string& path, const VolumeImportOptions& options) {
  Volume volume = read_volume(path, options.spacing_mm);
  const auto [s, gray] = read_tissues(volume, options, path);
  volume.gray = {};
  const FrameOptions settled = settled_frame(options.frame, options.sense);
  const Placement placed = place_tooth(volume, s, settled, path);
  require_size_of_a_tooth(volume, placed.box, path);

  VolumeImport out;
  if (s.voxels[k_enamel] > 0) {
    check_crown_size(placed.crown, options.sense, path, true, out.sense);
    if (s.voxels[k_dentin] > 0)
      check_upright(placed.frame.axes.row_z, placed.dentin_centroid, placed.enamel_centroid,
                    options.sense, path, out.sense);
  }
  TissueGrid grid =
      resample(volume, s, placed.frame.axes, placed.origin, placed.box, options.leaf_mm, path);
  if (s.voxels[k_enamel] > 0 && s.voxels[k_dentin] > 0) {
    check_closed_pulp(open_pulp(grid), options.sense, path, out.sense);
    tell_bare_dentin(bare_dentin(grid), out.sense);
  }
  const auto around = add_periodontium(grid, options.periodontium_mm);
  out.tooth.octree = Octree(grid, out.tooth.tissues);
  using By = VoxelSpacing::By;
  out.spacing = {options.spacing_mm       ? By::given
                 : volume.spacing_assumed ? By::assumed
                                          : By::file,
                 {volume.spacing_mm[0], volume.spacing_mm[1], volume.spacing_mm[2]}};
  out.native_enamel = s.voxels[k_enamel];
  out.native_dentin = s.voxels[k_dentin];
  out.native_pulp = s.voxels[k_pulp];
  out.pulp_bodies = s.pulp_bodies;
  out.rim_percent = s.rim_percent;
  const auto file = std::filesystem::path(path).filename().string();
  out.tooth.source = {ImportedVolume{file.empty() ? path : file, gray, out.spacing, options.leaf_mm,
                                     placed.frame.source,
                                     around > 0 ? options.periodontium_mm : 0.0}};
  out.tooth.name = "tooth from " + (file.empty() ? path : file);
  sense_tooth(out.tooth, settled, options.sense, path, out.sense);
  name_tooth(out.sense, options.sense, settled.mirror, out.tooth);
  return out;
}

}  // namespace cavum
