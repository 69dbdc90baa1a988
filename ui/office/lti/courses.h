// What launches have told of learning platforms' courses: which exam a link is for, where its
// gradebook is, and who is who there. One file for each ledger, mode 0600; whoever the ledger has
// forgotten is taken out of it.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "ui/office/lti/launch.h"

namespace cavum::office {

struct LtiCourse {
  std::string issuer, client_id, context, exam;  ///< together they name it
  std::string title;                             ///< for people
  std::string lineitems,
      lineitem;      ///< addresses: of all columns, and of the link's own; each may be empty
  std::string item;  ///< the column that scores go to; empty: not yet found
  std::vector<std::string> scopes;  ///< what the platform allows
  std::map<std::string, std::string>
      learners;  ///< `sub` by the school's own number, of those who came
  [[nodiscard]] bool is(const LtiCourse& o) const {
    return issuer == o.issuer && client_id == o.client_id && context == o.context && exam == o.exam;
  }
};

/// The file. Any thread.
class LtiCourses {
 public:
  explicit LtiCourses(std::string path) : path_(std::move(path)) {}
  /// Throws Error when the file is none of courses.
  [[nodiscard]] std::vector<LtiCourse> all() const;
  /// What this launch tells, where its link is for an exam and the platform opens a gradebook to
  /// it.
  void note(const LtiLaunch& launch);
  /// Scores of this course go to `item` from now on.
  void set_item(const LtiCourse& course, const std::string& item);
  /// Takes learners out whom nobody knows any more.
  void keep_only(const std::function<bool(const std::string& id)>& known);
  void remove(const std::string& issuer, const std::string& client_id);

 private:
  [[nodiscard]] std::vector<LtiCourse> read() const;
  void write(const std::vector<LtiCourse>& courses) const;
  std::string path_;
  mutable std::mutex lock_;
};

/// The platform's name for a candidate in this course; empty: not known. Whoever came to another
/// course of the same exam belongs there alone.
[[nodiscard]] std::string user_in(const LtiCourse& course, const std::vector<LtiCourse>& all,
                                  const std::string& claim, const std::string& id);

}  // namespace cavum::office
