// The station in another language: the words of its screens, as the window shows them.
#include <filesystem>

#include "tests/ui/language.h"
#include "tests/ui/station/station_window.h"

namespace cavum::station {
namespace {

using testing_ui::untranslated;

class StationLanguage : public StationWindow {
 protected:
  /// What the screen says after `script`, which ends with `words NAME`.
  [[nodiscard]] static std::string words(const std::string& name) {
    return read_text_file(std::string(CAVUM_PICTURES) + "/" + name + ".txt");
  }
  static void expect_all_translated(const std::string& name) {
    // what the scenario says itself
    const std::string slot =
        read_text_file(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/slot.toml");
    std::string all;
    for (const auto& w : untranslated(words(name)))
      if (slot.find(w) == std::string::npos) all += w + " ";
    EXPECT_EQ(all, "") << name << ":\n" << words(name);
  }
};

TEST_F(StationLanguage, EveryScreenOfAnExamIsTranslated) {
  const std::string script =
      "sleep 0.5\nwords qps-sign-in\ntype T5\ngo device-check\nwords qps-check\ngo briefing\nwords qps-briefing\nkey enter\nwait exam\nsleep "
      "1\nwords qps-exam\n"
      "key escape\nsleep 0.5\nwords qps-end\nkey enter\nwait result\nsleep 0.3\nwords qps-result\nkey f2\nsleep 0.5\nwords qps-report\nclose\n";
  ASSERT_EQ(
      run(script, "--language qps", std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/slot.toml"), 0)
      << said();
  for (const char* name : {"qps-sign-in", "qps-check", "qps-briefing", "qps-exam", "qps-end",
                           "qps-result", "qps-report"})
    expect_all_translated(name);
}

TEST_F(StationLanguage, GermanScreensSayWhatTheScenarioSaysInGerman) {
  const std::string script =
      "sleep 0.5\nwords de-sign-in\npicture de-sign-in\ntype T5\ngo device-check\ngo briefing\nwords de-briefing\npicture de-briefing\nclose\n";
  ASSERT_EQ(
      run(script, "--language de", std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/slot.toml"), 0)
      << said();
  EXPECT_NE(words("de-sign-in").find("Prüflingscode"), std::string::npos) << words("de-sign-in");
  const std::string briefing = words("de-briefing");
  for (const char* part : {"Gerade Nut in einem Block",
                           "Gehen Sie in der Mitte der Nut 1,5 mm hinab.", "Prüfling", "Minuten"})
    EXPECT_NE(briefing.find(part), std::string::npos) << part << "\n" << briefing;
}

}  // namespace
}  // namespace cavum::station
