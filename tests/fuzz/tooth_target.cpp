// A tooth file. Its checksum would turn away nearly all that a fuzzer makes, so the first byte says
// how the rest is wrapped: 0 as it is, 1 as all but magic and checksum, which are put right, 2 as
// all but the checksum.
#include <cstdlib>

#include "engine/tooth/tooth.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

constexpr std::size_t k_magic = 8, k_sum = 32;

/// Two bricks of 0.8 mm: one of dentin and enamel in air, one of air and pulp.
Tooth smallest_tooth() {
  Tooth tooth;
  tooth.name = "small";
  tooth.tissues = standard_tissues();
  TissueGrid grid;
  grid.allocate({16, 8, 8}, 0.1, {-0.8, -0.4, -0.4});
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) {
        const Vec3 c = grid.centre_mm({x, y, z});
        const auto i = grid.index({x, y, z});
        const double outside = length(c - Vec3{-0.3, 0, 0}) - 0.4;
        if (outside < 0) grid.tissue[i] = c.z > 0.1 ? k_enamel : k_dentin;
        if (x > 13) grid.tissue[i] = k_pulp;
        grid.distance[i] = encode_distance(outside / grid.leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  return tooth;
}

Bytes sealed(Bytes file) {
  const Sha256 sum = sha256(file);
  file.insert(file.end(), sum.begin(), sum.end());
  return file;
}

Bytes unwrapped(std::uint8_t how, Data rest) {
  Bytes file(rest.begin(), rest.end());
  if (how % 3 == 0) return file;
  if (how % 3 == 1) file.insert(file.begin(), {'C', 'V', 'T', 'O', 'O', 'T', 'H', '1'});
  return sealed(file);
}

Bytes with(std::uint8_t how, Data rest) {
  Bytes out;
  out.reserve(rest.size() + 1);
  out.push_back(how);
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

}  // namespace

void fuzz_tooth(Data data) {
  if (data.empty()) return;
  try {
    const Tooth tooth = load_tooth(unwrapped(data[0], data.subspan(1)), "tooth.cvt");
    if (tooth_hash(load_tooth(save_tooth(tooth), "saved again")) != tooth_hash(tooth)) std::abort();
  } catch (const Error&) {
  }
}

std::vector<Bytes> tooth_seeds() {
  const Tooth tooth = smallest_tooth();
  const Bytes file = save_tooth(tooth);
  Tooth marked = tooth;
  marked.placed_landmarks = {{"central_pit", {0.1, 0.2, 0.3}}, {"cusp_1", {-0.3, 0, 0.4}}};
  const Bytes more = save_tooth(marked);
  return {with(0, file), with(2, Data(file).first(file.size() - k_sum)),
          with(1, Data(more).subspan(k_magic, more.size() - k_magic - k_sum))};
}

}  // namespace cavum::fuzz
