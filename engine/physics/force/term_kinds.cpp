#include "engine/physics/force/term_kinds.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

#include "engine/base/file_error.h"
#include "engine/physics/force/term_laws.h"

namespace cavum {
namespace {

List all_kinds() {
  std::vector<std::string> names;
  for (const auto& k : term_kinds()) names.emplace_back(k.name);
  return list_of(names);
}

class TermOfKind final : public ForceTerm {
 public:
  TermOfKind(const TermKind& kind, std::vector<double> values)
      : kind_(kind), values_(std::move(values)) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in,
                                   TermMemory& memory) const noexcept override {
    return kind_.law(values_.data(), in, memory);
  }
  [[nodiscard]] bool counts_removed() const noexcept override { return kind_.counts_removed; }

 private:
  const TermKind& kind_;
  std::vector<double> values_;
};

}  // namespace

const std::vector<TermKind>& term_kinds() {
  static const std::vector<TermKind> k_all = force_laws();
  return k_all;
}

const TermKind* find_term_kind(const std::string& name) {
  for (const auto& k : term_kinds())
    if (name == k.name) return &k;
  return nullptr;
}

ForceTermPtr read_force_term(const toml::table& table, const std::string& where) {
  TomlReader in(table, where);
  const std::string name = in.text("kind");
  const TermKind* kind = find_term_kind(name);
  if (kind == nullptr)
    in.fail(FileError::unknown, "kind", msg("is '{}', which is no force term", name),
            msg("use one of: {}", all_kinds()));
  std::vector<std::string> known{"kind"};
  std::vector<double> values;
  for (const auto& p : kind->parameters) {
    known.emplace_back(p.name);
    values.push_back(p.otherwise ? in.number_or(p.name, p.low, p.high, *p.otherwise)
                                 : in.number(p.name, p.low, p.high));
  }
  for (const auto& [key, node] : table)
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      in.fail(FileError::unknown, key.str(), msg("is no parameter of {}", name),
              msg("it has: {}", list_of(std::vector<std::string>(known.begin() + 1, known.end()))));
  if (table.size() < 2)
    in.fail(
        FileError::missing, "kind", msg("stands alone, so this term does nothing"),
        msg("give one of: {}", list_of(std::vector<std::string>(known.begin() + 1, known.end()))));
  return std::make_shared<TermOfKind>(*kind, std::move(values));
}

std::string force_term_toml(const std::string& kind,
                            const std::vector<std::pair<std::string, double>>& parameters) {
  std::ostringstream out;
  out.precision(17);
  out << "[[terms]]\nkind = \"" << kind << "\"\n";
  for (const auto& [name, value] : parameters) out << name << " = " << value << "\n";
  return out.str();
}

ForceTermPtr make_force_term(const std::string& kind,
                             const std::vector<std::pair<std::string, double>>& parameters,
                             const std::string& where) {
  const toml::table document = parse_toml(force_term_toml(kind, parameters), where);
  return read_force_term(*document.get_as<toml::array>("terms")->get_as<toml::table>(0), where);
}

}  // namespace cavum
