// Sends scores to learning platforms (Assignment and Grade Services 2.0), in a thread of its own:
// what is due by the ledger, once each; a platform that is down is tried again later and later.
// What a platform has answered is an entry of the ledger.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "ui/office/desk.h"
#include "ui/office/lti/client.h"
#include "ui/office/lti/courses.h"

namespace cavum::office {

class LtiSender {
 public:
  LtiSender(Desk& desk, LtiPlatforms& platforms, LtiCourses& courses);
  ~LtiSender();
  LtiSender(const LtiSender&) = delete;
  LtiSender& operator=(const LtiSender&) = delete;
  /// Something was released, taken back or told: look at once.
  void nudge();
  /// Look at once, also at platforms that were down, and send again what was refused.
  void send_again();
  /// Of each course.
  [[nodiscard]] std::vector<ScoresOfCourse> progress();

 private:
  void run();
  /// `asked`: also where the ledger is as it was.
  void round(bool asked, bool again);
  void send(const LtiPlatform& platform, const LtiCourse& course, bool again);
  [[nodiscard]] std::string token_of(const LtiPlatform& platform, const LtiCourse& course);
  [[nodiscard]] std::string item_of(const LtiPlatform& platform, const LtiCourse& course,
                                    double maximum);
  [[nodiscard]] PlatformAnswer ask(const LtiPlatform& platform, const LtiCourse& course,
                                   const std::string& method, const std::string& address,
                                   const std::map<std::string, std::string>& fields,
                                   const std::string& body = "");

  struct Token {
    std::string text;
    std::chrono::steady_clock::time_point until;
  };
  struct Trouble {
    Message what;
    std::chrono::steady_clock::time_point next;
    std::chrono::seconds pause{0};
  };
  Desk& desk_;
  LtiPlatforms& platforms_;
  LtiCourses& courses_;
  std::map<std::string, Token> tokens_;  // by platform and scopes; of the thread alone
  std::mutex lock_;
  std::condition_variable wake_;
  std::map<std::string, Trouble> troubles_;  // by platform and course
  bool nudged_ = false, again_ = false;
  std::size_t seen_entries_ = 0;  // of the thread alone
  std::atomic<bool> ends_ = false;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace cavum::office
