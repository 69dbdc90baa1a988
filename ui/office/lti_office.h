// The office for learning platforms (LTI 1.3): logins and launches, what a learner and an
// instructor see, set-up by an officer, scores that are sent.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "ui/office/lti_sender.h"
#include "ui/office/reports.h"
#include "ui/office/site.h"

namespace cavum::office {

/// A learner who has come, for an hour.
struct LtiVisit {
  std::string id;    ///< the school's own number; empty: the platform did not tell
  std::string name;  ///< for people
  std::string exam;  ///< of the link; empty: none in particular
  std::string issuer, client_id;
  std::int64_t since_s = 0;
};

class LtiOffice {
 public:
  /// `home`: the office's folder. `report`: the student's report of a recording. `begin_sign_in`:
  /// for an account, gives its cookie field.
  LtiOffice(Desk& desk, const std::string& home, Reports::Make report,
            std::function<std::optional<Account>(const std::string&)> account,
            std::function<std::string(const Account&)> begin_sign_in);

  // Handlers of its routes.
  [[nodiscard]] Reply answer(route::lti_keys, const Call& call);
  [[nodiscard]] Reply answer(route::lti_login, const Call& call);
  [[nodiscard]] Reply answer(route::lti_login_form, const Call& call);
  [[nodiscard]] Reply answer(route::lti_launch, const Call& call);
  [[nodiscard]] Reply answer(route::own_results, const Call& call);
  [[nodiscard]] Reply answer(route::own_report, const Call& call);
  [[nodiscard]] LtiSetUp answer(route::lti, const Call& call);
  [[nodiscard]] LtiSetUp answer(route::set_platform, const SetPlatform& asked, const Call& call);
  [[nodiscard]] LtiSetUp answer(route::remove_platform, const RemovePlatform& asked,
                                const Call& call);
  [[nodiscard]] LtiSetUp answer(route::link_person, const LinkPerson& asked, const Call& call);
  [[nodiscard]] LtiSetUp answer(route::new_key, const WithCode& asked, const Call& call);
  [[nodiscard]] Nothing answer(route::send_scores, const Call& call);
  /// An instructor who came from a platform that is still set up, and whom no account is linked to.
  [[nodiscard]] std::optional<Account> reader(const std::string& name);
  /// Whether the cookie is that of a learner who has come.
  [[nodiscard]] bool has_come(const std::string& cookie) { return visit_of(cookie).has_value(); }
  void nudge() { sender_.nudge(); }

 private:
  [[nodiscard]] Reply login(const Call& call, const std::string& fields);
  [[nodiscard]] Reply launch(const Call& call);
  [[nodiscard]] Reply own_results(const Call& call);
  [[nodiscard]] std::optional<LtiVisit> visit_of(const std::string& cookie);
  /// What `say` says, or what is wrong, as a page.
  template <class Say>
  [[nodiscard]] Reply as_page(const Say& say) const;
  /// A page for whoever comes from a platform, which may stand in its frames: it holds no secret.
  [[nodiscard]] Reply framed(int status, const std::string& html) const;

  Desk& desk_;
  LtiPlatforms platforms_;
  LtiCourses courses_;
  LtiLogins logins_;
  PlatformKeys keys_;
  Reports reports_;
  std::function<std::optional<Account>(const std::string&)> account_;
  std::function<std::string(const Account&)> begin_sign_in_;
  std::mutex lock_;
  std::map<std::string, LtiVisit> visits_;  // by the cookie's hash
  struct Teaching {
    Account account;
    std::string issuer, client_id;
  };
  std::map<std::string, Teaching> teaching_;  // by the account's name
  LtiSender sender_;                          // ends first
};

}  // namespace cavum::office
