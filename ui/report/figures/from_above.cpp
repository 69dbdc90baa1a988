#include "ui/report/figures/from_above.h"

#include <cairo.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "engine/base/encoding.h"
#include "engine/base/error.h"
#include "engine/base/svg.h"
#include "engine/tooth/octree_edit.h"
#include "ui/language/say.h"

namespace cavum::report {
namespace {

constexpr double k_colours_end_mm = 0.5, k_wanted_px = 560;

struct Colour {
  double r, g, b;
};
constexpr Colour k_left{0.0, 0.447, 0.698}, k_planned{0.96, 0.96, 0.94},
    k_beyond{0.835, 0.369, 0.0}, k_tooth{0.80, 0.79, 0.76}, k_cut_through{0.15, 0.15, 0.15},
    k_neighbour{0.70, 0.77, 0.86}, k_gum_colour{0.91, 0.66, 0.68}, k_cut_adjacent{0.60, 0.10, 0.45};

Colour mix(Colour a, Colour b, double share) {
  return {a.r + (b.r - a.r) * share, a.g + (b.g - a.g) * share, a.b + (b.b - a.b) * share};
}
Colour of_deviation(double mm) {
  return mix(k_planned, mm < 0 ? k_left : k_beyond,
             std::min(1.0, std::fabs(mm) / k_colours_end_mm));
}
std::string hex(Colour c) {
  const auto byte = [](double v) { return std::lround(v * 255); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

/// z of the highest solid leaf of each column, -1 without; x fastest.
std::vector<int> tops(const Octree& tree) {
  const IVec3 n = tree.size();
  std::vector<int> top(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y), -1);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (!tree.is_solid(t)) return;
    for (int y = at.y; y < std::min(n.y, at.y + edge); ++y)
      for (int x = at.x; x < std::min(n.x, at.x + edge); ++x) {
        int& z = top[static_cast<std::size_t>(y) * static_cast<std::size_t>(n.x) +
                     static_cast<std::size_t>(x)];
        z = std::max(z, at.z + edge - 1);
      }
  });
  return top;
}

/// Where hard tissue was cut through into a hollow: how far beyond the target that went, mm, at
/// least 0.
double through_mm(const grading::GradeInput& input, int x, int y, int top, int was) {
  double beyond = 0;
  for (int z = top + 1; z <= was; ++z) {
    const Octree& before = input.before.octree;
    if (before.is_solid(before.tissue({x, y, z})))
      beyond = std::max(beyond, input.zones.distance_mm(IVec3{x, y, z}));
  }
  return beyond;
}

Bytes png_of(cairo_surface_t* surface) {
  Bytes bytes;
  const auto write = [](void* to, const unsigned char* data, unsigned n) {
    auto& all = *static_cast<Bytes*>(to);
    all.insert(all.end(), data, data + n);
    return CAIRO_STATUS_SUCCESS;
  };
  if (cairo_surface_write_to_png_stream(surface, write, &bytes) != CAIRO_STATUS_SUCCESS)
    throw Error(msg("report"), msg("the picture of the tooth could not be packed"),
                msg("free some memory"));
  return bytes;
}

/// z of the highest solid leaf of each column, had the target been taken out and nothing else.
std::vector<int> planned_tops(const grading::GradeInput& input, const std::vector<int>& was) {
  std::vector<int> top = was;
  const IVec3 n = input.before.octree.size();
  const Octree& before = input.before.octree;
  for (int y = 0; y < n.y; ++y)
    for (int x = 0; x < n.x; ++x) {
      int& z = top[static_cast<std::size_t>(y) * static_cast<std::size_t>(n.x) +
                   static_cast<std::size_t>(x)];
      while (z >= 0 && (!before.is_solid(before.tissue({x, y, z})) ||
                        input.zones.zone({x, y, z}) == scenarios::Zone::target))
        --z;
    }
  return top;
}

/// The tooth before and after, column by column.
struct Columns {
  Columns(const grading::GradeInput& graded, bool as_planned)
      : input(graded),
        size(graded.before.octree.size()),
        was(tops(graded.before.octree)),
        is(as_planned ? planned_tops(graded, was) : tops(graded.after)) {
    if (graded.beside == nullptr) return;
    all_was = tops(graded.seen_before().octree);
    all_is = as_planned ? all_was : tops(graded.seen_after());
    cut_adjacent.assign(was.size(), false);
    if (as_planned) return;
    for (const auto& r : graded.all_removed())
      if (graded.beside->apart.beside[r.leaf.tissue])
        cut_adjacent[index(r.leaf.x, r.leaf.y)] = true;
  }
  const grading::GradeInput& input;
  IVec3 size;
  std::vector<int> was, is;
  std::vector<int> all_was,
      all_is;                      ///< with what stands beside the tooth; empty where nothing does
  std::vector<bool> cut_adjacent;  ///< some of that went, anywhere in the column
  /// Columns beyond the tooth's are those at its edge.
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, size.y - 1)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(std::clamp(x, 0, size.x - 1));
  }
};

