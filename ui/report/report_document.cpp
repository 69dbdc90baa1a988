#include "ui/report/report_document.h"

#include <algorithm>
#include <cmath>

#include "grading/marking/grade.h"
#include "grading/result/loss.h"
#include "grading/result/mark.h"
#include "scenarios/file/measures.h"
#include "scenarios/review/picture.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/figures/from_above.h"
#include "ui/report/figures/section_pictures.h"
#include "ui/report/motion_charts.h"

namespace cavum::report {
namespace {

const std::string k_no_value = "–";
constexpr double k_no_points = 0.005;  // reads 0.00

/// How far from the pass mark, in points.
std::vector<std::string> margin(const grading::Result& r, ReportReader reader) {
  std::vector<std::string> lines;
  const Number percent = as_percent(r.pass_percent, k_as_needed);
  if (r.compensatory) {
    const double mark = r.pass_percent / 100 * r.max_points, off = r.points - mark;
    const Number by = as_points(std::fabs(off), std::fabs(off) < 0.05 ? 3 : 1),
                 pass = as_points(mark);
    const bool failed_alone = std::any_of(r.criteria.begin(), r.criteria.end(),
                                          [](const auto& c) { return c.critical_failed; });
    lines.push_back(off < 0
                        ? tr("{} points below the pass mark of {} points ({})", by, pass, percent)
                        : tr("{} points above the pass mark of {} points ({})", by, pass, percent));
    if (r.borderline_percent > 0 && !failed_alone)
      lines.push_back(tr("within {} points of the pass mark a person decides",
                         as_points(r.borderline_percent / 100 * r.max_points)));
  } else {
    const grading::CriterionResult* lowest = nullptr;
    const auto percent_of = [](const grading::CriterionResult& c) {
      return c.max > 0 ? 100 * c.points / c.max : 100.0;
    };
    for (const auto& c : r.criteria)
      if (c.max > 0 && (lowest == nullptr || percent_of(c) < percent_of(*lowest))) lowest = &c;
    lines.push_back(lowest != nullptr
                        ? tr("each criterion must reach {} by itself; the lowest, {}, reaches {}",
                             percent, Authored{lowest->title}, as_percent(percent_of(*lowest), 1))
                        : tr("each criterion must reach {} by itself", percent));
  }
  if (reader == ReportReader::instructor)
    lines.push_back(
        tr("± {} if every figure were off by its whole bound", as_points(r.points_bound)));
  return lines;
}

/// What gives full marks and what none, and beyond what the exam is failed.
List limits_of(const scenarios::CriterionSpec& c) {
  const scenarios::Measure measure = scenarios::known_measure(c.metric);
  if (measure.reads == scenarios::Reads::yes_no) {
    const Term wanted{c.full == 0 ? measure.no : measure.yes};
    return {{c.critical_above || c.critical_below ? msg("full marks if {}; failed else", wanted)
                                                  : msg("full marks if {}", wanted)},
            true};
  }
  const auto value = [&](double v) {
    return as_unit(v, unit_of(measure.unit).value_or(Unit::none));
  };
  List limits{{c.full <= c.zero ? msg("full up to {}, none from {}", value(c.full), value(c.zero))
                                : msg("full from {}, none up to {}", value(c.full), value(c.zero))},
              true};
  if (c.critical_above) limits.items.push_back(msg("failed above {}", value(*c.critical_above)));
  if (c.critical_below) limits.items.push_back(msg("failed below {}", value(*c.critical_below)));
  return limits;
}

/// A criterion's value as its table shows it.
Message shown_value(const grading::CriterionResult& c, bool with_bound = true) {
  if (!c.value) return msg("–");
  return msg("{}", grading::value_text(scenarios::known_measure(c.metric), *c.value,
                                       with_bound ? c.bound : 0, 2));
}

/// What a reader of the criteria would else have to guess.
std::vector<Paragraph> how_to_read(const grading::Result& r) {
  const auto small = [](const std::string& text, const char* id) {
    return Paragraph{text, "", Paragraph::Kind::small, id};
  };
  std::vector<Paragraph> words{small(
      tr("± after a value: how far the true one may lie from it, because the tooth is known in leaves of {}. ± after points: what the "
         "value at either end of its ± would give.",
         as_mm(r.leaf_mm, k_as_needed)),
      "bounds")};
  const auto any = [&r](const auto& is) {
    return std::any_of(r.criteria.begin(), r.criteria.end(), is);
  };
  if (any([](const grading::CriterionResult& c) { return c.work_share < 1; }))
    words.push_back(small(
        tr("Care counts for as much as was done: where less than {} of the target at the place in question was removed, points are given "
           "in proportion, and their ± holds that share at either end of its own ±, too.",
           as_percent(grading::k_care_counts_percent)),
        "care"));
  if (any([](const grading::CriterionResult& c) {
        return scenarios::known_measure(c.metric).of_floor;
      }))
    words.push_back(small(floor_words(), "floor"));
  return words;
}

void add_criteria(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Criteria")});
  ReportTable t{{{tr("Criterion"), false, 2.2},
                 {tr("Value"), true, 1.9},
                 {tr("Limits"), false, 2.4},
                 {tr("Points"), true, 1.8},
                 {tr("Why"), false, 3.8}},
                {},
                tr("Criteria"),
                0,
                "criteria"};
  for (std::size_t i = 0; i < s.result.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    const std::string points =
        !c.judged
            ? tr("not judged")
            : tr("{} / {}", Number{c.points, Unit::none, 1, c.points_bound}, as_points(c.max));
    const std::string limits =
        i < s.rubric.criteria.size()
            ? tr("{}", limits_of(grading::as_marked(s.rubric.criteria[i], s.result)))
            : "";
    const bool tick =
        s.reader == ReportReader::instructor && c.max - c.points > 1e-9 && c.first.timed();
    const std::string why =
        tick ? tr("{} (from tick {})", c.reason(), c.first.tick) : tr(c.reason());
    t.rows.push_back(
        {{{tr("{}", Authored{c.title})}, {tr(shown_value(c))}, {limits}, {points}, {why}},
         c.judged && c.max - c.points > 1e-9});
  }
  d.blocks.push_back(std::move(t));
  for (auto& words : how_to_read(s.result)) d.blocks.push_back(std::move(words));
}

/// What is asked of a criterion, and why care gives fewer points than its value would.
std::string asked_text(const grading::CriterionResult& c, const scenarios::CriterionSpec& spec,
                       const grading::Result& r) {
  const scenarios::CriterionSpec as = grading::as_marked(spec, r);
  List facts = limits_of(as);
  if (as.zero != spec.zero)
    facts.items.push_back(msg("longer than the rubric's, by the time that was granted"));
  if (c.work_share < 1)
    facts.items.push_back(
        msg("only {} of these points can be had, for so little of the cavity was cut there",
            as_percent(100 * c.work_share)));
  return tr("{}", facts);
}

/// What a student reads first of the criteria: no bounds, places and ticks.
void add_marks(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Marks")});
  ReportTable t{{{tr("What was looked at"), false, 2.6},
                 {tr("Yours"), true, 1.6},
                 {tr("Asked"), false, 3.6},
                 {tr("Points"), true, 1.4}},
                {},
                tr("Marks"),
                0,
                "marks"};
  for (std::size_t i = 0; i < s.result.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    t.rows.push_back(
        {{{tr("{}", Authored{c.title})},
          {tr(shown_value(c, false))},
          {i < s.rubric.criteria.size() ? asked_text(c, s.rubric.criteria[i], s.result) : ""},
          {c.judged ? points_of(c.points, c.max) : tr("not judged")}},
         c.judged && c.max - c.points > 1e-9});
  }
  d.blocks.push_back(std::move(t));
}

Pictures key_to_sections(const ReportSource& s) {
  Pictures key{{}, 3};
  for (auto& svg : scenarios::legend_parts_svg(s.input.seen_before(), true,
                                               s.input.scenario.accommodations.high_contrast, tr))
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
    const Number points = as_points(l.points);
    LessonList::Item item{
        l.fails_exam ? tr("{} points; this alone fails the exam", points) : tr("{} points", points),
        tr(l.what), tr(l.instead)};
    if (l.where.timed()) item.jump = Jump{l.where.t_s(), l.where.site_mm};
    if (l.look_mm)
      if (auto p = section_of_mistake(s.input, *l.look_mm))
        item.picture = Picture{std::move(p->svg), std::move(p->title), true};
    list.items.push_back(std::move(item));
  }
  const bool drawn = std::any_of(list.items.begin(), list.items.end(),
                                 [](const LessonList::Item& i) { return i.picture.has_value(); });
  d.blocks.push_back(std::move(list));
  if (drawn) d.blocks.push_back(key_to_sections(s));
}

/// A step by its own text and not by its identifier.
Value step_by_text(const Value& id, const ReportSource& s) {
  for (const auto& step : s.input.scenario.steps)
    if (id == Value(Name{step.id}) && !step.instruction.empty())
      return Value(Authored{step.instruction});
  return id;
}

/// A failed limit by its criterion's title, steps by their texts.
Message finding_for(grading::Finding f, const ReportSource& s) {
  using Kind = grading::FindingKind;
  const auto& v = f.values;
  if (f.kind == Kind::critical_limit)
    for (const auto& c : s.result.criteria)
      if (v[0] == Value(Name{c.id}))
        return msg("critical criterion {}: {}", Authored{c.title}, c.reason());
  if (f.kind == Kind::step_failed || f.kind == Kind::step_timed_out ||
      f.kind == Kind::step_timed_out_otherwise || f.kind == Kind::last_step_open)
    f.values[0] = step_by_text(v[0], s);
  return f.message();
}

/// Why the verdict is what it is, for a student: a failed limit by its title and figures, without
/// places in mm and ticks.
std::vector<std::string> reasons_for(const ReportSource& s) {
  std::vector<std::string> out;
  if (s.reader == ReportReader::instructor) {
    for (const auto& reason : s.result.verdict_reasons) out.push_back(tr(finding_for(reason, s)));
    return out;
  }
  for (std::size_t i = 0; i < s.result.criteria.size() && i < s.rubric.criteria.size(); ++i) {
    const grading::CriterionResult& c = s.result.criteria[i];
    if (!c.critical_failed) continue;
    out.push_back(tr("{}: {} ({}); this alone fails the exam", Authored{c.title},
                     shown_value(c, false),
                     limits_of(grading::as_marked(s.rubric.criteria[i], s.result))));
  }
  for (const auto& reason : s.result.verdict_reasons)
    if (reason.kind != grading::FindingKind::critical_limit &&
        reason.concerns() != grading::Concerns::detail)
      out.push_back(tr(finding_for(reason, s)));
  return out;
}

/// A row of a moment: time, place, what, how much, points.
TableRow moment_row(const grading::WhyItem& m) {
  const bool lasts = m.end_tick > m.tick && m.tick >= 0;
  return {{time_cell(m.tick, m.site_mm),
           {location_text(m.site_mm)},
           {lasts ? tr("{} (until {})", m.what(), as_s(static_cast<double>(m.end_tick) * k_tick_s))
                  : tr(m.what())},
           {m.amount ? figure(as_unit(*m.amount, unit_of(m.unit).value_or(Unit::none), 3)) : ""},
           {m.points_lost ? figure(as_points(*m.points_lost, 2)) : ""}},
          m.points_lost && *m.points_lost > 0};
}

void add_moments(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Where the points went")});
  if (s.lost.empty()) {
    d.blocks.push_back(Paragraph{tr("No points were lost."), ""});
    return;
  }
  d.blocks.push_back(
      Paragraph{tr("Each moment begins at its time; its place is where it went furthest."), "",
                Paragraph::Kind::small});
  for (const auto& w : s.lost) {
    const auto& c = w.criterion;
    const double lost = c.max - c.points;
    d.blocks.push_back(Heading{tr("{}: {} of {} points lost", Authored{c.title},
                                  as_points(lost, lost < 0.05 ? 3 : 1), as_points(c.max)),
                               3});
    ReportTable t{{{tr("Time"), true, 1.2},
                   {tr("Place x, y, z, mm"), true, 2},
                   {tr("What"), false, 6},
                   {tr("How much"), true, 1.7},
                   {tr("Points lost"), true, 1.2}},
                  {},
                  tr("Moments behind {}", Authored{c.title})};
    for (const auto& m : w.items) {
      const bool cost_nothing = m.points_lost && *m.points_lost < k_no_points;
      if (s.reader == ReportReader::instructor || !cost_nothing) t.rows.push_back(moment_row(m));
    }
    if (w.left_out > 0)
      t.rows.push_back({{{k_no_value},
                         {""},
                         {trn("{} smaller moment", "{} smaller moments together",
                              static_cast<long long>(w.left_out), w.left_out)},
                         {figure(as_number(w.left_out_amount, 3))},
                         {w.left_out_points > 0 ? figure(as_points(w.left_out_points, 2)) : ""}},
                        w.left_out_points > 0});
    d.blocks.push_back(std::move(t));
  }
}

void add_pictures(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("The tooth")});
  d.blocks.push_back(LiveFigure{
      "tooth-3d",
      tr("The tooth in three dimensions"),
      s.scan
          ? tr("The tooth in three dimensions needs a browser with scripts and WebGL.")
          : tr("The tooth in three dimensions, and the motion through it, need a browser with scripts and WebGL."),
      {}});
  Pictures above{{picture_from_above(s.input)}};
  if (s.beside) {
    Picture other = picture_from_above(s.beside->source.input);
    other.title = tr("Beside it, from above: {}", as_is(s.beside->name));
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
  for (auto& p : section_pictures(s.result, s.input))
    sections.list.push_back({std::move(p.svg), std::move(p.title), true});
  d.blocks.push_back(std::move(sections));
  d.blocks.push_back(key_to_sections(s));
}

