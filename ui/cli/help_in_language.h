// What CLI11 itself adds to the help of a verb, in the reader's language: headings, and the words
// for what an option takes.
#pragma once

#include "ui/parts/option_checks.h"

namespace cavum::ui {

/// Before any option or verb is added: they take over the names of the groups.
void help_in_language(CLI::App& app);
/// After all verbs are added: CLI11 gives the help flag of each the English group.
void group_help_flags(CLI::App& app);

}  // namespace cavum::ui
