#include "ui/report/report_document.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "grading/grade.h"
#include "grading/result/loss.h"
#include "scenarios/file/measures.h"
#include "scenarios/review/picture.h"
#include "ui/report/figures/from_above.h"
#include "ui/report/figures/section_pictures.h"
#include "ui/report/motion_charts.h"

namespace cavum::report {
namespace {

const std::string k_dash = "–";
constexpr double k_no_points = 0.005;  // reads 0.00

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : fmt::format("{} {}", number, unit_text(unit));
}

std::string points_of(const std::optional<double>& points, const std::optional<double>& max) {
  return points ? fmt::format("{} / {}", fixed(*points, 1), fixed(max.value_or(0), 1)) : k_dash;
}

/// How far from the pass mark, in points.
std::vector<std::string> margin(const grading::Result& r, ReportReader reader) {
  std::vector<std::string> lines;
  if (r.compensatory) {
    const double mark = r.pass_percent / 100 * r.max_points, off = r.points - mark;
    lines.push_back(fmt::format("{} points {} the pass mark of {} points ({} %){}", fixed(std::fabs(off), 1), off < 0 ? "below" : "above",
                                fixed(mark, 1), plain_number(r.pass_percent),
                                r.borderline_percent > 0
                                    ? fmt::format("; within {} points of it a person decides", fixed(r.borderline_percent / 100 * r.max_points, 1))
                                    : ""));
  } else {
    const grading::CriterionResult* lowest = nullptr;
    const auto percent = [](const grading::CriterionResult& c) { return c.max > 0 ? 100 * c.points / c.max : 100.0; };
    for (const auto& c : r.criteria)
      if (c.max > 0 && (lowest == nullptr || percent(c) < percent(*lowest))) lowest = &c;
    lines.push_back(fmt::format("each criterion must reach {} % by itself{}", plain_number(r.pass_percent),
                                lowest != nullptr ? fmt::format("; the lowest, {}, reaches {} %", lowest->title, fixed(percent(*lowest), 1)) : ""));
  }
  if (reader == ReportReader::instructor) lines.push_back(fmt::format("± {} if every figure were off by its whole bound", fixed(r.points_bound, 1)));
  return lines;
}

/// What gives full marks and what none, and beyond what the exam is failed.
std::string limits_text(const scenarios::CriterionSpec& c, const std::string& unit) {
  if (scenarios::known_measure(c.metric).reads == scenarios::Reads::yes_no)
    return fmt::format("full for {}{}", c.full == 0 ? "no" : "yes", c.critical_above || c.critical_below ? "; failed else" : "");
  std::string s = fmt::format("full {}{}, none {}{}", c.full <= c.zero ? "up to " : "from ", with_unit(plain_number(c.full), unit),
                              c.full <= c.zero ? "from " : "up to ", with_unit(plain_number(c.zero), unit));
  if (c.critical_above) s += "; failed above " + with_unit(plain_number(*c.critical_above), unit);
  if (c.critical_below) s += "; failed below " + with_unit(plain_number(*c.critical_below), unit);
  return s;
}

/// A criterion's value as its table shows it.
std::string shown_value(const grading::CriterionResult& c, bool with_bound = true) {
  if (!c.value) return k_dash;
  const scenarios::Measure measure = scenarios::known_measure(c.metric);
  if (measure.reads != scenarios::Reads::figure) return grading::value_text(measure, *c.value, with_bound ? c.bound : 0, 2);
  return with_unit(fixed(*c.value, 2) + (c.bound > 0 && with_bound ? " ± " + fixed(c.bound, 2) : ""), c.unit);
}

/// What a reader of the criteria would else have to guess.
std::vector<std::string> how_to_read(const grading::Result& r) {
  std::vector<std::string> words{
      fmt::format("± after a value: how far the true one may lie from it, because the tooth is known in leaves of {} mm. ± after points: what the "
                  "value at either end of its ± would give.",
                  plain_number(r.leaf_mm))};
  const auto any = [&r](const auto& is) { return std::any_of(r.criteria.begin(), r.criteria.end(), is); };
  if (any([](const grading::CriterionResult& c) { return c.work_share < 1; }))
    words.push_back(
        fmt::format("Care counts for as much as was done: where less than {} % of the target at the place in question was removed, points are given "
                    "in proportion, and their ± holds that share at either end of its own ±, too.",
                    plain_number(grading::k_care_counts_percent)));
  if (any([](const grading::CriterionResult& c) { return scenarios::known_measure(c.metric).of_floor; })) words.emplace_back(k_floor_words);
  return words;
}

void add_criteria(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"Criteria"});
  ReportTable t{
      {{"Criterion", false, 2.2}, {"Value", true, 1.9}, {"Limits", false, 2.4}, {"Points", true, 1.8}, {"Why", false, 3.8}}, {}, "Criteria"};
  for (std::size_t i = 0; i < s.result.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    const std::string points =
        !c.judged ? "not judged"
                  : fmt::format("{}{} / {}", fixed(c.points, 1), c.points_bound > 0 ? " ± " + fixed(c.points_bound, 1) : "", fixed(c.max, 1));
    const std::string limits = i < s.rubric.criteria.size() ? limits_text(s.rubric.criteria[i], c.unit) : "";
    t.rows.push_back({{{c.title}, {shown_value(c)}, {limits}, {points}, {c.reason}}, c.judged && c.max - c.points > 1e-9});
  }
  d.blocks.push_back(std::move(t));
  for (const auto& words : how_to_read(s.result)) d.blocks.push_back(Paragraph{words, "", Paragraph::Kind::small});
}

