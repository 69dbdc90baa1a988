#include "scenarios/review/task_texts.h"

#include <fmt/core.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <tuple>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/base/toml_reader.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/bodies.h"

namespace cavum::scenarios {
namespace {

constexpr std::string_view k_folder = "tasks", k_block = "block_";

/// From `from` on, where the next gap stands, `{name}` or `{#}`, and behind it; npos where there is
/// none. In TOML a blank follows the bracket of a table.
std::pair<std::size_t, std::size_t> next_gap(std::string_view text, std::size_t from) {
  constexpr std::string_view k_of_names = "abcdefghijklmnopqrstuvwxyz0123456789_";
  for (std::size_t at = text.find('{', from); at != std::string_view::npos;
       at = text.find('{', at + 1)) {
    const std::size_t end =
        text.substr(at + 1, 1) == "#" ? at + 2 : text.find_first_not_of(k_of_names, at + 1);
    if (end < text.size() && end > at + 1 && text[end] == '}') return {at, end + 1};
  }
  return {std::string_view::npos, std::string_view::npos};
}

/// The same text for as long as the program runs: messages keep the sentence that they are made of.
const char* kept(std::string text) {
  static std::mutex one_at_a_time;
  static std::set<std::string> k_kept;
  const std::lock_guard lock(one_at_a_time);
  return k_kept.insert(std::move(text)).first->c_str();
}

}  // namespace

Gap gap_mm(const char* name, double mm, int digits) {
  return {name, digits == k_as_needed ? plain_number(mm) : fixed(mm, digits), as_mm(mm, digits)};
}

TaskTexts::TaskTexts(const std::string& task) {
  read("common.toml");
  read(task + ".toml");
  texts_["bodies"] = {bodies_as_comments(), 0.0, {}};
}

void TaskTexts::read(const std::string& file) {
  file_ = find_data_file(std::string(k_folder), file, "");
  const toml::table table = parse_toml(read_text_file(file_), file_);
  for (const auto& [key, node] : table) {
    Text text;
    if (const auto number = node.value<double>()) {
      text = {plain_number(*number), *number, {}};
    } else if (const auto words = node.value<std::string>()) {
      text = {*words, 0.0, {*words}};
    } else if (const auto* list = node.as_array();
               list != nullptr && (list->empty() || list->is_homogeneous<std::string>())) {
      for (const auto& item : *list) {
        text.items.push_back(item.value_or(std::string()));
        text.toml += fmt::format("{}\"{}\"", text.toml.empty() ? "" : ", ", text.items.back());
      }
      text.toml = "[" + text.toml + "]";
    } else {
      throw Error(fmt::format("{}: {}", file_, key.str()),
                  msg("is no text, number or list of texts"), msg("correct it"));
    }
    texts_.insert_or_assign(std::string(key.str()), std::move(text));
  }
}

const TaskTexts::Text& TaskTexts::text(const std::string& name, const std::string& variant) const {
  auto found = texts_.find(name + variant);
  if (found == texts_.end()) found = texts_.find(name);
  if (found == texts_.end())
    throw Error(fmt::format("{}: {}", file_, name), msg("is missing"), msg("add it"));
  return found->second;
}

void TaskTexts::fill(std::string& out, const std::string& text, const Gaps& gaps,
                     const std::string& variant, int depth) const {
  constexpr int k_deepest = 8;
  constexpr std::size_t k_comments_at = 37;
  if (depth > k_deepest)
    throw Error(file_, msg("texts fill each other without an end"), msg("correct it"));
  std::size_t from = 0;
  for (auto [at, end] = next_gap(text, 0); at != std::string::npos;
       from = end, std::tie(at, end) = next_gap(text, from)) {
    out.append(text, from, at - from);
    const std::string name = text.substr(at + 1, end - at - 2);
    if (name == "#") {
      const std::size_t line = out.size() - (out.rfind('\n') + 1);
      out += std::string(line + 1 < k_comments_at ? k_comments_at - line : 1, ' ') + "# ";
    } else if (const auto gap = std::find_if(gaps.begin(), gaps.end(),
                                             [&](const Gap& g) { return g.name == name; });
               gap != gaps.end()) {
      out += gap->toml;
    } else {
      fill(out, this->text(name, variant).toml, gaps, variant, depth + 1);
    }
  }
  out.append(text, from);
}

std::string TaskTexts::filled(const std::string& name, const Gaps& gaps,
                              const std::string& variant) const {
  std::string out;
  fill(out, text(name, variant).toml, gaps, variant, 0);
  return out;
}

double TaskTexts::number(const std::string& name) const { return text(name, "").number; }

List TaskTexts::sentences(const std::string& name, const Gaps& gaps,
                          const std::string& variant) const {
  List list;
  for (const std::string& item : text(name, variant).items) {
    std::string english;
    std::vector<Value> values;
    std::size_t from = 0;
    for (auto [at, end] = next_gap(item, 0); at != std::string::npos;
         from = end, std::tie(at, end) = next_gap(item, from)) {
      english += item.substr(from, at - from) + "{}";
      const auto gap = std::find_if(gaps.begin(), gaps.end(), [&](const Gap& g) {
        return g.name == item.substr(at + 1, end - at - 2);
      });
      if (gap == gaps.end())
        throw Error(fmt::format("{}: {}", file_, item.substr(at, end - at)), msg("is missing"),
                    msg("add it"));
      values.push_back(gap->words);
    }
    list.items.emplace_back(kept(english + item.substr(from)), nullptr, 0, std::move(values));
  }
  return list;
}

Message TaskTexts::sentence(const std::string& name, const Gaps& gaps,
                            const std::string& variant) const {
  return sentences(name, gaps, variant).items.at(0);
}

std::vector<std::string> block_task_words() {
  std::vector<std::string> words;
  for (const auto& file : data_names(std::string(k_folder), ""))
    if (file.starts_with(k_block)) words.push_back(file.substr(k_block.size()));
  return words;
}

std::string block_task(const std::string& word) {
  const auto words = block_task_words();
  if (std::find(words.begin(), words.end(), word) == words.end())
    throw Error("--task " + word, msg("there is no such task for the block"),
                msg("choose {}", list_of(words)));
  const std::string id = std::string(k_block) + word;
  return TaskTexts(id).filled("scenario", {{"id", id},
                                           {"tooth", "block.cvt"},
                                           {"about", "the block that ships"},
                                           {"walls_limit", ""},
                                           {"tooth_criteria", ""}});
}

}  // namespace cavum::scenarios
