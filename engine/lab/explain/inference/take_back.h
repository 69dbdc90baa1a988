// What a careful person would not sign is not said: causes are said by a plainer law, or taken
// back.
#pragma once

#include "engine/lab/explain/inference/causes.h"
#include "engine/lab/explain/inference/explain.h"

namespace cavum::explain {

/// The least gain, at the low end of its interval, that a cause and all causes together must have;
/// percent of the error on sessions left out.
inline constexpr double k_min_low_percent = 0.5;

/// Causes that say no more than a plainer law does become it. True: some did.
[[nodiscard]] bool prefer_plainer(CauseSearch& search);
/// Causes that do not help on sessions left out, or whose parameters say nothing, are taken back,
/// or said by a plainer law: the strongest doubt first. `first`: the look without causes. True: a
/// plainer law took a place (only where `by_plainer`).
bool take_back(CauseSearch& search, std::vector<Cause>& causes, const Step& first, bool by_plainer);
/// Takes the least likely cause back where it is less likely than three to one. True: it did.
[[nodiscard]] bool drop_unlikely(CauseSearch& search, Explanation& e);
/// Something was taken back that mattered: nothing named is not the same as nothing there.
[[nodiscard]] bool is_doubted(const CauseSearch& search);

}  // namespace cavum::explain