/// What a student reads first of the criteria: no bounds, places and ticks.
void add_marks(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"Marks"});
  ReportTable t{{{"What was looked at", false, 2.6}, {"Yours", true, 1.6}, {"Asked", false, 3.6}, {"Points", true, 1.4}}, {}, "Marks"};
  for (std::size_t i = 0; i < s.result.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    t.rows.push_back({{{c.title},
                       {shown_value(c, false)},
                       {i < s.rubric.criteria.size() ? limits_text(s.rubric.criteria[i], c.unit) : ""},
                       {c.judged ? fmt::format("{} / {}", fixed(c.points, 1), fixed(c.max, 1)) : "not judged"}},
                      c.judged && c.max - c.points > 1e-9});
  }
  d.blocks.push_back(std::move(t));
}

Pictures key_to_sections(const ReportSource& s) {
  Pictures key{{}, 3};
  for (auto& svg : scenarios::legend_parts_svg(s.input.seen_before(), true, s.input.scenario.accommodations.high_contrast))
    key.list.push_back({std::move(svg), ""});
  return key;
}

/// The three mistakes that cost most, in words of the clinic.
void add_lessons(Document& d, const ReportSource& s) {
  constexpr std::size_t k_most = 3;
  if (s.lessons.empty()) return;
  d.blocks.push_back(Heading{"What to work on"});
  LessonList list;
  for (const auto& l : s.lessons) {
    if (list.items.size() == k_most) break;
    LessonList::Item item{fmt::format("{} points{}", fixed(l.points, 1), l.fails_exam ? "; this alone fails the exam" : ""), l.what, l.instead};
    if (l.where.timed()) item.jump = Jump{l.where.t_s(), l.where.site_mm};
    if (l.look_mm)
      if (auto p = section_of_mistake(s.input, *l.look_mm)) item.picture = Picture{std::move(p->svg), std::move(p->title), true};
    list.items.push_back(std::move(item));
  }
  const bool drawn = std::any_of(list.items.begin(), list.items.end(), [](const LessonList::Item& i) { return i.picture.has_value(); });
  d.blocks.push_back(std::move(list));
  if (drawn) d.blocks.push_back(key_to_sections(s));
}

/// Why the verdict is what it is, for a student: a failed limit by its title and figures, without places in mm and ticks.
std::vector<std::string> reasons_for(const ReportSource& s) {
  if (s.reader == ReportReader::instructor) return s.result.verdict_reasons;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < s.result.criteria.size() && i < s.rubric.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    if (!c.critical_failed) continue;
    out.push_back(fmt::format("{}: {} ({}); this alone fails the exam", c.title, shown_value(c, false), limits_text(s.rubric.criteria[i], c.unit)));
  }
  for (const auto& reason : s.result.verdict_reasons)
    if (!reason.starts_with(grading::k_critical_reason)) out.push_back(reason);
  return out;
}

