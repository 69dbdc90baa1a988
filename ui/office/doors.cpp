#include "ui/office/doors.h"

#include <algorithm>
#include <array>
#include <utility>

#include "ui/office/pieces.h"

namespace cavum::office {
namespace {

constexpr std::size_t k_hash_digits = 64;
constexpr std::uint64_t k_small = 16U << 10, k_launch = 128U << 10, k_rubric = 512U << 10, k_seats = 1U << 20, k_roster = 4U << 20;

constexpr unsigned bits(auto... roles) { return (0U | ... | static_cast<unsigned>(roles)); }
constexpr unsigned k_officer = bits(Role::officer), k_examiner = bits(Role::examiner), k_staff = bits(Role::officer, Role::examiner),
                   k_hall = bits(Role::officer, Role::invigilator), k_results = bits(Role::officer, Role::examiner, Role::reader),
                   k_all = bits(Role::officer, Role::examiner, Role::invigilator, Role::reader);

constexpr Door k_doors[] = {
    {"GET", "/", Asks::nobody, 0, 0},
    {"GET", "/office.js", Asks::nobody, 0, 0},
    {"GET", "/office.css", Asks::nobody, 0, 0},
    {"GET", "/api/words", Asks::nobody, 0, 0},
    {"POST", "/api/sign-in", Asks::nobody, 0, k_small},
    {"POST", "/api/sign-in/proxy", Asks::nobody, 0, k_small},
    {"POST", "/api/sign-out", Asks::person, k_all, k_small},
    {"GET", "/api/me", Asks::person, k_all, 0},
    {"GET", "/api/exams", Asks::person, k_officer, 0},
    {"POST", "/api/roster/preview", Asks::person, k_officer, k_roster},
    {"POST", "/api/roster/issue", Asks::person, k_officer, k_roster},
    {"GET", "/api/tickets", Asks::person, k_hall, 0},
    {"POST", "/api/tickets/cancel", Asks::person, k_officer, k_small},
    {"POST", "/api/tickets/makeup", Asks::person, k_officer, k_small},
    {"GET", "/api/board", Asks::person, k_hall, 0},
    {"GET", "/api/board/events", Asks::person, k_hall, 0},
    {"POST", "/api/stations/invite", Asks::person, k_officer, k_small},
    {"POST", "/api/stations/revoke", Asks::person, k_officer, k_small},
    {"POST", "/api/stations/room", Asks::person, k_officer, k_small},
    {"POST", "/api/seats", Asks::person, k_officer, k_seats},
    {"GET", "/api/attendance", Asks::person, k_hall, 0},
    {"GET", "/api/cards.pdf", Asks::person, k_officer, 0},
    {"GET", "/api/sign-in-sheet.pdf", Asks::person, k_hall, 0},
    {"POST", "/api/announce", Asks::person, k_hall, k_small},
    {"POST", "/api/hold", Asks::person, k_hall, k_small},
    {"POST", "/api/go-on", Asks::person, k_hall, k_small},
    {"GET", "/api/incidents", Asks::person, k_hall, 0},
    {"POST", "/api/incidents", Asks::person, k_hall, k_small},
    {"GET", "/api/queue", Asks::person, k_staff, 0},
    {"POST", "/api/decide", Asks::person, k_examiner, k_small},
    {"GET", "/api/results", Asks::person, k_results, 0},
    {"POST", "/api/release", Asks::person, k_officer, k_small},
    {"POST", "/api/retract", Asks::person, k_officer, k_small},
    {"GET", "/api/regrade", Asks::person, k_staff, 0},
    {"GET", "/api/regrade/events", Asks::person, k_staff, 0},
    {"POST", "/api/regrade/begin", Asks::person, k_examiner, k_rubric},
    {"POST", "/api/regrade/count", Asks::person, k_examiner, k_small},
    {"POST", "/api/regrade/drop", Asks::person, k_examiner, k_small},
    {"GET", "/api/appeals", Asks::person, k_staff, 0},
    {"POST", "/api/appeals/open", Asks::person, k_officer, k_small},
    {"POST", "/api/appeals/answer", Asks::person, k_examiner, k_small},
    {"POST", "/api/trail", Asks::person, k_results, k_small},
    {"GET", "/api/report/*", Asks::person, k_staff, 0},
    {"GET", "/api/gradebook.csv", Asks::person, k_officer, 0},
    {"GET", "/api/criteria.csv", Asks::person, k_results, 0},
    {"GET", "/api/lti", Asks::person, k_officer, 0},
    {"POST", "/api/lti/set", Asks::person, k_officer, k_seats},
    {"POST", "/api/lti/remove", Asks::person, k_officer, k_small},
    {"POST", "/api/lti/link", Asks::person, k_officer, k_small},
    {"POST", "/api/lti/new-key", Asks::person, k_officer, k_small},
    {"POST", "/api/lti/send", Asks::person, k_officer, k_small},
    {"GET", "/lti/jwks", Asks::nobody, 0, 0},
    {"GET", "/lti/login", Asks::nobody, 0, 0},
    {"POST", "/lti/login", Asks::form, 0, k_small},
    {"POST", "/lti/launch", Asks::form, 0, k_launch},
    {"GET", "/lti/result", Asks::came, 0, 0},
    {"GET", "/lti/report/*", Asks::came, 0, 0},
    {"GET", "/station/hello", Asks::nobody, 0, 0},
    {"POST", "/station/enrol", Asks::nobody, 0, k_small},
    {"GET", "/station/tickets", Asks::station, 0, 0},
    {"POST", "/station/begin", Asks::station, 0, k_small},
    {"POST", "/station/report", Asks::station, 0, k_small},
    {"PUT", "/station/pieces/*", Asks::station, 0, k_largest_piece},
    {"GET", "/station/pieces/*", Asks::station, 0, 0},
    {"PUT", "/station/sessions/*", Asks::station, 0, k_largest_session},
    {"GET", "/station/sessions/*", Asks::station, 0, 0},
};

constexpr std::array k_roles{Role::officer, Role::examiner, Role::invigilator, Role::reader};
constexpr std::array<std::string_view, 4> k_names{"officer", "examiner", "invigilator", "reader"};

bool is_hash(std::string_view text) {
  return text.size() == k_hash_digits &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

}  // namespace

std::string_view name_of(Role role) noexcept {
  return k_names[static_cast<std::size_t>(std::find(k_roles.begin(), k_roles.end(), role) - k_roles.begin())];
}

std::optional<Role> role_named(std::string_view name) noexcept {
  const auto found = std::find(k_names.begin(), k_names.end(), name);
  if (found == k_names.end()) return std::nullopt;
  return k_roles[static_cast<std::size_t>(found - k_names.begin())];
}

std::span<const Role> all_roles() noexcept { return k_roles; }
std::span<const Door> doors() noexcept { return k_doors; }

std::string_view tail_of(const Door& door, std::string_view path) noexcept {
  return door.path.ends_with('*') ? path.substr(door.path.size() - 1) : std::string_view();
}

const Door* door_for(std::string_view method, std::string_view path) noexcept {
  for (const Door& d : k_doors) {
    if (d.method != method) continue;
    const bool here = d.path.ends_with('*') ? path.starts_with(d.path.substr(0, d.path.size() - 1)) && is_hash(tail_of(d, path)) : d.path == path;
    if (here) return &d;
  }
  return nullptr;
}

}  // namespace cavum::office
