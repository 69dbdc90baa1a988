// Writes the pages' side of the table of routes, a TypeScript module: for each route its method,
// its path, and the types of request and answer.
#include <fmt/format.h>

#include <array>
#include <iostream>
#include <map>
#include <type_traits>
#include <variant>

#include "grading/records/entry.h"
#include "ui/office/routes.h"

namespace cavum::office {
namespace {

std::map<std::string, std::string> interfaces;

/// The name of a struct, without its namespaces.
template <class T>
std::string struct_name() {
  const std::string_view all = __PRETTY_FUNCTION__;
  const std::string_view type = all.substr(all.find("T = ") + 4);
  const std::string_view whole = type.substr(0, type.find_first_of(";]<"));
  return std::string(whole.substr(whole.rfind(':') + 1));
}

/// Of what is asked fields with a value of their own may be missing, too.
template <class T, bool asked>
std::string type_text() {
  if constexpr (JsonStruct<T>) {
    std::string fields;
    T none;
    each_field(none,
               [&]<class Member>(const char* name, Member&, JsonField field = JsonField::always) {
                 fields += fmt::format(
                     " {}{}: {};", name,
                     (asked && field == JsonField::optional) || k_is_optional<Member> ? "?" : "",
                     type_text<Member, asked>());
               });
    const std::string body = "{" + fields + " }", name = struct_name<T>();
    if (name == "Only") return body;
    interfaces[name] = body;
    return name;
  } else if constexpr (k_is_optional<T>) {
    return type_text<typename T::value_type, asked>();
  } else if constexpr (NamedEnum<T>) {
    return fmt::format("(\"{}\")", fmt::join(names_of(T()), "\" | \""));
  } else if constexpr (JsonMap<T>) {
    return "{ [name: string]: " + type_text<typename T::mapped_type, asked>() + " }";
  } else if constexpr (JsonList<T>) {
    return type_text<typename T::value_type, asked>() + "[]";
  } else if constexpr (std::derived_from<T, std::string>) {
    return "string";
  } else if constexpr (std::same_as<T, bool>) {
    return "boolean";
  } else if constexpr (std::is_arithmetic_v<T> || requires { T::k_least; }) {
    return "number";
  } else if constexpr (std::same_as<T, Nothing>) {
    return "Nothing";
  } else {
    return "unknown";
  }
}
template <class T>
std::string answer_text(const T*) {
  return type_text<T, false>();
}
template <class Event>
std::string answer_text(const EventsOf<Event>*) {
  return type_text<Event, false>();
}

/// "init" | "ticket" | ...
template <class... E>
std::string kinds_text(std::type_identity<std::variant<E...>>) {
  return fmt::format(
      "\"{}\"", fmt::join(std::array<std::string_view, sizeof...(E)>{E::k_kind...}, "\" | \""));
}

}  // namespace

void write_routes() {
  std::string rows;
  each_route([&]<class Row>(Row) {
    rows +=
        fmt::format("  {}: {{ method: \"{}\", path: \"{}\" }} as Route<{}, {}>,\n", Row::row.name,
                    Row::row.method, Row::row.path, type_text<typename Row::Request, true>(),
                    answer_text(static_cast<const typename Row::Answer*>(nullptr)));
  });
  std::cout
      << "// Made from ui/office/routes.h.\nexport type Nothing = Record<string, never>;\n"
         "/** `asks` and `answers` are in no object: they carry the types of request and answer, or of each event. */\n"
         "export interface Route<Request, Answer> { method: string; path: string; asks?: Request; answers?: Answer }\n";
  std::cout << "export type EntryKind = " << kinds_text(std::type_identity<records::Entry>())
            << ";\n";
  for (const auto& [name, body] : interfaces)
    std::cout << "export interface " << name << " " << body << "\n";
  std::cout << "export const routes = {\n" << rows << "};\n";
}

}  // namespace cavum::office

int main() { cavum::office::write_routes(); }
