// Sentences in the reader's language: what tr() says, what shown() makes of English sentences that were made elsewhere, which language is chosen, and
// that the German catalogue takes every argument that the English sentence has.
#include "engine/language/language.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "engine/base/error.h"
#include "engine/base/kept.h"
#include "engine/base/text.h"
#include "engine/language/catalogue.h"
#include "engine/language/pattern.h"
#include "engine/language/say.h"

namespace cavum {
namespace {

/// Each test begins and ends in English, whatever the environment says.
class Language : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"}) ::unsetenv(name);
    set_language("en");
  }
  void TearDown() override { set_language("en"); }
};

TEST_F(Language, EnglishIsWhatStandsInTheCode) {
  EXPECT_EQ(tr("page {} of {}", 1, 12), "page 1 of 12");
  EXPECT_EQ(tr("{} points below the pass mark of {} points ({} %)", fixed(1.5, 1), "60", 60), "1.5 points below the pass mark of 60 points (60 %)");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 1, 1), "1 candidate");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 0, 0), "0 candidates");
  EXPECT_EQ(shown("page 1 of 12"), "page 1 of 12");
}

TEST_F(Language, GermanHasItsOwnWordsPluralsAndDecimalSign) {
  set_language("de");
  EXPECT_EQ(tr("page {} of {}", 1, 12), "Seite 1 von 12");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 1, 1), "1 Prüfling");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 2, 2), "2 Prüflinge");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 0, 0), "0 Prüflinge");
  EXPECT_EQ(tr("{} of {} points", fixed(71.25, 2), fixed(100, 1)), "71,25 von 100,0 Punkten");
}

TEST_F(Language, NumbersWithTheirUnitsGetTheDecimalSignAndNamesDoNot) {
  set_language("de");
  EXPECT_EQ(shown("0.30 ± 0.02 mm"), "0,30 ± 0,02 mm");
  EXPECT_EQ(shown("-2.10"), "-2,10");
  EXPECT_EQ(shown("1.20, 0.30, -2.10"), "1,20; 0,30; -2,10");
  EXPECT_EQ(shown("71.2 / 100.0"), "71,2 / 100,0");
  for (const char* name : {"round-1.0", "exam-2.5.cavum", "0.2.0", "2026-11-21T09:00:00Z", "v1.5"}) EXPECT_EQ(shown(name), name);
}

TEST_F(Language, ASentenceThatWasMadeElsewhereIsTranslatedWithWhatStandsInItsGaps) {
  set_language("de");
  EXPECT_EQ(shown("The pulp was opened mesiobuccally at 1:05."), "Eröffnet wurde Pulpa mesiobukkal bei 1:05.");
  EXPECT_EQ(shown("You pressed with 1.5 N on average and up to 3.0 N at 0:12."),
            "Sie drückten im Mittel mit 1,5 N und höchstens mit 3,0 N bei 0:12.");
  EXPECT_EQ(shown("full marks; critical"), "volle Punktzahl; kritisch");
  EXPECT_EQ(shown("Pause  (P), 1 left"), "Pause  (P), noch 1") << "no part takes a sentence that begins with a gap";
  EXPECT_EQ(shown("3.1 mm³ of the cavity was left standing, the largest part (61 %) at the floor, up to 0.62 mm thick."),
            "3,1 mm³ der Kavität blieben stehen, der größte Teil (61 %) hier: Boden, bis zu 0,62 mm dick.");
  EXPECT_EQ(shown("nothing like this is in any catalogue"), "nothing like this is in any catalogue");
  EXPECT_EQ(shown(shown("full marks")), "volle Punktzahl") << "a translation is not translated again";
}

