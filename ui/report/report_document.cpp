#include "ui/report/report_document.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/figures.h"
#include "engine/base/text.h"
#include "engine/language/language.h"
#include "engine/language/say.h"
#include "grading/grade.h"
#include "grading/result/loss.h"
#include "grading/result/mark.h"
#include "scenarios/file/measures.h"
#include "scenarios/review/picture.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/figures/from_above.h"
#include "ui/report/figures/section_pictures.h"
#include "ui/report/motion_charts.h"

namespace cavum::report {
namespace {

const std::string k_dash = "–";
constexpr double k_no_points = 0.005;  // reads 0.00

std::string with_unit(const std::string& number, const std::string& unit) { return unit.empty() ? number : fmt::format("{} {}", number, unit); }

std::string points_of(const std::optional<double>& points, const std::optional<double>& max) {
  return points ? fmt::format("{} / {}", fixed(*points, 1), fixed(max.value_or(0), 1)) : k_dash;
}

/// How far from the pass mark, in points.
std::vector<std::string> margin(const grading::Result& r, ReportReader reader) {
  std::vector<std::string> lines;
  if (r.compensatory) {
    const double mark = r.pass_percent / 100 * r.max_points, off = r.points - mark;
    const std::string by = fixed(std::fabs(off), std::fabs(off) < 0.05 ? 3 : 1), pass = fixed(mark, 1), percent = plain_number(r.pass_percent);
    const bool failed_alone = std::any_of(r.criteria.begin(), r.criteria.end(), [](const auto& c) { return c.critical_failed; });
    lines.push_back((off < 0 ? tr("{} points below the pass mark of {} points ({} %)", by, pass, percent)
                             : tr("{} points above the pass mark of {} points ({} %)", by, pass, percent)) +
                    (r.borderline_percent > 0 && !failed_alone
                         ? tr("; within {} points of it a person decides", fixed(r.borderline_percent / 100 * r.max_points, 1))
                         : ""));
  } else {
    const grading::CriterionResult* lowest = nullptr;
    const auto percent = [](const grading::CriterionResult& c) { return c.max > 0 ? 100 * c.points / c.max : 100.0; };
    for (const auto& c : r.criteria)
      if (c.max > 0 && (lowest == nullptr || percent(c) < percent(*lowest))) lowest = &c;
    lines.push_back(tr("each criterion must reach {} % by itself{}", plain_number(r.pass_percent),
                       lowest != nullptr ? tr("; the lowest, {}, reaches {} %", lowest->title, fixed(percent(*lowest), 1)) : ""));
  }
  if (reader == ReportReader::instructor) lines.push_back(tr("± {} if every figure were off by its whole bound", fixed(r.points_bound, 1)));
  return lines;
}

/// What gives full marks and what none, and beyond what the exam is failed.
std::string limits_text(const scenarios::CriterionSpec& c, const std::string& unit) {
  if (const scenarios::Measure measure = scenarios::known_measure(c.metric); measure.reads == scenarios::Reads::yes_no)
    return tr("full marks if {}", c.full == 0 ? measure.no : measure.yes) + (c.critical_above || c.critical_below ? tr("; failed else") : "");
  const std::string full = with_unit(plain_number(c.full), unit), zero = with_unit(plain_number(c.zero), unit);
  std::string s = c.full <= c.zero ? tr("full up to {}, none from {}", full, zero) : tr("full from {}, none up to {}", full, zero);
  if (c.critical_above) s += tr("; failed above {}", with_unit(plain_number(*c.critical_above), unit));
  if (c.critical_below) s += tr("; failed below {}", with_unit(plain_number(*c.critical_below), unit));
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
      tr("± after a value: how far the true one may lie from it, because the tooth is known in leaves of {} mm. ± after points: what the "
         "value at either end of its ± would give.",
         plain_number(r.leaf_mm))};
  const auto any = [&r](const auto& is) { return std::any_of(r.criteria.begin(), r.criteria.end(), is); };
  if (any([](const grading::CriterionResult& c) { return c.work_share < 1; }))
    words.push_back(
        tr("Care counts for as much as was done: where less than {} % of the target at the place in question was removed, points are given "
           "in proportion, and their ± holds that share at either end of its own ±, too.",
           plain_number(grading::k_care_counts_percent)));
  if (any([](const grading::CriterionResult& c) { return scenarios::known_measure(c.metric).of_floor; })) words.push_back(floor_words());
  return words;
}

void add_criteria(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Criteria")});
  ReportTable t{
      {{tr("Criterion"), false, 2.2}, {tr("Value"), true, 1.9}, {tr("Limits"), false, 2.4}, {tr("Points"), true, 1.8}, {tr("Why"), false, 3.8}},
      {},
      tr("Criteria")};
  for (std::size_t i = 0; i < s.result.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    const std::string points =
        !c.judged ? tr("not judged")
                  : fmt::format("{}{} / {}", fixed(c.points, 1), c.points_bound > 0 ? " ± " + fixed(c.points_bound, 1) : "", fixed(c.max, 1));
    const std::string limits = i < s.rubric.criteria.size() ? limits_text(grading::as_marked(s.rubric.criteria[i], s.result), c.unit) : "";
    t.rows.push_back({{{c.title}, {shown_value(c)}, {limits}, {points}, {for_reader(c.reason, s)}}, c.judged && c.max - c.points > 1e-9});
  }
  d.blocks.push_back(std::move(t));
  for (const auto& words : how_to_read(s.result)) d.blocks.push_back(Paragraph{words, "", Paragraph::Kind::small});
}

/// What is asked of a criterion, and why care gives fewer points than its value would.
std::string asked_text(const grading::CriterionResult& c, const scenarios::CriterionSpec& spec, const grading::Result& r) {
  const scenarios::CriterionSpec as = grading::as_marked(spec, r);
  std::string text = limits_text(as, c.unit);
  if (as.zero != spec.zero) text += tr("; longer than the rubric's, by the time that was granted");
  if (c.work_share < 1) text += tr("; only {} % of these points can be had, for so little of the cavity was cut there", fixed(100 * c.work_share, 0));
  return text;
}

/// What a student reads first of the criteria: no bounds, places and ticks.
void add_marks(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Marks")});
  ReportTable t{
      {{tr("What was looked at"), false, 2.6}, {tr("Yours"), true, 1.6}, {tr("Asked"), false, 3.6}, {tr("Points"), true, 1.4}}, {}, tr("Marks")};
  for (std::size_t i = 0; i < s.result.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    t.rows.push_back({{{c.title},
                       {shown_value(c, false)},
                       {i < s.rubric.criteria.size() ? asked_text(c, s.rubric.criteria[i], s.result) : ""},
                       {c.judged ? fmt::format("{} / {}", fixed(c.points, 1), fixed(c.max, 1)) : tr("not judged")}},
                      c.judged && c.max - c.points > 1e-9});
  }
  d.blocks.push_back(std::move(t));
}

Pictures key_to_sections(const ReportSource& s) {
  Pictures key{{}, 3};
  for (auto& svg : scenarios::legend_parts_svg(s.input.seen_before(), true, s.input.scenario.accommodations.high_contrast, shown))
    key.list.push_back({std::move(svg), ""});
  return key;
}

/// The three mistakes that cost most, in words of the clinic.
void add_lessons(Document& d, const ReportSource& s) {
  constexpr std::size_t k_most = 3;
  if (s.lessons.empty()) return;
  d.blocks.push_back(Heading{tr("What to work on")});
  LessonList list;
  for (const auto& l : s.lessons) {
    if (list.items.size() == k_most) break;
    LessonList::Item item{tr("{} points{}", fixed(l.points, 1), l.fails_exam ? tr("; this alone fails the exam") : ""), l.what, l.instead};
    if (l.where.timed()) item.jump = Jump{l.where.t_s(), l.where.site_mm};
    if (l.look_mm)
      if (auto p = section_of_mistake(s.input, *l.look_mm)) item.picture = Picture{std::move(p->svg), std::move(p->title), true};
    list.items.push_back(std::move(item));
  }
  const bool drawn = std::any_of(list.items.begin(), list.items.end(), [](const LessonList::Item& i) { return i.picture.has_value(); });
  d.blocks.push_back(std::move(list));
  if (drawn) d.blocks.push_back(key_to_sections(s));
}

std::string without_ticks(std::string text) {
  for (std::size_t at = text.find(" (tick "); at != std::string::npos; at = text.find(" (tick ", at))
    text.erase(at, std::min(text.find(')', at), text.size() - 1) + 1 - at);
  return text;
}

/// A failed limit by its criterion's title.
std::string reason_text(const grading::Finding& reason, const ReportSource& s) {
  if (reason.kind == grading::FindingKind::critical_limit)
    for (const auto& c : s.result.criteria)
      if (reason.values[0] == Value(Name{c.id}))
        return english_text(grading::finding<grading::FindingKind::critical_limit>(c.title, without_ticks(for_reader(c.reason, s))).message());
  return for_reader(english_text(reason.message()), s);
}

/// Why the verdict is what it is, for a student: a failed limit by its title and figures, without places in mm and ticks.
std::vector<std::string> reasons_for(const ReportSource& s) {
  std::vector<std::string> out;
  if (s.reader == ReportReader::instructor) {
    for (const auto& reason : s.result.verdict_reasons) out.push_back(reason_text(reason, s));
    return out;
  }
  for (std::size_t i = 0; i < s.result.criteria.size() && i < s.rubric.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    if (!c.critical_failed) continue;
    out.push_back(tr("{}: {} ({}); this alone fails the exam", c.title, shown_value(c, false),
                     limits_text(grading::as_marked(s.rubric.criteria[i], s.result), c.unit)));
  }
  for (const auto& reason : s.result.verdict_reasons)
    if (reason.kind != grading::FindingKind::critical_limit && reason.row().concerns != grading::Concerns::detail)
      out.push_back(reason_text(reason, s));
  return out;
}

/// A row of a moment: time, place, what, how much, points.
TableRow moment_row(const grading::WhyItem& m, const ReportSource& s) {
  const std::string amount = m.amount ? with_unit(fixed(*m.amount, 3), m.unit) : "";
  std::string what = shown(for_reader(m.what, s));
  if (m.end_tick > m.tick && m.tick >= 0) what += tr(" (until {} s)", fixed(static_cast<double>(m.end_tick) * k_tick_s, 2));
  return {{time_cell(m.tick, m.site_mm), {place_text(m.site_mm)}, {what}, {amount}, {m.points_lost ? fixed(*m.points_lost, 2) : ""}},
          m.points_lost && *m.points_lost > 0};
}

void add_moments(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Where the points went")});
  if (s.lost.empty()) {
    d.blocks.push_back(Paragraph{tr("No points were lost."), ""});
    return;
  }
  d.blocks.push_back(Paragraph{tr("Each moment begins at its time; its place is where it went furthest."), "", Paragraph::Kind::small});
  for (const auto& w : s.lost) {
    const auto& c = w.criterion;
    const double lost = c.max - c.points;
    d.blocks.push_back(Heading{tr("{}: {} of {} points lost", c.title, fixed(lost, lost < 0.05 ? 3 : 1), fixed(c.max, 1)), 3});
    ReportTable t{{{tr("Time"), true, 1.2},
                   {tr("Place x, y, z, mm"), true, 2},
                   {tr("What"), false, 6},
                   {tr("How much"), true, 1.7},
                   {tr("Points lost"), true, 1.2}},
                  {},
                  tr("Moments behind {}", c.title)};
    for (const auto& m : w.items) {
      const bool cost_nothing = m.points_lost && *m.points_lost < k_no_points;
      if (s.reader == ReportReader::instructor || !cost_nothing) t.rows.push_back(moment_row(m, s));
    }
    if (w.left_out > 0)
      t.rows.push_back({{{k_dash},
                         {""},
                         {trn("{} smaller moment", "{} smaller moments together", static_cast<long long>(w.left_out), w.left_out)},
                         {fixed(w.left_out_amount, 3)},
                         {w.left_out_points > 0 ? fixed(w.left_out_points, 2) : ""}},
                        w.left_out_points > 0});
    d.blocks.push_back(std::move(t));
  }
}

void add_pictures(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("The tooth")});
  d.blocks.push_back(LiveFigure{"tooth-3d",
                                tr("The tooth in three dimensions"),
                                s.scan ? tr("The tooth in three dimensions needs a browser with scripts and WebGL.")
                                       : tr("The tooth in three dimensions, and the motion through it, need a browser with scripts and WebGL."),
                                {}});
  Pictures above{{picture_from_above(s.input)}};
  if (s.beside) {
    Picture other = picture_from_above(s.beside->source.input);
    other.title = tr("Beside it, from above: {}", s.beside->name);
    above.list.push_back(std::move(other));
    above.columns = 2;
  } else if (s.reader == ReportReader::student) {
    above.list.push_back(picture_as_planned(s.input));
    above.columns = 2;
  }
  d.blocks.push_back(std::move(above));
}

