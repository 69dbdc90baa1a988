// The files of a report: the same words and figures in HTML, in PDF and in `grade --json`; nothing
// in a scenario's or a candidate's text can become markup or script; the same session gives the
// same bytes.
#include <cmath>
#include <map>
#include <random>
#include <regex>
#include <set>

#include "engine/base/text.h"
#include "tests/ui/program.h"
#include "tests/ui/report/kinds.h"
#include "tests/ui/report/unpack.h"
#include "ui/report/figures/from_above.h"
#include "ui/report/figures/section_pictures.h"
#include "ui/report/print/html_writer.h"
#include "ui/report/print/pdf_writer.h"
#include "ui/report/report.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

using nlohmann::json;
using testing_report::data_in;
using testing_report::holds;
using testing_report::of_kind;
using testing_report::times;
using testing_ui::k_block;

/// Without white space, which wrapping puts anywhere.
std::string packed(std::string text) {
  std::erase_if(text, [](unsigned char c) { return c <= ' '; });
  return text;
}

class ReportFile : public testing_ui::Program {
 protected:
  /// The moments behind the points that a criterion lost.
  [[nodiscard]] json moments(const std::string& session, const json& criterion) const {
    return run_json("grade " + session + " --why " + criterion["id"].get<std::string>())["moments"];
  }
  /// A session of the block, sat by a simulated operator.
  std::string sit(const std::string& by) const {
    const auto r = run("exam " + k_block + " --candidate A17 --operator " + by + " --quiet --out " +
                       path(by + ".cavum"));
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return path(by + ".cavum");
  }
  /// What a PDF says, page by page between form feeds.
  [[nodiscard]] std::string pdf_text(const std::string& file, const std::string& how = "") const {
    EXPECT_EQ(std::system(("pdftotext " + how + " " + file + " " + path("pdf.txt")).c_str()), 0);
    return read_text_file(path("pdf.txt"));
  }
  /// A session's report as a document, after `change` did what it does to facts and scenario.
  template <class Change>
  std::string html_with(const Change& change) const {
    const auto session = grading::load_for_grading(sit("expert"));
    change(*session);
    const grading::GradeInput input = session->input();
    const grading::Result result = grading::grade(input, session->rubric);
    return report_html(report_source(result, input, session->facts, session->rubric));
  }
};

TEST_F(ReportFile, SaysTheSameFiguresAsHtmlAsPdfAndAsJson) {
  const std::string session = sit("perforator");
  const json g = run_json("grade " + session);
  for (const std::string reader : {"student", "instructor"}) {
    for (const char* ending : {".html", ".pdf"})
      ASSERT_EQ(run("report " + session + " --for " + reader + " --out " + path(reader + ending))
                    .exit_code,
                0);
    const std::string html = read_text_file(path(reader + ".html"));
    const std::string as_html = packed(html),
                      as_pdf = packed(pdf_text(path(reader + ".pdf"), "-raw"));
    const auto both = [&](const std::string& words) {
      EXPECT_NE(as_html.find(packed(xml_text(words))), std::string::npos)
          << reader << ": HTML lacks " << words;
      EXPECT_NE(as_pdf.find(packed(words)), std::string::npos) << reader << ": PDF lacks " << words;
    };
    both(g["scenario"]["title"]);
    both(g["verdict"]);
    EXPECT_TRUE(holds(testing_report::verdict_box(html), fixed(g["score"]["points"], 1),
                      fixed(g["score"]["max"], 1)));
    both(fixed(g["score"]["points"], 1));
    for (const auto& c : g["criteria"]) {
      both(c["title"]);
      both(fixed(c["points"], 1));
      both("/ " + fixed(c["max"], 1));
      if (!c["value"].is_null()) both(fixed(c["value"], 2));
      if (reader == "instructor" || !(c["points"] < c["max"])) continue;
      for (const json all = moments(session, c); const auto& m : all)
        if (!m["t_s"].is_null()) both(fixed(m["t_s"], 3) + " s");
    }
    const double mark =
        g["score"]["pass_percent"].get<double>() / 100 * g["score"]["max"].get<double>();
    both(fixed(std::fabs(g["score"]["points"].get<double>() - mark), 1));
    EXPECT_NE(of_kind(html, "replayed"), "");
    const bool all = reader == "instructor";
    for (const char* table : {"volumes", "walls", "cavity", "perforations", "work", "device"})
      EXPECT_EQ(of_kind(html, table) != "", all) << table;
    EXPECT_EQ(as_pdf.find(fixed(g["volumes"]["dice"], 3)) != std::string::npos, all);
    if (!all) continue;
    both(fixed(g["volumes"]["removed_mm3"], 2) + " ± " +
         fixed(g["volumes"]["bounds"]["removed_mm3"], 2));
    both(fixed(g["volumes"]["dice"], 3));
    both(fixed(g["walls"]["floor"]["max_over_mm"], 2) + " ± ");
    both(fixed(g["perforation"]["truth"]["first_t_s"], 3) + " s");
    EXPECT_TRUE(holds(of_kind(html, "perforation"),
                      fixed(g["perforation"]["truth"]["first_t_s"], 3) + " s"));
    both(fixed(g["force"]["peak_n"], 2) + " N");
    for (const auto& e : g["perforation"]["events"])
      for (const char* force : {"force_before_n", "force_after_n"}) both(fixed(e[force], 2) + " N");
  }
}

