// No verb writes over what it reads: an exam, a scenario, a scan cannot be lost by a slip in a file
// name.
#include <filesystem>

#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;

class OwnPlaces : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    fs::copy(std::string(CAVUM_SOURCE_DIR) + "/tests/replay/sessions/block_expert.cavum",
             path("s.cavum"));
    fs::copy(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/slot.toml", path("slot.toml"));
    write_text_file(path("e.stl"), "solid e\nendsolid e\n");
  }
  /// Refused with its name, and the file is as it was.
  void expect_kept(const std::string& name, const std::string& arguments) {
    const Bytes before = read_file(path(name));
    expect_refused(arguments, {name});
    EXPECT_EQ(read_file(path(name)), before) << arguments;
  }
};

TEST_F(OwnPlaces, ASealedExamIsNoPlaceForAVerdict) {
  expect_kept("s.cavum", "replay " + path("s.cavum") + " --verify --junit " + path("s.cavum"));
  expect_kept("s.cavum", "replay " + path("") + " --verify --junit " + path("./s.cavum"));
  expect_kept("s.cavum", "grade " + path("s.cavum") + " --out " + path("s.cavum"));
  expect_kept("s.cavum", "report " + path("s.cavum") + " --out " + path("s.cavum"));
}

TEST_F(OwnPlaces, AnExamKeepsItsScenario) {
  const std::string exam =
      "exam " + path("slot.toml") + " --candidate x --operator expert --out " + path("x.cavum");
  expect_kept("slot.toml", exam + " --report " + path("slot.toml"));
  expect_refused(exam + " --report " + path("x.cavum"), {"x.cavum"});
  EXPECT_FALSE(fs::exists(path("x.cavum"))) << "it is said before the exam begins";
}

TEST_F(OwnPlaces, AScanAndAToothAreKept) {
  expect_kept("e.stl", "tooth import --enamel " + path("e.stl") + " --dentin " + path("d.stl") +
                           " --pulp " + path("p.stl") + " --out " + path("e.stl"));
  ASSERT_EQ(run("tooth make cube --edge-mm 1 --leaf-mm 0.1 --out " + path("c.cvt")).exit_code, 0);
  expect_kept("c.cvt", "tooth mesh " + path("c.cvt") + " --out " + path("c.cvt"));
}

}  // namespace
}  // namespace cavum::ui
