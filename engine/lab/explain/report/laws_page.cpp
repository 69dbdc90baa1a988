#include "engine/lab/explain/report/laws_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

namespace cavum::explain {
namespace {

/// Shapes of zeros, but for at most two numbers that are at an end of their range: no form of a law
/// takes more to be seen.
std::vector<std::vector<double>> forms_of(const std::vector<ShapeRange>& shape) {
  std::vector<std::vector<double>> out{std::vector<double>(shape.size(), 0.0)};
  for (int set = 0; set < 2; ++set)
    for (const auto& begun : std::vector(out))
      for (std::size_t i = 0; i < shape.size(); ++i)
        for (const double value : {shape[i].low, shape[i].high}) {
          out.push_back(begun);
          out.back()[i] = value;
        }
  return out;
}

/// `|` would end a cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

template <class List, class Name>
std::string listed(const List& list, const Name& name) {
  std::string out;
  for (const auto& one : list) out += fmt::format("{}{}`", out.empty() ? "`" : ", `", name(one));
  return out;
}

std::string ranges(const TermKind& kind) {
  std::ostringstream out;
  for (const auto& p : kind.parameters) {
    out << (out.tellp() > 0 ? ", `" : "`") << p.name << "` " << p.low << " … " << p.high;
    if (p.otherwise) out << " (" << *p.otherwise << ")";
  }
  return out.str();
}

}  // namespace

std::vector<std::string> parameter_names(const Mechanism& m) {
  std::vector<std::string> out;
  for (const auto& shape : forms_of(m.shape))
    for (const auto& p : m.parameters(shape, {1.0, 2.0},
                                      {1.0, 1.0}))  // none has more coefficients that are its own
      if (std::find(out.begin(), out.end(), p.name) == out.end()) out.push_back(p.name);
  return out;
}

std::string laws_page() {
  const auto text = [](const auto& one) { return one; };
  std::ostringstream out;
  out << "# The laws\n\n"
         "What may be added to F = max(0, k X + c V). `cavum explain --laws` writes this page, from the one table that the force model, the exam, "
         "the\n"
         "rigs and `explain` read. X is the penetration in mm, V its rate in mm/s, F_sim the law above. A law that is felt in an exam is a force "
         "term,\n"
         "`[[terms]]` of a force model; the others belong to the measurement. `explain` looks for a law where the recording has one of the columns "
         "that it needs.\n\n"
         "| law | adds, N | what it is | found as | felt in an exam | needs | variant of | shown best by |\n"
         "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const auto& m : mechanisms())
    out << "| " << m.name << " | " << cell(m.equation) << " | " << m.words << " | "
        << listed(parameter_names(m), text) << " | " << (m.term != nullptr ? "yes" : "no") << " | "
        << listed(m.needs, text) << " | " << (m.variant_of != nullptr ? m.variant_of : "") << " | "
        << m.separate << " |\n";
  out << "\n## Force terms\nF in these is the law above without terms. The name of a parameter ends in its unit; beside it the range, and in "
         "brackets the value when a file does not give "
         "it.\n\n"
         "| `kind` | adds, N | parameters | source of the form | notes, and values without a source |\n| --- | --- | --- | --- | --- |\n";
  for (const auto& kind : term_kinds())
    out << "| " << kind.name << " | " << cell(kind.adds) << " | " << ranges(kind) << " | "
        << cell(kind.source) << " | " << cell(kind.notes) << " |\n";
  return out.str();
}

}  // namespace cavum::explain
