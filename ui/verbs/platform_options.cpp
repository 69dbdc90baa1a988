#include "ui/verbs/platform_options.h"

#include <fmt/core.h>

#include <iostream>

#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "ui/office/accounts.h"
#include "ui/office/lti/platforms.h"

namespace cavum::ui {
namespace {

/// The platform that an option names by its issuer, or "ISSUER CLIENT" where an issuer has several.
office::LtiPlatform platform_named(const office::LtiPlatforms& platforms, const std::string& option, const std::string& name) {
  std::vector<office::LtiPlatform> found = platforms.all();
  std::erase_if(found, [&](const office::LtiPlatform& p) { return name != p.issuer && name != p.issuer + " " + p.client_id; });
  if (found.size() != 1)
    throw Error(option + " " + one_line(name), found.empty() ? "is not set up" : "has several clients",
                R"(name the issuer as `cavum serve --platforms` shows it, or "ISSUER CLIENT")");
  return found.front();
}

void list_platforms(office::LtiPlatforms& platforms) {
  for (const auto& p : platforms.all()) {
    std::cout << one_line(p.name) << "\n  issuer: " << one_line(p.issuer) << "\n  client id: " << one_line(p.client_id)
              << "\n  candidates are matched by: " << p.claim << "\n";
    const auto addresses = office::addresses_for(p);
    std::cout << "  for its administrator:\n    tool URL: " << addresses.tool << "\n    initiate login URL: " << addresses.login
              << "\n    redirection URI: " << addresses.redirect << "\n    public keyset URL: " << addresses.keys << "\n";
    for (const auto& [sub, account] : p.accounts) std::cout << "  " << one_line(sub) << " is the account of " << one_line(account) << "\n";
  }
  for (const auto& key : platforms.keys()) std::cout << "key " << key.kid << ", made " << utc_text(key.made_utc_ns) << "\n";
}

}  // namespace

void add_platform_options(CLI::App& verb, PlatformArguments& o) {
  verb.add_option("--platform", o.set, "set up a learning platform (LTI 1.3), or change it: a JSON file as docs/lti.md has it")
      ->check(CLI::ExistingFile);
  verb.add_flag("--platforms", o.list, "list the platforms, with what their administrators type in there");
  verb.add_option("--remove-platform", o.remove, "remove the platform of that issuer: who came from there is out at once");
  verb.add_option("--of-platform", o.of, "the platform, by its issuer, of the person whom --link names");
  verb.add_option("--link", o.link, "who comes as this `sub` is the account that --to names, and no mere reader");
  verb.add_option("--to", o.account, "name of the account; empty: nobody's any more");
  verb.add_flag("--new-lti-key", o.new_key, "make another key of the office's for platforms; the one before stays known");
}

bool set_up_platforms(const PlatformArguments& o, const std::string& home) {
  office::LtiPlatforms platforms(home + "/platforms.json");
  if (!o.set.empty()) {
    platforms.set(office::platform_in(parse_json(read_text_file(o.set), o.set)));
    list_platforms(platforms);
  } else if (!o.remove.empty()) {
    const auto p = platform_named(platforms, "--remove-platform", o.remove);
    platforms.remove(p.issuer, p.client_id);
  } else if (!o.link.empty()) {
    const auto p = platform_named(platforms, "--of-platform", o.of);
    if (!o.account.empty() && !office::Accounts(home + "/accounts.json").of(o.account))
      throw Error("--to " + one_line(o.account), msg("is no account"), msg("see `cavum serve --accounts`"));
    platforms.link(p.issuer, p.client_id, o.link, o.account);
  } else if (o.new_key) {
    platforms.rotate();
    list_platforms(platforms);
  } else if (o.list) {
    list_platforms(platforms);
  } else {
    return false;
  }
  return true;
}

}  // namespace cavum::ui
