// Verbs and their errors in another language: in the pseudo-language no word stands outside
// brackets but those that the lists below name, each with its reason; in German none of the small
// words of English is left.
#include <algorithm>
#include <regex>

#include "tests/ui/language.h"
#include "tests/ui/program.h"

namespace cavum {
namespace {

using testing_ui::k_data;

/// What stays as it is typed or written: names of verbs and options, of candidates and operators,
/// of files' own texts.
const char* const k_names =
    "tooth scenario exam replay serve office session grade scan rig explain ledger report cohort verify devices station manual simulated falcon "
    "touch inverse3 "
    "novice expert nobody none Seat Ann Lee Dentistry walls removed upright depth elsewhere school out enrol help why cavum";
/// The task's own English texts, which its file brings in German as well.
const char* const k_own_texts = "Straight slot in a block Block cavity";
/// Options as they are typed.
const char* const k_options = "verify-all h,--help help version language see VERB";

class VerbLanguage : public testing_ui::Program {
 protected:
  /// Commands with what they need before them, each a line; those that refuse are meant to.
  [[nodiscard]] std::vector<std::string> tour() const {
    const std::string slot = k_data + "/scenarios/slot.toml", s = path("n.cavum"), l = path("L");
    return {"--help", "exam " + slot + " --candidate A17 --operator novice --quiet --out " + s,
            "grade " + s, "replay " + s + " --verify", "verify " + s,
            "report " + s + " --no-replay --out " + path("r.html"),
            "scenario show " + slot + " --out " + path("s.svg"),
            "ledger init " + l + " --school Dentistry",
            "ledger ticket " + l + " " + slot +
                " --candidate 4711 --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " +
                path("t"),
            "ledger add " + l + " " + s, "ledger release " + l + " --all", "ledger verify " + l,
            "ledger backup " + l + " --out " + path("B"),
            // refused
            "grade " + path("none.cavum"), "grade " + path("bad.cavum"),
            "tooth info " + path("bad.cvt"),
            "tooth import --enamel " + path("bad.stl") + " --dentin " + path("bad.stl") +
                " --pulp " + path("bad.stl") + " --out " + path("x.cvt"),
            "exam " + slot + " --candidate A --operator nobody --out " + path("x.cavum"),
            "exam " + slot + " --candidate A17 --operator expert --out " + s,
            "ledger add " + l + " " + path("bad.cavum"), "ledger init " + l,
            "ledger release " + path("none") + " --all", "report " + s + " --out " + path("x.doc"),
            "cohort report " + l + " --exam none --out " + path("x.html"),
            "grade " + s + " --why nothing"};
  }
  void write_bad_files() const {
    for (const char* name : {"bad.cavum", "bad.cvt", "bad.stl"})
      write_text_file(path(name), "rubbish");
  }
};

TEST_F(VerbLanguage, NoWordOfAVerbOrAnErrorIsLeftOutOfTheCatalogue) {
  write_bad_files();
  const std::string allowed =
      std::string(" ") + k_names + " " + k_own_texts + " " + k_options + " ";
  for (const auto& command : tour()) {
    const auto r = run("--language qps " + command);
    if (command.find("--quiet") == std::string::npos &&
        !command.starts_with("ledger ticket ")) {  // a code, a folder, a candidate
      EXPECT_NE((r.out + r.err).find("\u27e6"), std::string::npos)
          << command << " says nothing in this language:\n"
          << r.out << r.err;
    }
    std::string left;
    for (const auto& word : testing_ui::untranslated(r.out + "\n" + r.err))
      if (allowed.find(" " + word + " ") == std::string::npos) left += word + " ";
    EXPECT_EQ(left, "") << command << "\n" << r.out << r.err;
  }
}

TEST_F(VerbLanguage, NoWordOfAPageOrAPictureIsLeftOutOfTheCatalogue) {
  const std::pair<std::string, std::string> written[] = {
      {"explain " + k_data + "/measured/fig6/fig6.csv --out ", "table.html"},
      {"explain --protocol ", "protocol.html"},
      {"rig cube --runs 1 --k 0.4,0.8 --model consistent --out ", "cube.svg"},
      {"scenario show " + k_data + "/scenarios/slot.toml --out ", "sheet.svg"}};
  for (const auto& [command, file] : written) {
    const auto r = run("--language qps " + command + path(file));
    ASSERT_EQ(r.exit_code, 0) << r.err;
    EXPECT_EQ(testing_ui::untranslated(testing_ui::readable(read_text_file(path(file)))),
              std::vector<std::string>{})
        << file;
  }
}

TEST_F(VerbLanguage, InGermanNoEnglishSentenceIsLeft) {
  write_bad_files();
  const std::regex english(
      "\\b(the|of|and|with|which|is|from|to|by|not|for|cut|left|points|cannot|use|give|choose|there|has)\\b");
  for (const auto& command : tour()) {
    const auto r = run("--language de " + command);
    const std::string text = std::regex_replace(r.out + r.err, std::regex("--[a-z-]+"), "");
    for (auto at = std::sregex_iterator(text.begin(), text.end(), english);
         at != std::sregex_iterator(); ++at)
      ADD_FAILURE() << command << ": ..."
                    << text.substr(std::max<std::ptrdiff_t>(0, at->position() - 60), 130) << "...";
  }
}

}  // namespace
}  // namespace cavum