void add_course(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Force, depth and speed")});
  d.blocks.push_back(LiveFigure{"charts", tr("Force, depth and handpiece speed over time"),
                                tr("The charts that move need a browser with scripts."),
                                motion_charts(s)});
  if (s.events.empty()) return;
  d.blocks.push_back(Heading{tr("Events"), 3});
  ReportTable t{{{tr("No."), true, 0.6},
                 {tr("Time"), true, 1.2},
                 {tr("Kind"), false, 1.4},
                 {tr("What"), false, 6},
                 {tr("Place x, y, z, mm"), true, 2}},
                {},
                tr("Events")};
  for (std::size_t i = 0; i < s.events.size(); ++i) {
    const ReportEvent& e = s.events[i];
    t.rows.push_back({{{std::to_string(i + 1)},
                       {figure(as_s(e.t_s, 3)), Jump{e.t_s, e.site_mm}},
                       {tr(word_of(e.kind))},
                       {tr(e.text)},
                       {location_text(e.site_mm)}},
                      e.kind == EventGroup::perforation || e.kind == EventGroup::violation});
  }
  d.blocks.push_back(std::move(t));
}

}  // namespace

std::string points_of(const std::optional<double>& points, const std::optional<double>& max) {
  return points ? tr("{} / {}", as_points(*points), as_points(max.value_or(0))) : k_no_value;
}