TEST_F(Language, WhatIsPassedAsItIsStaysAndKeepsTheLineInOrder) {
  set_language("de");
  EXPECT_EQ(tr("Candidate {}", as_is("pass")), "Prüfling pass");
  EXPECT_EQ(tr("Candidate {}", as_is("Müller 1.5")), "Prüfling Müller 1.5");
  const std::string arabic = "\u0633\u0627\u0631\u0629", hebrew = "\u05e0\u05d5\u05e2\u05d4";
  for (const std::string& name : {arabic, hebrew}) EXPECT_EQ(tr("Candidate {}", as_is(name)), "Prüfling \u2068" + name + "\u2069");
  EXPECT_EQ(as_is("a\u2067b\nc").text, "a b c") << "nobody isolates by himself";
  EXPECT_EQ(with_isolates("1 \u2068" + arabic + "\u2069 < 2", xml_text, "<bdi>", "</bdi>"), "1 <bdi>" + arabic + "</bdi> &lt; 2");
  EXPECT_EQ(with_isolates("\u2068 never ended", xml_text, "<bdi>", "</bdi>"), xml_text("\u2068 never ended"));
}

TEST_F(Language, AnIdentifierInAPrintedLineIsKept) {
  EXPECT_EQ(kept("depth"), "depth");
  set_language("de");
  EXPECT_EQ(shown("depth"), "Tiefe");
  EXPECT_EQ(shown(kept("depth")), "depth");
  EXPECT_EQ(shown("  " + kept("removed         ") + "12.3 / 30.0   full marks"), "  removed         12,3 / 30,0   volle Punktzahl");
  EXPECT_EQ(shown("critical criterion " + kept("walls") + ": 0.65 ± 0.05 mm"), "kritisches Kriterium walls: 0,65 ± 0,05 mm");
  EXPECT_EQ(shown("take one of: " + kept("depth") + ", " + kept("time")).substr(shown("take one of: ").size() - 1), " depth, time");
  EXPECT_EQ(without_marks("a " + kept("depth") + " b"), "a depth b");
  set_language("qps");
  EXPECT_EQ(shown(kept("depth")), "⟨depth⟩");
}

TEST_F(Language, AMessageOfSeveralLinesIsFoundLineByLine) {
  set_language("de");
  EXPECT_EQ(shown("\ntime 24.5 s (handpiece 23.5 s, idle 1.4 s), way 141 mm, force 0.89 N mean, 1.54 N peak\n"),
            "\nZeit 24,5 s (Handstück 23,5 s, untätig 1,4 s), Weg 141 mm, Kraft 0,89 N im Mittel, 1,54 N höchstens\n");
}

TEST_F(Language, AnIndentedLineIsThatOfTheSame) {
  set_language("de");
  const std::string line =
      "stylus inverse3: no service listens at 127.0.0.1:10001 (Connection refused); start the Haply Inverse Service (`systemctl start "
      "haply-inverse-service`), or name its port in stylus-inverse3.toml";
  const std::string indented = shown("    " + line);  // asked for first: what fails once is remembered
  EXPECT_EQ(indented, "    " + shown(line));
  EXPECT_NE(indented.find("nennen Sie seinen Port in"), std::string::npos) << indented;
}

TEST_F(Language, ATextInAPictureIsTranslatedAndItsTagsAreNot) {
  set_language("de");
  EXPECT_EQ(shown_svg("<svg aria-label='target'><text x='1.5' y='2'>removed, damage</text><text>0.5</text><path d='M1.5 2'/></svg>"),
            "<svg aria-label='Sollkavität'><text x='1.5' y='2'>abgetragen, Schaden</text><text>0,5</text><path d='M1.5 2'/></svg>");
  EXPECT_EQ(shown_svg("<text>mesial &#8594;</text>"), "<text>mesial &#8594;</text>");
  EXPECT_EQ(shown_svg("<text>&#8593; buccal</text>"), "<text>&#8593; bukkal</text>");
}

TEST_F(Language, ABadTranslationFallsBackToEnglish) {
  EXPECT_EQ(language_detail::fill("Seite {} von {} und {}", "page {} of {}", 1, 2), "page 1 of 2");
  EXPECT_EQ(language_detail::fill("Seite {", "page {}", 1), "page 1");
}

