// Sentences in the reader's language: what tr() says, which language is chosen, and that the German
// catalogue takes every argument that the English sentence has.
#include "ui/language/language.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "ui/language/catalogue.h"
#include "ui/language/say.h"

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
  EXPECT_EQ(
      tr("{} points below the pass mark of {} points ({} %)", as_points(1.5), as_is("60"), 60),
      "1.5 points below the pass mark of 60 points (60 %)");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 1, 1), "1 candidate");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 0, 0), "0 candidates");
}

TEST_F(Language, GermanHasItsOwnWordsPluralsAndDecimalSign) {
  set_language("de");
  EXPECT_EQ(tr("page {} of {}", 1, 12), "Seite 1 von 12");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 1, 1), "1 Prüfling");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 2, 2), "2 Prüflinge");
  EXPECT_EQ(trn("{} candidate", "{} candidates", 0, 0), "0 Prüflinge");
  EXPECT_EQ(tr("{} of {} points", as_points(71.25, 2), as_points(100)), "71,25 von 100,0 Punkten");
}

TEST_F(Language, NumbersHaveTheReadersDecimalSignAndNamesStayAsTheyAre) {
  set_language("de");
  EXPECT_EQ(tr(msg("{}", as_mm(0.3, 2, 0.02))), "0,30 ± 0,02 mm");
  EXPECT_EQ(tr(msg("{}", Vec3{1.2, 0.3, -2.1})), "[1,20; 0,30; -2,10] mm");
  for (const char* name : {"round-1.0", "exam-2.5.cavum", "full marks"})
    EXPECT_EQ(tr(msg("{}", name)), name);
}

TEST_F(Language, AnAuthorsTextIsSaidAsItsFileHasIt) {
  set_language("de");
  const Message text = msg("{}", Authored{"Open the chamber, slowly."});
  EXPECT_EQ(tr(text), "Open the chamber, slowly.");
  add_translations({{"Open the chamber, slowly.", "Langsam die Kammer eröffnen."}});
  EXPECT_EQ(tr(text), "Langsam die Kammer eröffnen.");
}

TEST_F(Language, ThePseudoLanguageBracketsWhatTheSourcesSayAndNothingElse) {
  set_language("qps");
  EXPECT_EQ(tr("page {} of {}", 1, 2), "⟦þáĝé 1 ôf 2⟧");
  EXPECT_EQ(tr(msg("{}", "a name")), "⟨a name⟩");
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

}  // namespace
}  // namespace cavum
