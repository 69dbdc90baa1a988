// Sections of removed against target for a report: eight of them, through the middle of the target,
// through the places of the worst over- and undercut, and through a perforation where there is one;
// and three on one sheet, as a picture by itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grading/marking/grade.h"
#include "scenarios/review/picture.h"

namespace cavum::report {

/// For what a section is cut just there.
enum class SectionOf : std::uint8_t {
  target,
  opening,
  force,
  nick,
  contact,
  overcut,
  undercut,
  beside
};

struct SectionPicture {
  scenarios::View view = scenarios::View::mesio_distal;
  double at_mm = 0.0;  ///< where it is cut, along the axis looked at, tooth frame
  std::string title;   ///< in the reader's language, with its place: "Mesio-distal, y = 0.12 mm:
                       ///< through the middle of the target"
  std::string svg;     ///< a complete `<svg>` element
  SectionOf of = SectionOf::target;
};

inline constexpr std::size_t k_report_sections = 8;
/// Always k_report_sections, no two the same.
[[nodiscard]] std::vector<SectionPicture> section_pictures(const grading::Result& result,
                                                           const grading::GradeInput& input);

/// The section through a place in which what is wrong within 1.5 mm of it (removed beyond the
/// target or of what stands beside it, or left of the target) shows together with cavity and wall,
/// with a ring around the place; none where nothing is wrong. Its title has no figures.
[[nodiscard]] std::optional<SectionPicture> section_of_mistake(const grading::GradeInput& input,
                                                               Vec3 place_mm);

/// Three sections (through the middle of the target, or the place of a perforation) with the key to
/// their colours: one standalone SVG document.
[[nodiscard]] std::string sections_svg(const grading::Result& result,
                                       const grading::GradeInput& input);

}  // namespace cavum::report
