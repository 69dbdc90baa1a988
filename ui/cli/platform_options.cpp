#include "ui/cli/platform_options.h"

#include <CLI/CLI.hpp>

#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "ui/language/say.h"
#include "ui/office/accounts.h"
#include "ui/office/lti/platforms.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

/// The platform that an option names by its issuer, or "ISSUER CLIENT" where an issuer has several.
office::LtiPlatform platform_named(const office::LtiPlatforms& platforms, const std::string& option,
                                   const std::string& name) {
  std::vector<office::LtiPlatform> found = platforms.all();
  std::erase_if(found, [&](const office::LtiPlatform& p) {
    return name != p.issuer && name != p.issuer + " " + p.client_id;
  });
  if (found.size() != 1)
    throw Error(
        Name{option + " " + name},
        found.empty() ? msg("is not set up") : msg("has several clients"),
        msg(R"(name the issuer as `cavum serve --platforms` shows it, or "ISSUER CLIENT")"));
  return found.front();
}

void list_platforms(office::LtiPlatforms& platforms) {
  for (const auto& p : platforms.all()) {
    const auto addresses = office::addresses_for(p);
    Lines out;
    out.add(Name{p.name});
    out.add(msg("issuer: {}", p.issuer), 2);
    out.add(msg("client id: {}", p.client_id), 2);
    out.add(msg("candidates are matched by: {}", p.claim), 2);
    out.add(msg("for its administrator:"), 2);
    out.add(msg("tool URL: {}", addresses.tool), 4);
    out.add(msg("initiate login URL: {}", addresses.login), 4);
    out.add(msg("redirection URI: {}", addresses.redirect), 4);
    out.add(msg("public keyset URL: {}", addresses.keys), 4);
    for (const auto& [sub, account] : p.accounts)
      out.add(msg("{} is the account of {}", sub, account), 2);
    say(out);
  }
  for (const auto& key : platforms.keys())
    say(msg("key {}, made {}", key.kid, utc_text(key.made_utc_ns)));
}

}  // namespace

void add_platform_options(CLI::App& verb, PlatformArguments& o) {
  verb.add_option(
          "--platform", o.set,
          tr("set up a learning platform (LTI 1.3), or change it: a JSON file as docs/lti.md has it"))
      ->check(existing_file());
  verb.add_flag("--platforms", o.list,
                tr("list the platforms, with what their administrators type in there"));
  verb.add_option("--remove-platform", o.remove,
                  tr("remove the platform of that issuer: who came from there is out at once"));
  verb.add_option("--of-platform", o.of,
                  tr("the platform, by its issuer, of the person whom --link names"));
  verb.add_option("--link", o.link,
                  tr("who comes as this `sub` is the account that --to names, and no mere reader"));
  verb.add_option("--to", o.account, tr("name of the account; empty: nobody's any more"));
  verb.add_flag("--new-lti-key", o.new_key,
                tr("make another key of the office's for platforms; the one before stays known"));
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
      throw Error(Name{"--to " + one_line(o.account)}, msg("is no account"),
                  msg("see `cavum serve --accounts`"));
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
