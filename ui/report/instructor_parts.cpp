// What only an instructor's report shows: every figure with its bound, perforation by force and by
// tissue, the work, the device.
#include <nlohmann/json.hpp>

#include "engine/base/json_reader.h"
#include "engine/base/version.h"
#include "engine/session/lock_event.h"
#include "grading/result/loss.h"
#include "scenarios/file/accommodations.h"
#include "ui/language/say.h"
#include "ui/report/report_document.h"

namespace cavum::report {
namespace {

using nlohmann::json;
const std::string k_dash = "–";

Number bounded(double v, double bound, int digits, Unit unit) { return {v, unit, digits, bound}; }

void add_volumes(Document& d, const grading::Result& r) {
  d.blocks.push_back(Heading{tr("Volumes")});
  ReportTable t{{{tr("What"), false, 4},
                 {tr("Volume"), true, 3},
                 {tr("First at"), true, 1.4},
                 {tr("Place x, y, z, mm"), true, 2.2}},
                {},
                tr("Volumes"),
                0,
                "volumes"};
  const auto volume = [&](const std::string& name, const grading::BoundedVolume& v,
                          const grading::Trace& first = {}) {
    t.rows.push_back({{{name},
                       {figure(bounded(v.mm3, v.bound_mm3, 2, Unit::mm3))},
                       first.tick < 0 ? TableCell{""} : time_cell(first.tick, first.site_mm),
                       {first.tick < 0 ? "" : location_text(first.site_mm)}}});
  };
  volume(tr("target"), r.volumes.target);
  t.rows.push_back({{{tr("target removed")},
                     {figure(bounded(r.volumes.target_removed_percent,
                                     r.volumes.target_removed_bound_percent, 1, Unit::percent))},
                     {""},
                     {""}}});
  volume(tr("target left standing"), r.volumes.missed);
  volume(tr("removed in all"), r.volumes.removed);
  const auto zone = [&](const std::string& name, scenarios::Zone z) {
    const grading::ZoneVolume& v = r.volumes.zone[static_cast<std::size_t>(z)];
    volume(name, v.alone(), v.removed.mm3 > 0 ? v.first : grading::Trace{});
  };
  for (const scenarios::Zone z :
       {scenarios::Zone::leeway_sides, scenarios::Zone::leeway_bottom,
        scenarios::Zone::container_sides, scenarios::Zone::container_bottom})
    zone(tr("removed, {}", Term{scenarios::zone_name(z)}), z);
  volume(tr("removed, outside"), r.volumes.outside());
  zone(tr("of it in no zone"), scenarios::Zone::none);
  zone(tr("of it protected"), scenarios::Zone::protected_);
  for (const auto& tissue : r.tissues)
    if (r.volumes.tissue[tissue.id].mm3 > 0)
      volume(tr("removed of {}, in whole leaves", Term{tissue.name}), r.volumes.tissue[tissue.id]);
  t.rows.push_back({{{tr("agreement (Dice)")},
                     {figure(bounded(r.volumes.dice, r.volumes.dice_bound, 3, Unit::none))},
                     {""},
                     {""}}});
  d.blocks.push_back(std::move(t));
}

void add_walls(Document& d, const grading::Result& r) {
  d.blocks.push_back(Heading{tr("Walls")});
  ReportTable t{{{tr("mm, + = overcut"), false, 1.6},
                 {tr("mean"), true},
                 {tr("p95"), true},
                 {tr("over"), true},
                 {tr("at"), true, 0.9},
                 {tr("under"), true},
                 {tr("at"), true, 0.9}},
                {},
                tr("Walls"),
                0,
                "walls"};
  for (std::size_t w = 0; w < scenarios::k_walls; ++w) {
    const grading::WallMeasures& m = r.shape.wall[w];
    const auto cell = [&](double v, double bound) {
      return TableCell{m.samples == 0 ? k_dash : figure(bounded(v, bound, 2, Unit::none))};
    };
    t.rows.push_back(
        {{{tr("{}", Term{scenarios::wall_name(static_cast<scenarios::Wall>(w), r.shape.facing)})},
          cell(m.mean_mm, m.mean_bound_mm),
          cell(m.p95_mm, m.p95_bound_mm),
          cell(m.max_over_mm, r.shape.bound_mm),
          time_cell(m.worst_over.tick, m.worst_over.site_mm),
          cell(m.max_under_mm, r.shape.bound_mm),
          time_cell(m.worst_under.tick, m.worst_under.site_mm)}});
  }
  d.blocks.push_back(std::move(t));
  d.blocks.push_back(Paragraph{floor_words(), "", Paragraph::Kind::small, "floor"});
  d.blocks.push_back(Heading{tr("Cavity")});
  ReportTable c{{{tr("What"), false, 3}, {tr("Measured"), true, 2}, {tr("Target"), true, 2}},
                {},
                tr("Cavity"),
                0,
                "cavity"};
  const auto shape = [&](const std::string& name, const std::optional<double>& v, double target) {
    c.rows.push_back({{{name},
                       {v ? figure(bounded(*v, r.shape.bound_mm, 2, Unit::mm)) : k_dash},
                       {figure(as_mm(target))}}});
  };
  shape(tr("length"), r.shape.length_mm, r.shape.target_length_mm);
  shape(tr("width"), r.shape.width_mm, r.shape.target_width_mm);
  shape(tr("depth"), r.shape.depth_mm, r.shape.target_depth_mm);
  c.rows.push_back(
      {{{tr("wall taper")},
        {r.shape.taper_deg
             ? figure(bounded(*r.shape.taper_deg, r.shape.taper_bound_deg, 1, Unit::deg))
             : k_dash},
        {r.access.target_taper_deg ? figure(bounded(*r.access.target_taper_deg,
                                                    r.access.target_taper_bound_deg, 1, Unit::deg))
                                   : k_dash}}});
  if (r.access.overhang) {
    c.rows.push_back(
        {{{tr("roof left over")},
          {figure(bounded(r.access.overhang->mm3, r.access.overhang->bound_mm3, 2, Unit::mm3))},
          {"0 mm³"}}});
    c.rows.push_back({{{tr("canals covered")},
                       {r.access.canals_covered_percent
                            ? figure(bounded(*r.access.canals_covered_percent,
                                             r.access.canals_bound_percent, 1, Unit::percent))
                            : k_dash},
                       {"0 %"}}});
    c.rows.push_back(
        {{{tr("cut below the target")},
          {figure(bounded(r.access.floor_cut.mm3, r.access.floor_cut.bound_mm3, 2, Unit::mm3))},
          {"0 mm³"}}});
  }
  d.blocks.push_back(std::move(c));
}

void add_perforation(Document& d, const grading::Result& r) {
  d.blocks.push_back(Heading{tr("Perforation")});
  const grading::PerforationMeasures& p = r.perforation;
  if (!p.agree())
    d.blocks.push_back(Paragraph{
        p.detected()
            ? tr("the force shows a faulty breakthrough, the tissue does not: the tissue decides")
            : tr("the tissue shows a faulty breakthrough, the force does not: the tissue decides"),
        tr("Force and tissue disagree"), Paragraph::Kind::note});
  ReportTable t{{{tr("Source"), false, 1},
                 {tr("Kind"), false, 0.9},
                 {tr("Time"), true, 1.3},
                 {tr("Place x, y, z, mm"), true, 2},
                 {tr("What"), false, 5}},
                {},
                tr("Perforation"),
                0,
                "perforations"};
  for (const auto& e : p.events)
    t.rows.push_back(
        {{{tr("force")},
          {e.fault ? tr("fault") : tr("aim")},
          time_cell(e.tick, e.site_mm),
          {location_text(e.site_mm)},
          {tr("{} to {} while the tip went on by {}; probability {}; {}", as_n(e.force_before_n),
              as_n(e.force_after_n), as_mm(e.advance_mm), as_number(e.probability, 2),
              e.confirmed ? msg("confirmed by the tissue") : msg("not confirmed by the tissue"))}},
         e.fault});
  for (const auto& [kind, truth] :
       {std::pair{tr("fault"), &p.fault}, std::pair{tr("aim"), &p.aim}}) {
    if (truth == &p.aim && !p.has_aims) continue;
    t.rows.push_back({{{tr("tissue")},
                       {kind},
                       time_cell(truth->perforated ? truth->first.tick : -1, truth->first.site_mm),
                       {truth->perforated ? location_text(truth->first.site_mm) : ""},
                       {truth->perforated ? tr("{} opened, {} of its wall lie open, {} removed",
                                               Term{truth->tissue},
                                               as_mm2(truth->area_mm2, 3, truth->area_bound_mm2),
                                               as_mm3(truth->volume_mm3, 3, truth->bound_mm3))
                                          : tr("not opened")}},
                      truth == &p.fault && truth->perforated});
    if (truth->drop)
      t.rows.push_back({{{tr("drop")},
                         {kind},
                         time_cell(truth->drop->from_tick, truth->drop->site_mm),
                         {""},
                         {tr(grading::drop_text(*truth->drop))}},
                        truth == &p.fault});
  }
  d.blocks.push_back(std::move(t));
}

void add_work(Document& d, const ReportSource& s) {
  const grading::Result& r = s.result;
  const grading::MotionMeasures& m = r.motion;
  d.blocks.push_back(Heading{tr("Work")});
  d.blocks.push_back(Paragraph{
      tr("Time {}, handpiece turning {}, idle {}. Way of the tip {}. Force {} on average while cutting, {} at most, over the "
         "limit for {}. Steps {} of {} completed, {} violations; the exam ended: {}.",
         as_s(m.time_s, 1), as_s(m.handpiece_time_s, 1), as_s(m.idle_s, 1), as_mm(m.path_mm, 0),
         as_n(m.force_mean_n), as_n(m.force_peak_n), as_s(m.force_over_limit_s, 1),
         r.progress.steps_completed, r.progress.steps, r.progress.violations,
         finish_words(r.progress.finish)),
      ""});
  ReportTable t{{{tr("What"), false, 3}, {tr("Details"), false, 7}},
                {},
                tr("Accommodations, pauses, late work"),
                0,
                "work"};
  const auto seconds = [](std::int64_t ticks) {
    return as_s(static_cast<double>(ticks) * k_tick_s, 1);
  };
  const auto granted = scenarios::accommodations_text(r.accommodations);
  t.rows.push_back(
      {{{tr("accommodations")}, {granted.empty() ? tr("none") : tr(msg("{}", granted))}}});
  t.rows.push_back({{{tr("time limit")}, {figure(seconds(r.limit_ticks))}}});
  List pauses{{}, true};
  for (const auto& p : r.pauses)
    pauses.items.push_back(msg("{} to {}", seconds(p.begin), seconds(p.end)));
  if (pauses.items.empty()) pauses.items.push_back(msg("none"));
  if (r.pauses_refused > 0) pauses.items.push_back(msg("refused: {}", r.pauses_refused));
  t.rows.push_back({{{tr("pauses")}, {tr("{}", pauses)}}});
  const std::int64_t late = m.late_ticks + r.late_work.ticks;
  t.rows.push_back({{{tr("late work")},
                     {late == 0 ? tr("none")
                                : tr("{} after the end, {} removed in it; nothing of it counts",
                                     seconds(late), as_mm3(m.late_removed_mm3))}}});
  for (const LockSummary& l : lock_summary(s.input.events))
    t.rows.push_back(
        {{{tr("the exam's lock")},
          {l.times > 1 ? tr(msg("{}, {} times; first at {}", lock_words(l.first), l.times,
                                seconds(l.first_tick)))
                       : tr(msg("{}; first at {}", lock_words(l.first), seconds(l.first_tick)))}}});
  d.blocks.push_back(std::move(t));
}

/// Of a live exam: how punctual the servo was, as the session's own event says it.
void add_servo(ReportTable& t, const RealTimeReport& servo) {
  const auto ms = [](double us) { return as_unit(us * 1e-3, Unit::ms, 3); };
  const Lateness& l = servo.lateness;
  t.rows.push_back(
      {{{tr("lateness of the servo")},
        {tr("{} ticks, {} late; half of them within {}, 99.9 % within {}, worst {}", servo.ticks,
            servo.overruns, ms(l.quantile_us(0.5)), ms(l.quantile_us(0.999)), ms(l.worst_us()))}}});
}

void add_device(Document& d, const ReportSource& s) {
  d.blocks.push_back(Heading{tr("Device and calibration")});
  ReportTable t{{{tr("What"), false, 3}, {tr("Details"), false, 7}},
                {},
                tr("Device and calibration"),
                0,
                "device"};
  t.rows.push_back({{{tr("device")}, {tr(in_words(s.facts.source))}}});
  t.rows.push_back({{{tr("calibration")},
                     {s.facts.calibration.empty() ? tr("none recorded") : s.facts.calibration}}});
  for (const auto& [key, value] : s.facts.notes)
    if (key != "ticket") t.rows.push_back({{{tr("{}", as_is(key))}, {value}}});
  bool live = false;
  for (const auto& e : s.input.events)
    if (const auto* lateness = e.as<ServoLateness>()) {
      add_servo(t, lateness->servo);
      live = true;
    }
  if (!live)
    t.rows.push_back(
        {{{tr("lateness of the servo")}, {tr("not recorded: the exam did not run in real time")}}});
  t.rows.push_back({{{tr("tooth")},
                     {tr("{}, hash {}, leaf {}", Authored{s.result.tooth_name},
                         as_is(s.facts.tooth_hash), as_mm(s.result.leaf_mm, 3))}}});
  d.blocks.push_back(std::move(t));
}

/// How the scan lay upon the tooth, and how well it is known from it.
void add_scan_facts(Document& d, const ReportScan& scan) {
  const grading::ScanFacts& f = scan.facts;
  d.blocks.push_back(Heading{tr("The scan")});
  ReportTable t{{{tr("What"), false, 3}, {tr("Details"), false, 7}}, {}, tr("The scan")};
  const auto row = [&](const std::string& what, const std::string& text) {
    t.rows.push_back({{{what}, {text}}});
  };
  const auto percent = [](double share) { return as_percent(100 * share, 1); };
  row(tr("file"), tr("{}, SHA-256 {}", as_is(scan.file), as_is(scan.file_sha256)));
  row(tr("surface"), f.end_mm > 0 ? tr("{} triangles; open below", f.triangles)
                                  : tr("{} triangles; closed", f.triangles));
  row(tr("laid upon the unprepared tooth"),
      tr("{} RMS over {} of its surface; {} of what should fit does", as_mm(f.fit.rms_mm, 3),
         percent(f.fit.fits), percent(agreement(f.fit))));
  row(tr("crown seen"), figure(percent(f.fit.crown_seen)));
  row(tr("the best other pose"),
      tr("fits {} of the scan, this one {}", percent(f.second_share), percent(f.pose.share)));
  row(tr("noise"), figure(as_mm(f.fit.noise_mm, 3)));
  row(tr("a place of the cut surface is known to"),
      tr("{}, the surface as a whole to {}", as_mm(f.surface_bound_mm, 3),
         as_mm(f.surface_mean_bound_mm, 3)));
  row(tr("cavities"), std::to_string(f.cavities));
  row(tr("not seen"), tr("{} of the tooth below the end of the scan", as_mm3(f.unseen_mm3)));
  d.blocks.push_back(std::move(t));
}

}  // namespace

void add_scan_parts(Document& d, const ReportSource& s) {
  add_volumes(d, s.result);
  add_walls(d, s.result);
  add_scan_facts(d, *s.scan);
  d.footer.push_back(
      tr("Scan {}, SHA-256 {}…: marked without its recording; time, way and force are not judged",
         as_is(s.scan->file), as_is(s.scan->file_sha256.substr(0, 16))));
  d.footer.push_back(
      tr("Tooth {}, leaf {}. Definitions: docs/grading.md and docs/scans.md of Cavum {}.",
         as_is(s.facts.tooth_hash.substr(0, 16)), as_mm(s.result.leaf_mm, 3), as_is(version())));
}

void add_instructor_parts(Document& d, const ReportSource& s) {
  add_volumes(d, s.result);
  add_walls(d, s.result);
  add_perforation(d, s.result);
  add_work(d, s);
  add_device(d, s);
}

}  // namespace cavum::report
