// Dependences on a variable that no mechanism is meant by: flexible curves over every numeric column (in air too, in contact, in proportion to the
// force), the same some time later, and steps in time. They say where to look when nothing that has a name fits.
#pragma once

#include <string>
#include <vector>

#include "engine/explain/model/scene.h"

namespace cavum::explain {

struct Curve {
  std::string variable;  ///< name of the column; `t_s` for steps and trends in time
  std::string form;      ///< what kind of dependence, for a person
  std::vector<Series> columns;
};

/// In the order of the columns, those of one variable together.
[[nodiscard]] std::vector<Curve> curves_of(const Scene& scene);

}  // namespace cavum::explain
