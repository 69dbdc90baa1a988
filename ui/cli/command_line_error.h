// What is wrong with a command line. CLI11 says it in English, and knows only which kind of mistake
// it is: which option it is about is looked up.
#pragma once

#include <string>
#include <vector>

#include "engine/base/error.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {

#define CAVUM_COMMAND_LINE_ERRORS(ERROR) ERROR(usage)
CAVUM_NAMED_ENUM(CommandLineError, CAVUM_COMMAND_LINE_ERRORS)

/// `app` as the parser left it when it threw.
[[nodiscard]] Error command_line_error(const CLI::ParseError& error, const CLI::App& app,
                                       const std::vector<std::string>& arguments);

/// Of a first argument that is no verb.
[[nodiscard]] Error no_verb(const std::string& name);

}  // namespace cavum::ui
