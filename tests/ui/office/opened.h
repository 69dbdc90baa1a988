// An office that is open: a school with a ledger and an enrolled station, accounts of each role,
// and the server on a free port of this computer.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/encoding.h"
#include "grading/records/station_ticket.h"
#include "tests/grading/records/school.h"
#include "tests/ui/office/web.h"
#include "ui/office/accounts.h"
#include "ui/office/office.h"
#include "ui/office/one_time_code.h"
#include "ui/office/station_client.h"

namespace cavum::testing_office {

inline constexpr char k_password[] = "correct horse trial";

class Opened {
 public:
  explicit Opened(const office::HttpLimits& limits = {}) : limits_(limits) {
    for (const office::Role r : office::all_roles())
      accounts().set(name_of(r), r, k_password, r == office::Role::officer);
    open();
  }
  [[nodiscard]] static std::string name_of(office::Role r) {
    return "The " + std::string(office::name_of(r));
  }
  [[nodiscard]] std::string home() const { return school_.file("office"); }
  [[nodiscard]] office::Accounts accounts() const {
    return office::Accounts(home() + "/accounts.json");
  }
  [[nodiscard]] const testing_ledger::School& school() const { return school_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string address() const { return "https://127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] std::string certificate() const { return home() + "/certificate.pem"; }
  [[nodiscard]] std::string id() const { return records::read_ledger(school_.places()).id; }
  [[nodiscard]] records::LedgerContent content() const {
    return records::read_ledger(school_.places());
  }

  void open() {
    office::OfficeOptions o;
    o.ledger_folder = school_.ledger_folder();
    o.school = testing_ledger::School::key();
    o.home = home();
    o.exams = {testing_ledger::k_scenario};
    o.port = 0;
    o.certificate = {certificate(), home() + "/certificate.key"};
    o.limits = limits_;
    o.filing.simulated = rehearsal_;
    o.proxy = proxy_;
    o.report = [](const std::string& recording) {
      return "<p>" + recording + "</p><script>1</script>";
    };
    o.student_report = [](const std::string& recording) {
      return "<p>student's " + recording + "</p><script>1</script>";
    };
    if (port_ != 0) o.port = port_;  // where it was before
    office::make_certificate(o.certificate, {"127.0.0.1", "localhost"});
    office_ = std::make_unique<office::Office>(o);
    port_ = office_->port();
  }
  /// From the next open() on what no hand moved is filed, too.
  void rehearse() { rehearsal_ = true; }
  /// From the next open() on people may sign in by a proxy.
  void stand_behind(const office::ProxySignOn& proxy) { proxy_ = proxy; }
  void close() { office_.reset(); }

  [[nodiscard]] Visitor visitor() const { return {port()}; }
  [[nodiscard]] Visitor signed_in(office::Role r) const {
    Visitor v{port()};
    const Heard heard = v.sign_in(name_of(r), k_password);
    EXPECT_EQ(heard.status, 200) << heard.body;
    return v;
  }
  /// The station of this CAVUM_HOME.
  [[nodiscard]] office::StationClient station() const {
    return {"https://127.0.0.1:" + std::to_string(port()), certificate(),
            to_hex(testing_ledger::School::key().public_key), load_station_key(station_key_path())};
  }
  /// A code of the officer's second factor: of this half minute, or of one beside it, which is
  /// good, too. Each is good once, and none before it then.
  [[nodiscard]] std::string code(int steps_on = 0) const {
    return code_of(name_of(office::Role::officer), steps_on);
  }
  /// The same of another account.
  [[nodiscard]] std::string code_of(const std::string& name, int steps_on = 0) const {
    const auto secret = office::from_base32(accounts().of(name)->code_secret);
    return office::one_time_code(
        *secret, static_cast<std::uint64_t>(
                     read_clocks().utc_ns / 1'000'000'000 / office::k_code_step_s + steps_on));
  }
  /// A class list as the page sends it.
  [[nodiscard]] static nlohmann::json list(const std::string& text,
                                           const std::vector<std::string>& answers = {}) {
    return {
        {"base64", to_base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})},
        {"answers", answers}};
  }
  /// Tickets of an hour around now for these numbers.
  [[nodiscard]] Heard issue(const Visitor& officer, const std::string& numbers,
                            bool begin_at_office = false, bool another = false) const {
    const std::int64_t now = read_clocks().utc_ns;
    nlohmann::json asked = list("id\n" + numbers);
    asked.update({{"exam", "block_cavity"},
                  {"from", utc_text(now - testing_ledger::k_hour_ns)},
                  {"until", utc_text(now + testing_ledger::k_hour_ns)},
                  {"begin_at_office", begin_at_office},
                  {"another", another},
                  {"reason", "the class of this year"}});
    return officer.post("/api/roster/issue", asked);
  }
  /// Waits until a recording is filed or refused.
  [[nodiscard]] static nlohmann::json outcome(office::StationClient& station,
                                              const std::string& sha256) {
    for (int i = 0; i < 1200; ++i) {
      nlohmann::json state = station.handed(sha256);
      if (state["state"] != "waiting") return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return {{"state", "waited a minute"}};
  }

 private:
  testing_ledger::School school_;
  office::HttpLimits limits_;
  std::uint16_t port_ = 0;
  bool rehearsal_ = false;
  std::optional<office::ProxySignOn> proxy_;
  std::unique_ptr<office::Office> office_;
};

}  // namespace cavum::testing_office
