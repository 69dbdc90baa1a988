// Reports in German of each faulty preparation that the trial makes (docs/trial.md): no English
// word is left, and numbers and units are as German has them. What an English word is follows from
// the catalogue: one that its English sentences hold, and its German ones do not, or seldom.
#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "engine/base/file.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tooth.h"
#include "grading/trial/coarse_tooth.h"
#include "grading/trial/faulty_preparations.h"
#include "scenarios/file/parse.h"
#include "scenarios/zones/placed.h"
#include "scenarios/zones/zone_map.h"
#include "tests/ui/language.h"
#include "tests/ui/program.h"
#include "ui/language/catalogue.h"
#include "ui/language/language.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

using testing_ui::k_data;

/// Words of letters alone, in small ones; what stands beside a digit, / _ . or \ is a file, an
/// identifier or a version.
std::vector<std::string> words_of(const std::string& text) {
  static const std::regex k_name("[^ \n]*([A-Za-z][0-9_./\\\\]|[0-9_/\\\\][A-Za-z])[^ \n]*");
  std::vector<std::string> words;
  std::string word;
  for (const char c : std::regex_replace(text, k_name, " ") + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 ||
        (static_cast<unsigned char>(c) & 0x80U) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    if (word.size() >= 3) words.push_back(word);
    word.clear();
  }
  return words;
}

std::set<std::string> english_words() {
  std::map<std::string, int> english, of_german;
  std::istringstream lines(read_text_file(std::string(CAVUM_SOURCE_DIR) + "/data/languages/de.po"));
  for (std::string line; std::getline(lines, line);) {
    auto& words = line.starts_with("msgid") ? english : of_german;
    if (!line.starts_with("msg")) continue;
    for (const auto& w : words_of(line.substr(line.find('"')))) ++words[w];
  }
  std::set<std::string> out;
  for (const auto& [word, times] : english)
    if (times > 3 * of_german[word])
      out.insert(word);  // German ones quote a few, as names of options
  return out;
}

/// All that a reader sees of it.
struct Texts {
  std::vector<std::string> list;
  void add(const Picture& p) {
    list.push_back(testing_ui::readable(p.svg));
    list.push_back(p.title);
  }
  void operator()(const Heading& b) { list.push_back(b.text); }
  void operator()(const Paragraph& b) { list.insert(list.end(), {b.text, b.lead}); }
  void operator()(const Bullets& b) { list.insert(list.end(), b.items.begin(), b.items.end()); }
  void operator()(const ReportTable& b) {
    for (const auto& c : b.columns) list.push_back(c.title);
    for (const auto& row : b.rows)
      for (const auto& cell : row.cells) list.push_back(cell.text);
  }
  void operator()(const VerdictBox& b) {
    list.push_back(b.score);  // the verdict is translated where it is printed
    list.insert(list.end(), b.lines.begin(), b.lines.end());
    list.insert(list.end(), b.reasons.begin(), b.reasons.end());
  }
  void operator()(const Pictures& b) {
    for (const auto& p : b.list) add(p);
  }
  void operator()(const LiveFigure& b) {
    list.insert(list.end(), {b.title, b.fallback});
    for (const auto& p : b.on_paper) add(p);
  }
  void operator()(const LessonList& b) {
    for (const auto& i : b.items) {
      list.insert(list.end(), {i.weight, i.what, i.instead});
      if (i.picture) add(*i.picture);
    }
  }
  void operator()(const Fold& b) { list.push_back(b.title); }
  void operator()(const FoldEnd&) {}
  void operator()(const CutLine&) {}
};

class TrialLanguage : public ::testing::TestWithParam<const char*> {
 protected:
  void TearDown() override { set_language("en"); }

