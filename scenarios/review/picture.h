// Sections of a tooth as SVG: tissues as filled leaves, zones as outlines, what was removed as
// hatching. Colours keep apart for colour-blind eyes, and removed tissue is also told by its
// pattern.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "engine/tooth/tooth.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

class Shape;

/// Puts a picture's words into a language.
using InWords = std::string (*)(const Message& words);

/// Which way one looks: the two axes of the picture, to the right and up.
enum class View : std::uint8_t {
  mesio_distal,   ///< right = mesial, up = occlusal; cut across buccal-lingual
  bucco_lingual,  ///< right = buccal, up = occlusal
  horizontal,     ///< right = mesial, up = buccal, cut at a height
  occlusal,       ///< from above, the whole surface
};

struct PictureSpec {
  View view = View::mesio_distal;
  double at_mm = 0.0;  ///< where the section is cut, along the axis looked at
  double scale_px_per_mm = 24.0;
  std::string title;
  bool high_contrast = false;  ///< stronger colours and lines
  const Shape* guard =
      nullptr;  ///< what is protected, drawn as a dashed line in sections; may be null
  /// How often a leaf was cut or left wrongly by many, per cent: + removed outside the target, -
  /// left inside it. With it the tissues are drawn in grey and the leaves in the colours of
  /// heat_legend_svg, and from above each column shows its most frequent overcut, else what was
  /// left most often.
  std::function<double(IVec3 leaf)> heat_percent = {};
  InWords in_words = english_text;
};

/// One picture, a complete `<svg>` element. `after` may be null (nothing was removed yet); then
/// only the zones show.
[[nodiscard]] std::string section_svg(const Tooth& before, const Octree* after,
                                      const ZoneMap& zones, const PictureSpec& spec);

/// Three sections through the middle of the target and the view from above, on one sheet.
[[nodiscard]] std::string scenario_sheet_svg(const Scenario& scenario, const Tooth& tooth,
                                             const ZoneMap& zones, InWords in_words);

/// The colour of a tissue in these pictures, "#rrggbb".
[[nodiscard]] std::string tissue_colour(std::uint8_t tissue, bool high_contrast = false);

/// The key to the colours, an `<svg>` element, with what stands beside the tooth where anything
/// does. `with_removed` adds what a graded section shows.
[[nodiscard]] std::string legend_svg(const Tooth& tooth, bool with_removed,
                                     bool high_contrast = false, InWords in_words = english_text);
/// The same in up to four `<svg>` elements: tissues, lines, what was removed, what stands beside.
/// `in_words`: the room that each entry has is that of its words in that language.
[[nodiscard]] std::vector<std::string> legend_parts_svg(const Tooth& tooth, bool with_removed,
                                                        bool high_contrast = false,
                                                        InWords in_words = english_text);
/// The key to the colours of PictureSpec::heat_percent, an `<svg>` element.
[[nodiscard]] std::string heat_legend_svg(InWords in_words = english_text);

}  // namespace cavum::scenarios
