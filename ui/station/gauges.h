// What the window shows of the work in numbers: clock, speed, force, depth. Each is a bar with its
// value in words beside it.
#pragma once

#include "scenarios/exam/exam.h"
#include "ui/station/theme.h"

namespace cavum::station {

/// A bar `share` full (0..1), over the whole width. `mark` > 0: a line there, and from there on the
/// bar is hatched as too much.
void bar_gauge(const Theme& theme, const Message& name, const Message& value, double share,
               double mark = 0.0);

/// Depth of the tip below the surface's level: "1.2 mm", above it "0.7 mm above"; "0.0 mm" at it
/// and nowhere else.
[[nodiscard]] Message depth_text(double below_mm);

/// Depth below the opening as a scale that grows downwards: where the tip is, and how deep it has
/// been. `most_mm`: the scale's end.
void depth_gauge(const Theme& theme, double tip_mm, double deepest_mm, double most_mm,
                 float height);

/// Those of speed, force and depth that are `shown`. `deepest_mm` so far below the opening.
void show_gauges(const Theme& theme, const scenarios::ExamSetup& setup, const TickOutput& now,
                 double deepest_mm, const scenarios::GaugeSpec& shown);

/// Whether the instrument touches, by a word and a lamp that is full or hollow.
void contact_lamp(const Theme& theme, bool touches);

/// The exam's clock: what is left of the limit, or what has passed when there is none.
void exam_clock(const Theme& theme, double passed_s, double limit_s, bool standing);

}  // namespace cavum::station
