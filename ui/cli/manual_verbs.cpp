// The manual page, the shell's completion and the udev rules, made of what the program says of
// itself with --help.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/version.h"
#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/hardware/udev_rule.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"

namespace cavum::ui {
namespace {

/// As roff prints it: no dot or quote may begin a line, and hyphens stay what they are.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\n') {
      out += ' ';
    } else {
      out += c;
    }
  }
  return !out.empty() && (out[0] == '.' || out[0] == '\'') ? "\\&" + out : out;
}

std::vector<const CLI::Option*> shown_options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); });
}

std::vector<const CLI::App*> shown_verbs(const CLI::App& app) {
  return app.get_subcommands(
      [](const CLI::App* verb) { return !verb->get_name().empty() && !verb->get_group().empty(); });
}

void write_verb(std::ostream& out, const CLI::App& verb, const std::string& path) {
  const auto below = shown_verbs(verb);
  if (below.empty()) {
    out << ".SS \"" << roff(path) << "\"\n" << roff(verb.get_description()) << "\n";
    for (const auto* o : shown_options(verb)) {
      const bool takes_value = o->get_expected_max() > 0 && o->get_items_expected_max() > 0;
      const std::string value = takes_value && !o->get_positional() ? " " + o->get_type_name() : "";
      out << ".TP\n.B \"" << roff(o->get_name(o->get_positional(), true) + value) << "\"\n"
          << roff(o->get_description())
          << (o->get_default_str().empty() ? "" : roff(fmt::format(" ({})", o->get_default_str())))
          << "\n";
    }
  }
  for (const auto* v : below) write_verb(out, *v, fmt::format("{} {}", path, v->get_name()));
}

void write_man_page(std::ostream& out, const CLI::App& app) {
  out << ".TH CAVUM 1 \"\" \"cavum " << version() << "\" \"User Commands\"\n"
      << ".SH NAME\ncavum \\- " << roff(app.get_description()) << "\n"
      << ".SH SYNOPSIS\n.B cavum\n.I VERB\n[\n.I ARGUMENT ...\n]\n"
      << ".SH DESCRIPTION\nEach verb explains itself with \\-\\-help. Without anything named, \\fBcavum exam\\fP runs a demonstration.\n"
      << ".SH VERBS\n";
  for (const auto* v : shown_verbs(app)) write_verb(out, *v, "cavum " + v->get_name());
  out << ".SH EXIT STATUS\n0: done. 1: done, and the answer is no. 2: wrong usage, or input that cannot be read.\n"
      << ".SH ENVIRONMENT\n.TP\n.B CAVUM_HOME\nwhere keys, witnesses and settings are kept, instead of ~/.config/cavum\n"
      << ".TP\n.B CAVUM_DATA\nthe data folder, instead of ../share/cavum beside the program\n";
}

std::string names_of(const CLI::App& app) {
  std::string out;
  for (const auto* v : shown_verbs(app)) out += v->get_name() + " ";
  for (const auto* o : shown_options(app))
    for (const auto& name : o->get_lnames()) out += fmt::format("--{} ", name);
  if (!out.empty()) out.pop_back();
  return out;
}

void write_cases(std::ostream& paths, std::ostream& words, const CLI::App& app,
                 const std::string& path) {
  words << "    \"" << path << "\") words=\"" << names_of(app) << "\" ;;\n";
  for (const auto* v : shown_verbs(app)) {
    paths << (paths.tellp() > 0 ? " | " : "") << "\"" << path << " " << v->get_name() << "\"";
    write_cases(paths, words, *v, fmt::format("{} {}", path, v->get_name()));
  }
}

void write_completion(std::ostream& out, const CLI::App& app) {
  std::ostringstream paths, words;
  write_cases(paths, words, app, "");
  out << "# bash completion for cavum, made by `cavum manual --completion`\n"
         "_cavum() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} path=\"\" words=\"\" i\n"
         "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
         "    case \"$path ${COMP_WORDS[i]}\" in\n"
         "    "
      << paths.str()
      << ") path=\"$path ${COMP_WORDS[i]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$path\" in\n"
      << words.str()
      << "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
         "  [[ $cur == -* || -z $path ]] || COMPREPLY+=($(compgen -f -- \"$cur\"))\n"
         "}\n"
         "complete -o filenames -F _cavum cavum\n";
}

void write_udev_rules(std::ostream& out) {
  out << "# Whoever sits at the screen may use the stylus. `cavum devices` names the line that another device needs.\n";
  for (const auto& kind : stylus_kinds().all())
    if (kind.usb)
      out << "# " << english_text(kind.facts.name) << "\n"
          << udev_rule(kind.usb->vendor, kind.usb->product, false) << "\n";
}

}  // namespace

void add_manual_verbs(CLI::App& app, int& exit_code) {
  struct Options {
    bool man = false, completion = false, udev = false;
  };
  const auto o = std::make_shared<Options>();
  auto* verb = app.add_subcommand(
      "manual",
      tr("The manual page (roff), the completion of bash, or the udev rules of the styluses"));
  auto* man = verb->add_flag("--man", o->man, tr("the manual page: cavum manual --man | man -l -"));
  auto* completion =
      verb->add_flag("--completion", o->completion,
                     tr("what bash is to source, so that it completes verbs and options"))
          ->excludes(man);
  verb->add_flag(
          "--udev-rules", o->udev,
          tr("lets whoever sits at the screen use a stylus: for /etc/udev/rules.d/60-cavum.rules"))
      ->excludes(man)
      ->excludes(completion);
  verb->callback([o, &app, &exit_code] {
    if (!o->man && !o->completion && !o->udev)
      throw Error(msg("manual"), msg("is to write nothing"),
                  msg("add --man, --completion or --udev-rules"));
    if (o->udev)
      write_udev_rules(std::cout);
    else
      o->man ? write_man_page(std::cout, app) : write_completion(std::cout, app);
    exit_code = 0;
  });
}

}  // namespace cavum::ui