void add_sections(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Sections: removed against target")});
  Pictures sections{{}, 2, true};
  for (auto& p : section_pictures(s.result, s.input)) sections.list.push_back({std::move(p.svg), std::move(p.title), true});
  d.blocks.push_back(std::move(sections));
  d.blocks.push_back(key_to_sections(s));
}

void add_course(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Force, depth and speed")});
  d.blocks.push_back(LiveFigure{"charts", tr("Force, depth and handpiece speed over time"), tr("The charts that move need a browser with scripts."),
                                motion_charts(s)});
  if (s.events.empty()) return;
  d.blocks.push_back(Heading{tr("Events"), 3});
  ReportTable t{
      {{tr("No."), true, 0.6}, {tr("Time"), true, 1.2}, {tr("Kind"), false, 1.4}, {tr("What"), false, 6}, {tr("Place x, y, z, mm"), true, 2}},
      {},
      tr("Events")};
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
    return tr("How much marks vary from one attempt to the next is not known yet: that takes {} further attempts of {} candidates or more.",
              cohort::k_least_steps, cohort::k_least_repeaters);
  if (!f.progress) return tr("This is the first attempt that counts.");
  const cohort::Progress& p = *f.progress;
  const std::string by_chance = tr("up to {} % may be chance, as {} steps of {} candidates from one attempt to the next show",
                                   fixed(p.bound_percent, 0), f.scatter->steps, f.scatter->candidates);
  if (!p.told())
    return tr("Over {} attempts no change can be told from chance: {}{} %, and {}.", p.attempts, p.change_percent < 0 ? "" : "+",
              fixed(p.change_percent, 0), by_chance);
  const std::string by = fixed(std::fabs(p.change_percent), 0);
  return p.change_percent > 0 ? tr("Over {} attempts the mark rose by {} %: more than chance explains ({}).", p.attempts, by, by_chance)
                              : tr("Over {} attempts the mark fell by {} %: more than chance explains ({}).", p.attempts, by, by_chance);
}