TableCell time_cell(std::int64_t tick, const std::optional<Vec3>& site_mm) {
  if (tick < 0 || tick == grading::k_untimed_tick) return {k_no_value};
  const double t_s = static_cast<double>(tick) * k_tick_s;
  return {figure(as_s(t_s, 3)), Jump{t_s, site_mm}};
}

std::string location_text(const std::optional<Vec3>& p) {
  return p ? tr("{}; {}; {}", as_number(p->x, 2), as_number(p->y, 2), as_number(p->z, 2)) : "";
}

std::string floor_words() {
  return tr(
      "Overcut of the floor is what was cut of hard tissue below it: where the pulp lies under it the overcut ends at the pulp's own wall, however "
      "far "
      "the bur went on. An opened pulp is told as a perforation, not as overcut.");
}

Message finish_words(Finish finish) {
  switch (finish) {
    case Finish::completed:
      return msg("its last step was completed");
    case Finish::failed:
      return msg("a step was failed");
    case Finish::time:
      return msg("time was up");
    case Finish::ended:
      return msg("it was handed in before its steps were completed");
    case Finish::running:
      break;
  }
  return msg("it was not finished");
}

namespace {

/// Candidate, date, tooth, device.
Message subtitle_of(const ReportSource& s) {
  const bool named = s.filing && s.filing->name && s.filing->released;
  const Message who = named ? msg("{}, candidate {}", *s.filing->name, s.facts.candidate)
                            : msg("Candidate {}", s.facts.candidate);
  const Message all = msg("{} · {} · {} · {}", who, s.facts.created, Authored{s.result.tooth_name},
                          in_words(s.facts.source));
  return s.reader == ReportReader::instructor ? msg("{} · instructor's report", all) : all;
}

}  // namespace

