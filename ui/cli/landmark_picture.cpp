#include "ui/cli/landmark_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/svg.h"
#include "engine/tooth/octree_edit.h"
#include "ui/language/say.h"
#include "ui/parts/chart_svg.h"

namespace cavum::ui {
namespace {

constexpr double k_px_per_mm = 34.0, k_cell_mm = 0.15, k_margin_px = 34.0;

/// Which two axes a view shows (0 x, 1 y, 2 z), to the right and up.
struct ViewAxes {
  int right, up;
  const char* title;
};
constexpr std::array<ViewAxes, 3> k_views{{{0, 1, noop("from above: right mesial, up buccal (mm)")},
                                           {0, 2, noop("from buccal: right mesial (mm)")},
                                           {1, 2, noop("from distal: right buccal (mm)")}}};

double part(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
int part(IVec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// A view's place on the sheet.
class Panel {
 public:
  Panel(const ViewAxes& axes, Vec3 low, Vec3 high, double left_px)
      : axes_(axes),
        low_{part(low, axes.right), part(low, axes.up), 0},
        high_{part(high, axes.right), part(high, axes.up), 0},
        left_px_(left_px) {}
  [[nodiscard]] double width_px() const { return (high_.x - low_.x) * k_px_per_mm; }
  [[nodiscard]] double height_px() const { return (high_.y - low_.y) * k_px_per_mm; }
  [[nodiscard]] double px(double mm) const { return left_px_ + (mm - low_.x) * k_px_per_mm; }
  [[nodiscard]] double py(double mm) const { return k_margin_px + (high_.y - mm) * k_px_per_mm; }
  [[nodiscard]] double px(Vec3 p) const { return px(part(p, axes_.right)); }
  [[nodiscard]] double py(Vec3 p) const { return py(part(p, axes_.up)); }
  [[nodiscard]] const ViewAxes& axes() const { return axes_; }
  [[nodiscard]] Vec3 low() const { return low_; }
  [[nodiscard]] Vec3 high() const { return high_; }

 private:
  ViewAxes axes_;
  Vec3 low_, high_;
  double left_px_;
};

/// Cells of a view and what each shows; -1 nothing.
struct Cells {
  int nx = 0, ny = 0;
  std::vector<int> value;
  [[nodiscard]] int& at(int x, int y) { return value[static_cast<std::size_t>(y * nx + x)]; }
};

std::string runs_svg(Cells& cells, const Panel& panel, const std::vector<std::string>& colours) {
  std::string out;
  for (int y = 0; y < cells.ny; ++y)
    for (int x = 0; x < cells.nx;) {
      const int value = cells.at(x, y);
      int end = x + 1;
      while (end < cells.nx && cells.at(end, y) == value) ++end;
      if (value >= 0)
        out += svg_rect(panel.px(panel.low().x + x * k_cell_mm),
                        panel.py(panel.low().y + (y + 1) * k_cell_mm),
                        (end - x) * k_cell_mm * k_px_per_mm + 0.3, k_cell_mm * k_px_per_mm + 0.3,
                        colours[static_cast<std::size_t>(value)]);
      x = end;
    }
  return out;
}

Cells empty_cells(const Panel& panel, int value) {
  Cells cells;
  cells.nx = static_cast<int>((panel.high().x - panel.low().x) / k_cell_mm) + 1;
  cells.ny = static_cast<int>((panel.high().y - panel.low().y) / k_cell_mm) + 1;
  cells.value.assign(static_cast<std::size_t>(cells.nx) * static_cast<std::size_t>(cells.ny),
                     value);
  return cells;
}

/// Calls visit(x, y, cube's low corner and edge, tissue) for the cells that each cube covers in a
/// view.
template <class Visit>
void for_cells(const Tooth& tooth, const Panel& panel, const Cells& cells, const Visit& visit) {
  const Octree& tree = tooth.octree;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    const auto range = [&](int axis, double low, int n) {
      const double a = part(tree.origin_mm(), axis) + part(at, axis) * tree.leaf_mm(),
                   b = a + edge * tree.leaf_mm();
      return std::pair{std::clamp(static_cast<int>((a - low) / k_cell_mm), 0, n - 1),
                       std::clamp(static_cast<int>((b - low) / k_cell_mm), 0, n - 1)};
    };
    const auto [x0, x1] = range(panel.axes().right, panel.low().x, cells.nx);
    const auto [y0, y1] = range(panel.axes().up, panel.low().y, cells.ny);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) visit(x, y, at, edge, t);
  });
}

std::string from_above(const Tooth& tooth, const Panel& panel) {
  const Octree& tree = tooth.octree;
  Cells tops = empty_cells(panel, -1);
  for_cells(tooth, panel, tops, [&](int x, int y, IVec3 at, int edge, std::uint8_t t) {
    if (tree.is_solid(t)) tops.at(x, y) = std::max(tops.at(x, y), at.z + edge);
  });
  constexpr int k_shades = 32;
  std::vector<std::string> colours;
  for (int i = 0; i < k_shades; ++i)
    colours.push_back(fmt::format("#{0:02x}{0:02x}{1:02x}", 70 + 5 * i, 60 + 5 * i));
  Cells shades = empty_cells(panel, -1);
  for (int y = 1; y + 1 < tops.ny; ++y)
    for (int x = 1; x + 1 < tops.nx; ++x) {
      if (tops.at(x, y) < 0) continue;
      const double per = tree.leaf_mm() / (2 * k_cell_mm),
                   gx = (tops.at(x + 1, y) - tops.at(x - 1, y)) * per,
                   gy = (tops.at(x, y + 1) - tops.at(x, y - 1)) * per;
      const double light = (0.35 * gx - 0.35 * gy + 0.87) / std::sqrt(1 + gx * gx + gy * gy);
      shades.at(x, y) = std::clamp(static_cast<int>(light * k_shades), 0, k_shades - 1);
    }
  return runs_svg(shades, panel, colours);
}

std::string from_side(const Tooth& tooth, const Panel& panel) {
  Cells cells = empty_cells(panel, -1);
  for_cells(tooth, panel, cells, [&](int x, int y, IVec3, int, std::uint8_t t) {
    const int value = t == k_pulp ? 2 : t == k_enamel ? 1 : tooth.octree.is_solid(t) ? 0 : -1;
    cells.at(x, y) = std::max(cells.at(x, y), value);
  });
  return runs_svg(cells, panel, {"#e8d9b0", "#cfd8e0", "#e3a9a4"});
}

std::string line_svg(const Panel& panel, const Polyline& line, const char* colour, bool closed,
                     double width_px = 1.6) {
  if (line.size() < 2) return "";
  std::string points;
  for (const Vec3 p : line) points += fmt::format("{:.1f},{:.1f} ", panel.px(p), panel.py(p));
  return fmt::format("<{} points='{}' fill='none' stroke='{}' stroke-width='{}'/>",
                     closed ? "polygon" : "polyline", points, colour, width_px);
}

std::string dot_svg(const Panel& panel, Vec3 p, const char* colour, const std::string& label) {
  return svg_circle(panel.px(p), panel.py(p), 4, colour, "stroke='#ffffff'") +
         svg_text(panel.px(p) + 6, panel.py(p) - 4, label, 11, "start",
                  fmt::format("fill='{}' stroke='#ffffff' stroke-width='2.5' paint-order='stroke'",
                              colour));
}

std::string marks_svg(const Panel& panel, const Landmarks& l, bool above) {
  std::string out;
  out += line_svg(panel, l.height_of_contour_mm, "#8a8a8a", true, 1.0) +
         line_svg(panel, l.neck_mm, "#7a4a00", true);
  out += line_svg(panel, l.occlusal_table_mm, "#c07000", true, 1.2);
  for (const auto& r : l.cusp_ridges) out += line_svg(panel, r, "#c07000", false, 1.0);
  out += line_svg(panel, l.mesial_ridge.crest_mm, "#d02090", false, 2.4) +
         line_svg(panel, l.distal_ridge.crest_mm, "#8030c0", false, 2.4);
  if (above) {
    out += line_svg(panel, l.central_fissure_mm, "#0050d0", false, 2.4);
    for (const auto& b : l.fissure_branches_mm) out += line_svg(panel, b, "#3090ff", false, 1.8);
  }
  out += line_svg(panel, l.incisal_edge_mm, "#c07000", false, 2.4);
  const Vec3 through = l.long_axis.through_mm, way = l.long_axis.occlusal;
  if (!above && !l.neck_mm.empty())
    out += line_svg(panel, {through - way * 12.0, through + way * 8.0}, "#555555", false, 0.8);
  for (const auto& [name, at] : named_points(l)) {
    const bool deep = name.starts_with("pulp") || name.starts_with("chamber") ||
                      name.starts_with("canal") || name.starts_with("apex");
    const char* colour = name.starts_with("cusp")  ? "#a03000"
                         : name.ends_with("pit")   ? "#0030a0"
                         : name.ends_with("ridge") ? "#a00070"
                                                   : "#b01010";
    if (!deep || !above) out += dot_svg(panel, at, colour, name);
  }
  return out;
}

std::string axes_svg(const Panel& panel) {
  std::string out =
      svg_text(panel.px(panel.low().x), k_margin_px - 14, tr("{}", Term{panel.axes().title}), 13);
  for (int mm = static_cast<int>(std::ceil(panel.low().x)); mm <= panel.high().x; mm += 1)
    if (mm % 2 == 0)
      out += svg_text(panel.px(mm), panel.py(panel.low().y) + 14, std::to_string(mm), 10, "middle",
                      "fill='#555555'");
  for (int mm = static_cast<int>(std::ceil(panel.low().y)); mm <= panel.high().y; mm += 1)
    if (mm % 2 == 0)
      out += svg_text(panel.px(panel.low().x) - 4, panel.py(mm) + 3, std::to_string(mm), 10, "end",
                      "fill='#555555'");
  return out;
}

}  // namespace

std::string landmark_picture(const Tooth& tooth, const Landmarks& landmarks) {
  const Octree& tree = tooth.octree;
  Bounds box;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (!tree.is_solid(t)) return;
    const Vec3 a = tree.origin_mm() + to_vec3(at) * tree.leaf_mm(),
               b = a + Vec3{1, 1, 1} * (edge * tree.leaf_mm());
    box.add(a, b);
  });
  if (box.empty()) box.low = box.high = {};
  box.low = box.low - Vec3{0.6, 0.6, 0.6};
  box.high = box.high + Vec3{0.6, 0.6, 0.6};
  std::string content;
  double left = k_margin_px, tallest = 0;
  for (std::size_t v = 0; v < k_views.size(); ++v) {
    const Panel panel(k_views[v], box.low, box.high, left);
    content += (v == 0 ? from_above(tooth, panel) : from_side(tooth, panel)) +
               marks_svg(panel, landmarks, v == 0) + axes_svg(panel);
    left += panel.width_px() + 2 * k_margin_px;
    tallest = std::max(tallest, panel.height_px());
  }
  return svg_page(left, tallest + 2 * k_margin_px, content, tr("landmarks of a tooth"));
}

}  // namespace cavum::ui
