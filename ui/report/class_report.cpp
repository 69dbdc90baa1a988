#include "ui/report/class_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/base/version.h"
#include "scenarios/review/picture.h"
#include "ui/language/say.h"
#include "ui/parts/chart_svg.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/print/html_writer.h"
#include "ui/report/print/pdf_writer.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

using cohort::ClassFigures;
using cohort::ClassTooth;

constexpr int k_bins = 20;

std::string number(const std::optional<double>& v, int digits) {
  return v ? figure(as_number(*v, digits)) : "–";
}
Message candidates(std::size_t n) {
  return msgn("{} candidate", "{} candidates", static_cast<std::int64_t>(n), n);
}

/// What a figure says, and that it comes from few.
std::string with_few(const ClassFigures& f, const char* figure, const Message& says) {
  const Message few = few_words(f, figure);
  return few.empty() ? tr(says) : tr("{} ({})", says, few);
}

/// Who was marked by what, where that is not one for all.
std::string marked_differently(const ClassFigures& f) {
  return tr("{}. The criteria below are of those who were marked as most were.",
            marked_by_words(f.marked_by));
}

/// Points of the class in twentieths of the whole, and the cut.
Picture distribution(const ClassFigures& f) {
  std::vector<double> in_bin(k_bins, 0.0);
  for (const double p : f.points)
    in_bin[static_cast<std::size_t>(
        std::clamp(static_cast<int>(p / f.max_points * k_bins), 0, k_bins - 1))] += 1;
  ui::Chart c;
  c.x_label = tr("points");
  c.y_label = tr("candidates");
  ui::ChartSeries steps;
  steps.colour = "#0072b2";
  for (int i = 0; i < k_bins; ++i) {
    steps.points.push_back({f.max_points * i / k_bins, in_bin[static_cast<std::size_t>(i)]});
    steps.points.push_back({f.max_points * (i + 1) / k_bins, in_bin[static_cast<std::size_t>(i)]});
  }
  c.series = {steps};
  c.x_range = {0, f.max_points};
  c.y_range = {0, 1.15 * std::max(1.0, *std::max_element(in_bin.begin(), in_bin.end()))};
  if (f.pass_points) c.marks.push_back({*f.pass_points, true, tr("pass mark")});
  if (f.agreement.cut) c.marks.push_back({*f.agreement.cut, true, tr("borderline regression")});
  c.width_px = 760;
  c.height_px = 300;
  return {ui::svg_page(c.width_px, c.height_px, ui::chart_group(c, 0, 0)),
          f.pass_points ? tr("How the points of the class lie around the pass mark")
                        : tr("How the points of the class lie")};
}

ReportTable key_figures(const ClassFigures& f) {
  ReportTable t{{{tr("Figure"), false, 3}, {tr("Value"), true, 2}, {tr("What it says"), false, 6}},
                {},
                tr("The class in figures"),
                0,
                "figures"};
  const auto row = [&](const std::string& what, const std::string& value, const std::string& says) {
    t.rows.push_back({{{what}, {value}, {says}}});
  };
  row(tr("mean"), tr("{} of {}", as_points(f.mean), as_number(f.max_points)), tr("points"));
  row(tr("standard deviation"), figure(as_points(f.sd)), tr("points"));
  row(tr("pass mark"), number(f.pass_points, 1),
      f.pass_points ? tr("points") : tr("there is no one: see the note above"));
  row(tr("pass / review / fail"), tr("{} / {} / {}", f.pass, f.review, f.fail), tr("candidates"));
  row(tr("Cronbach's alpha"), number(f.alpha, 2),
      with_few(
          f, "alpha",
          msg("how far the criteria tell one story: k/(k−1)·(1 − Σ variances / variance of the sum), Cronbach 1951")));
  row(tr("standard error"), number(f.sem, 1),
      with_few(
          f, "standard_error",
          msg("points, s·√(1 − alpha): how far one candidate's sum would move if the same exam were sat again")));
  return t;
}