TEST_F(ReportFile, SaysHowTheExamEndedAndHowItsBoundsAreMeant) {
  const std::string session = sit("novice");
  const json g = run_json("grade " + session);
  ASSERT_EQ(run("report " + session + " --out " + path("r.html")).exit_code, 0);
  const std::string html = read_text_file(path("r.html"));
  EXPECT_EQ(data_in(html)["events"].back()["kind"], "finish");
  EXPECT_TRUE(holds(of_kind(html, "bounds"), "0.05 mm"));
  EXPECT_EQ(times(html, "data-kind='floor'"), 1u) << "beside the walls";
  bool by_work = false;
  for (const auto& c : g["criteria"]) by_work |= c.contains("work_share");
  EXPECT_EQ(of_kind(html, "care") != "", by_work);
  const std::string of_the_floor = html_with([](grading::GradedSession& graded) {
    graded.rubric.criteria[0].metric = "floor_max_over_mm";
  });
  EXPECT_EQ(times(of_the_floor, "data-kind='floor'"), 2u) << "beside the criteria, too";
  std::set<std::string> ends;
  for (const Finish f :
       {Finish::completed, Finish::failed, Finish::time, Finish::ended, Finish::running})
    ends.insert(english_text(finish_words(f)));
  EXPECT_EQ(ends.size(), 5u);
}

TEST_F(ReportFile, NoPageIsLeftHalfEmptyBeforeAPicture) {
  const std::string session = sit("novice");
  ASSERT_EQ(run("report " + session + " --for student --out " + path("r.pdf")).exit_code, 0);
  const std::string first = pdf_text(path("r.pdf"), "-l 1 -raw");
  const auto graded = grading::load_for_grading(session);
  EXPECT_NE(first.find(run_json("grade " + session)["criteria"].back()["title"]), std::string::npos)
      << "the marks: " << first;
  EXPECT_NE(packed(first).find(packed(picture_from_above(graded->input()).title)),
            std::string::npos)
      << "the picture that follows the marks stands on their page: " << first;
}

TEST_F(ReportFile, EveryWordOfTheDocumentIsInBothFiles) {
  const auto session = grading::load_for_grading(sit("novice"));
  const grading::GradeInput input = session->input();
  const grading::Result result = grading::grade(input, session->rubric);
  ReportSource source = report_source(result, input, session->facts, session->rubric);
  for (const ReportReader reader : {ReportReader::instructor, ReportReader::student}) {
    source.reader = reader;
    const Document d = report_document(source);
    write_text_file(path("d.pdf"), pdf_of(d));
    const std::string html = packed(html_of(d, json::object())),
                      pdf = packed(pdf_text(path("d.pdf"), "-raw"));
    std::size_t checked = 0;
    const auto both = [&](const std::string& words) {
      ++checked;
      EXPECT_NE(html.find(packed(xml_text(words))), std::string::npos) << "HTML lacks " << words;
      // a word that stands alone is searched; rows of cells are wrapped side by side
      std::istringstream in(words);
      for (std::string word; in >> word;)
        EXPECT_NE(pdf.find(word), std::string::npos) << "PDF lacks '" << word << "' of " << words;
    };
    for (const auto& b : d.blocks) {
      if (const auto* h = std::get_if<Heading>(&b)) both(h->text);
      if (const auto* p = std::get_if<Paragraph>(&b)) both(p->text);
      if (const auto* f = std::get_if<Fold>(&b)) both(f->title);
      if (const auto* l = std::get_if<LessonList>(&b))
        for (const auto& i : l->items) both(i.instead);
      if (const auto* l = std::get_if<Bullets>(&b))
        for (const auto& i : l->items) both(i);
      if (const auto* v = std::get_if<VerdictBox>(&b))
        for (const auto& r : v->reasons) both(r);
      if (const auto* p = std::get_if<Pictures>(&b))
        for (const auto& i : p->list) both(i.title);
      if (const auto* t = std::get_if<ReportTable>(&b))
        for (const auto& r : t->rows) {
          ASSERT_EQ(r.cells.size(), t->columns.size());
          for (const auto& c : r.cells)
            if (c.text.size() < 20) both(c.text);  // longer ones break within words
        }
    }
    EXPECT_GT(checked, reader == ReportReader::instructor ? 100u : 60u);
  }
}

