// How sure a named cause is: the share of causes named under like circumstances that were true, on
// three outside generators.
#pragma once

#include "engine/base/message.h"
#include "engine/lab/explain/inference/explain.h"

namespace cavum::explain {

/// Fills the probabilities of `e.causes`, 0 to 1. A set's (the cause or one that fits as well):
/// logistic in what the data left open; the cause's own: its share by fit, exp(-behind/(2 s)) for
/// each that fits as well, with s for laws that are not quite those of nature (tempered likelihood:
/// Bissiri, Holmes and Walker 2016). docs/statistics.md has the coefficients and the calibration.
void set_probabilities(Explanation& e);

/// "very likely" and so on; of IPCC's calibrated words (Mastrandrea et al. 2010).
[[nodiscard]] Message probability_words(double probability);

}  // namespace cavum::explain
