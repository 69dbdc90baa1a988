#include "ui/station/tooth_drawing.h"

namespace cavum {

ToothDrawing::Drawn ToothDrawing::made(SurfacePatches surface) {
  Drawn drawn{std::move(surface), {}};
  drawn.meshes.resize(drawn.surface.count());
  for (std::size_t i = 0; i < drawn.meshes.size(); ++i) drawn.meshes[i].put(drawn.surface.patch(i));
  return drawn;
}

ToothDrawing::ToothDrawing(const Octree& tooth, bool with_pulp) : leaves_(tooth), hard_(made(SurfacePatches(leaves_))) {
  if (with_pulp) pulp_ = made(SurfacePatches(leaves_, k_pulp));
}

std::size_t ToothDrawing::update(Drawn& drawn) {
  touched_.clear();
  drawn.surface.update(leaves_, changed_, touched_);
  for (const std::uint32_t i : touched_) drawn.meshes[i].put(drawn.surface.patch(i));
  return touched_.size();
}

std::size_t ToothDrawing::update() {
  if (changed_.empty()) return 0;
  std::size_t patches = update(hard_);
  if (pulp_) patches += update(*pulp_);
  changed_.clear();
  ++version_;
  return patches;
}

void ToothDrawing::draw(const Drawn& drawn) {
  for (const GpuMesh& mesh : drawn.meshes) mesh.draw();
}

}  // namespace cavum