TEST_F(ReportFile, AChangeOverAttemptsIsToldOnlyBeyondWhatMarksVaryByThemselves) {
  const auto session = grading::load_for_grading(sit("novice"));
  const grading::GradeInput input = session->input();
  const grading::Result result = grading::grade(input, session->rubric);
  ReportSource source = report_source(result, input, session->facts, session->rubric);
  const auto told = [&](const std::vector<double>& marks, bool class_known) {
    source.filing = ReportFiling{};
    for (const double percent : marks) {
      ReportAttempt attempt;
      attempt.verdict = grading::Verdict::pass;
      attempt.points = percent;
      attempt.max = 100;
      attempt.released = true;
      source.filing->attempts.push_back(attempt);
    }
    if (class_known) {
      source.filing->scatter = cohort::AttemptScatter{5.0, 12.0, 30, 21};
      source.filing->progress = cohort::progress(marks, *source.filing->scatter);
    }
    return html_of(report_document(source), json::object());
  };
  EXPECT_TRUE(holds(of_kind(told({60, 90}, false), "change_unknown"), " 8 ", " 5 "));
  EXPECT_NE(of_kind(told({60}, true), "first_attempt"), "");
  EXPECT_TRUE(holds(of_kind(told({60, 65}, true), "no_change"), " 2 ", " +5 %"));
  EXPECT_TRUE(holds(of_kind(told({60, 80, 90}, true), "rose"), " 3 ", " 30 %"));
  EXPECT_TRUE(holds(of_kind(told({90, 60}, true), "fell"), " 30 %"));
}

/// What a student reads before unfolding the figures: no coordinates, no ticks, no ±.
TEST_F(ReportFile, AStudentReadsNoCoordinatesTicksOrBoundsUnlessAsked) {
  const std::string session = sit("novice");
  ASSERT_EQ(
      run("report " + session + " --for student --no-replay --out " + path("r.html")).exit_code, 0);
  const std::string html = read_text_file(path("r.html"));
  const auto from = html.find("<main>"), fold = html.find("<details><summary>");
  ASSERT_NE(fold, std::string::npos);
  EXPECT_NE(html.find("</details>", fold), std::string::npos);
  const std::string text = std::regex_replace(html.substr(from, fold - from),
                                              std::regex("<svg[^]*?</svg>|<[^>]*>"), " ");
  for (const char* sign : {"±", " y = ", "[-", "] mm"})
    EXPECT_EQ(text.find(sign), std::string::npos) << sign << " in " << text;
  EXPECT_NE(html.substr(from, fold - from).find("<ol class='lessons'>"), std::string::npos);
  EXPECT_NE(html.substr(fold).find("± "), std::string::npos) << "they are there, folded";
}

