#include "ui/cli/command_line_error.h"

#include <CLI/CLI.hpp>

namespace cavum::ui {
namespace {

/// The program, and the verbs that were named, one below the other.
std::vector<const CLI::App*> chosen(const CLI::App& app) {
  std::vector<const CLI::App*> all{&app};
  while (!all.back()->get_subcommands().empty())
    all.push_back(all.back()->get_subcommands().back());
  return all;
}

/// Their options, in the order in which the parser takes them.
std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  std::vector<const CLI::Option*> all;
  for (const CLI::App* verb : chosen(app))
    for (const CLI::Option* o : verb->get_options()) all.push_back(o);
  return all;
}

Message missing(const CLI::App& app) {
  for (const CLI::App* verb : chosen(app)) {
    for (const CLI::Option* o : verb->get_options())
      if (o->get_required() && o->count() == 0) return msg("{} is missing", o->get_name());
    if (verb->get_require_subcommand_min() == 0 || !verb->get_subcommands().empty()) continue;
    std::vector<std::string> names;
    for (const CLI::App* below : verb->get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(below->get_name());
    return msg("a verb is missing, one of {}", list_of(names));
  }
  return {};
}

Message alone(const CLI::App& app) {
  for (const CLI::Option* o : options_of(app))
    for (const CLI::Option* needed : o->get_needs())
      if (o->count() > 0 && needed->count() == 0)
        return msg("{} goes with {} only", o->get_name(), needed->get_name());
  return {};
}

Message together(const CLI::App& app) {
  for (const CLI::Option* o : options_of(app))
    for (const CLI::Option* other : o->get_excludes())
      if (o->count() > 0 && other->count() > 0)
        return msg("{} and {} do not go together", o->get_name(), other->get_name());
  return {};
}

/// Of an option that was named at the end, without what belongs behind it; or with too little or
/// too much.
Message number_of_values(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto options = options_of(app);
  for (const CLI::Option* o : options)
    if (o->count() == 0 && !arguments.empty() && arguments.back().starts_with('-') &&
        o->check_name(arguments.back()))
      return msg("{} needs a value", o->get_name());
  for (const CLI::Option* o : options)
    if (o->count() > 0 && !o->get_callback_run())
      return msg("{} takes another number of values", o->get_name());
  return {};
}

/// The one at which the parser stopped.
Message unreadable(const CLI::App& app) {
  const CLI::Option* last = nullptr;
  for (const CLI::Option* o : options_of(app))
    if (o->count() > 0 && o->get_callback_run()) last = o;
  return last == nullptr ? Message()
                         : msg("{} cannot be '{}'", last->get_name(), list_of(last->results()));
}

}  // namespace

Error command_line_error(const CLI::ParseError& error, const CLI::App& app,
                         const std::vector<std::string>& arguments) {
  Message what;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)
    what = msg("not understood: {}", list_of(app.remaining(true)));
  else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    what = missing(app);
  else if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    what = alone(app);
  else if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    what = together(app);
  else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    what = number_of_values(app, arguments);
  else if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr)
    what = unreadable(app);
  else if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr)
    what = msg("{}", error.what());  // of ui/parts/option_checks.h: in the reader's language
  if (what.empty()) what = msg("the options do not fit together");
  return {CommandLineError::usage, msg("command line"), what,
          msg("see `cavum --help` or `cavum VERB --help`")};
}

Error no_verb(const std::string& name) {
  return {CommandLineError::usage, msg("command line"), msg("there is no verb '{}'", name),
          msg("see `cavum --help`")};
}

}  // namespace cavum::ui
