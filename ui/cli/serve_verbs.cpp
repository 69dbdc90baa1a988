// `serve`: the exam office over HTTPS. `office`: a station's side of it.
#include <fmt/core.h>
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session_image.h"
#include "grading/records/begin.h"
#include "grading/records/ledger_key.h"
#include "grading/records/station_ticket.h"
#include "grading/records/stations.h"
#include "scenarios/exam/exam.h"
#include "ui/cli/platform_options.h"
#include "ui/cli/session_files.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/office/accounts.h"
#include "ui/office/board.h"
#include "ui/office/office.h"
#include "ui/office/station_client.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

using nlohmann::json;

struct ServeArguments {
  std::string ledger, key, listen = "127.0.0.1:8443", certificate, certificate_key, add_account,
                           remove_account, role, known_as, proxy_address, proxy_secret,
                           proxy_header = "X-Auth-Request-Email";
  std::vector<std::string> exams, names;
  bool accounts = false, second_factor = false, simulated = false;
  PlatformArguments platforms;
};

std::string office_home() { return station_path("office"); }

/// Typed twice at a terminal, where it does not show; the first line of anything else.
std::string typed_password() {
  const bool asks = ::isatty(STDIN_FILENO) == 1;
  termios before{};
  if (asks) ::tcgetattr(STDIN_FILENO, &before);
  const auto typed = [&](const std::string& what) {
    if (asks) {
      std::cerr << what << " " << std::flush;
      termios hidden = before;
      hidden.c_lflag &= ~static_cast<tcflag_t>(ECHO);
      ::tcsetattr(STDIN_FILENO, TCSANOW, &hidden);
    }
    std::string line;
    std::getline(std::cin, line);
    if (asks) {
      ::tcsetattr(STDIN_FILENO, TCSANOW, &before);
      std::cerr << "\n";
    }
    return line;
  };
  std::string password = typed(tr("the account's new password:"));
  if (asks && typed(tr("once more:")) != password)
    throw Error(msg("the password"), msg("was typed differently the second time"),
                msg("begin again"));
  return password;
}

void add_account(const ServeArguments& o) {
  const auto role = office::role_named(o.role);
  if (!role)
    throw Error(Name{"--role " + one_line(o.role)}, msg("is none"),
                msg("say officer, examiner, invigilator or reader"));
  office::Accounts accounts(office_home() + "/accounts.json");
  const office::Account made =
      accounts.set(o.add_account, *role, typed_password(), o.second_factor, o.known_as);
  say(msg("written: {}", accounts.path()));
  if (o.second_factor)
    say(msg("for the app, shown only now: {}", office::code_address(made, "exam office")));
}

void list_accounts() {
  for (const auto& a : office::Accounts(office_home() + "/accounts.json").all()) {
    List said{{msg("{}", a.name), msg("{}", Term{std::string(office::name_of(a.role))})}, false};
    if (!a.code_secret.empty()) said.items.push_back(msg("second factor"));
    if (!a.known_as.empty()) said.items.push_back(msg("known as {}", a.known_as));
    say(msg("{}", said));
  }
}

std::vector<std::string> exams_of(const ServeArguments& o) {
  if (!o.exams.empty()) return o.exams;
  std::vector<std::string> out;
  for (const auto& name : scenarios::data_names("scenarios", ""))
    out.push_back(scenarios::find_data_file("scenarios", name + ".toml", ""));
  return out;
}

/// The first line of a file that nobody else may read.
std::string proxy_secret(const std::string& path) {
  const auto may = std::filesystem::status(path).permissions();
  if ((may & (std::filesystem::perms::group_all | std::filesystem::perms::others_all)) !=
      std::filesystem::perms::none)
    throw Error(Name{path}, msg("may be read by others"),
                msg("chmod 600 it: whoever knows the secret can sign in as anybody"));
  const std::string text = read_text_file(path);
  return text.substr(0, text.find_first_of("\r\n"));
}