/// Middle of what the class cut too much, weighted by how many did; the target's where nobody did.
Vec3 hottest_mm(const ClassTooth& t) {
  const IVec3 low = t.map->low(), size = t.map->size();
  Vec3 sum;
  double all = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const IVec3 leaf = low + IVec3{x, y, z};
        const double heat = std::max(0.0, t.map->percent(leaf));
        sum += t.zones.centre_mm(leaf) * (heat * heat);
        all += heat * heat;
      }
  return all > 0 ? sum * (1 / all) : (t.zones.target_low_mm() + t.zones.target_high_mm()) * 0.5;
}

/// Where the class cuts too much or too little: from above, and three sections.
std::vector<Picture> class_pictures(const ClassTooth& t) {
  const Vec3 at = hottest_mm(t);
  const auto draw = [&](scenarios::View view, double at_mm, const std::string& title) {
    scenarios::PictureSpec spec{view, at_mm, 30, ""};
    spec.in_words = tr;
    spec.heat_percent = [&](IVec3 leaf) { return t.map->percent(leaf); };
    return Picture{scenarios::section_svg(t.tooth, nullptr, t.zones, spec), title};
  };
  return {draw(scenarios::View::occlusal, 0, tr("From above")),
          draw(scenarios::View::mesio_distal, at.y, tr("Mesio-distal, y = {}", as_mm(at.y))),
          draw(scenarios::View::bucco_lingual, at.x, tr("Bucco-lingual, x = {}", as_mm(at.x))),
          draw(scenarios::View::horizontal, at.z, tr("Horizontal, z = {}", as_mm(at.z)))};
}

void add_places(Document& d, const ClassFigures& f, const ClassTooth& t) {
  d.blocks.emplace_back(Heading{tr("Where on the tooth")});
  d.blocks.emplace_back(Paragraph{
      trn("{} cavity laid over each other. Orange: how many of the class removed a place outside target and leeway; blue: how many left a "
          "place inside the target.",
          "{} cavities laid over each other. Orange: how many of the class removed a place outside target and leeway; blue: how many left a "
          "place inside the target.",
          static_cast<long long>(t.map->sessions()), t.map->sessions()),
      ""});
  d.blocks.emplace_back(LiveFigure{
      "tooth-3d",
      tr("The tooth with the planned cavity"),
      tr("The tooth in 3D needs a browser with scripts and WebGL; the sections below show the same."),
      {}});
  Pictures pictures{{}, 2, false};
  pictures.list = class_pictures(t);
  d.blocks.emplace_back(std::move(pictures));
  d.blocks.emplace_back(Pictures{{{scenarios::heat_legend_svg(tr), ""}}, 1, false});
  d.blocks.emplace_back(
      Paragraph{tr("The sections run through the middle of what was cut too much."), "",
                Paragraph::Kind::small});
  if (t.left_out > 0)
    d.blocks.emplace_back(Paragraph{
        tr("{} sat it with another text, tooth or leaf size than most; they are not in these pictures.",
           t.left_out),
        tr("Note"), Paragraph::Kind::note});
  for (const auto& finding : t.findings)
    d.blocks.emplace_back(
        Paragraph{tr(finding), tr("Not in these pictures"), Paragraph::Kind::note});
  if (f.walls.empty()) return;
  ReportTable walls{{{tr("Wall"), false, 3},
                     {tr("Cut by"), true, 2},
                     {tr("Mean, mm"), true, 2},
                     {tr("95th percentile, mm"), true, 3},
                     {tr("Largest of all, mm"), true, 3}},
                    {},
                    tr("Walls")};
  for (const auto& w : f.walls)
    walls.rows.push_back({{{tr("{}", Term{w.wall})},
                           {std::to_string(w.n)},
                           {number(w.mean_mm, 2)},
                           {number(w.p95_mm, 2)},
                           {number(w.worst_mm, 2)}}});
  d.blocks.emplace_back(std::move(walls));
  d.blocks.emplace_back(Paragraph{
      tr("Signed distance of the cut surface from the target's wall, + = overcut, averaged over the class."),
      "", Paragraph::Kind::small});
}

