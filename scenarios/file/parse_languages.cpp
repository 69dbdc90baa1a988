#include "scenarios/file/parse_languages.h"

#include <fmt/core.h>

#include <algorithm>

namespace cavum::scenarios {
namespace {

/// Translations of texts that a list has by id, or by name: a table `key` in the language's table.
template <class List, class Id, class Text>
void read_list(CheckedTable& language, const std::string& name, const char* key, const List& list,
               const Id& id, const Text& text, std::map<std::string, std::string>& out,
               ProblemList& problems) {
  const toml::table* table = language.table(key);
  if (table == nullptr) return;
  CheckedTable t(*table, fmt::format("{}.{}]", name.substr(0, name.size() - 1), key), problems);
  for (const auto& item : list)
    if (t.has(id(item))) out[text(item)] = t.text(id(item), "", true);
  t.finish();
}

}  // namespace

Translations read_languages(CheckedTable& file, const Scenario& s, ProblemList& problems) {
  Translations all;
  const toml::table* languages = file.table("languages");
  if (languages == nullptr) return all;
  for (const auto& [key, node] : *languages) {
    const std::string language(key.str()), name = fmt::format("[languages.{}]", language);
    const bool plain =
        !language.empty() && language.size() <= 3 &&
        std::all_of(language.begin(), language.end(), [](char c) { return c >= 'a' && c <= 'z'; });
    if (!plain || language == "en" || node.as_table() == nullptr || all.size() >= k_max_languages) {
      problems.add(
          node.source(), msg("{} is no table of another language", name),
          msg("write for example [languages.de]; the texts of the scenario itself are English"),
          Mistake::unknown_language);
      continue;
    }
    CheckedTable t(*node.as_table(), name, problems);
    std::map<std::string, std::string>& out = all[language];
    if (t.has("title")) out[s.title] = t.text("title", "", true);
    if (t.has("description")) out[s.description] = t.text("description", "", true);
    const auto id = [](const auto& item) { return item.id; };
    read_list(
        t, name, "steps", s.steps, id, [](const StepSpec& step) { return step.instruction; }, out,
        problems);
    read_list(
        t, name, "criteria", s.rubric.criteria, id, [](const CriterionSpec& c) { return c.title; },
        out, problems);
    const auto band = [](const BandSpec& b) { return b.name; };
    read_list(t, name, "bands", s.rubric.bands, band, band, out, problems);
    t.finish();
  }
  return all;
}

}  // namespace cavum::scenarios
