// Checkpoints, cosigners, backups by the commands of the README, and the verifier that ships, which
// needs nothing of ours: run as it stands on what the program wrote, and on what somebody made of
// it.
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class LedgerNotes : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
    ticket("4711");
    ticket("4712");
  }
  void ticket(const std::string& who) const {
    ASSERT_EQ(
        run("ledger ticket " + path("L") + " " + CAVUM_SOURCE_DIR +
            "/tests/replay/block_cavity.toml --candidate " + who +
            " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path(who + ".ticket"))
            .exit_code,
        0);
  }
  std::string school_key() const { return read_text_file(path("home/school.pub")).substr(0, 64); }
  /// As on another computer: with a home of its own.
  testing_ui::Ran elsewhere(const std::string& arguments) const {
    setenv("CAVUM_HOME", path("elsewhere").c_str(), 1);
    auto ran = run(arguments);
    setenv("CAVUM_HOME", path("home").c_str(), 1);
    return ran;
  }
  /// Has the ledger cosigned and keeps that; returns the cosigner's key line.
  std::string have_cosigned(const std::string& name) const {
    EXPECT_EQ(run("ledger checkpoint " + path("L") + " --out " + path(name + ".request")).exit_code,
              0);
    const auto r = elsewhere("ledger cosign " + path(name + ".request") + " --school-key " +
                             school_key() + " --out " + path(name) + " --json");
    EXPECT_EQ(r.exit_code, 0) << r.out << r.err;
    const std::string key = json::parse(r.out)["cosigner"];
    write_text_file(path("home/cosigners"), "# who signs our ledger\n" + key + "\n");
    EXPECT_EQ(run("ledger add-cosignature " + path("L") + " " + path(name)).exit_code, 0);
    return key;
  }
  /// Exit code of the verifier that ships, on a receipt.
  int verify(const json& receipt, const std::string& more) const {
    write_text_file(path("r.json"), receipt.dump());
    const int status =
        std::system(("python3 " + std::string(CAVUM_SOURCE_DIR) + "/docs/verify_receipt.py " +
                     path("r.json") + " " + more + " >" + path("said") + " 2>&1")
                        .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(LedgerNotes, TheVerifierThatShipsChecksReceiptsWithoutUs) {
  const std::string cosigner = have_cosigned("n1");
  ASSERT_EQ(
      run("ledger receipt " + path("L") + " --entry 1 --from-size 2 --out " + path("receipt.json"))
          .exit_code,
      0);
  const json sound = json::parse(read_text_file(path("receipt.json")));
  const std::string ours = school_key() + " '" + cosigner + "'";
  ASSERT_EQ(verify(sound, school_key()), 0) << read_text_file(path("said"));
  ASSERT_EQ(verify(sound, ours), 0) << read_text_file(path("said"));
  for (int entry = 0; entry < 3; ++entry)
    for (int from = 0; from <= 3; ++from) {
      const std::string file = path("r-" + std::to_string(entry) + "-" + std::to_string(from));
      ASSERT_EQ(run("ledger receipt " + path("L") + " --entry " + std::to_string(entry) +
                    " --from-size " + std::to_string(from) + " --out " + file)
                    .exit_code,
                0);
      EXPECT_EQ(verify(json::parse(read_text_file(file)), ours), 0)
          << entry << " " << from << read_text_file(path("said"));
    }

  // in a note, in its lines: text 0 to 3, empty, the school's signature, the cosigner's
  const auto edit_line = [](const json& note, std::size_t line,
                            const std::function<void(std::string&)>& change) {
    std::vector<std::string> lines;
    std::string text = note;
    for (std::size_t from = 0; from < text.size(); from = text.find('\n', from) + 1)
      lines.push_back(text.substr(from, text.find('\n', from) - from));
    change(lines.at(line));
    text.clear();
    for (const auto& l : lines) text += l + "\n";
    return text;
  };
  const auto other_digit = [](std::string& text, std::size_t from_end) {
    char& c = text.at(text.size() - from_end);
    c = c == 'A' ? 'B' : 'A';
  };
  const auto swap_hex = [](json& hash) {
    std::string text = hash;
    text[10] = text[10] == '0' ? '1' : '0';
    hash = text;
  };
  const std::vector<std::pair<std::string, std::function<void(json&)>>> tampered = {
      {"another candidate",
       [](json& r) {
         std::string e = r["entry"];
         e.replace(e.find("C-"), 2, "D-");
         r["entry"] = e;
       }},
      {"another place in the tree", [](json& r) { r["seq"] = 2; }},
      {"another hash on the way", [&](json& r) { swap_hex(r["inclusion"][0]); }},
      {"a hash too many", [](json& r) { r["inclusion"].push_back(r["inclusion"][0]); }},
      {"a hash too few", [](json& r) { r["inclusion"].erase(0); }},
      {"another size",
       [&](json& r) {
         r["checkpoint"] = edit_line(r["checkpoint"], 1, [](std::string& l) { l = "4"; });
       }},
      {"another root",
       [&](json& r) {
         r["checkpoint"] =
             edit_line(r["checkpoint"], 2, [&](std::string& l) { other_digit(l, 5); });
       }},
      {"another time",
       [&](json& r) {
         r["checkpoint"] = edit_line(
             r["checkpoint"], 3, [&](std::string& l) { l.back() = l.back() == '1' ? '2' : '1'; });
       }},
      {"another signature of the school",
       [&](json& r) {
         r["checkpoint"] =
             edit_line(r["checkpoint"], 5, [&](std::string& l) { other_digit(l, 9); });
       }},
      {"a cosignature of another moment",
       [&](json& r) {
         r["checkpoint"] =
             edit_line(r["checkpoint"], 6, [&](std::string& l) { other_digit(l, 92); });
       }},
      {"a cosigner's signature changed",
       [&](json& r) {
         r["checkpoint"] =
             edit_line(r["checkpoint"], 6, [&](std::string& l) { other_digit(l, 9); });
       }},
      {"a cosigner's line taken out",
       [&](json& r) {
         r["checkpoint"] =
             edit_line(r["checkpoint"], 6, [](std::string& l) { l = "— x AAAAAAAAAAA="; });
       }},
      {"another ledger", [](json& r) { r["ledger"] = std::string(32, 'a'); }},
      {"a beginning with another hash", [&](json& r) { swap_hex(r["consistency"]["proof"][0]); }},
      {"a beginning of another size", [&](json& r) { r["consistency"]["from"] = r["checkpoint"]; }},
      {"a beginning of another root",
       [&](json& r) {
         r["consistency"]["from"] =
             edit_line(r["consistency"]["from"], 2, [&](std::string& l) { other_digit(l, 5); });
       }},
      {"no proof at all", [](json& r) { r = json::object(); }},
  };
  for (const auto& [name, change] : tampered) {
    json r = sound;
    change(r);
    ASSERT_NE(r, sound) << name;
    EXPECT_EQ(verify(r, ours), 1) << name << ": " << read_text_file(path("said"));
    if (name.find("cosign") != std::string::npos)
      continue;  // ours says so of what the ledger holds, or of --cosigned
    EXPECT_EQ(run("ledger verify " + path("L") + " --receipt " + path("r.json")).exit_code, 1)
        << name << ": our own says the same";
  }
  EXPECT_EQ(verify(sound, std::string(64, 'a')), 1) << "another school's key";
  EXPECT_EQ(verify(sound, school_key() + " 'cavum.cosigner/else+" +
                              cosigner.substr(cosigner.find('+') + 1) + "'"),
            1)
      << "somebody who has not signed";
}

TEST_F(LedgerNotes, ACosignerRefusesALedgerThatWasPutBack) {
  const std::string witness =
      path("home/witness/") + run_json("ledger show " + path("L"))["ledger"].get<std::string>();
  const std::string old_ledger = read_text_file(path("L/ledger.db")),
                    old_witness = read_text_file(witness);
  ticket("4713");
  have_cosigned("n1");
  EXPECT_EQ(run("ledger verify " + path("L") + " --cosigned " + path("n1")).exit_code, 0);
  // somebody puts ledger and witness back: nothing on this computer sees it
  write_text_file(path("L/ledger.db"), old_ledger);
  write_text_file(witness, old_witness);
  EXPECT_EQ(run("ledger verify " + path("L")).exit_code, 0);
  const auto found = run("ledger verify --json " + path("L") + " --cosigned " + path("n1"));
  EXPECT_EQ(found.exit_code, 1);
  const json finding = json::parse(found.out)["findings"].at(0);
  EXPECT_EQ(finding["group"], "older_copy");
  for (const std::string& told : {path("n1"), std::string(" 3 "), std::string(" 4")})
    EXPECT_NE(finding.dump().find(told), std::string::npos) << finding;
  EXPECT_EQ(run("ledger add-cosignature " + path("L") + " " + path("n1")).exit_code, 1)
      << "it is not kept";
  // and the cosigner neither signs the older copy nor what grew from it
  ASSERT_EQ(run("ledger checkpoint " + path("L") + " --out " + path("older")).exit_code, 0);
  const auto smaller = elsewhere("ledger cosign " + path("older") + " --out " + path("n2"));
  EXPECT_EQ(smaller.exit_code, 1) << smaller.err;
  EXPECT_FALSE(fs::exists(path("n2")));
  ticket("4714");
  ticket("4715");
  ASSERT_EQ(run("ledger checkpoint " + path("L") + " --since 4 --out " + path("grown")).exit_code,
            0);
  EXPECT_EQ(elsewhere("ledger cosign " + path("grown") + " --out " + path("n2")).exit_code, 1)
      << "its history was rewritten";
  EXPECT_FALSE(fs::exists(path("n2")));
}

TEST_F(LedgerNotes, SayWhatIsWrongAndWhere) {
  const std::string L = path("L"), c = path("c"), n = path("n"),
                    known = " --school-key " + school_key();
  const std::string cosign = "cosign " + c + " --key " + path("k") + " --state " + path("s");
  ASSERT_EQ(run("ledger checkpoint " + L + " --out " + c).exit_code, 0);
  expect_refused("ledger " + cosign + " --out " + n, {c});
  ASSERT_EQ(run("ledger " + cosign + known + " --out " + n).exit_code, 0);
  write_text_file(path("bad"), "nobody\n");
  for (const auto& [command, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"checkpoint " + L + " --out " + c, {c}},
           {"checkpoint " + L + " --since 99 --out " + path("d"), {"--since 99", "3"}},
           {"cosign " + path("L/ledger.db") + " --out " + path("n2"), {path("L/ledger.db")}},
           {"cosign " + c + " --name 'a b'" + known + " --out " + path("n2"), {"'a b'"}},
           {"cosign " + c + known + " --out " + c + " --overwrite", {c}},
           {cosign + known + " --out " + path("n2"), {"3"}},
           {"add-cosignature " + L + " " + n, {"home/cosigners"}},
           {"verify " + L + " --cosigners " + path("none"), {path("none")}},
           {"verify " + L + " --cosigners " + path("bad"), {"bad:1"}},
           {"receipt " + L + " --entry 1 --from-size 4 --out " + path("r"), {"--from-size 4"}},
           {"backup " + path("none") + " --out " + path("b"), {path("none")}},
           {"backup " + L + " --out " + L, {L}},
           {"restore " + path("none") + " --out " + path("b"), {path("none")}}})
    expect_refused("ledger " + command, parts);
  for (const char* verb : {"checkpoint", "cosign", "add-cosignature", "backup", "restore"})
    EXPECT_EQ(run("ledger " + std::string(verb) + " --help").exit_code, 0) << verb;
}

TEST_F(LedgerNotes, ABackupIsRestoredAndSaysWhatWasLost) {
  const json taken =
      run_json("ledger backup " + path("L") + " --with-identities --out " + path("B"));
  EXPECT_EQ(taken["entries"], 3);
  EXPECT_EQ(taken["identities"], true);
  ticket("4713");
  ASSERT_EQ(run("ledger receipt " + path("L") + " --entry 3 --out " + path("r.json")).exit_code, 0);
  fs::remove_all(path("L"));
  const std::string restore =
      "ledger restore " + path("B") + " --receipt " + path("r.json") + " --out " + path("L2");
  const auto told = run(restore + " --json");
  EXPECT_EQ(told.exit_code, 1) << told.err;
  EXPECT_EQ(json::parse(told.out)["restored"], false) << told.out;
  EXPECT_EQ(json::parse(told.out)["lost"].size(), 2u)
      << "entry 3, by the witness and by the receipt: " << told.out;
  EXPECT_FALSE(fs::exists(path("L2")));
  const json done = run_json(restore + " --accept-loss 'the disk died'");
  EXPECT_EQ(done["restored"], true);
  const json remark = run_json("ledger verify " + path("L2"))["remarks"].at(0);
  EXPECT_EQ(remark["group"], "restored");
  EXPECT_NE(remark["text"].get<std::string>().find("the disk died"), std::string::npos) << remark;
  EXPECT_NE(run("ledger candidates " + path("L2")).out.find("4711"), std::string::npos);
  EXPECT_EQ(run("ledger ticket " + path("L2") + " " + CAVUM_SOURCE_DIR +
                "/tests/replay/block_cavity.toml --candidate 4714" +
                " --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --out " + path("t"))
                .exit_code,
            0)
      << "it goes on";
}

}  // namespace
}  // namespace cavum::ui
