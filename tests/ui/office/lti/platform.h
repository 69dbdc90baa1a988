// A learning platform beside an office: `platform.py` as a process of its own, and a browser that
// goes between the two.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <regex>

#include "tests/ui/office/opened.h"
#include "ui/office/lti/launch.h"

namespace cavum::testing_office {

class Platform {
 public:
  /// For the office at `tool`, in a folder of its own.
  explicit Platform(const std::string& tool) : tool_(tool) {
    office::make_certificate({certificate_file(), folder_.file("key.pem")}, {"127.0.0.1"});
    begin("0");
  }
  ~Platform() { end(); }
  Platform(const Platform&) = delete;
  Platform& operator=(const Platform&) = delete;
  void end() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

  [[nodiscard]] std::string issuer() const { return "https://127.0.0.1:" + port_; }
  /// What the officer types in.
  [[nodiscard]] nlohmann::json set_up() const {
    return {{"name", "Moodle"},
            {"office", tool_},
            {"issuer", issuer()},
            {"client_id", "cavum-1"},
            {"deployments", {"1"}},
            {"auth_endpoint", issuer() + "/auth"},
            {"token_endpoint", issuer() + "/token"},
            {"jwks_url", issuer() + "/jwks"},
            {"claim", "custom.number"},
            {"certificate", read_text_file(certificate_file())}};
  }
  /// Tells the platform something, and what it knows since: {posts, results, items, asked,
  /// violations}.
  nlohmann::json control(const nlohmann::json& what = nlohmann::json::object()) const {
    return Visitor{number()}.ask("POST", "/control", what.dump()).json();
  }
  [[nodiscard]] std::uint16_t number() const {
    return static_cast<std::uint16_t>(std::stoi(port_));
  }

 private:
  [[nodiscard]] std::string certificate_file() const { return folder_.file("certificate.pem"); }
  void begin(const std::string& port) {
    int out[2];
    ASSERT_EQ(::pipe(out), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(out[1], STDOUT_FILENO);
      ::close(out[0]);
      const std::string program =
                            std::string(CAVUM_SOURCE_DIR) + "/tests/ui/office/lti/platform.py",
                        key = folder_.file("key.pem");
      ::execlp("python3", "python3", program.c_str(), "--certificate", certificate_file().c_str(),
               "--key", key.c_str(), "--tool", tool_.c_str(), "--port", port.c_str(),
               static_cast<char*>(nullptr));
      ::_exit(127);
    }
    ::close(out[1]);
    for (char c = 0; ::read(out[0], &c, 1) == 1 && c != '\n';) port_ += c;
    ::close(out[0]);
    ASSERT_FALSE(port_.empty()) << "platform.py did not begin: it needs python3-cryptography";
  }

  testing_basics::Folder folder_;
  std::string tool_, port_;
  pid_t pid_ = 0;
};

/// A browser: what it sends, and the cookies that the office gave it.
struct Browser {
  std::uint16_t office = 0;
  const Platform* platform = nullptr;
  std::map<std::string, std::string> cookies = {};

  Heard ask(const std::string& method, const std::string& path, const std::string& body = "",
            std::map<std::string, std::string> more = {}) {
    std::string all;
    for (const auto& [name, value] : cookies) all += (all.empty() ? "" : "; ") + name + "=" + value;
    if (!all.empty()) more["Cookie"] = all;
    if (method == "POST" && !more.contains("Content-Type"))
      more["Content-Type"] = "application/x-www-form-urlencoded";
    Heard heard = Visitor{office}.ask(method, path, body, more);
    if (const auto set = heard.fields.find("set-cookie"); set != heard.fields.end()) {
      const std::string one = set->second.substr(0, set->second.find(';'));
      cookies[one.substr(0, one.find('='))] = one.substr(one.find('=') + 1);
    }
    return heard;
  }
  /// What the platform sends the browser to, as `who` ("Learner:4711"): the query of our login.
  [[nodiscard]] std::string begun(const std::string& who, const std::string& attack = "") const {
    const std::string tool = "https://127.0.0.1:" + std::to_string(office);
    return "iss=" + office::url_encoded(platform->issuer()) +
           "&login_hint=" + office::url_encoded(who) +
           "&target_link_uri=" + office::url_encoded(tool + "/lti/launch") +
           "&client_id=cavum-1&lti_deployment_id=1" +
           (attack.empty() ? "" : "&lti_message_hint=" + attack);
  }
  /// The form with which the platform sends the browser back; empty: no login was begun.
  std::string form(const std::string& who, const std::string& attack = "") {
    const Heard login = ask("GET", "/lti/login?" + begun(who, attack));
    EXPECT_EQ(login.status, 302) << login.body;
    if (login.status != 302) return "";
    return form_at(login.fields.at("location"));
  }
  /// The same from where a login was answered.
  [[nodiscard]] std::string form_at(const std::string& to) const {
    EXPECT_TRUE(to.starts_with(platform->issuer() + "/auth?")) << to;
    const Heard page = Visitor{platform->number()}.get(to.substr(platform->issuer().size()));
    EXPECT_EQ(page.status, 200) << page.body;
    std::smatch found;
    static const std::regex k_form(
        R"re(name="state" value="([^"]*)"><input name="id_token" value="([^"]*)")re");
    return std::regex_search(page.body, found, k_form)
               ? "state=" + found[1].str() + "&id_token=" + found[2].str()
               : "";
  }
  Heard launch(const std::string& who, const std::string& attack = "") {
    return ask("POST", "/lti/launch", form(who, attack));
  }
};

}  // namespace cavum::testing_office