void add_criteria(Document& d, const ClassFigures& f) {
  d.blocks.emplace_back(Heading{tr("Criteria")});
  ReportTable t{{{tr("Criterion"), false, 3},
                 {tr("Measure"), false, 4},
                 {tr("Share of points"), true, 2},
                 {tr("Discrimination"), true, 2},
                 {tr("Remark"), false, 5}},
                {},
                tr("Criteria")};
  for (const auto& c : f.criteria) {
    const std::string remark =
        c.difficulty > 0.95 ? tr("nearly everybody has all of it: it tells candidates apart little")
        : c.difficulty < 0.2 ? tr("hardly anybody has it: is the task clear, the limit right?")
        : c.discrimination && *c.discrimination < 0.1
            ? tr("goes its own way: who does well elsewhere does not here")
            : "";
    t.rows.push_back(
        {{{c.id}, {c.metric}, {number(c.difficulty, 2)}, {number(c.discrimination, 2)}, {remark}}});
  }
  d.blocks.emplace_back(std::move(t));
  d.blocks.emplace_back(Paragraph{
      tr("Share of points: 0 hard, 1 easy. Discrimination: correlation with the sum of the other criteria. Alpha takes criteria for parts of "
         "one skill, and a rubric of few and different ones has a low one without being unfair."),
      "", Paragraph::Kind::small});
  if (const Message few = few_words(f, "discrimination"); !few.empty())
    d.blocks.emplace_back(
        Paragraph{tr("Discrimination, {}.", few), tr("Few candidates"), Paragraph::Kind::note});
}

void add_stations(Document& d, const ClassFigures& f) {
  d.blocks.emplace_back(Heading{tr("Stations")});
  if (f.stations.size() < 2) {
    d.blocks.emplace_back(
        Paragraph{tr("All sat at one station."), "", Paragraph::Kind::normal, "one_station"});
    return;
  }
  ReportTable t{
      {{tr("Station"), false, 4}, {tr("Candidates"), true, 2}, {tr("Mean points"), true, 2}},
      {},
      tr("Stations"),
      0,
      "stations"};
  for (const auto& s : f.stations)
    t.rows.push_back({{{s.name}, {std::to_string(s.n)}, {number(s.mean, 1)}}});
  d.blocks.emplace_back(std::move(t));
  if (!f.station_effect) return;
  const auto& e = *f.station_effect;
  d.blocks.emplace_back(Paragraph{
      tr("F = {}; stations hold {} of the variance, and shuffled candidates give as much in a share of {} of 9,999 shuffles. {}",
         as_number(e.f, 2), as_percent(100 * e.share, 1), as_number(e.chance, 3),
         e.chance < 0.01
             ? msg("One station may grade harder: compare its stylus by `cavum devices --test`, and who sat there.")
             : msg("No station stands out.")),
      ""});
}