void add_attempts(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Attempts over time")});
  if (!s.filing) {
    d.blocks.push_back(Paragraph{tr("This report was made from one session alone; earlier attempts are known to the school's ledger."), ""});
    return;
  }
  const bool all = s.reader == ReportReader::instructor;
  ReportTable t{{{tr("Attempt"), true, 1},
                 {tr("Filed (UTC)"), false, 3},
                 {tr("Verdict"), false, 1.5},
                 {tr("Points"), true, 2},
                 {tr("Entry"), true, 1},
                 {"", false, 2.5}},
                {},
                tr("Attempts")};
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
  d.blocks.push_back(Heading{tr("Beside the sealed result")});
  ReportTable t{{{"", false, 2}, {tr("Sealed"), true, 1.5}, {tr("Regrade"), true, 1.5}, {tr("Change"), true, 1}, {tr("What changed"), false, 5}},
                {},
                tr("Sealed result and regrade")};
  t.rows.push_back({{{tr("verdict")}, {c.before.verdict}, {c.verdict}, {""}, {because(c.rules)}}});
  t.rows.push_back({{{tr("points")},
                     {points_of(c.before.points, c.before.max)},
                     {points_of(c.points, c.max)},
                     {grading::signed_points(c.points - c.before.points)},
                     {""}}});
  if (std::fabs(c.before.max - c.max) > 1e-9) {  // two scales: what is left of each
    const double before = c.before.max > 0 ? 100 * c.before.points / c.before.max : 0, now = c.max > 0 ? 100 * c.points / c.max : 0;
    t.rows.push_back(
        {{{tr("of its own scale")}, {fixed(before, 1) + " %"}, {fixed(now, 1) + " %"}, {grading::signed_points(now - before) + " %"}, {""}}});
  }
  for (const auto& k : c.criteria) {
    std::string why = because(k.why);
    if (k.old_value && k.new_value && fixed(*k.old_value, 3) != fixed(*k.new_value, 3))
      why += (why.empty() ? "" : "; ") + with_unit(tr("value {} → {}", fixed(*k.old_value, 3), fixed(*k.new_value, 3)), k.unit);
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

std::string place_text(const std::optional<Vec3>& p) {
  return p ? shown(fmt::format("{}, {}, {}", fixed(p->x, 2), fixed(p->y, 2), fixed(p->z, 2))) : "";
}

std::string floor_words() {
  return tr(
      "Overcut of the floor is what was cut of hard tissue below it: where the pulp lies under it the overcut ends at the pulp's own wall, however "
      "far "
      "the instrument went on. An opened pulp is told as a perforation, not as overcut.");
}

std::string finish_words(Finish finish) {
  switch (finish) {
    case Finish::completed:
      return tr("its last step was completed");
    case Finish::failed:
      return tr("a step was failed");
    case Finish::time:
      return tr("time was up");
    case Finish::ended:
      return tr("it was handed in before its steps were completed");
    case Finish::running:
      break;
  }
  return tr("it was not finished");
}

std::string for_reader(std::string text, const ReportSource& s) {
  if (s.reader == ReportReader::student) text = without_ticks(std::move(text));
  const auto put = [&text](const std::string& said, const std::string& shown_as) {
    if (const auto at = text.find(said); at != std::string::npos) text.replace(at, said.size(), shown_as);
  };
  const auto& steps = s.input.scenario.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const char* what : {"step", "step,"})
      if (!steps[i].instruction.empty()) put(fmt::format("{} '{}'", what, steps[i].id), fmt::format("{} '{}'", what, steps[i].instruction));
    for (const char* what : {"started", "completed", "failed", "time limit"})
      put(fmt::format("step {} ({})", what, steps[i].id), fmt::format("step {} ({})", what, i + 1));
  }
  return text;
}

