// The help of the verbs in the reader's language. Names of options and verbs stay as they are typed.
#pragma once

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

#include "engine/base/text.h"
#include "engine/language/shown.h"

namespace cavum::ui {

class HelpInLanguage : public CLI::Formatter {
 public:
  HelpInLanguage() {
    for (const char* english :
         {said("Options"), said("REQUIRED"), said("Usage"), said("Positionals"), said("OPTIONS"), said("SUBCOMMAND"), said("SUBCOMMANDS"),
          said("Needs"), said("Excludes"), said("Env"), said("TEXT"), said("INT"), said("UINT"), said("FLOAT"), said("NUMBER")})
      label(english, shown(english));
  }
  std::string make_group(std::string group, bool is_positional, std::vector<const CLI::Option*> options) const override {
    return CLI::Formatter::make_group(shown(group), is_positional, options);
  }
  std::string make_option_desc(const CLI::Option* option) const override { return shown(CLI::Formatter::make_option_desc(option)); }
  std::string make_description(const CLI::App* app) const override { return shown(CLI::Formatter::make_description(app)); }
  std::string make_footer(const CLI::App* app) const override { return shown(CLI::Formatter::make_footer(app)); }
  std::string make_subcommand(const CLI::App* sub) const override {
    std::stringstream out;
    CLI::detail::format_help(out, sub->get_name(), shown(sub->get_description()), column_width_);
    return out.str();
  }
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override {
    const std::string title = said("Subcommands"), text = CLI::Formatter::make_subcommands(app, mode);
    const std::size_t at = text.find(title);
    return at == std::string::npos ? text : text.substr(0, at) + shown(title) + text.substr(at + title.size());
  }
};

}  // namespace cavum::ui
