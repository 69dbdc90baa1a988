// A4 pages on which text, rules and pictures are put from top to bottom; a head with the title and
// a foot with page number and proof stand on each. Cairo writes the file, Pango sets the text,
// librsvg draws the pictures.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ui/report/print/document.h"

namespace cavum::report {

struct PdfColour {
  double r = 0.1, g = 0.1, b = 0.1;
};

struct PdfText {
  std::string text;
  double size_pt = 9.5;
  bool bold = false;
  PdfColour colour = {};
  bool right = false;                  ///< set against the right edge
  std::string lead = {};               ///< bold, before the text
  std::optional<PdfColour> fill = {};  ///< behind it
  double most_pt = 0;                  ///< greatest height, beyond which it ends in "…"; 0 = any
  const char* tag = "P";  ///< what it is to a program that reads it aloud, as PDF names it: H1, P,
                          ///< TH ...; nullptr: nothing
};

/// A picture read from SVG. Throws Error when it is none.
class PdfPicture {
 public:
  explicit PdfPicture(const std::string& svg);
  [[nodiscard]] double width_px() const noexcept { return width_px_; }
  [[nodiscard]] double height_px() const noexcept { return height_px_; }
  /// Draws it into a rectangle of a cairo context (cairo_t*).
  void draw(void* cairo, double x, double y, double width, double height) const;

 private:
  std::shared_ptr<void> handle_;
  double width_px_ = 0, height_px_ = 0;
};

class PdfSheet {
 public:
  /// Writes into `out`, complete after `finish`. `pages`: how many there will be, 0 = not known.
  PdfSheet(const Document& document, int pages, std::string& out);
  ~PdfSheet();
  PdfSheet(const PdfSheet&) = delete;
  PdfSheet& operator=(const PdfSheet&) = delete;

  [[nodiscard]] double width_pt() const noexcept;
  [[nodiscard]] double page_height_pt() const noexcept;
  [[nodiscard]] double left_pt() const noexcept;  ///< of the running page
  /// A new page unless so much is left on this one; true when there was one.
  bool need(double height_pt);
  void space(double height_pt);

  /// Height of text that is as wide as that.
  [[nodiscard]] double height(const PdfText& text, double width_pt);
  /// Text below what stands there already, over as many pages as it takes.
  void lines(const PdfText& text, double width_pt);
  /// Text at a place from here, which is not moved; returns its height.
  double at(const PdfText& text, double x_pt, double y_pt, double width_pt);
  enum class Rule { solid, dashed };
  void rule(PdfColour colour, Rule kind = Rule::solid);
  void fill(double x_pt, double width_pt, double height_pt, PdfColour colour);
  void frame(double x_pt, double width_pt, double height_pt, PdfColour colour, double line_pt);
  /// `words`: for those who cannot see it.
  void draw(const PdfPicture& picture, double x_pt, double y_pt, double width_pt, double height_pt,
            bool raster, const std::string& words);
  /// Around what belongs together: Table, TR, L, LI. Each begin is paired with an end.
  void begin_tag(const char* tag);
  void end_tag(const char* tag);
  /// Ends the last page and the file; returns how many pages there are.
  int finish();
  /// Words of the pictures, in their order.
  [[nodiscard]] const std::vector<std::string>& picture_words() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> s_;
};

}  // namespace cavum::report
