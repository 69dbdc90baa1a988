#include "grading/measures/apart.h"

#include <algorithm>
#include <iterator>

namespace cavum::grading {

std::shared_ptr<const ToothApart> take_apart(const Tooth& tooth) {
  if (!has_adjacent(tooth)) return nullptr;
  auto apart = std::make_shared<ToothApart>();
  apart->own = own_tooth(tooth);
  apart->neighbours = neighbours_alone(tooth);
  apart->beside = adjacent_tissues(tooth);
  apart->of_neighbours = tissues_of(tooth, TissueKind::neighbour);
  apart->of_gum = tissues_of(tooth, TissueKind::gum);
  return apart;
}

WorkApart take_apart(const ToothApart& tooth, const Octree& after,
                     std::span<const RemovedAt> removed) {
  WorkApart work{octree_without(after, tooth.beside), {}};
  std::copy_if(removed.begin(), removed.end(), std::back_inserter(work.removed),
               [&](const RemovedAt& r) { return !tooth.beside[r.leaf.tissue]; });
  return work;
}

}  // namespace cavum::grading