void serve(const ServeArguments& o) {
  if (o.ledger.empty())
    throw Error(msg("serve"), msg("needs to know which ledger"),
                msg("name its folder; `cavum ledger init` makes one"));
  if (o.certificate.empty() != o.certificate_key.empty())
    throw Error(Name{"--certificate"},
                msg("is given without --certificate-key, or that without it"),
                msg("give both, or neither: one is made then"));
  const auto colon = o.listen.rfind(':');
  const std::string port = colon == std::string::npos ? "" : o.listen.substr(colon + 1);
  if (port.empty() || port.size() > 5 ||
      port.find_first_not_of("0123456789") != std::string::npos || std::stoi(port) > 65'535)
    throw Error(Name{"--listen " + one_line(o.listen)}, msg("is no address and port"),
                msg("give one such as 127.0.0.1:8443"));
  office::OfficeOptions options;
  options.ledger_folder = o.ledger;
  options.school = records::load_school_key(o.key.empty() ? records::school_key_path() : o.key);
  options.home = office_home();
  options.exams = exams_of(o);
  options.address = o.listen.substr(0, colon);
  if (options.address.starts_with('[') && options.address.ends_with(']'))
    options.address = options.address.substr(1, options.address.size() - 2);
  options.port = static_cast<std::uint16_t>(std::stoi(port));
  options.certificate = {o.certificate, o.certificate_key};
  if (o.certificate.empty()) {
    options.certificate = {options.home + "/certificate.pem", options.home + "/certificate.key"};
    std::vector<std::string> names{"localhost", "127.0.0.1", "::1"};
    names.insert(names.end(), o.names.begin(), o.names.end());
    office::make_certificate(options.certificate, names);
  }
  if (o.proxy_address.empty() != o.proxy_secret.empty())
    throw Error(Name{"--proxy-address"}, msg("is given without --proxy-secret, or that without it"),
                msg("give both, or neither: nobody signs in by a proxy then"));
  if (!o.proxy_address.empty())
    options.proxy =
        office::proxy_sign_on(o.proxy_address, proxy_secret(o.proxy_secret), o.proxy_header);
  options.filing.simulated = o.simulated;
  options.report = [folder = o.ledger](const std::string& recording) {
    return filed_report(folder, recording);
  };
  options.student_report = [folder = o.ledger](const std::string& recording) {
    return filed_report(folder, recording, "student");
  };
  const Interrupt interrupt;
  const office::Office office(options);
  say(msg("the office of {} at {}", office.school(),
          fmt::format("https://{}:{}", o.listen.substr(0, colon), office.port())));
  say(msg("certificate: {}", options.certificate.certificate));
  say(msg("its SHA-256: {}", office::fingerprint_of(options.certificate.certificate)));
  say(msg("it ends with Ctrl-C"));
  std::cout << std::flush;
  while (!Interrupt::asked()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

struct OfficeArguments {
  std::string server, certificate, code, out = ".", ticket, state, candidate, step, alarm, receipts;
  std::int64_t left_s = -1;
  std::uint64_t heard = 0;
  std::vector<std::string> sessions;
};

office::StationClient client_of(const OfficeArguments& o) {
  const std::string school = records::station_school_key();
  if (school.empty())
    throw Error(Name{records::school_public_key_path()}, msg("this station knows no school yet"),
                msg("copy the school's public key there: `cavum ledger init` writes it"));
  return {o.server, o.certificate, school, load_station_key(station_key_path())};
}

void office_enrol(const OfficeArguments& o) {
  const std::string path = station_key_path();
  const SigningKey key = load_station_key(path);
  auto client = client_of(o);
  const json done =
      client.enrol(records::station_request(key, records::station_school_key(), {}, o.code));
  remember_enrolled(path, key);
  say(msg("enrolled as '{}'", done.value("name", "")));
}

void office_tickets(const OfficeArguments& o) {
  auto client = client_of(o);
  make_private_folder(o.out);
  const json tickets = client.tickets();
  for (const auto& t : tickets) {
    const std::string text = t.at("text");
    const records::Ticket ticket =
        records::parse_ticket(text, records::station_school_key(), msg("the office's ticket"));
    const std::string file = fmt::format("{}/{}.ticket", o.out, file_name_of(ticket.candidate));
    write_private_text_file(file, text);
    say(msg("written: {}", file));
  }
}

void office_begin(const OfficeArguments& o) {
  auto client = client_of(o);
  const std::string out = records::begin_path(o.ticket);
  require_writable(out);
  write_private_text_file(out, client.begin(records::read_ticket(o.ticket).ticket.nonce) + "\n");
  say(msg("written: {}", out));
}

void office_report(const OfficeArguments& o) {
  auto client = client_of(o);
  const json word = client.report({{"state", o.state},
                                   {"candidate", o.candidate},
                                   {"step", o.step},
                                   {"alarm", o.alarm},
                                   {"left_s", o.left_s},
                                   {"heard", o.heard}});
  if (word.contains("hold"))
    say(msg("paused: {}", word.at("hold").at("reason").get<std::string>()));
  for (const json& a : word.at("announcements"))
    say(msg("announcement {}: {}", a.at("entry").get<std::int64_t>(),
            a.at("text").get<std::string>()));
}

int office_file(const OfficeArguments& o) {
  constexpr auto k_between_questions = std::chrono::milliseconds(500);
  auto client = client_of(o);
  if (!o.receipts.empty()) make_private_folder(o.receipts);
  bool all = true;
  for (const auto& path : session_files(o.sessions)) {
    Damages findings;
    const Bytes image = read_session_image(path, findings);
    const std::string hash = to_hex(sha256(image));
    json state = client.handed(hash);
    if (state.value("state", "") != "filed") state = client.hand_in(image);
    while (state.value("state", "") == "waiting") {
      std::this_thread::sleep_for(k_between_questions);
      state = client.handed(hash);
      if (state.value("state", "") == "unknown")
        state = client.hand_in(image);  // it was lost on the way
    }
    const bool filed = state.value("state", "") == "filed";
    all = all && filed;
    say(filed ? msg("{}: entry {}", path, state.at("entry").get<std::int64_t>())
              : msg("{}: NOT FILED", path));
    if (!filed)
      for (const json& f : state.value("findings", json::array()))
        say(msg("- {}", text_in(f, "text")), 2);
    if (filed && !o.receipts.empty())
      write_private_text_file(
          fmt::format("{}/receipt-{}.json", o.receipts, state.at("entry").get<std::uint64_t>()),
          state.at("receipt").dump(2) + "\n");
  }
  return all ? 0 : 1;
}

void add_serve_verb(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<ServeArguments>();
  auto* serve_verb = app.add_subcommand(
      "serve",
      tr("The exam office: a ledger over HTTPS, for people in a browser and for stations"));
  serve_verb->add_option("ledger", o->ledger, tr("the ledger's folder"));
  serve_verb->add_option("--listen", o->listen, tr("address and port"))->capture_default_str();
  serve_verb->add_option(
      "--certificate", o->certificate,
      tr("certificate chain (PEM); without it, one of its own that is made at the first start"));
  serve_verb->add_option("--certificate-key", o->certificate_key,
                         tr("the certificate's key (PEM)"));
  serve_verb->add_option(
      "--name", o->names,
      tr("name or address that the certificate of its own is for, too; may be repeated"));
  serve_verb->add_option(
      "--exam", o->exams,
      tr("scenario that tickets may be issued for; may be repeated; without it, all that ship"));
  serve_verb->add_option("--key", o->key, tr("the school's key, instead of the one in its place"));
  serve_verb->add_option(
      "--proxy-address", o->proxy_address,
      tr("address of a reverse proxy that signs people in by the school's accounts (OpenID Connect)"));
  serve_verb
      ->add_option("--proxy-secret", o->proxy_secret,
                   tr("file with the secret that the proxy adds as X-Cavum-Proxy-Secret"))
      ->check(existing_file());
  serve_verb
      ->add_option("--proxy-header", o->proxy_header, tr("field in which the proxy says who asks"))
      ->capture_default_str();
  serve_verb->add_flag("--simulated", o->simulated,
                       tr("rehearsal: files what no candidate's hand moved, too, marked as such"));
  serve_verb->add_option(
      "--add-account", o->add_account,
      tr("add an account, or give it another password: the person's name; the password is asked for"));
  serve_verb->add_option("--role", o->role,
                         tr("of the account: officer, examiner, invigilator or reader"));
  serve_verb->add_flag(
      "--second-factor", o->second_factor,
      tr("with --add-account: a secret for an authenticator app, which a release asks for"));
  serve_verb->add_option(
      "--known-as", o->known_as,
      tr("with --add-account: what the proxy calls the person, letter by letter"));
  serve_verb->add_option("--remove-account", o->remove_account,
                         tr("remove an account: who is signed in with it is out at once"));
  serve_verb->add_flag("--accounts", o->accounts, tr("list the accounts"));
  add_platform_options(*serve_verb, o->platforms);
  serve_verb->callback([o, &exit_code] {
    if (!o->add_account.empty())
      add_account(*o);
    else if (!o->remove_account.empty())
      office::Accounts(office_home() + "/accounts.json").remove(o->remove_account);
    else if (o->accounts)
      list_accounts();
    else if (!set_up_platforms(o->platforms, office_home()))
      serve(*o);
    exit_code = 0;
  });
}

void add_office_verb(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<OfficeArguments>();
  auto* verb = app.add_subcommand(
      "office",
      tr("A station's side of `cavum serve`: tickets, the word to begin, reports, exams that are handed in"));
  verb->require_subcommand(1);
  const auto add = [&](const char* name, const std::string& what, auto run) {
    auto* one = verb->add_subcommand(name, what);
    one->add_option("--server", o->server, tr("address of the office, such as https://office:8443"))
        ->required();
    one->add_option(
           "--certificate", o->certificate,
           tr("the office's own certificate (PEM), where it is not one that this computer trusts"))
        ->check(existing_file());
    one->callback([o, run, &exit_code] { exit_code = run(*o); });
    return one;
  };
  const auto done = [](auto act) {
    return [act](const OfficeArguments& a) {
      act(a);
      return 0;
    };
  };
  add("enrol", tr("enrol this station with the one-time code that the office gave"),
      done(office_enrol))
      ->add_option("--code", o->code, tr("S-…"))
      ->required();
  add("tickets", tr("fetch all tickets that may be used"), done(office_tickets))
      ->add_option("--out", o->out, tr("folder for them"))
      ->capture_default_str();
  add("begin", tr("ask whether the exam of a ticket may begin; the word is written beside it"),
      done(office_begin))
      ->add_option("ticket", o->ticket, tr("the ticket's file"))
      ->required()
      ->check(existing_file());
  auto* report = add(
      "report", tr("tell the live board what this station does; prints what the office has to say"),
      done(office_report));
  report->add_option("--state", o->state, tr("free, check, briefing, exam, paused or ended"))
      ->required();
  report->add_option("--candidate", o->candidate, tr("pseudonym of who sits"));
  report->add_option("--step", o->step, tr("of the exam"));
  report->add_option("--alarm", o->alarm, tr("what an invigilator should see to"));
  report->add_option("--remaining-s", o->left_s, tr("on the exam's clock, s"));
  report->add_option("--last-announcement", o->heard,
                     tr("number of the last announcement that was read"));
  auto* file =
      add("file", tr("hand in exams that were sat, and wait until they are filed"), office_file);
  file->add_option("sessions", o->sessions, tr("session files, or folders of them"))->required();
  file->add_option("--receipts", o->receipts, tr("folder for the receipts"));
}

}  // namespace

void add_serve_verbs(CLI::App& app, int& exit_code) {
  add_serve_verb(app, exit_code);
  add_office_verb(app, exit_code);
}

}  // namespace cavum::ui
