// `cavum explain --dry-run`: what was understood of a recording, and the page with its plots. And
// the options by which a recording of others is read.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/lab/explain/recording/overview.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {

/// As they stand on the command line.
struct ReadingArgs {
  std::vector<std::string> columns, units, negate;
  double surface_mm = 0.0, lever_mm = 0.0;
  bool as_it_is = false;
  CLI::Option *surface = nullptr, *lever = nullptr;
  /// None of them is given.
  [[nodiscard]] bool empty() const;
};

void add_reading_options(CLI::App& verb, ReadingArgs& args);
/// Throws Error(option, ...) for one that is not of the form NAME=VALUE.
[[nodiscard]] explain::ReadingOptions reading_options(const ReadingArgs& args);
/// Force over position, force and position over time, and what was understood in words. `title`:
/// the recording's name.
[[nodiscard]] std::string overview_html(const explain::Recording& recording,
                                        const explain::Overview& overview,
                                        const std::string& title);

}  // namespace cavum::ui