TEST_F(ReportFile, ShowsEightSectionsWithTheirPlacesAndOneThroughAPerforation) {
  const std::string session = sit("perforator");
  const json g = run_json("grade " + session);
  ASSERT_TRUE(g["perforation"]["truth"]["perforated"]);
  ASSERT_EQ(
      run("report " + session + " --for student --no-replay --out " + path("r.html")).exit_code, 0);
  const std::string html = read_text_file(path("r.html"));
  const auto from = html.find("<div class='sections'>");
  ASSERT_NE(from, std::string::npos);
  const std::string sections = html.substr(from, html.find("</div>", from) - from);
  EXPECT_EQ(times(sections, "<svg "), 8u);
  const auto graded = grading::load_for_grading(session);
  const auto list =
      section_pictures(grading::grade(graded->input(), graded->rubric), graded->input());
  std::set<std::string> titles;
  std::map<SectionOf, std::vector<SectionPicture>> of;
  for (const auto& p : list) {
    EXPECT_NE(sections.find("<figcaption>" + p.title + "</figcaption>"), std::string::npos)
        << p.title;
    EXPECT_NE(p.title.find(" = " + fixed(p.at_mm, 2) + " mm"), std::string::npos) << p.title;
    EXPECT_TRUE(titles.insert(p.title).second) << "no section twice";
    of[p.of].push_back(p);
  }
  EXPECT_EQ(list.size(), 8u);
  const json& site = g["perforation"]["truth"]["site_mm"];
  constexpr double k_rounding_mm = 0.0005 + 1e-9;
  ASSERT_EQ(of[SectionOf::opening].size(), 2u);
  for (const auto& p : of[SectionOf::opening]) {
    EXPECT_NEAR(p.at_mm, site[p.view == scenarios::View::mesio_distal ? 1 : 0].get<double>(),
                k_rounding_mm);
    EXPECT_NE(p.view, scenarios::View::horizontal);
  }
  EXPECT_FALSE(of[SectionOf::target].empty());
  ASSERT_FALSE(of[SectionOf::overcut].empty());
  EXPECT_TRUE(holds(of[SectionOf::overcut][0].title,
                    fixed(g["walls"]["floor"]["max_over_mm"], 2) + " mm", "floor"))
      << g["walls"];
}

TEST_F(ReportFile, JumpsLeadToTheMomentsOfEachPointLost) {
  const std::string session = sit("perforator");
  ASSERT_EQ(
      run("report " + session + " --for student --no-replay --out " + path("r.html")).exit_code, 0);
  const std::string html = read_text_file(path("r.html"));
  std::size_t found = 0;
  const json g = run_json("grade " + session);
  for (const auto& c : g["criteria"]) {
    if (!(c["points"] < c["max"])) continue;
    for (const json all = moments(session, c); const auto& m : all) {
      if (m["t_s"].is_null()) continue;
      std::string button = "<button class='jump' type='button' data-t='" + fixed(m["t_s"], 4) + "'";
      if (!m["site_mm"].is_null())
        button += " data-x='" + fixed(m["site_mm"][0], 4) + "' data-y='" +
                  fixed(m["site_mm"][1], 4) + "' data-z='" + fixed(m["site_mm"][2], 4) + "'";
      EXPECT_NE(html.find(button + ">" + fixed(m["t_s"], 3) + " s</button>"), std::string::npos)
          << button;
      ++found;
    }
  }
  EXPECT_GT(found, 2u);
}

TEST_F(ReportFile, NothingThatPeopleWroteBecomesMarkupOrScript) {
  const std::string evil =
      "</script><script>alert(1)</script><!-- <b>'\"& \x01\x7f ]]> \\u003c/script>";
  const std::string html = html_with([&](grading::GradedSession& s) {
    s.facts.candidate = s.facts.source.name = s.facts.calibration = s.facts.created = evil;
    s.facts.notes.emplace_back(evil, evil);
    s.scenario.title = evil;
    auto named = std::make_shared<Tooth>(*s.before);
    named->name = evil;
    s.before = std::move(named);
    for (auto& c : s.rubric.criteria) c.title = evil;
    s.scenario.steps[0].id = s.scenario.steps[0].instruction = evil;
    s.events.push_back({5, Announced{{1, evil}}});
  });
  EXPECT_EQ(times(html, "<script"), 2u) << "the data and the page's own";
  EXPECT_EQ(times(html, "</script"), 2u);
  EXPECT_EQ(html.find("<b>'"), std::string::npos);
  EXPECT_EQ(html.find('\x01'), std::string::npos);
  const json data = data_in(html);
  ASSERT_TRUE(data.is_object());
  EXPECT_EQ(data["title"], evil) << "unchanged for the page, which writes it as text";
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* reach :
       {"src='http", "src=\"http", "href='http", "href=\"http", "url(http", "@import"})
    EXPECT_EQ(html.find(reach), std::string::npos) << reach;
}

TEST_F(ReportFile, TheSameSessionGivesTheSameBytes) {
  const std::string session = sit("novice");
  for (const char* ending : {".html", ".pdf"}) {
    for (const char* name : {"a", "b"})
      ASSERT_EQ(run("report " + session + " --no-replay --out " + path(std::string(name) + ending))
                    .exit_code,
                0);
    EXPECT_TRUE(read_file(path(std::string("a") + ending)) ==
                read_file(path(std::string("b") + ending)))
        << ending;
  }
}