namespace {

/// Texts of the rooms below, numbers and units, which are still English: what is said here already stays as it is.
void show_words(Document& d) {
  const auto show = [](std::string& text) { text = with_unit_signs(shown(text)); };
  struct Visit {
    decltype(show)& show_it;
    void operator()(Heading& b) const { show_it(b.text); }
    void operator()(Paragraph& b) const { show_it(b.text), show_it(b.lead); }
    void operator()(Bullets& b) const {
      for (auto& i : b.items) show_it(i);
    }
    void operator()(ReportTable& b) const {
      for (auto& row : b.rows)
        for (auto& cell : row.cells) show_it(cell.text);
    }
    void operator()(VerdictBox& b) const {
      for (auto& line : b.lines) show_it(line);
      for (auto& reason : b.reasons) show_it(reason);
    }
    void operator()(Pictures& b) const {
      for (auto& p : b.list) p = {shown_svg(p.svg), shown(p.title), p.raster};
    }
    void operator()(LiveFigure& b) const {
      for (auto& p : b.on_paper) p = {shown_svg(p.svg), shown(p.title), p.raster};
    }
    void operator()(LessonList& b) const {
      for (auto& i : b.items) {
        show_it(i.what), show_it(i.instead);
        if (i.picture) i.picture = Picture{shown_svg(i.picture->svg), shown(i.picture->title), i.picture->raster};
      }
    }
    void operator()(Fold&) const {}
    void operator()(FoldEnd&) const {}
    void operator()(CutLine&) const {}
  };
  d.language = language();
  show(d.title);
  for (auto& block : d.blocks) std::visit(Visit{show}, block);
}

}  // namespace