/// A row of a moment: time, place, what, how much, points.
TableRow moment_row(const grading::WhyItem& m) {
  const std::string amount = m.amount ? with_unit(fixed(*m.amount, 3), m.unit) : "";
  std::string what = m.what;
  if (m.end_tick > m.tick && m.tick >= 0) what += fmt::format(" (until {} s)", fixed(static_cast<double>(m.end_tick) * k_tick_s, 2));
  return {{time_cell(m.tick, m.site_mm), {place_text(m.site_mm)}, {what}, {amount}, {m.points_lost ? fixed(*m.points_lost, 2) : ""}},
          m.points_lost && *m.points_lost > 0};
}

void add_moments(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"Where the points went"});
  if (s.lost.empty()) {
    d.blocks.push_back(Paragraph{"No points were lost.", ""});
    return;
  }
  d.blocks.push_back(Paragraph{"Each moment begins at its time; its place is where it went furthest.", "", Paragraph::Kind::small});
  for (const auto& w : s.lost) {
    const auto& c = w.criterion;
    const double lost = c.max - c.points;
    d.blocks.push_back(Heading{fmt::format("{}: {} of {} points lost", c.title, fixed(lost, lost < 0.05 ? 3 : 1), fixed(c.max, 1)), 3});
    ReportTable t{{{"Time", true, 1.2}, {"Place x, y, z, mm", true, 2}, {"What", false, 6}, {"How much", true, 1.7}, {"Points lost", true, 1.2}},
                  {},
                  "Moments behind " + c.title};
    for (const auto& m : w.items) {
      const bool cost_nothing = m.points_lost && *m.points_lost < k_no_points;
      if (s.reader == ReportReader::instructor || !cost_nothing) t.rows.push_back(moment_row(m));
    }
    if (w.left_out > 0)
      t.rows.push_back({{{k_dash},
                         {""},
                         {fmt::format("{} smaller moments together", w.left_out)},
                         {fixed(w.left_out_amount, 3)},
                         {w.left_out_points > 0 ? fixed(w.left_out_points, 2) : ""}},
                        w.left_out_points > 0});
    d.blocks.push_back(std::move(t));
  }
}

void add_pictures(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"The tooth"});
  d.blocks.push_back(LiveFigure{"tooth-3d",
                                "The tooth in three dimensions",
                                s.scan ? "The tooth in three dimensions needs a browser with scripts and WebGL."
                                       : "The tooth in three dimensions, and the motion through it, need a browser with scripts and WebGL.",
                                {}});
  Pictures above{{picture_from_above(s.input)}};
  if (s.reader == ReportReader::student) {
    above.list.push_back(picture_as_planned(s.input));
    above.columns = 2;
  }
  d.blocks.push_back(std::move(above));
}

void add_sections(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"Sections: removed against target"});
  Pictures sections{{}, 2, true};
  for (auto& p : section_pictures(s.result, s.input)) sections.list.push_back({std::move(p.svg), std::move(p.title), true});
  d.blocks.push_back(std::move(sections));
  d.blocks.push_back(key_to_sections(s));
}

void add_course(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"Force, depth and speed"});
  d.blocks.push_back(
      LiveFigure{"charts", "Force, depth and handpiece speed over time", "The charts that move need a browser with scripts.", motion_charts(s)});
  if (s.events.empty()) return;
  d.blocks.push_back(Heading{"Events", 3});
  ReportTable t{{{"No.", true, 0.6}, {"Time", true, 1.2}, {"Kind", false, 1.4}, {"What", false, 6}, {"Place x, y, z, mm", true, 2}}, {}, "Events"};
  for (std::size_t i = 0; i < s.events.size(); ++i) {
    const ReportEvent& e = s.events[i];
    t.rows.push_back({{{std::to_string(i + 1)}, {fixed(e.t_s, 3) + " s", Jump{e.t_s, e.site_mm}}, {e.kind}, {e.text}, {place_text(e.site_mm)}},
                      e.kind == "perforation" || e.kind == "violation"});
  }
  d.blocks.push_back(std::move(t));
}