Document report_document(const ReportSource& s) {
  ui::show_texts_of(s.input.scenario);
  const grading::Result& r = s.result;
  Document d;
  d.language = language();
  d.title = tr("{}", Authored{report_title(s)});
  if (s.scan)
    d.subtitle =
        tr("Scan of a prepared tooth · {} · {}", as_is(s.scan->file), Authored{r.tooth_name});
  else
    d.subtitle = tr(subtitle_of(s));
  d.created = s.facts.created;
  if (s.regrade != nullptr)
    d.blocks.push_back(Paragraph{tr("{}.", grading::regrade_text(*s.regrade)), tr("Regrade"),
                                 Paragraph::Kind::note, "regrade"});
  add_filing_notes(d, s);
  const bool decided = s.filing && s.filing->regrade && !s.filing->regrade->person.empty();
  const grading::Verdict verdict = decided ? s.filing->regrade->verdict : r.verdict;
  d.blocks.push_back(VerdictBox{verdict, tr("{}", word_of(verdict)),
                                tr("{} of {} points", as_points(r.points), as_points(r.max_points)),
                                margin(r, s.reader), reasons_for(s)});
  if (s.regrade != nullptr &&
      (s.reader == ReportReader::instructor || (s.filing && s.filing->regrade)))
    add_regrade(d, *s.regrade);
  // whether or not the rubric takes points for it
  if (const grading::PerforationTruth& p = r.perforation.fault; p.perforated)
    d.blocks.push_back(Paragraph{
        tr("{} was opened at {}, which this task asks to spare: {} of its wall lie open, {} of it were removed",
           Term{p.tissue}, as_s(p.first.t_s(), 3), as_mm2(p.area_mm2, 3), as_mm3(p.volume_mm3, 3)),
        tr("Perforation"), Paragraph::Kind::note, "perforation"});
  add_lessons(d, s);
  for (const auto& note : r.notes)
    d.blocks.push_back(Paragraph{tr(finding_for(note, s)), tr("Note")});
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