/// Of a column that still has a top: by its distance from the target where it was cut or should
/// have been.
Colour colour_of_top(const Columns& columns, int x, int y) {
  const Octree& before = columns.input.before.octree;
  const scenarios::ZoneMap& zones = columns.input.zones;
  const int top = columns.is[columns.index(x, y)], was = columns.was[columns.index(x, y)];
  // the natural wall of a hollow is no cut
  const bool cut = before.is_solid(before.tissue({x, y, top + 1})),
             left = zones.zone({x, y, top}) == scenarios::Zone::target;
  if (cut || left)
    return of_deviation(
        zones.distance_mm(before.centre_mm({x, y, top}) + Vec3{0, 0, 0.5 * before.leaf_mm()}));
  return top < was ? of_deviation(through_mm(columns.input, x, y, top, was)) : k_tooth;
}

/// Light from the upper left: slopes that face away from it are darker. `tops`: of what is seen.
Colour lit(Colour c, const Columns& columns, const std::vector<int>& tops, int x, int y) {
  const auto height = [&](int dx, int dy) {
    const int z = tops[columns.index(x + dx, y + dy)];
    return z < 0 ? tops[columns.index(x, y)] : z;
  };
  const double slope = (height(2, -2) - height(-2, 2)) / 8.0;
  const double light = std::clamp(1.0 + 0.22 * std::clamp(slope, -2.0, 1.0), 0.55, 1.12);
  return {std::min(1.0, c.r * light), std::min(1.0, c.g * light), std::min(1.0, c.b * light)};
}

/// Where what stands beside the tooth is seen, or some of it was cut.
std::optional<Colour> adjacent_colour(const Columns& columns, int x, int y) {
  if (columns.all_was.empty()) return std::nullopt;
  const std::size_t i = columns.index(x, y);
  const auto& apart = columns.input.beside->apart;
  const std::uint8_t top =
      columns.all_was[i] < 0
          ? std::uint8_t{k_air}
          : columns.input.seen_before().octree.tissue({x, y, columns.all_was[i]});
  if (columns.cut_adjacent[i]) return k_cut_adjacent;
  if (!apart.beside[top]) return std::nullopt;
  return lit(apart.of_gum[top] ? k_gum_colour : k_neighbour, columns, columns.all_is, x, y);
}

/// ARGB; 0 where there was no tooth.
std::uint32_t pixel_at(const Columns& columns, int x, int y) {
  const std::size_t i = columns.index(x, y);
  const auto beside = adjacent_colour(columns, x, y);
  if (!beside && columns.was[i] < 0) return 0;
  const Colour c = beside ? *beside
                   : columns.is[i] < 0
                       ? k_cut_through
                       : lit(colour_of_top(columns, x, y), columns, columns.is, x, y);
  const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(v * 255)); };
  return 0xff000000u | byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

/// A pixel for each column, as PNG.
Bytes columns_png(const Columns& columns) {
  const IVec3 n = columns.size;
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, n.x, n.y), cairo_surface_destroy);
  cairo_surface_flush(image.get());
  unsigned char* rows = cairo_image_surface_get_data(image.get());
  if (rows == nullptr)
    throw Error(msg("report"), msg("there is no room for a picture of the tooth"),
                msg("free some memory"));
  const int stride = cairo_image_surface_get_stride(image.get());
  for (int y = 0; y < n.y; ++y)
    for (int x = 0; x < n.x; ++x) {
      const std::uint32_t pixel = pixel_at(columns, x, y);
      std::memcpy(rows + static_cast<std::ptrdiff_t>(n.y - 1 - y) * stride +
                      4 * static_cast<std::ptrdiff_t>(x),
                  &pixel, 4);
    }
  cairo_surface_mark_dirty(image.get());
  return png_of(image.get());
}

constexpr double k_top_px = 24, k_bar_px = 18,
                 k_bar_height_px = 200;  // the key stands beside the picture

std::string text_at(double x, double y, const std::string& words, const char* anchor = "start") {
  return svg_text(x, y, words, 16, anchor);
}

std::string beyond_words() { return tr("{} beyond", as_mm(k_colours_end_mm, 1)); }
std::string left_words() { return tr("{} left", as_mm(k_colours_end_mm, 1)); }

/// Room beside the picture for the key, in the reader's language.
double key_width_px() {
  constexpr double k_min_px = 190, k_letter_px = 10;  // of letters of 16 px, wide ones
  std::size_t letters = 0;
  for (const std::string& words : {beyond_words(), left_words(), tr("as planned")})
    letters = std::max(letters, words.size());
  return std::max(k_min_px, 20 + k_bar_px + 8 + k_letter_px * static_cast<double>(letters));
}