/// Whether the marks changed by more than they do by themselves.
std::string progress_words(const ReportFiling& f) {
  if (!f.scatter)
    return fmt::format("How much marks vary from one attempt to the next is not known yet: that takes {} further attempts of {} candidates or more.",
                       cohort::k_least_steps, cohort::k_least_repeaters);
  if (!f.progress) return "This is the first attempt that counts.";
  const cohort::Progress& p = *f.progress;
  const std::string by_chance = fmt::format("up to {} % may be chance, as {} steps of {} candidates from one attempt to the next show",
                                            fixed(p.bound_percent, 0), f.scatter->steps, f.scatter->candidates);
  if (!p.told())
    return fmt::format("Over {} attempts no change can be told from chance: {}{} %, and {}.", p.attempts, p.change_percent < 0 ? "" : "+",
                       fixed(p.change_percent, 0), by_chance);
  return fmt::format("Over {} attempts the mark {} by {} %: more than chance explains ({}).", p.attempts, p.change_percent > 0 ? "rose" : "fell",
                     fixed(std::fabs(p.change_percent), 0), by_chance);
}

void add_attempts(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{"Attempts over time"});
  if (!s.filing) {
    d.blocks.push_back(Paragraph{"This report was made from one session alone; earlier attempts are known to the school's ledger.", ""});
    return;
  }
  const bool all = s.reader == ReportReader::instructor;
  ReportTable t{{{"Attempt", true, 1}, {"Filed (UTC)", false, 3}, {"Verdict", false, 1.5}, {"Points", true, 2}, {"Entry", true, 1}, {"", false, 2.5}},
                {},
                "Attempts"};
  std::vector<ReportAttempt> shown;
  for (const auto& a : s.filing->attempts) {
    if (!all && !a.released) continue;
    shown.push_back(a);
    t.rows.push_back({{{std::to_string(shown.size())},
                       {a.date},
                       {attempt_verdict(a)},
                       {points_of(a.points, a.max)},
                       {std::to_string(a.entry)},
                       {attempt_remark(a)}},
                      !a.doubt.empty()});
  }
  d.blocks.push_back(Pictures{{attempts_chart(shown, s.result.pass_percent)}});
  d.blocks.push_back(Paragraph{progress_words(*s.filing), ""});
  d.blocks.push_back(std::move(t));
}

void add_regrade(Document& d, const grading::Comparison& c) {
  const auto because = [](const std::vector<std::string>& why) {
    std::string s;
    for (const auto& w : why) s += (s.empty() ? "" : "; ") + w;
    return s;
  };
  d.blocks.push_back(Heading{"Beside the sealed result"});
  ReportTable t{{{"", false, 2}, {"Sealed", true, 1.5}, {"Regrade", true, 1.5}, {"Change", true, 1}, {"What changed", false, 5}},
                {},
                "Sealed result and regrade"};
  t.rows.push_back({{{"verdict"}, {c.before.verdict}, {c.verdict}, {""}, {because(c.rules)}}});
  t.rows.push_back({{{"points"},
                     {points_of(c.before.points, c.before.max)},
                     {points_of(c.points, c.max)},
                     {grading::signed_points(c.points - c.before.points)},
                     {""}}});
  if (std::fabs(c.before.max - c.max) > 1e-9) {  // two scales: what is left of each
    const double before = c.before.max > 0 ? 100 * c.before.points / c.before.max : 0, now = c.max > 0 ? 100 * c.points / c.max : 0;
    t.rows.push_back(
        {{{"of its own scale"}, {fixed(before, 1) + " %"}, {fixed(now, 1) + " %"}, {grading::signed_points(now - before) + " %"}, {""}}});
  }
  for (const auto& k : c.criteria) {
    std::string why = because(k.why);
    if (k.old_value && k.new_value && fixed(*k.old_value, 3) != fixed(*k.new_value, 3))
      why += (why.empty() ? "" : "; ") + with_unit(fmt::format("value {} → {}", fixed(*k.old_value, 3), fixed(*k.new_value, 3)), k.unit);
    t.rows.push_back(
        {{{k.id}, {points_of(k.old_points, k.old_max)}, {points_of(k.new_points, k.new_max)}, {grading::signed_points(k.difference())}, {why}}});
  }
  d.blocks.push_back(std::move(t));
}

}  // namespace

