#include "ui/cli/help_in_language.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>

#include "ui/language/say.h"

namespace cavum::ui {

void help_in_language(CLI::App& app) {
  const auto formatter = std::make_shared<CLI::Formatter>();
  const std::pair<const char*, std::string> labels[] = {{"REQUIRED", tr("REQUIRED")},
                                                        {"Usage", tr("Usage")},
                                                        {"Positionals", tr("Positionals")},
                                                        {"OPTIONS", tr("OPTIONS")},
                                                        {"SUBCOMMAND", tr("SUBCOMMAND")},
                                                        {"SUBCOMMANDS", tr("SUBCOMMANDS")},
                                                        {"Needs", tr("Needs")},
                                                        {"Excludes", tr("Excludes")},
                                                        {"Env", tr("Env")},
                                                        {"TEXT", tr("TEXT")},
                                                        {"INT", tr("INT")},
                                                        {"UINT", tr("UINT")},
                                                        {"FLOAT", tr("FLOAT")},
                                                        {"NUMBER", tr("NUMBER")}};
  for (const auto& [english, own] : labels) formatter->label(english, own);
  app.formatter(formatter);
  app.group(tr("Subcommands"));
  app.option_defaults()->group(tr("Options"));
  app.set_help_flag("-h,--help", tr("Print this help message and exit"));
}

void group_help_flags(CLI::App& app) {
  app.get_help_ptr()->group(tr("Options"));
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    group_help_flags(*verb);
}

}  // namespace cavum::ui
