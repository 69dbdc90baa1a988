#include "ui/office/routes.h"

#include <algorithm>
#include <array>

namespace cavum::office {
namespace {

constexpr std::size_t k_hash_digits = 64;
#define CAVUM_ROW(NAME, ...) route::NAME::row,
constexpr Route k_routes[] = {CAVUM_ROUTES(CAVUM_ROW)};
#undef CAVUM_ROW
constexpr std::array k_roles{Role::officer, Role::examiner, Role::invigilator, Role::reader};

bool is_hash(std::string_view text) {
  return text.size() == k_hash_digits && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace

std::string_view name_of(Role role) noexcept {
  return names_of(role)[static_cast<std::size_t>(role)];
}

std::optional<Role> role_named(std::string_view name) noexcept {
  const auto found =
      std::find_if(k_roles.begin(), k_roles.end(), [name](Role r) { return name_of(r) == name; });
  return found == k_roles.end() ? std::nullopt : std::optional(*found);
}

std::span<const Role> all_roles() noexcept { return k_roles; }
std::span<const Route> routes() noexcept { return k_routes; }

std::string_view tail_of(const Route& route, std::string_view path) noexcept {
  return route.path.ends_with('*') ? path.substr(route.path.size() - 1) : std::string_view();
}

std::string Route::path_of(std::string_view tail) const {
  return std::string(path.substr(0, path.size() - (path.ends_with('*') ? 1 : 0))) +
         std::string(tail);
}

const Route* route_for(std::string_view method, std::string_view path) noexcept {
  for (const Route& r : k_routes) {
    if (r.method != method) continue;
    const bool here =
        r.path.ends_with('*')
            ? path.starts_with(r.path.substr(0, r.path.size() - 1)) && is_hash(tail_of(r, path))
            : r.path == path;
    if (here) return &r;
  }
  return nullptr;
}

}  // namespace cavum::office
