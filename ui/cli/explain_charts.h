// The charts of an explanation's page.
#pragma once

#include <string>

#include "engine/lab/explain/inference/explain.h"
#include "ui/parts/chart_svg.h"

namespace cavum::ui {

// Okabe and Ito's colours: told apart with any colour vision; shapes and dashes say the same again
inline constexpr const char *k_measured = "#7f7f7f", *k_before = "#d55e00", *k_after = "#0072b2",
                            *k_third = "#009e73";
inline constexpr double
    k_narrow_px = 340,
    k_wide_px = 1050;  // read on a telephone: a narrow chart fits, a wide one scrolls in its box

/// A chart with its title and legend above it as text of the page, which breaks where a telephone
/// ends.
[[nodiscard]] std::string figure(Chart chart, const Message& title, const Message& x_label,
                                 const Message& y_label);
/// Measured and simulated over the most telling 12 s, and the residual below.
[[nodiscard]] std::string force_charts(const explain::View& before, const explain::View& after);
/// The residual over all that it may go with, what moves it most first; all on one scale.
[[nodiscard]] std::string residual_charts(const explain::View& before, const explain::View& after);
/// All that the simulation and the other causes leave, and the cause's own force, over what shows
/// it best.
[[nodiscard]] std::string cause_chart(const explain::Cause& cause, const explain::View& after);

}  // namespace cavum::ui
