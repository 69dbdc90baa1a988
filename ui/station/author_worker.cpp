#include "ui/station/author_worker.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/message_from.h"
#include "engine/tooth/anatomy/placed.h"
#include "engine/tooth/marching.h"
#include "engine/tooth/surface_mesh.h"
#include "scenarios/file/bodies.h"
#include "scenarios/file/surface_files.h"
#include "scenarios/review/check.h"
#include "scenarios/zones/placed.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::station {
namespace {

/// Leaves `step` apart in a box (low, high exclusive) that `inside` says yes to, as a smooth
/// surface.
template <class Inside>
MeshData body_of(const Octree& tooth, IVec3 low, IVec3 high, int step,
                 const std::array<std::uint8_t, 4>& colour, const Inside& inside) {
  const IVec3 from = low - IVec3{step, step, step}, span = high - low;
  const IVec3 size{span.x / step + 4, span.y / step + 4, span.z / step + 4};
  std::vector<std::uint8_t> in;
  in.reserve(cells_of(size));
  const auto rim = [](int i, int n) { return i == 0 || i == n - 1; };
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const bool edge = rim(x, size.x) || rim(y, size.y) || rim(z, size.z);
        in.push_back(!edge && inside(from + IVec3{x * step, y * step, z * step}) ? 1 : 0);
      }
  TriangleMesh mesh = march_tetrahedra(size, tooth.centre_mm(from), step * tooth.leaf_mm(), in,
                                       [](IVec3, IVec3) { return 0.5; });
  // steps of leaves are no walls: each corner goes to the middle of its neighbours, a few times
  constexpr int k_rounds = 4;
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<Vec3> sum(mesh.vertices_mm.size());
    std::vector<int> count(mesh.vertices_mm.size(), 0);
    for (const auto& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        sum[t[i]] += mesh.vertices_mm[t[(i + 1) % 3]] + mesh.vertices_mm[t[(i + 2) % 3]];
        count[t[i]] += 2;
      }
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (count[i] > 0) mesh.vertices_mm[i] = sum[i] / count[i];
  }
  return smooth_shaded(mesh, colour);
}

bool counts_from_chamber(const scenarios::Scenario& s) {
  const auto does = [](const scenarios::ShapeSpec& shape) {
    const auto* outline = scenarios::field_of<scenarios::OutlineField>(shape);
    return outline != nullptr && outline->seen == scenarios::OutlineSeen::from_occlusal &&
           shape.outline.from_chamber;
  };
  return std::any_of(s.zones.target.begin(), s.zones.target.end(), does) ||
         std::any_of(s.zones.protected_shapes.begin(), s.zones.protected_shapes.end(), does);
}

}  // namespace

std::array<MeshData, k_author_layers> zone_bodies(const scenarios::ZoneMap& zones,
                                                  const Octree& tooth) {
  const auto colour = [](AuthorLayer layer, std::uint8_t opacity) -> std::array<std::uint8_t, 4> {
    const auto c = layer_colour(layer);
    return {c[0], c[1], c[2], opacity};
  };
  const IVec3 low = zones.low(), high = zones.low() + zones.size();
  std::array<MeshData, k_author_layers> bodies;
  bodies[0] = body_of(tooth, low, high, 1, colour(AuthorLayer::target, 130),
                      [&](IVec3 l) { return zones.zone(l) == scenarios::Zone::target; });
  bodies[1] = body_of(tooth, low, high, 2, colour(AuthorLayer::leeway, 80), [&](IVec3 l) {
    const scenarios::Zone z = zones.zone(l);
    return z == scenarios::Zone::target || z == scenarios::Zone::leeway_sides ||
           z == scenarios::Zone::leeway_bottom;
  });
  bodies[2] = body_of(tooth, low, high, 2, colour(AuthorLayer::container, 80), [&](IVec3 l) {
    const scenarios::Zone z = zones.zone(l);
    return z != scenarios::Zone::none && z != scenarios::Zone::protected_;
  });
  // anywhere in the tooth, coarser
  constexpr int k_coarse = 3;
  if (zones.count(scenarios::Zone::protected_) > 0)
    bodies[3] = body_of(tooth, {0, 0, 0}, tooth.size(), k_coarse, colour(AuthorLayer::guarded, 90),
                        [&](IVec3 l) { return zones.zone(l) == scenarios::Zone::protected_; });
  return bodies;
}

void AuthorWorker::look_at(AuthorTask task) {
  const std::lock_guard lock(mutex_);
  task_ = std::move(task);
  asked_.notify_one();
}

std::unique_ptr<AuthorFindings> AuthorWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::move(found_);
}

void AuthorWorker::publish(AuthorFindings findings) {
  auto found = std::make_unique<AuthorFindings>(std::move(findings));
  const std::lock_guard lock(mutex_);
  found_ = std::move(found);
}

void AuthorWorker::work(const std::stop_token& stop) {
  for (;;) {
    AuthorTask task;
    {
      std::unique_lock lock(mutex_);
      if (!asked_.wait(lock, stop, [this] { return task_.has_value(); })) return;
      task = std::move(*task_);
      task_.reset();
    }
    find(task);
  }
}

std::shared_ptr<const AuthorTooth> AuthorWorker::tooth_of(const scenarios::Scenario& scenario,
                                                          std::uint64_t reading) {
  if (scenario.tooth_file.empty()) return nullptr;
  try {
    const std::string file = scenarios::find_tooth_file(scenario);
    if (tooth_ == nullptr || tooth_->file != file || reading_ != reading)
      tooth_ = std::make_shared<const AuthorTooth>(read_author_tooth(file));
    reading_ = reading;
    return tooth_;
  } catch (const Error&) {
    return nullptr;  // the check says why
  }
}

void AuthorWorker::find(const AuthorTask& task) {
  AuthorFindings f;
  f.version = task.version;
  scenarios::ReadScenario read = scenarios::read_scenario(task.text, task.path);
  scenarios::Scenario& s = read.scenario;
  f.tooth = tooth_of(s, task.reading);
  std::optional<Tooth> tooth;
  try {
    scenarios::SurfaceFiles files;
    const bool whole = read.problems.empty() && scenarios::read_surfaces(s, files).empty();
    if (f.tooth) {
      tooth = f.tooth->tooth;
      tooth->placed_landmarks = task.landmarks;
    }
    if (tooth && counts_from_chamber(s))
      f.chamber_mm =
          scenarios::tissue_relief(*tooth, "pulp", scenarios::TissuePart::chamber, Name{task.path})
              .middle_mm;
    if (whole && tooth && scenarios::missing_tissues(s, *tooth).empty()) {
      Landmarks landmarks = f.tooth->found;
      place_landmarks(task.landmarks, landmarks);
      const scenarios::ZoneMap zones = scenarios::build_zones(s, *tooth, landmarks);
      f.target_low_mm = zones.target_low_mm();
      f.target_high_mm = zones.target_high_mm();
      f.opening_z_mm = zones.opening_z_mm();
      f.body = zone_bodies(zones, tooth->octree);
      publish(f);
    }
  } catch (const Error&) {
    // why there are no zones is one of the problems that the check finds now
  }
  try {
    scenarios::CheckedScenario checked =
        tooth ? scenarios::check_whole_on(*tooth, task.text, task.path)
              : scenarios::check_whole(task.text, task.path);
    f.problems = std::move(checked.problems);
    f.expert_s = checked.expert.time_s;
  } catch (const std::exception& e) {
    f.problems = {{{task.path}, message_from(e), msg("mend it in a text editor")}};
  }
  f.checked = true;
  publish(std::move(f));
}

}  // namespace cavum::station
