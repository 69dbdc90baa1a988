#include "grading/feedback/measures_page.h"

#include <fmt/core.h>

#include <sstream>

#include "grading/feedback/loss_finder.h"
#include "grading/result/measure_marking.h"

namespace cavum::grading {
namespace {

const char* better_words(scenarios::Better better) {
  switch (better) {
    case scenarios::Better::less:
      return "less";
    case scenarios::Better::more:
      return "more";
    case scenarios::Better::by_task:
      break;
  }
  return "as the task says";
}

const char* needs_words(scenarios::Needs needs) {
  switch (needs) {
    case scenarios::Needs::nothing:
      return "";
    case scenarios::Needs::protection:
      return "something protected";
    case scenarios::Needs::leeway_sides:
      return "a leeway at the sides";
    case scenarios::Needs::leeway_bottom:
      return "a leeway below";
    case scenarios::Needs::container_sides:
      return "a container at the sides";
    case scenarios::Needs::container_bottom:
      return "a container below";
    case scenarios::Needs::container:
      return "a container";
    case scenarios::Needs::aim:
      return "an aim";
    case scenarios::Needs::fault:
      return "a fault";
    case scenarios::Needs::force_limit:
      return "a force limit";
    case scenarios::Needs::pulp:
      return "a tooth with pulp";
    case scenarios::Needs::neighbour:
      return "a neighbouring tooth";
    case scenarios::Needs::gum:
      break;
  }
  return "gum";
}

std::string code(const std::string& text) { return text.empty() ? "" : fmt::format("`{}`", text); }

}  // namespace

std::string measures_page() {
  std::ostringstream out;
  out << "# The measures\n\n"
         "What a criterion of a rubric may measure. `cavum grade --measures` writes this page, from the one table that the reader of rubrics, their\n"
         "check, marking, `grade --why` and the result's JSON go by. How each is measured, and how far it may be off: [grading.md](grading.md).\n\n"
         "*Better*: which value is; where the task says it, `full` and `zero` do. *Judges*: work, that something was done, which an untouched tooth\n"
         "fails in; or care, which counts only for as much as was done. *Ends at*: values run from 0 to there; without one, `check` says nothing of\n"
         "the range. *Needs*: an exam without it has nothing to measure, and `--rubric` refuses the measure. *JSON*: where the result has it.\n"
         "*Counts*: two criteria that count the same charge one mistake twice; `check` warns of it unless one of them\n"
         "names the other under `shares_with`.\n\n"
         "| measure | unit | better | judges | ends at | what it is | counts | needs | JSON | `--why` lists |\n"
         "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  bool tissues = false;
  for (const auto& listed : scenarios::measures()) {
    if (!listed.tissue.empty() && tissues) continue;
    tissues = tissues || !listed.tissue.empty();
    const scenarios::Measure m =
        listed.tissue.empty() ? listed : scenarios::tissue_measure("TISSUE");
    const char* ends = m.most != nullptr ? m.most->words : m.tissue.empty() ? "" : "the tissue";
    out << "| " << code(m.name) << " | " << m.unit << " | " << better_words(m.better) << " | "
        << (m.judges == scenarios::Judges::work ? "work" : "care") << " | " << ends << " | "
        << m.words << " | " << english_text(msg("{}", scenarios::counts_text(m.counts))) << " | "
        << needs_words(m.needs) << " | " << code(json_location(m)) << " | " << loss_list_of(m).words
        << " |\n";
  }
  return out.str();
}

}  // namespace cavum::grading
