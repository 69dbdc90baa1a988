// A report before it is printed: headings, paragraphs, tables and pictures in their order, in the
// reader's language. It is made once (report_document.h) and printed as HTML or as PDF, so that
// both say the same words and figures.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/base/vec.h"
#include "grading/result/result.h"

namespace cavum::report {

/// A moment of the exam that the page can go to.
struct Jump {
  double t_s = 0;
  std::optional<Vec3> site_mm;
};

struct Heading {
  std::string text;
  int level = 2;  ///< 2 or 3
};

struct Paragraph {
  std::string text;
  std::string lead;  ///< bold, before the text
  enum class Kind { normal, small, note } kind = Kind::normal;
  std::string id =
      {};  ///< which it is, as programs know it (`data-kind` of the page); may be empty
};

struct Bullets {
  std::vector<std::string> items;
  bool small = false;
};

struct TableCell {
  std::string text;
  std::optional<Jump> jump = {};  ///< the text is a button to there
};
struct TableColumn {
  std::string title;
  bool number = false;
  double width = 1;  ///< share of the table's width, where the page is of a fixed one
};
struct TableRow {
  std::vector<TableCell> cells;  ///< as many as columns
  bool lost = false;             ///< points were lost here
  std::string id = {};           ///< what it is, as of a paragraph
};
struct ReportTable {
  std::vector<TableColumn> columns;
  std::vector<TableRow> rows;
  std::string name;  ///< for those who cannot see it
  double least_row_pt =
      0;  ///< height of each row below the heads, where somebody writes into it; 0: its text's
  std::string id = {};  ///< as of a paragraph
};

struct VerdictBox {
  grading::Verdict verdict{};
  std::string verdict_words;
  std::string score;               ///< "71.2 of 100.0 points"
  std::vector<std::string> lines;  ///< margin and uncertainty
  std::vector<std::string> reasons;
};

struct Picture {
  std::string svg;      ///< a complete `<svg>` element with width and height, px
  std::string title;    ///< below it, and for those who cannot see it; may be empty
  bool raster = false;  ///< drawn in cells that touch: print it as an image, not as lines
};
struct Pictures {
  std::vector<Picture> list;
  int columns = 1;  ///< side by side on paper
  bool sections = false;
};

/// What the page moves (`id`: tooth-3d or charts). On paper, and as long as the page cannot, the
/// pictures stand there.
struct LiveFigure {
  std::string id, title, fallback;
  std::vector<Picture> on_paper;
};

/// What cost most, and what to do instead.
struct LessonList {
  struct Item {
    std::string weight;  ///< "9.0 points"
    std::string what, instead;
    std::optional<Jump> jump = {};
    std::optional<Picture> picture = {};
  };
  std::vector<Item> items;
};

/// What follows, up to its end, is folded away on a screen until it is asked for. On paper it
/// stands under its title.
struct Fold {
  std::string title;
};
struct FoldEnd {};

/// A line along which paper is cut; of what follows so much stands together on a page.
struct CutLine {
  double together_pt = 0;
};

using Block = std::variant<Heading, Paragraph, Bullets, ReportTable, VerdictBox, Pictures,
                           LiveFigure, LessonList, Fold, FoldEnd, CutLine>;

struct Document {
  std::string title;
  std::string subtitle;  ///< candidate, date, tooth, device
  std::string language = "en";
  std::string created;  ///< of the session, UTC: "2026-11-21T09:00:00Z"
  std::vector<Block> blocks;
  std::vector<std::string>
      footer;  ///< at the end of the page, on every page of paper the first line alone
};

}  // namespace cavum::report
