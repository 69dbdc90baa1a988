// Edits of a scenario's text: what is wanted is there afterwards, read by the scenario's own
// parser, and nothing else has moved.
#include "scenarios/file/edit_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "scenarios/file/parse.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

/// A value of a scenario that can be edited, found by the scenario's own parser.
struct Editable {
  std::string place;
  double low = 0.0, high = 0.0;
  std::function<double(const Scenario&)> is;
  std::function<double(const Scenario&)> y;  // of a point; else empty
};

std::vector<Editable> editables_of(const Scenario& s) {
  std::vector<Editable> all;
  all.push_back({"zones/leeway/sides_mm",
                 0,
                 0.5,
                 [](const Scenario& z) { return z.zones.leeway.sides_mm; },
                 {}});
  all.push_back({"zones/container/bottom_mm",
                 0.6,
                 5,
                 [](const Scenario& z) { return z.zones.container.bottom_mm; },
                 {}});
  for (std::size_t i = 0; i < s.zones.target.size(); ++i) {
    const ShapeSpec& shape = s.zones.target[i];
    const std::string at = "zones/target/" + std::to_string(i);
    const auto of = [i](const Scenario& z) -> const ShapeSpec& { return z.zones.target[i]; };
    if (shape.bottom.depth_mm > 0)
      all.push_back({at + "/bottom/depth_mm",
                     0.5,
                     4,
                     [of](const Scenario& z) { return of(z).bottom.depth_mm; },
                     {}});
    if (shape.height_mm > 0)
      all.push_back(
          {at + "/height_mm", 0.5, 20, [of](const Scenario& z) { return of(z).height_mm; }, {}});
    if (shape.kind == ShapeSpec::Kind::column ||
        shape.kind == ShapeSpec::Kind::prism)  // absent in most files
      all.push_back({at + "/outline/offset_mm",
                     0,
                     1,
                     [of](const Scenario& z) { return of(z).outline.offset_mm; },
                     {}});
    for (std::size_t p = 0; p < shape.outline.points_mm.size(); ++p)
      all.push_back({at + "/outline/points_mm/" + std::to_string(p), -6, 6,
                     [of, p](const Scenario& z) { return of(z).outline.points_mm[p].x; },
                     [of, p](const Scenario& z) { return of(z).outline.points_mm[p].y; }});
  }
  return all;
}

std::vector<std::pair<std::string, std::string>> shipped() {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& f :
       std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios"))
    if (f.path().extension() == ".toml")
      files.emplace_back(f.path().string(), read_text_file(f.path().string()));
  return files;
}

/// Lines, without their ends, that begin with a comment or hold one after two spaces.
std::vector<std::string> comments_of(const std::string& text) {
  std::vector<std::string> comments;
  for (std::size_t i = text.find('#'); i != std::string::npos; i = text.find('#', i + 1))
    comments.push_back(text.substr(i, text.find('\n', i) - i));
  return comments;
}