Document in_language(Document document) {
  show_words(document);
  return document;
}

Document report_document(const ReportSource& s) {
  ui::show_texts_of(s.input.scenario);
  const grading::Result& r = s.result;
  Document d;
  d.title = report_title(s);
  const bool named = s.filing && s.filing->name && s.filing->released;
  if (s.scan)
    d.subtitle = tr("Scan of a prepared tooth · {} · {}", as_is(s.scan->file), r.tooth_name);
  else
    d.subtitle = fmt::format(
        "{} · {} · {} · {}{}",
        named ? tr("{}, candidate {}", as_is(*s.filing->name), as_is(s.facts.candidate)) : tr("Candidate {}", as_is(s.facts.candidate)),
        s.facts.created, shown(r.tooth_name), shown(s.facts.device), s.reader == ReportReader::instructor ? tr(" · instructor's report") : "");
  d.created = s.facts.created;
  if (s.regrade != nullptr) d.blocks.push_back(Paragraph{grading::regrade_text(*s.regrade) + ".", tr("Regrade"), Paragraph::Kind::note});
  add_filing_notes(d, s);
  const bool decided = s.filing && s.filing->regrade && !s.filing->regrade->person.empty();
  d.blocks.push_back(VerdictBox{decided ? s.filing->regrade->verdict : grading::verdict_name(r.verdict),
                                tr("{} of {} points", fixed(r.points, 1), fixed(r.max_points, 1)), margin(r, s.reader), reasons_for(s)});
  if (s.regrade != nullptr && (s.reader == ReportReader::instructor || (s.filing && s.filing->regrade))) add_regrade(d, *s.regrade);
  // whether or not the rubric takes points for it
  if (const grading::PerforationTruth& p = r.perforation.fault; p.perforated)
    d.blocks.push_back(Paragraph{tr("{} was opened at {} s, which this task asks to spare: {} mm² of its wall lie open, {} mm³ of it were removed",
                                    p.tissue, fixed(p.first.t_s(), 3), fixed(p.area_mm2, 3), fixed(p.volume_mm3, 3)),
                                 tr("Perforation"), Paragraph::Kind::note});
  add_lessons(d, s);
  for (const auto& note : r.notes) d.blocks.push_back(Paragraph{for_reader(english_text(note.message()), s), tr("Note")});
  const bool student = s.reader == ReportReader::student;
  if (student)
    add_marks(d, s);
  else
    add_criteria(d, s);
  add_pictures(d, s);
  if (student && !s.scan) add_attempts(d, s);
  if (student) {
    d.blocks.push_back(Fold{tr("Every figure: with its bound, its place and its time")});
    add_criteria(d, s);
  }
  add_sections(d, s);
  if (s.scan) {
    add_scan_parts(d, s);
    if (student) d.blocks.push_back(FoldEnd{});
    return in_language(std::move(d));
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
  return in_language(std::move(d));
}

}  // namespace cavum::report