TEST_F(ReportFile, ATableOverManyPagesRepeatsItsHeadAndNumbersItsPages) {
  Document d;
  d.title = "A long one";
  d.subtitle = "for a test";
  d.footer = {"the foot"};
  ReportTable t{{{"Number", true}, {"Square of it", true, 2}, {"Words", false, 3}}, {}, "squares"};
  for (int i = 0; i < 300; ++i)
    t.rows.push_back(
        {{{std::to_string(i)},
          {std::to_string(i * i)},
          {i % 7 == 0 ? std::string(300, 'w') : "row " + std::to_string(i) + " end"}}});
  d.blocks = {Heading{"Squares"}, t, Heading{"After"}, Paragraph{"last words", ""}};
  write_text_file(path("t.pdf"), pdf_of(d));
  std::istringstream pages(pdf_text(path("t.pdf"), "-layout"));
  std::vector<std::string> list;
  for (std::string page; std::getline(pages, page, '\f');)
    if (!page.empty()) list.push_back(page);
  ASSERT_GT(list.size(), 5u);
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_TRUE(holds(list[i].substr(list[i].find("the foot")), std::to_string(i + 1),
                      std::to_string(list.size())))
        << list[i];
    if (i + 1 < list.size()) {
      EXPECT_NE(list[i].find("Square of it"), std::string::npos) << "page " << i + 1;
    }
  }
  std::string all;
  for (const auto& p : list) all += p;
  for (int i = 0; i < 300; ++i)
    if (i % 7 != 0) {
      EXPECT_EQ(times(all, "row " + std::to_string(i) + " end"), 1u) << i;
    }
}

TEST_F(ReportFile, ADocumentOfAnyLengthFitsItsPages) {
  std::mt19937_64 random(testing_basics::drawn_seed("ADocumentOfAnyLengthFitsItsPages"));
  Document d;
  d.title = std::string(500, 'T');
  d.subtitle = std::string(3000, 's');
  std::string text;
  for (int i = 0; i < 6000; ++i)
    text += "w" + std::to_string(random() % 1000) + (random() % 9 == 0 ? "<&'\x02\xff" : " ");
  d.blocks = {Heading{text.substr(0, 900)},
              Paragraph{text, "Lead"},
              Bullets{{text, "short"}, true},
              VerdictBox{grading::Verdict::review,
                         "review",
                         "1 of 2",
                         {text.substr(0, 300)},
                         {text.substr(0, 1500)}},
              ReportTable{{{"a"}, {"b", true}}, {{{{text}, {"number"}}}, {{{"x"}, {"y"}}}}, "huge"},
              Paragraph{"the end is here", ""}};
  write_text_file(path("t.pdf"), pdf_of(d));
  EXPECT_NE(pdf_text(path("t.pdf")).find("the end is here"), std::string::npos);
}

TEST_F(ReportFile, TenMinutesOnTheMolarStayBelowThreeMegabytes) {
  std::mt19937_64 random(testing_basics::drawn_seed("TenMinutesOnTheMolarStayBelowThreeMegabytes"));
  const auto r = run("exam " + std::string(CAVUM_SOURCE_DIR) +
                     "/data/scenarios/class_1.toml --candidate A --operator novice --quiet --out " +
                     path("m.cavum"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto session = grading::load_for_grading(path("m.cavum"));
  // as long as ten minutes: the exam again and again, with a hand that trembles differently each
  // time
  const std::size_t once = session->inputs.size();
  for (std::size_t i = once; i < 600'000; ++i) {
    TickInput in = session->inputs[i % once];
    for (auto& v : in.tip_nm) v += static_cast<std::int32_t>(random() % 40'000) - 20'000;
    session->inputs.push_back(in);
    session->records.push_back(session->records[i % once]);
  }
  const grading::GradeInput input = session->input();
  const grading::Result result = grading::grade(input, session->rubric);
  const std::string html =
      report_html(report_source(result, input, session->facts, session->rubric));
  EXPECT_LE(html.size(), 3'000'000u);
  EXPECT_GT(data_in(html)["motion"]["n"], 29'000);
  std::printf("ten minutes: %.2f MB\n", static_cast<double>(html.size()) * 1e-6);
}

}  // namespace
}  // namespace cavum::report
