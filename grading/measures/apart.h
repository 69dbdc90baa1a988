// A tooth taken apart from what stands beside it, before and after the exam: all that is measured
// of the cavity is measured on the tooth alone, as if it stood alone; what happened to its
// neighbours and the gum is measured by itself (adjacent.h).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/session/session_reader.h"
#include "engine/tooth/adjacent.h"

namespace cavum::grading {

/// What depends on the tooth before the exam alone.
struct ToothApart {
  Tooth own;          ///< without what stands beside it
  Octree neighbours;  ///< the teeth beside it alone
  TissueSet beside{}, of_neighbours{}, of_gum{};
};
/// Null where nothing stands beside the tooth.
[[nodiscard]] std::shared_ptr<const ToothApart> take_apart(const Tooth& tooth);

/// What depends on the work.
struct WorkApart {
  Octree after;                    ///< of the tooth alone
  std::vector<RemovedAt> removed;  ///< of its own tissues
};
[[nodiscard]] WorkApart take_apart(const ToothApart& tooth, const Octree& after,
                                   std::span<const RemovedAt> removed);

}  // namespace cavum::grading
