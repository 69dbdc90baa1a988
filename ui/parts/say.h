// What a verb tells: lines on standard output, and mistakes on standard error, in the reader's
// language.
#pragma once

#include "engine/base/error.h"
#include "engine/base/lines.h"
#include "engine/base/message.h"

namespace cavum::ui {

/// A line on standard output.
void say(const Message& message, int indent = 0);
void say(const Lines& lines);
/// "cavum: ..." on standard error.
void say_error(const Message& message);

}  // namespace cavum::ui