/// The bar of colours with its corner at `left` and `top`, and a millimetre of `mm_px` below it.
std::string key_svg(double left, double top, double mm_px) {
  const double words = left + k_bar_px + 8;
  constexpr int k_steps = 20;
  constexpr double k_step_px = k_bar_height_px / k_steps;
  std::string svg;
  for (int i = 0; i < k_steps; ++i)
    svg += svg_rect(left, top + i * k_step_px, k_bar_px, k_step_px + 0.5,
                    hex(of_deviation(k_colours_end_mm * (1 - 2.0 * (i + 0.5) / k_steps))));
  svg += svg_rect(left, top, k_bar_px, k_bar_height_px, "none", "stroke='#666666'");
  svg += text_at(words, top + 14, beyond_words()) +
         text_at(words, top + k_bar_height_px / 2 + 5, tr("as planned")) +
         text_at(words, top + k_bar_height_px - 4, left_words());
  const double below = top + k_bar_height_px + 34;
  return svg + svg_line(left, below, left + mm_px, below, "#222222", 2) +
         text_at(left + mm_px + 8, below + 6, tr("{}", as_mm(1, 0)));
}

constexpr double k_line_px = 26;  // of the second part of the key

/// What stands beside the tooth, below the bar of colours; as many lines as there is of it.
std::vector<std::string> key_beside(const grading::GradeInput& input, double left, double top) {
  std::vector<std::pair<Colour, Message>> entries;
  if (input.beside != nullptr) {
    const auto counts = input.seen_before().octree.count_leaves();
    const auto any = [&](const TissueSet& set) {
      for (std::size_t t = 0; t < set.size(); ++t)
        if (set[t] && counts[t] > 0) return true;
      return false;
    };
    if (any(input.beside->apart.of_neighbours))
      entries.emplace_back(k_neighbour, msg("neighbouring tooth"));
    if (any(input.beside->apart.of_gum)) entries.emplace_back(k_gum_colour, msg("gum"));
    if (!entries.empty()) entries.emplace_back(k_cut_adjacent, msg("cut of these"));
  }
  std::vector<std::string> lines;
  for (const auto& [colour, words] : entries) {
    const double y = top + static_cast<double>(lines.size()) * k_line_px;
    lines.push_back(svg_rect(left, y, k_bar_px, 16, hex(colour), "stroke='#666666'") +
                    text_at(left + k_bar_px + 8, y + 13, tr(words)));
  }
  return lines;
}

/// With the key to its colours, or its place left empty.
std::string picture_svg(const Columns& columns, bool with_key, bool& adjacent_shown) {
  const grading::GradeInput& input = columns.input;
  const IVec3 n = columns.size;
  const double px = k_wanted_px / std::max(n.x, n.y), width = n.x * px, height = n.y * px;
  constexpr double k_below_bar_px = k_bar_height_px + 60;
  const auto beside = with_key ? key_beside(input, width + 20, k_top_px + 10 + k_below_bar_px)
                               : std::vector<std::string>{};
  adjacent_shown = !beside.empty();
  const double all_width = width + key_width_px(),
               key_height =
                   k_below_bar_px +
                   (beside.empty() ? 0.0 : 10 + k_line_px * static_cast<double>(beside.size())),
               all_height = k_top_px + std::max(height, key_height);
  std::string svg =
      k_svg_white + text_at(4, 17, tr("↑ buccal")) + text_at(width - 4, 17, tr("mesial →"), "end");
  svg += fmt::format(
      "<image x='0' y='{}' width='{}' height='{}' preserveAspectRatio='none' href='data:image/png;base64,{}'/>\n",
      fixed(k_top_px, 0), fixed(width, 1), fixed(height, 1), to_base64(columns_png(columns)));
  if (with_key) svg += key_svg(width + 20, k_top_px + 10, px / input.before.octree.leaf_mm());
  for (const auto& line : beside) svg += line;
  return svg_root(all_width, all_height, svg, "font-family='sans-serif' fill='#222222'");
}

}  // namespace

Picture picture_from_above(const grading::GradeInput& input) {
  bool beside = false;
  std::string svg = picture_svg(Columns(input, false), true, beside);
  return {
      std::move(svg),
      beside
          ? tr("From above: what was cut, coloured by the distance of its surface from the target's walls and floor; grey was not cut; what "
               "stands beside it, and what was cut of that, in colours of their own")
          : tr("From above: what was cut, coloured by the distance of its surface from the target's walls and floor; grey was not cut")};
}

Picture picture_as_planned(const grading::GradeInput& input) {
  bool beside = false;
  return {picture_svg(Columns(input, true), false, beside),
          tr("From above, as planned: the target taken out and nothing else")};
}

}  // namespace cavum::report