TEST_F(Language, ThePseudoLanguageBracketsWhatTheSourcesSayAndNothingElse) {
  set_language("qps");
  EXPECT_EQ(tr("page {} of {}", 1, 2), "⟦þáĝé 1 ôf 2⟧");
  EXPECT_EQ(shown("full marks"), "⟦fûļļ máŕkš⟧");
  EXPECT_EQ(shown("nobody says this"), "nobody says this");
}

TEST_F(Language, TheEnvironmentChoosesTheFirstThatThereIs) {
  EXPECT_EQ(language_of_environment(), "en");
  ::setenv("LANG", "de_AT.UTF-8", 1);
  EXPECT_EQ(language_of_environment(), "de");
  ::setenv("LC_ALL", "xx_XX", 1);
  EXPECT_EQ(language_of_environment(), "de") << "there is no such catalogue: the next is asked";
  ::setenv("LC_MESSAGES", "C", 1);
  EXPECT_EQ(language_of_environment(), "en");
  ::setenv("LANGUAGE", "xx:de:en", 1);
  EXPECT_EQ(language_of_environment(), "de");
}

TEST_F(Language, AnUnknownLanguageIsRefusedWithThoseThatThereAre) {
  for (const char* wrong : {"xx", "", "../de", "de/../de"}) {
    try {
      set_language(wrong);
      FAIL() << wrong;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("en, de"), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(language(), "en");
}

TEST_F(Language, TheOptionIsTakenOutOfTheCommandLine) {
  std::vector<std::string> words{"report", "--language", "de", "s.cavum", "--", "--language"};
  EXPECT_EQ(take_language_option(words), "de");
  EXPECT_EQ(words, (std::vector<std::string>{"report", "s.cavum", "--", "--language"}));
  words = {"--language=qps", "exam"};
  EXPECT_EQ(take_language_option(words), "qps");
  words = {"exam", "--language"};
  EXPECT_THROW((void)take_language_option(words), Error);
}

TEST_F(Language, APatternFindsWhatStoodInItsGaps) {
  EXPECT_EQ(*Pattern("{} of {:.1f} steps").match("3 of 4.0 steps"), (std::vector<std::string>{"3", "4.0"}));
  EXPECT_EQ(*Pattern("{1} before {0}").match("a before b"), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(*Pattern("%d of %zu, %.2f %% more").match("1 of 2, 3.00 % more"), (std::vector<std::string>{"1", "2", "3.00"}));
  EXPECT_EQ(*Pattern("a{}b{}b").match("a1b2bb"), (std::vector<std::string>{"1", "2b"}));
  EXPECT_FALSE(Pattern("{} of {} steps").match("3 of 4 points"));
  EXPECT_EQ(Pattern("{{}} {}").message(), "{{}} {}");
  EXPECT_EQ(Pattern::fill("{1} vor {0}", {"a", "b"}), "b vor a");
  EXPECT_THROW((void)Pattern::fill("{2}", {"a"}), std::invalid_argument);
  EXPECT_EQ(Pattern("5 % of {}").gaps(), 1U);
}

/// Arguments with their forms, in any order: what translation and message must have in common.
std::vector<std::string> arguments(const std::string& message) {
  std::vector<std::string> a = Pattern::arguments(message);
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

TEST_F(Language, EveryGermanSentenceTakesTheArgumentsOfItsEnglishOne) {
  const Catalogue german("de");
  std::size_t translated = 0;
  for (const std::string& m : Catalogue::messages()) {
    const auto t = german.find(m);
    if (!t) continue;  // a plural, looked up with its count
    ++translated;
    EXPECT_EQ(arguments(*t), arguments(m)) << m << "\n" << *t;
    EXPECT_EQ(lines_of(*t).size(), lines_of(m).size()) << m << "\n" << *t;
    EXPECT_EQ(m.front() == ' ', t->front() == ' ') << m << "\n" << *t;
    EXPECT_EQ(m.back() == ' ', t->back() == ' ') << "'" << m << "'\n'" << *t << "'";
  }
  std::printf("%zu of %zu messages held against their translation\n", translated, Catalogue::messages().size());
  EXPECT_GT(translated, 900U);
}

}  // namespace
}  // namespace cavum
