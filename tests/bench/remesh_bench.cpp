// What the surface for the eye costs: made whole, and again where a ball of 0.5 mm was cut into the
// molar. Prints triangles, memory, and the time of a remesh (leaves taken from the octree, patches
// made anew) beside that of a whole one in the same run.
//   remesh_bench [TOOTH.cvt] [CUTS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/base/random.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/octree_edit.h"
#include "engine/tooth/surface_mesh.h"
#include "engine/tooth/surface_patches.h"
#include "tests/bench/thread_clock.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::Ball;

double share(std::vector<double> v, double of) {
  std::sort(v.begin(), v.end());
  return v[std::min(v.size() - 1, static_cast<std::size_t>(of * static_cast<double>(v.size())))];
}

void print(const char* what, const std::vector<double>& us) {
  std::printf("%-46s median %8.0f us   p99 %8.0f us   worst %8.0f us\n", what, share(us, 0.5),
              share(us, 0.99), share(us, 1.0));
}

void run(Tooth tooth, int cuts) {
  Octree& tree = tooth.octree;
  tree.reserve_edits(1 << 16);
  double begin = thread_us();
  LeafBlocks blocks(tree);
  const double copying = thread_us() - begin;
  begin = thread_us();
  SurfacePatches hard(blocks);
  const double whole = thread_us() - begin;
  begin = thread_us();
  SurfacePatches enamel(blocks, k_enamel), dentin(blocks, k_dentin), pulp(blocks, k_pulp);
  const double tissues = thread_us() - begin;
  std::size_t full = 0, vertices = 0;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // vertices to cut at
  for (std::size_t p = 0; p < hard.count(); ++p) {
    full += !hard.patch(p).triangles.empty();
    vertices += hard.patch(p).vertices.size();
    for (std::size_t v = 0; v < hard.patch(p).vertices.size(); v += 97)
      if (hard.patch(p).vertices[v].position_mm[2] > 0) places.emplace_back(p, v);
  }
  std::printf("%s, leaf %.3f mm\n", tooth.name.c_str(), tree.leaf_mm());
  std::printf("  hard tissue: %zu triangles, %zu vertices in %zu patches; octree %.1f MB\n",
              hard.triangle_count(), vertices, full,
              1e-6 * static_cast<double>(tree.memory_bytes()));
  std::printf("  enamel, dentin, pulp: %zu, %zu, %zu triangles\n", enamel.triangle_count(),
              dentin.triangle_count(), pulp.triangle_count());
  std::printf("  whole: leaves copied %.0f us, hard tissue made %.0f us, three tissues %.0f us\n",
              copying, whole, tissues);
  begin = thread_us();
  const TriangleMesh tetrahedra = surface_mesh(tooth, "solid");
  std::printf("  by marching tetrahedra (surface_mesh): %zu triangles, %.0f us\n",
              tetrahedra.triangles.size(), thread_us() - begin);

  Random random(7);
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 17);
  std::vector<LeafBounds> changed;
  std::vector<std::uint32_t> touched, of_tissues;
  std::vector<double> take_us, hard_us, both_us, three_us, patches;
  for (int i = 0; i < cuts; ++i) {
    const auto place = places[random.below(static_cast<std::uint32_t>(places.size()))];
    const auto& patch = hard.patch(place.first);
    if (patch.vertices.empty()) continue;
    const auto& v = patch.vertices[place.second % patch.vertices.size()].position_mm;
    const Vec3 at{v[0], v[1], v[2]};
    const double radius = 0.25, r = radius + 3 * tree.leaf_mm();
    removed.clear();
    changed.clear();
    touched.clear();
    if (!tree.carve(at - Vec3{r, r, r}, at + Vec3{r, r, r}, Ball{at, radius}, removed)) break;
    begin = thread_us();
    blocks.take(tree, changed);
    const double taken = thread_us();
    hard.update(blocks, changed, touched);
    const double made = thread_us();
    for (auto* s : {&enamel, &dentin, &pulp}) s->update(blocks, changed, of_tissues);
    take_us.push_back(taken - begin);
    hard_us.push_back(made - taken);
    both_us.push_back(made - begin);
    three_us.push_back(thread_us() - made);
    patches.push_back(static_cast<double>(touched.size()));
  }
  std::printf(
      "  %zu balls of 0.5 mm diameter at random places of the surface; %.0f patches touched in the median\n",
      take_us.size(), share(patches, 0.5));
  print("  leaves taken (octree must stand still)", take_us);
  print("  hard tissue made anew", hard_us);
  print("  both", both_us);
  print("  enamel, dentin and pulp besides", three_us);
  std::printf("  a whole remesh costs %.0f times a cut's in the median\n",
              (copying + whole) / share(both_us, 0.5));
}

}  // namespace
}  // namespace cavum

int main(int argc, char** argv) {
  using namespace cavum;
  const int cuts = argc > 2 ? std::atoi(argv[2]) : 400;
  run(argc > 1 && std::string(argv[1]) != "molar" ? load_tooth_file(argv[1]) : make_molar({}),
      cuts);
}
