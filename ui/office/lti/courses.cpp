#include "ui/office/lti/courses.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"

namespace cavum::office {

struct CoursesFile {
  std::vector<LtiCourse> courses;
};
// clang-format off
CAVUM_JSON_OF(LtiCourse, (issuer), (client_id), (context), (exam), (title), (lineitems), (lineitem), (item), (scopes), (learners))
// clang-format on
void json_fields(auto& of, JsonOf<CoursesFile> auto& file) {
  of("format", JsonFormat{"cavum courses 1"}), of("courses", file.courses);
}

std::vector<LtiCourse> LtiCourses::read() const {
  if (!std::filesystem::exists(path_)) return {};
  const JsonSource source{
      path_, msg("remove it: each course is in it again once somebody opens its link")};
  return json_value_of<CoursesFile>(parse_json(read_text_file(path_), path_), source).courses;
}

void LtiCourses::write(const std::vector<LtiCourse>& courses) const {
  make_private_folder(std::filesystem::path(path_).parent_path().string());
  write_private_text_file(path_, to_json_value(CoursesFile{courses}).dump(1) + "\n");
}

std::vector<LtiCourse> LtiCourses::all() const {
  const std::lock_guard guard(lock_);
  return read();
}

void LtiCourses::note(const LtiLaunch& launch) {
  LtiCourse told{launch.platform.issuer,
                 launch.platform.client_id,
                 launch.context,
                 launch.exam,
                 launch.title,
                 text_in(launch.grades, "lineitems"),
                 text_in(launch.grades, "lineitem"),
                 {},
                 {},
                 {}};
  if (told.exam.empty()) return;
  if (told.lineitems.empty() && told.lineitem.empty()) return;
  if (const auto& scopes = member_of(launch.grades, "scope"); scopes.is_array())
    for (const auto& s : scopes)
      if (s.is_string()) told.scopes.push_back(s);
  const std::lock_guard guard(lock_);
  std::vector<LtiCourse> courses = read();
  const auto found =
      std::find_if(courses.begin(), courses.end(), [&](const LtiCourse& c) { return c.is(told); });
  LtiCourse before;
  if (found != courses.end()) {
    before = *found;
    told.learners = before.learners;
    told.item = before.item;
  }
  if (launch.platform.may_ask(told.lineitem)) told.item = told.lineitem;
  if (!launch.teaches && !launch.id.empty()) told.learners[launch.id] = launch.sub;
  const bool same = found != courses.end() && before.learners == told.learners &&
                    before.item == told.item && before.scopes == told.scopes &&
                    before.lineitems == told.lineitems && before.lineitem == told.lineitem &&
                    before.title == told.title;
  if (same) return;
  if (found == courses.end())
    courses.push_back(std::move(told));
  else
    *found = std::move(told);
  write(courses);
}

void LtiCourses::set_item(const LtiCourse& course, const std::string& item) {
  const std::lock_guard guard(lock_);
  std::vector<LtiCourse> courses = read();
  for (auto& c : courses)
    if (c.is(course)) c.item = item;
  write(courses);
}

void LtiCourses::keep_only(const std::function<bool(const std::string& id)>& known) {
  const std::lock_guard guard(lock_);
  std::vector<LtiCourse> courses = read();
  std::size_t gone = 0;
  for (auto& c : courses)
    gone += std::erase_if(c.learners, [&](const auto& one) { return !known(one.first); });
  if (gone > 0) write(courses);
}

void LtiCourses::remove(const std::string& issuer, const std::string& client_id) {
  const std::lock_guard guard(lock_);
  std::vector<LtiCourse> courses = read();
  if (std::erase_if(courses, [&](const LtiCourse& c) {
        return c.issuer == issuer && c.client_id == client_id;
      }) > 0)
    write(courses);
}

std::string user_in(const LtiCourse& course, const std::vector<LtiCourse>& all,
                    const std::string& claim, const std::string& id) {
  if (const auto found = course.learners.find(id); found != course.learners.end())
    return found->second;
  const bool elsewhere = std::any_of(all.begin(), all.end(), [&](const LtiCourse& c) {
    return c.issuer == course.issuer && c.client_id == course.client_id && c.exam == course.exam &&
           c.learners.contains(id);
  });
  return claim == "sub" && !elsewhere ? id : "";
}

}  // namespace cavum::office
