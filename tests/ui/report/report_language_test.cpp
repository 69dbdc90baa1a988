// Reports in another language: every word of them is translated, the file says its language,
// numbers have its decimal sign, and a name that is written from right to left leaves its line in
// order.
#include <algorithm>
#include <regex>

#include "engine/base/text.h"
#include "tests/ui/language.h"
#include "tests/ui/program.h"

namespace cavum::report {
namespace {

using nlohmann::json;
using testing_ui::k_data;
using testing_ui::readable;
using testing_ui::untranslated;

std::string joined(std::vector<std::string> words) {
  std::string all;
  for (const auto& w : words) all += w + " ";
  return all;
}

class ReportLanguage : public testing_ui::Program {
 protected:
  /// Without what the scenario says itself, and the names of operators, which are no words of the
  /// program.
  static std::string without_own_texts(std::string text, const std::string& scenario) {
    const std::string toml = read_text_file(k_data + "/scenarios/" + scenario + ".toml");
    const std::regex quoted("\\b(?:title|instruction|description) = \"([^\"]+)\"");
    std::vector<std::string> own{"novice", "perforator", "expert"};
    for (auto at = std::sregex_iterator(toml.begin(), toml.end(), quoted);
         at != std::sregex_iterator(); ++at)
      own.push_back((*at)[1]);
    std::sort(own.begin(), own.end(),
              [](const std::string& a, const std::string& b) { return a.size() > b.size(); });
    for (const auto& words : own)
      for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at))
        text.erase(at, words.size());
    return text;
  }
  /// A session of the shipped slot, sat by a simulated operator who loses points.
  std::string sit(const std::string& by, const std::string& scenario,
                  const std::string& more = "") const {
    const std::string file = path(by + ".cavum");
    const auto r =
        run("exam " + k_data + "/scenarios/" + scenario + ".toml --candidate A17 --operator " + by +
            " --quiet --out " + file + " " + more);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return file;
  }
  std::string report(const std::string& session, const std::string& reader,
                     const std::string& language, const std::string& ending = ".html") const {
    const auto r = run("--language " + language + " report " + session + " --for " + reader +
                       " --overwrite --out " + path("r" + ending));
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return read_text_file(path("r" + ending));
  }
};

TEST_F(ReportLanguage, NoWordOfAReportIsLeftOutOfTheCatalogue) {
  for (const std::string by : {"novice", "perforator"}) {
    const std::string session = sit(by, "slot");
    for (const std::string reader : {"student", "instructor"}) {
      const std::string html = report(session, reader, "qps");
      EXPECT_NE(html.find("<html lang='qps'>"), std::string::npos);
      const std::vector<std::string> left = untranslated(without_own_texts(readable(html), "slot"));
      EXPECT_TRUE(left.empty()) << by << ", " << reader << ": " << joined(left);
    }
  }
}

TEST_F(ReportLanguage, AGermanReportHoldsNoEnglishSentence) {
  const std::string session = sit("novice", "slot");
  for (const std::string reader : {"student", "instructor"}) {
    const std::string html = report(session, reader, "de"), text = readable(html);
    EXPECT_NE(html.find("<html lang='de'>"), std::string::npos);
    // English words that are no German ones
    const std::regex english(
        "\\b(the|of|and|with|which|is|from|to|by|not|for|cut|left|removed|wall|floor|points|time)\\b");
    for (auto at = std::sregex_iterator(text.begin(), text.end(), english);
         at != std::sregex_iterator(); ++at)
      ADD_FAILURE() << reader << ": ..."
                    << text.substr(std::max<std::ptrdiff_t>(0, at->position() - 60), 130) << "...";
    EXPECT_NE(text.find("Kriterien"), std::string::npos);
    EXPECT_NE(text.find("Gerade Nut in einem Block"), std::string::npos)
        << "the scenario's own German title";
    EXPECT_TRUE(std::regex_search(text, std::regex("[0-9],[0-9] von 100,0 Punkten")))
        << "decimal comma";
  }
}

TEST_F(ReportLanguage, WhatProgramsReadStaysEnglish) {
  const std::string session = sit("novice", "slot");
  const json english = run_json("grade " + session);
  const auto german = run("--language de grade " + session + " --json");
  EXPECT_EQ(json::parse(german.out), english);
  ::setenv("LANGUAGE", "de", 1);
  const std::string other = sit("expert", "slot");
  ::setenv("LANGUAGE", "en", 1);
  EXPECT_EQ(run_json("grade " + other)["verdict"], "pass");
  EXPECT_EQ(run("replay " + other + " --verify").exit_code, 0)
      << "an exam that a German station recorded and sealed";
}

TEST_F(ReportLanguage, TheSameSessionGivesTheSameBytesInEachLanguage) {
  const std::string session = sit("novice", "slot");
  for (const std::string language : {"de", "qps"})
    for (const std::string ending : {".html", ".pdf"})
      EXPECT_EQ(report(session, "student", language, ending),
                report(session, "student", language, ending));
  EXPECT_NE(report(session, "student", "de"), report(session, "student", "en"));
}

}  // namespace
}  // namespace cavum::report