  /// What each reader is shown of each piece of work, text by text; of those in a tooth, which take
  /// longer than those in a block, every `every`th. Returns how many reports that were.
  template <class See>
  int for_each_text(std::size_t every, const See& see) const {
    const Tooth fine = load_tooth_file(scenarios::find_tooth_file(scenario_)),
                tooth = grading::coarse_tooth(fine);
    const scenarios::ZoneMap zones =
        scenarios::follows_landmarks(scenario_.zones)
            ? scenarios::build_zones(scenario_, tooth, find_landmarks(fine))
            : scenarios::build_zones(scenario_, tooth);
    const grading::Task task = grading::make_task(scenario_, tooth, zones);
    const grading::TargetField field(tooth, zones);
    const auto works = grading::faulty_preparations(task, field);
    int reports = 0;
    for (std::size_t i = 0; i < works.size(); i += std::string(GetParam()) == "slot" ? 1 : every)
      static_cast<void>(grading::sit(
          task, works[i].cut, grading::box_of_work(field, works[i].below_mm), 0,
          [&](const auto& input, const auto& result) {
            grading::ReportFacts facts;
            facts.candidate = "A17", facts.source = {SourceKind::simulated_operator, "novice"};
            ReportSource source = report_source(result, input, facts, scenario_.rubric);
            for (const ReportReader reader : {ReportReader::student, ReportReader::instructor}) {
              source.reader = reader;
              const Document d = report_document(source);
              Texts texts;
              texts.list = {d.title, d.subtitle};
              for (const auto& block : d.blocks) std::visit(texts, block);
              for (std::string text : texts.list) {
                for (const std::string& name :
                     {tooth.name, facts.source.name})  // data of their files, said as they stand
                  if (const auto at = text.find(name); at != std::string::npos)
                    text.erase(at, name.size());
                see(works[i].name, reader, text);
              }
              ++reports;
            }
          }));
    return reports;
  }

  scenarios::Scenario scenario_ =
      scenarios::load_scenario(k_data + "/scenarios/" + GetParam() + ".toml");
};

TEST_P(TrialLanguage, NoEnglishIsLeftInAReportOfAnyFaultyPreparation) {
  set_language("de");
  std::set<std::string> english = english_words();
  for (const char* word : {"the", "cut", "left", "wall", "tick", "removed", "seed"})
    EXPECT_TRUE(english.contains(word)) << word;
  for (const auto& [original, text] : scenario_.languages.at("de"))
    for (const auto& w : words_of(text)) english.erase(w);
  const std::regex wrong_number(
      "(^|[^0-9.])[0-9]+\\.[0-9]+($|[^0-9.])|mm[23]($|[^0-9a-z_])|[0-9](mm|%|s)($|[^a-z])");
  std::set<std::string> said_before;
  const int reports =
      for_each_text(3, [&](const std::string& work, ReportReader reader, const std::string& text) {
        for (const auto& w : words_of(text))
          if (english.contains(w) && said_before.insert(w).second)
            ADD_FAILURE() << work << ": '" << w << "' in: " << text;
        std::smatch at;
        if (std::regex_search(text, at, wrong_number) && said_before.insert(at.str()).second)
          ADD_FAILURE() << work << ": " << at.str() << " in: " << text;
        if (reader == ReportReader::student) {
          EXPECT_EQ(text.find("(Takt "), std::string::npos) << text;
        }
      });
  EXPECT_GT(reports, 20);
}

TEST_P(TrialLanguage, NoWordIsOutsideThePseudoLanguagesBrackets) {
  set_language(k_pseudo_language);
  std::vector<std::string> own;  // the texts of the scenario, which has no such language; German
                                 // ones, where German was shown before
  for (const auto& [original, text] : scenario_.languages.at("de"))
    own.insert(own.end(), {original, text});
  std::sort(own.begin(), own.end(),
            [](const std::string& a, const std::string& b) { return a.size() > b.size(); });
  std::set<std::string> said_before;
  const int reports =
      for_each_text(6, [&](const std::string& work, ReportReader, std::string text) {
        for (const auto& words : own)
          for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at))
            text.erase(at, words.size());
        for (const auto& w : testing_ui::untranslated(text))
          if (said_before.insert(w).second) ADD_FAILURE() << work << ": '" << w << "' in: " << text;
      });
  EXPECT_GT(reports, 10);
}

INSTANTIATE_TEST_SUITE_P(Tasks, TrialLanguage,
                         ::testing::Values("slot", "class_2_neighbour", "molar_access"),
                         [](const auto& task) { return std::string(task.param); });

}  // namespace
}  // namespace cavum::report
