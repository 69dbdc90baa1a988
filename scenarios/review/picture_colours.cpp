#include "scenarios/review/picture_colours.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "engine/base/svg.h"
#include "engine/tooth/adjacent.h"
#include "scenarios/review/picture.h"

namespace cavum::scenarios {
namespace {

// Okabe and Ito's palette, told apart with every common colour blindness; tissues pale, findings
// strong.
constexpr Palette k_usual{&KnownTissue::usual, "#56b4e9", "#f0b74d", "#d55e00", "#0072b2",
                          "#8a6d00",           "#8c2d04", "#8b3f78", 1.0};
// For candidates who need stronger contrasts: light and dark alone tell the tissues apart.
constexpr Palette k_strong{&KnownTissue::strong,
                           "#0047ab",
                           "#ff8c00",
                           "#000000",
                           "#0000cd",
                           "#5a4600",
                           "#7a0000",
                           "#6a006a",
                           1.7};

// For what many did: the tissues recede.
constexpr Palette k_grey{&KnownTissue::grey, "#56b4e9", "#f0b74d", "#d55e00", "#0072b2",
                         "#8a6d00",          "#8c2d04", "#8b3f78", 1.0};
struct HeatBand {
  double from_percent;
  const char *over, *under;
};
// Orange against blue, which common colour blindnesses leave apart; lighter = rarer. Steps and
// colours are those of the class's tooth in 3D (ui/report/page/src/deviation.ts).
constexpr HeatBand k_heat[] = {{80, "#9c3a02", "#0b4488"},
                               {60, "#dd6410", "#2b78bd"},
                               {40, "#f58f3d", "#63a5d6"},
                               {20, "#fdb777", "#9fc8e6"},
                               {k_min_heat_percent, "#fdd9b5", "#cfe1f2"}};

struct KeyEntry {
  std::string colour;
  Message text;
  bool is_line;
};

constexpr double k_of_a_telephone_px = 330;

/// In rows, none wider than `most_px`; the entries of `second` begin another one.
std::string key_svg(const std::vector<KeyEntry>& first, const std::vector<KeyEntry>& second = {},
                    double most_px = 1e9, InWords in_words = english_text) {
  constexpr double k_row_px = 22;
  std::string items;
  double width = 0, y = 0;
  for (const auto* row : {&first, &second}) {
    if (row->empty()) continue;
    double x = 4;
    for (const auto& e : *row) {
      const std::string text = in_words(e.text);
      const auto letters = std::count_if(text.begin(), text.end(),
                                         [](unsigned char c) { return (c & 0xc0U) != 0x80U; });
      const double wide = 34 + 6.6 * static_cast<double>(letters);
      if (x > 4 && x + wide > most_px) {
        x = 4;
        y += k_row_px;
      }
      if (e.is_line)
        items += svg_line(x, y + 11, x + 16, y + 11, e.colour, 2);
      else
        items += svg_rect(x, y + 4, 16, 14, e.colour, "stroke='#777777' stroke-width='0.6'");
      items += svg_text(x + 21, y + 15, text, 12, "start", "fill='#222222'");
      x += wide;
      width = std::max(width, x);
    }
    y += k_row_px;
  }
  return svg_root(width, y, items);
}

}  // namespace

const char* heat_colour(double percent) {
  for (const auto& band : k_heat)
    if (std::fabs(percent) >= band.from_percent) return percent > 0 ? band.over : band.under;
  return "";
}

const Palette& palette_of(bool high_contrast) { return high_contrast ? k_strong : k_usual; }

const Palette& grey_palette() { return k_grey; }

const char* tissue_colour(const Palette& colours, std::uint8_t t) {
  return known_tissue(t).*colours.tissue;
}

const char* finding_colour(const Palette& colours, Zone zone) {
  switch (zone) {
    case Zone::target:
      return colours.removed;
    case Zone::leeway_sides:
    case Zone::leeway_bottom:
      return colours.leeway;
    default:
      return colours.overcut;
  }
}

std::string tissue_colour(std::uint8_t tissue, bool high_contrast) {
  return tissue_colour(palette_of(high_contrast), tissue);
}

std::string heat_legend_svg(InWords in_words) {
  std::vector<KeyEntry> entries{{k_grey.target_line, msg("target"), true}};
  const auto band = [](std::size_t i) {
    const Number from = as_number(k_heat[i].from_percent, 0);
    return i == 0 ? msg("{} % or more", from)
                  : msg("{} to {} %", from, as_number(k_heat[i - 1].from_percent, 0));
  };
  for (std::size_t i = std::size(k_heat); i-- > 0;)
    entries.push_back({k_heat[i].over,
                       i + 1 == std::size(k_heat) ? msg("removed, damage: {}", band(i)) : band(i),
                       false});
  for (std::size_t i = std::size(k_heat); i-- > 0;)
    entries.push_back({k_heat[i].under,
                       i + 1 == std::size(k_heat) ? msg("left standing: {}", band(i)) : band(i),
                       false});
  return key_svg(entries, {}, k_of_a_telephone_px, in_words);
}

namespace {

/// What a key names, in its parts.
struct Key {
  std::vector<KeyEntry> tissues, lines, removed, beside;
};
Key key_of(const Tooth& tooth, bool with_removed, const Palette& colours) {
  Key key{{},
          {{colours.target_line, msg("target"), true},
           {colours.leeway_line, msg("leeway"), true},
           {colours.container_line, msg("container"), true}},
          {},
          {}};
  if (!with_removed) key.lines.push_back({colours.guard_line, msg("protected"), true});
  if (with_removed)
    key.removed = {{colours.removed, msg("removed, target"), false},
                   {colours.leeway, msg("removed, leeway"), false},
                   {colours.overcut, msg("removed, damage"), false}};
  for (const Tissue& t : standard_tissues())
    key.tissues.push_back({tissue_colour(colours, t.id), tissue_words(t.name), false});
  for (const Tissue& t : tooth.tissues)
    if (is_adjacent(t.name))
      key.beside.push_back({tissue_colour(colours, t.id), tissue_words(t.name), false});
  return key;
}

}  // namespace

std::string legend_svg(const Tooth& tooth, bool with_removed, bool high_contrast,
                       InWords in_words) {
  const Key key = key_of(tooth, with_removed, palette_of(high_contrast));
  std::vector<KeyEntry> first = key.tissues;
  first.insert(first.end(), key.lines.begin(), key.lines.end());
  first.insert(first.end(), key.removed.begin(), key.removed.end());
  return key_svg(first, key.beside, 1e9, in_words);
}

std::vector<std::string> legend_parts_svg(const Tooth& tooth, bool with_removed, bool high_contrast,
                                          InWords in_words) {
  const Key key = key_of(tooth, with_removed, palette_of(high_contrast));
  std::vector<std::string> parts;
  for (const auto* part : {&key.tissues, &key.lines, &key.removed, &key.beside})
    if (!part->empty()) parts.push_back(key_svg(*part, {}, k_of_a_telephone_px, in_words));
  return parts;
}

}  // namespace cavum::scenarios