void add_agreement(Document& d, const ClassFigures& f) {
  const auto& a = f.agreement;
  d.blocks.emplace_back(Heading{tr("Agreement with people")});
  if (a.n == 0) {
    d.blocks.emplace_back(Paragraph{tr("No marks of people were given (--marks)."), ""});
    return;
  }
  d.blocks.emplace_back(
      Paragraph{tr("{} marked by {}.", candidates(a.n),
                   msgn("{} judge", "{} judges", static_cast<std::int64_t>(a.judges), a.judges)),
                ""});
  ReportTable t{{{tr("Figure"), false, 3}, {tr("Value"), true, 3}, {tr("What it says"), false, 6}},
                {},
                tr("Agreement with people")};
  const auto row = [&](const std::string& what, const std::string& value, const std::string& says) {
    t.rows.push_back({{{what}, {value}, {says}}});
  };
  if (a.icc) {
    row(tr("ICC(2,1)"), number(a.icc->single_random, 2),
        with_few(
            f, "icc",
            msg("agreement of one judge, the program among them, with any other (Shrout and Fleiss 1979)")));
    row("ICC(3,1)", number(a.icc->single_fixed, 2),
        with_few(f, "icc", msg("the same when a judge may be harder than another throughout")));
    row("ICC(3,k)", number(a.icc->average_fixed, 2),
        with_few(f, "icc", msg("consistency of all judges' mean")));
  }
  if (a.limits)
    row(tr("program less people"),
        tr("{} ({} to {})", as_points(a.limits->bias), as_points(a.limits->low),
           as_points(a.limits->high)),
        with_few(
            f, "limits",
            msg("points: mean, and limits within which about 95 % lie (Bland and Altman 1986)")));
  if (f.pass_points)
    row(tr("weighted kappa"), number(a.kappa, 2),
        with_few(f, "weighted_kappa",
                 msg("fail, borderline, pass; quadratic weights (Cohen 1968)")));
  if (a.cut)
    row(tr("cut by borderline regression"), number(a.cut, 1),
        with_few(
            f, "borderline_cut",
            f.pass_points
                ? msg("points at the rating that means borderline; the rubric's pass mark is {}",
                      as_points(*f.pass_points))
                : msg("points at the rating that means borderline")));
  d.blocks.emplace_back(std::move(t));
  if (a.incomplete > 0)
    d.blocks.emplace_back(
        Paragraph{trn("{} candidate was not marked by all judges, and left out of the ICC.",
                      "{} candidates were not marked by all judges, and left out of the ICC.",
                      static_cast<long long>(a.incomplete), a.incomplete),
                  "", Paragraph::Kind::small});
}

void add_to_look_at(Document& d, const ClassFigures& f) {
  d.blocks.emplace_back(Heading{tr("To look at")});
  if (f.to_look_at.empty()) {
    d.blocks.emplace_back(Paragraph{tr("Nothing stands out."), ""});
    return;
  }
  ReportTable t{{{tr("Entry"), true, 1}, {tr("Candidate"), false, 3}, {tr("Why"), false, 6}},
                {},
                tr("Sessions to look at")};
  for (const auto& l : f.to_look_at)
    t.rows.push_back(
        {{{l.session > 0 ? std::to_string(l.session) : "–"}, {l.candidate}, {tr(l.why)}}});
  d.blocks.emplace_back(std::move(t));
}

}  // namespace

Document class_document(const ClassFigures& f, const ClassTooth& tooth) {
  ui::show_texts_of(tooth.scenario);
  Document d;
  d.language = language();
  d.title = tr("{}: the class", Authored{tooth.scenario.title});
  d.subtitle =
      tr("{} of the exam {}; the last attempt of each counts, sessions filed with findings do not",
         candidates(f.n), as_is(f.exam));
  if (f.simulated > 0)
    d.blocks.emplace_back(Paragraph{
        f.simulated == f.n
            ? tr("All of them were sat by simulated operators.")
            : tr("{} of them were sat by simulated operators, and every figure below mixes them with people: they are listed at the end.",
                 f.simulated),
        tr("Note"), Paragraph::Kind::note});
  if (f.marked_by.size() > 1)
    d.blocks.emplace_back(
        Paragraph{marked_differently(f), tr("Note"), Paragraph::Kind::note, "marked_differently"});
  d.blocks.emplace_back(key_figures(f));
  d.blocks.emplace_back(Pictures{{distribution(f)}, 1, false});
  add_places(d, f, tooth);
  add_criteria(d, f);
  add_stations(d, f);
  add_agreement(d, f);
  add_to_look_at(d, f);
  d.footer = {tr("Class of the exam {}, {}", as_is(f.exam), candidates(f.n)),
              tr("Formulae and sources: grading/cohort/README.md of Cavum {}.", as_is(version()))};
  return d;
}

std::string class_html(const ClassFigures& f, const ClassTooth& tooth) {
  return html_of(class_document(f, tooth), class_data(f, tooth));
}
std::string class_pdf(const ClassFigures& f, const ClassTooth& tooth) {
  return pdf_of(class_document(f, tooth));
}

}  // namespace cavum::report