TableCell time_cell(std::int64_t tick, const std::optional<Vec3>& site_mm) {
  if (tick < 0 || tick == grading::k_untimed_tick) return {k_dash};
  const double t_s = static_cast<double>(tick) * k_tick_s;
  return {fixed(t_s, 3) + " s", Jump{t_s, site_mm}};
}

std::string place_text(const std::optional<Vec3>& p) { return p ? fmt::format("{}, {}, {}", fixed(p->x, 2), fixed(p->y, 2), fixed(p->z, 2)) : ""; }

std::string finish_words(const std::string& finish) {
  if (finish == scenarios::finish_name(scenarios::Finish::completed)) return "its last step was completed";
  if (finish == scenarios::finish_name(scenarios::Finish::failed)) return "a step was failed";
  if (finish == scenarios::finish_name(scenarios::Finish::time)) return "time was up";
  if (finish == scenarios::finish_name(scenarios::Finish::ended)) return "it was handed in before its steps were completed";
  return "it was not finished";
}

std::string unit_text(const std::string& unit) {
  if (unit == "mm3") return "mm³";
  if (unit.starts_with("mm3 ")) return "mm³" + unit.substr(3);
  return unit;
}

Document report_document(const ReportSource& s) {
  const grading::Result& r = s.result;
  Document d;
  d.title = report_title(s);
  const bool named = s.filing && s.filing->name && s.filing->released;
  if (s.scan)
    d.subtitle = fmt::format("Scan of a prepared tooth · {} · {}", s.scan->file, r.tooth_name);
  else
    d.subtitle = fmt::format("{}{} · {} · {} · {}{}", named ? *s.filing->name + ", candidate " : "Candidate ", s.facts.candidate, s.facts.created,
                             r.tooth_name, s.facts.device, s.reader == ReportReader::instructor ? " · instructor's report" : "");
  d.created = s.facts.created;
  if (s.regrade != nullptr) d.blocks.push_back(Paragraph{grading::regrade_text(*s.regrade) + ".", "Regrade", Paragraph::Kind::note});
  add_filing_notes(d, s);
  d.blocks.push_back(VerdictBox{grading::verdict_name(r.verdict), fmt::format("{} of {} points", fixed(r.points, 1), fixed(r.max_points, 1)),
                                margin(r, s.reader), reasons_for(s)});
  if (s.regrade != nullptr && (s.reader == ReportReader::instructor || (s.filing && s.filing->regrade))) add_regrade(d, *s.regrade);
  // whether or not the rubric takes points for it
  if (const grading::PerforationTruth& p = r.perforation.fault; p.perforated)
    d.blocks.push_back(
        Paragraph{fmt::format("{} was opened at {} s, which this task asks to spare: {} mm² of its wall lie open, {} mm³ of it were removed",
                              p.tissue, fixed(p.first.t_s(), 3), fixed(p.area_mm2, 3), fixed(p.volume_mm3, 3)),
                  "Perforation", Paragraph::Kind::note});
  add_lessons(d, s);
  for (const auto& note : r.notes) d.blocks.push_back(Paragraph{note, "Note"});
  const bool student = s.reader == ReportReader::student;
  if (student)
    add_marks(d, s);
  else
    add_criteria(d, s);
  add_pictures(d, s);
  if (student && !s.scan) add_attempts(d, s);
  if (student) {
    d.blocks.push_back(Fold{"Every figure: with its bound, its place and its time"});
    add_criteria(d, s);
  }
  add_sections(d, s);
  if (s.scan) {
    add_scan_parts(d, s);
    if (student) d.blocks.push_back(FoldEnd{});
    return d;
  }
  add_course(d, s);
  add_moments(d, s);
  if (student)
    d.blocks.push_back(FoldEnd{});
  else {
    add_instructor_parts(d, s);
    add_attempts(d, s);
  }
  add_integrity(d, s);
  return d;
}

}  // namespace cavum::report
