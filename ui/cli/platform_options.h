// Options of `cavum serve` that set up learning platforms (LTI 1.3), as the office's page does.
#pragma once

#include <string>

#include "ui/parts/option_checks.h"

namespace cavum::ui {

struct PlatformArguments {
  std::string set, remove, of, link, account;
  bool list = false, new_key = false;
};
void add_platform_options(CLI::App& verb, PlatformArguments& o);
/// False: nothing of it was asked for. `home`: the office's folder. Throws Error.
bool set_up_platforms(const PlatformArguments& o, const std::string& home);

}  // namespace cavum::ui
