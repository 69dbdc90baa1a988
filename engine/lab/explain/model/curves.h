// Dependences on a variable that no mechanism is meant by: flexible curves over every numeric
// column (in air too, in contact, in proportion to the force), the same some time later, and steps
// in time. They say where to look when nothing that has a name fits.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "engine/lab/explain/model/scene.h"

namespace cavum::explain {

struct Curve {
  std::string variable;  ///< name of the column; `t_s` for steps and trends in time
  Message form;          ///< what kind of dependence, for a person
  std::vector<Series> columns;
};

/// Gives them to `take` one after the other, in the order of the columns, those of one variable
/// together: all at once would be large.
void each_curve(const Scene& scene, const std::function<void(Curve)>& take);

}  // namespace cavum::explain
