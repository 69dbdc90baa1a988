// Recordings that say which layer the tool was in (column `layer`): each layer has its own k and c.
#pragma once

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// Fits k and c of every layer by least squares on the rows in contact (F = k X + c V, each held
/// near the fit of all rows where its own rows say little) and sets `relative_k`, `relative_c` to
/// those over the k and c of the layer with most rows, so that what follows fits one k and one c.
/// Notes name the layers. Nothing changes without a column `layer` of 2 to 12 values with 100 rows
/// in contact each, or when the stiffnesses differ by less than 5 %.
void set_layers(Recording& recording);

}  // namespace cavum::explain
