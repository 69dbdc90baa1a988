// What is wrong with a command line. CLI11 says it in English, and knows only which kind of mistake it is: which option it is about is looked up.
#pragma once

#include <string>
#include <vector>

#include "engine/base/message.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {

/// `app` as the parser left it when it threw.
[[nodiscard]] Message command_line_error(const CLI::ParseError& error, const CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace cavum::ui
