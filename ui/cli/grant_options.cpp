#include "ui/cli/grant_options.h"

#include <CLI/CLI.hpp>

#include "ui/language/say.h"

namespace cavum::ui {

void add_grant_options(CLI::App* verb, scenarios::Grant& grant) {
  verb->add_option("--extra-time-percent", grant.extra_time_percent,
                   tr("extra time for this candidate, instead of the scenario's"));
  verb->add_option("--extra-time-s", grant.extra_time_s, tr("the same in seconds; both add up"));
  // by callbacks: bound to an optional, a flag that is not given would be set to false, and take
  // away what the scenario grants
  const std::string shown = tr("for this candidate; recorded and shown with the result");
  const std::string back = tr("takes back what the scenario grants");
  verb->add_flag_callback(
      "--left-handed", [&grant] { grant.left_handed = true; }, shown);
  verb->add_flag_callback(
      "--right-handed", [&grant] { grant.left_handed = false; }, back);
  verb->add_flag_callback(
      "--high-contrast", [&grant] { grant.high_contrast = true; }, shown);
  verb->add_flag_callback(
      "--normal-contrast", [&grant] { grant.high_contrast = false; }, back);
}

}  // namespace cavum::ui