std::string with_crlf(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

Scenario read(const std::string& text) { return read_scenario(text, "f.toml").scenario; }

TEST(EditText, ChangesTheBytesOfTheValueAlone) {
  std::mt19937_64 random(testing_basics::drawn_seed("EditText"));
  std::size_t edits = 0;
  for (const auto& [path, shipped_text] : shipped())
    for (const std::string& text : {shipped_text, with_crlf(shipped_text)})
      for (const Editable& e : editables_of(read(text))) {
        const double x =
            std::round(1000 * std::uniform_real_distribution<>(e.low, e.high)(random)) / 1000;
        const double y =
            std::round(1000 * std::uniform_real_distribution<>(e.low, e.high)(random)) / 1000;
        const TextChange change =
            e.y ? set_point(text, path, e.place, x, y) : set_number(text, path, e.place, x);
        const std::string changed = with_change(text, change);
        const Scenario after = read(changed);
        EXPECT_EQ(e.is(after), x) << path << " " << e.place;
        if (e.y) {
          EXPECT_EQ(e.y(after), y) << path << " " << e.place;
        }
        // the rest, byte by byte, and no byte of the change is a comment, a line's end within a
        // value or a bracket
        EXPECT_EQ(changed.substr(0, change.at), text.substr(0, change.at));
        EXPECT_EQ(changed.substr(change.at + change.inserted.size()),
                  text.substr(change.at + change.removed.size()));
        EXPECT_EQ(change.removed.find_first_not_of("0123456789+-., "), std::string::npos)
            << path << " " << e.place << ": " << change.removed;
        EXPECT_EQ(comments_of(changed), comments_of(text));
        // every other value is what it was
        for (const Editable& other : editables_of(read(text))) {
          if (other.place == e.place) continue;
          EXPECT_EQ(other.is(after), other.is(read(text)))
              << path << ": " << e.place << " moved " << other.place;
        }
        EXPECT_EQ(with_change(changed, inverse(change)), text);
        ++edits;
      }
  EXPECT_GT(edits, 60u);
}

TEST(EditText, AValueThatIsThereAlreadyChangesNothing) {
  for (const auto& [path, text] : shipped()) {
    const Scenario s = read(text);
    for (const Editable& e : editables_of(s)) {
      if (e.place.ends_with("offset_mm")) continue;  // would be added
      const TextChange change = e.y ? set_point(text, path, e.place, e.is(s), e.y(s))
                                    : set_number(text, path, e.place, e.is(s));
      EXPECT_TRUE(change.empty()) << e.place << ": " << change.removed << " by " << change.inserted;
      EXPECT_EQ(with_change(text, change), text);
    }
  }
  // also one that is written in another way than we would
  const std::string odd = "[zones.leeway]\nsides_mm = +0.250_0 # so\n";
  EXPECT_EQ(with_change(odd, set_number(odd, "f", "zones/leeway/sides_mm", 0.25)), odd);
}

TEST(EditText, ManyEditsTakenBackOneByOneLeaveTheFileAsItWas) {
  std::mt19937_64 random(testing_basics::drawn_seed("EditText"));
  for (const auto& [path, text] : shipped()) {
    std::vector<TextChange> done;
    std::string now = text;
    for (int i = 0; i < 40; ++i) {
      const auto all = editables_of(read(now));
      const Editable& e = all[random() % all.size()];
      const double x = std::uniform_real_distribution<>(e.low, e.high)(random);
      done.push_back(e.y ? set_point(now, path, e.place, x, -x)
                         : set_number(now, path, e.place, x));
      now = with_change(now, done.back());
      const auto slash = e.place.rfind('/');
      if (e.y && i % 3 == 0) {
        done.push_back(insert_point(now, path, e.place.substr(0, slash),
                                    std::stoul(e.place.substr(slash + 1)), x, 0.5));
        now = with_change(now, done.back());
      }
    }
    EXPECT_EQ(comments_of(now), comments_of(text));
    for (; !done.empty(); done.pop_back()) now = with_change(now, inverse(done.back()));
    EXPECT_EQ(now, text);
  }
}

TEST(EditText, FindsValuesWhereverAnAuthorPutsThem) {
  const auto edited = [](const std::string& text, const std::string& place, double v) {
    return with_change(text, set_number(text, "f", place, v));
  };
  EXPECT_EQ(
      edited("title = 'äöü \"#'\n[zones.leeway]\nsides_mm=0.2# c\n", "zones/leeway/sides_mm", 0.3),
      "title = 'äöü \"#'\n[zones.leeway]\nsides_mm=0.3# c\n");
  EXPECT_EQ(edited("zones = { leeway = { \"ä\" = \"é}\", sides_mm = 1 } }", "zones/leeway/sides_mm",
                   -2.5),
            "zones = { leeway = { \"ä\" = \"é}\", sides_mm = -2.5 } }");
  EXPECT_EQ(edited("\xef\xbb\xbf[a]\nb = 1", "a/b", 2), "\xef\xbb\xbf[a]\nb = 2");
  EXPECT_EQ(edited("\xef\xbb\xbf"
                   "b = 1",
                   "b", 2),
            "\xef\xbb\xbf"
            "b = 2");
  EXPECT_EQ(edited("a.b = 1\na.c = 2\n", "a/c", 3), "a.b = 1\na.c = 3\n");
  EXPECT_EQ(edited("text = \"\"\"\nb = 1\n\"\"\"\nb = 1\n", "b", 7),
            "text = \"\"\"\nb = 1\n\"\"\"\nb = 7\n");
  EXPECT_EQ(edited("[zones.target]\nz_mm = 1e0\n", "zones/target/0/z_mm", 2),
            "[zones.target]\nz_mm = 2\n");  // one table counts as a list of one
  EXPECT_EQ(edited("[[t]]\na=1\n[[t]]\na = 1.5\t# x\r\n", "t/1/a", 2),
            "[[t]]\na=1\n[[t]]\na = 2\t# x\r\n");
}

TEST(EditText, AddsWhatIsAbsentAtTheEndOfItsTable) {
  const auto edited = [](const std::string& text, const std::string& place, double v) {
    return with_change(text, set_number(text, "f", place, v));
  };
  EXPECT_EQ(edited("[a]\nb = [\n 1, # one ]\n]  # b\n\n# of c\n[c]\n", "a/d", 2),
            "[a]\nb = [\n 1, # one ]\n]  # b\nd = 2\n\n# of c\n[c]\n");
  EXPECT_EQ(edited("[a]\r\nb = 1\r\n", "a/d", 2), "[a]\r\nb = 1\r\nd = 2\r\n");
  EXPECT_EQ(edited("[a]\nb = 1", "a/d", 2), "[a]\nb = 1\nd = 2");
  EXPECT_EQ(edited("[a]  # x\n[c]\n", "a/d", 2), "[a]  # x\nd = 2\n[c]\n");
  EXPECT_EQ(edited("a = { b = \"}\" }  # x\n", "a/d", 2), "a = { b = \"}\", d = 2 }  # x\n");
  EXPECT_EQ(edited("a = {}\n", "a/d", 2), "a = { d = 2 }\n");
  // the table's own keys end before the table below it
  EXPECT_EQ(edited("[[t]]\nb = 1\n[t.u]\nc = 1\n[[t]]\nb = 3\n", "t/0/d", 2),
            "[[t]]\nb = 1\nd = 2\n[t.u]\nc = 1\n[[t]]\nb = 3\n");
  const std::string centre = "[o]\nk = 1\n";
  EXPECT_EQ(with_change(centre, set_point(centre, "f", "o/centre_mm", 0.5, -1)),
            "[o]\nk = 1\ncentre_mm = [0.5, -1]\n");
}

TEST(EditText, PointsComeAndGoInTheLayoutOfTheirList) {
  const auto inserted = [](const std::string& text, std::size_t i) {
    return with_change(text, insert_point(text, "f", "p", i, 9, 8));
  };
  const auto removed = [](const std::string& text, std::size_t i) {
    return with_change(text, remove_point(text, "f", "p", i));
  };
  const std::string row = "p = [[1, 2], [3,4],  [5, 6]] # p";
  EXPECT_EQ(inserted(row, 0), "p = [[9, 8], [1, 2], [3,4],  [5, 6]] # p");
  EXPECT_EQ(inserted(row, 2), "p = [[1, 2], [3,4],  [9, 8],  [5, 6]] # p");
  EXPECT_EQ(inserted(row, 3), "p = [[1, 2], [3,4],  [5, 6],  [9, 8]] # p");
  EXPECT_EQ(removed(row, 0), "p = [[3,4],  [5, 6]] # p");
  EXPECT_EQ(removed(row, 2), "p = [[1, 2], [3,4]] # p");
  const std::string lines = "p = [\r\n  [1, 2],\r\n  [3, 4],\r\n]\r\n";
  EXPECT_EQ(inserted(lines, 1), "p = [\r\n  [1, 2],\r\n  [9, 8],\r\n  [3, 4],\r\n]\r\n");
  EXPECT_EQ(removed(lines, 1), "p = [\r\n  [1, 2],\r\n]\r\n");
  const std::string told = "p = [\n  [1, 2],  # mesial, [so]\n  [3, 4]  # distal\n]\n";
  EXPECT_EQ(inserted(told, 1), "p = [\n  [1, 2], [9, 8],  # mesial, [so]\n  [3, 4]  # distal\n]\n");
  EXPECT_EQ(removed(told, 0), "p = [\n    # mesial, [so]\n  [3, 4]  # distal\n]\n");
  EXPECT_EQ(comments_of(removed(told, 1)), comments_of(told));
}

TEST(EditText, PutsATextInPlaceOfAText) {
  const std::string text = "# tooth = \"a\"\ntooth = 'a.cvt'  # mine\nid = \"tooth\"\n";
  const TextChange change = set_text(text, "f", "tooth", "b \"2\" \\ \xc3\xa4.cvt");
  const std::string changed = with_change(text, change);
  EXPECT_EQ(changed,
            "# tooth = \"a\"\ntooth = \"b \\\"2\\\" \\\\ \xc3\xa4.cvt\"  # mine\nid = \"tooth\"\n");
  EXPECT_EQ(read(changed).tooth_file, "b \"2\" \\ \xc3\xa4.cvt");
  EXPECT_EQ(with_change(changed, inverse(change)), text);
  EXPECT_TRUE(set_text(text, "f", "tooth", "a.cvt").empty());
  EXPECT_THROW((void)set_text(text, "f", "tooth", "a\nb"), Error);
  EXPECT_THROW((void)set_text("tooth = 1", "f", "tooth", "a"), Error);
  EXPECT_THROW((void)set_text("", "f", "tooth", "a"), Error);
}

TEST(EditText, RefusesWhatItCannotDoAndNamesThePlace) {
  const auto place = [](const std::function<TextChange()>& edit) {
    return testing_basics::place_of(testing_basics::thrown_by(edit));
  };
  EXPECT_TRUE(
      place([] { return set_number("a = [1\nb = 2", "f.toml", "a", 1); }).starts_with("f.toml:2:"));
  EXPECT_EQ(place([] { return set_number("b = 'x'", "f.toml", "b", 1); }), "f.toml:1:5");
  EXPECT_EQ(place([] { return set_number("b = 1", "f.toml", "c/d", 1); }), "f.toml");
  EXPECT_THROW((void)set_number("a.b = 1", "f.toml", "a/c", 1), Error) << "dotted keys";
  EXPECT_THROW((void)remove_point("p = [[1, 2]]", "f.toml", "p", 0), Error) << "none to spare";
  EXPECT_THROW((void)set_number("b = 1", "f.toml", "b", std::nan("")), Error);
}

TEST(EditText, WritesNumbersInTheirShortestForm) {
  for (const auto& [v, s] : std::vector<std::pair<double, std::string>>{{1.8, "1.8"},
                                                                        {2, "2"},
                                                                        {-0.05, "-0.05"},
                                                                        {-0.0001, "0"},
                                                                        {0.1 + 0.2, "0.3"},
                                                                        {1.23456, "1.235"},
                                                                        {100, "100"},
                                                                        {-3.0, "-3"}})
    EXPECT_EQ(written_number(v), s);
}

}  // namespace
}  // namespace cavum::scenarios
