#include "ui/report/print/pdf_writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "ui/language/say.h"
#include "ui/report/print/pdf_sheet.h"
#include "ui/report/print/pdf_tags.h"

namespace cavum::report {
namespace {

constexpr double k_text_pt = 9.5, k_small_pt = 8, k_cell_pt = 7.8, k_padding_pt = 3, k_gap_pt = 6;
constexpr double k_pt_per_px = 0.75, k_max_of_page = 0.42;
// Of their size: pictures that stand on the rest of a page rather than leave it empty; one that has
// its line for itself, several side by side.
constexpr double k_min_alone = 0.5, k_min_beside = 0.7;

PdfColour verdict_colour(grading::Verdict verdict) {
  constexpr PdfColour k_colours[] = {
      {0.0, 0.447, 0.698}, {0.835, 0.369, 0.0}, {0.541, 0.427, 0.0}};  // pass, fail, review
  return k_colours[static_cast<std::size_t>(verdict)];
}

class Printer {
 public:
  explicit Printer(PdfSheet& sheet) : s_(sheet) {}

  void title(const Document& d) {
    PdfText title{d.title, 17, true};
    title.tag = "H1";
    s_.lines(title, s_.width_pt());
    s_.space(2);
    s_.lines({d.subtitle, k_small_pt, false, {0.3, 0.3, 0.3}}, s_.width_pt());
    s_.space(k_gap_pt);
  }
  /// So much of what comes next stands on the page of a heading.
  void with_next(double height_pt) { with_next_pt_ = height_pt; }
  /// Height of what of a block cannot be parted.
  [[nodiscard]] double least_height(const Block& block) {
    if (const auto* heading = std::get_if<Heading>(&block)) return heading->level > 2 ? 14 : 20;
    if (const auto* pictures = std::get_if<Pictures>(&block))
      return row_of(*pictures, 0).least_height() + k_gap_pt;
    if (const auto* live = std::get_if<LiveFigure>(&block))
      return live->on_paper.empty() ? 0 : row_of({live->on_paper, 1}, 0).least_height() + k_gap_pt;
    if (const auto* table = std::get_if<ReportTable>(&block)) {
      const std::vector<double> widths = widths_of(*table);
      return height_of(*table, head_of(*table), widths, true) +
             (table->rows.empty() ? 0 : height_of(*table, table->rows.front(), widths, false));
    }
    return 40;
  }
  void operator()(const Heading& b) {
    heading_ = b.text;
    s_.space(b.level > 2 ? 5 : 9);
    s_.need((b.level > 2 ? 14 : 20) + with_next_pt_);
    PdfText text{b.text, b.level > 2 ? 10.0 : 12.5, true};
    text.tag = b.level > 2 ? "H3" : "H2";
    s_.lines(text, s_.width_pt());
    if (b.level <= 2) s_.rule({0.75, 0.75, 0.75});
    s_.space(3);
  }
  void operator()(const Paragraph& b) {
    const double size = b.kind == Paragraph::Kind::small ? k_small_pt : k_text_pt;
    PdfText text{b.text, size, false};
    text.lead = b.lead;
    if (b.kind == Paragraph::Kind::note) text.fill = PdfColour{1.0, 0.957, 0.839};
    s_.lines(text, s_.width_pt());
    s_.space(k_gap_pt / 2);
  }
  void operator()(const Bullets& b) {
    s_.begin_tag("L");
    for (const auto& item : b.items) {
      PdfText text{"• " + item, b.small ? k_small_pt : k_text_pt, false};
      text.tag = "LBody";
      s_.begin_tag("LI");
      s_.lines(text, s_.width_pt());
      s_.end_tag("LI");
      s_.space(1);
    }
    s_.end_tag("L");
    s_.space(k_gap_pt / 2);
  }
  void operator()(const LessonList& b) {
    int number = 0;
    for (const auto& i : b.items) {
      s_.lines({fmt::format("{}. {}", ++number, i.what), k_text_pt, true}, s_.width_pt());
      s_.lines(
          {i.jump ? tr("{} ({}, at {})", as_is(i.instead), as_is(i.weight), as_s(i.jump->t_s, 1))
                  : fmt::format("{} ({})", i.instead, i.weight),
           k_text_pt, false},
          s_.width_pt());
      s_.space(k_gap_pt / 2);
    }
    s_.space(k_gap_pt / 2);
    Pictures pictures{{}, 3};
    for (std::size_t i = 0; i < b.items.size(); ++i)
      if (b.items[i].picture)
        pictures.list.push_back({b.items[i].picture->svg, tr("To {}", i + 1), true});
    if (!pictures.list.empty()) (*this)(pictures);
  }
  void operator()(const Fold& b) { (*this)(Heading{b.title}); }
  void operator()(const FoldEnd&) {}
  void operator()(const CutLine& b) {
    s_.space(2 * k_gap_pt);
    if (!s_.need(b.together_pt)) s_.rule({0.5, 0.5, 0.5}, PdfSheet::Rule::dashed);
    s_.space(k_gap_pt);
  }
  void operator()(const VerdictBox& b) {
    const double left = 0.36 * s_.width_pt(), inner = 8;
    const PdfColour colour = verdict_colour(b.verdict);
    const PdfText verdict{b.verdict_words, 20, true, colour}, score{b.score, 11, true};
    double height_left = s_.height(verdict, left) + s_.height(score, left), height_right = 0;
    for (const auto& line : b.lines) height_left += s_.height({line, k_small_pt, false}, left) + 1;
    const double right = s_.width_pt() - left - 3 * inner;
    for (const auto& reason : b.reasons)
      height_right += s_.height({"• " + reason, k_text_pt, false}, right) + 2;
    const double height = std::max(height_left, height_right) + 2 * inner;
    s_.need(height);
    s_.frame(0, s_.width_pt(), height, colour, 1.4);
    double y = inner;
    for (const PdfText& t : {verdict, score}) y += s_.at(t, inner, y, left);
    for (const auto& line : b.lines) y += s_.at({line, k_small_pt, false}, inner, y + 1, left) + 1;
    y = inner;
    for (const auto& reason : b.reasons)
      y += s_.at({"• " + reason, k_text_pt, false}, left + 2 * inner, y, right) + 2;
    s_.space(height + k_gap_pt);
  }
  void operator()(const ReportTable& b) {
    const std::vector<double> widths = widths_of(b);
    const TableRow head = head_of(b);
    const double head_height = height_of(b, head, widths, true);
    const bool has_head = std::any_of(b.columns.begin(), b.columns.end(),
                                      [](const TableColumn& c) { return !c.title.empty(); });
    s_.begin_tag("Table");
    const auto print_head = [&](bool again) {
      if (!has_head) return;
      s_.fill(0, s_.width_pt(), head_height, {0.93, 0.93, 0.93});
      row(b, head, widths, true, 0, !again);  // once more on another page it is not said again
      s_.space(head_height);
    };
    const double most = s_.page_height_pt() - head_height - 1;
    bool begun = false;
    for (const auto& r : b.rows) {
      const double height = std::min(height_of(b, r, widths, false), most);
      if (!begun) {
        s_.need(height + head_height);
        print_head(false);
      } else if (s_.need(height)) {
        print_head(true);
      }
      begun = true;
      if (r.lost) s_.fill(0, s_.width_pt(), height, {1.0, 0.955, 0.92});
      row(b, r, widths, false, most);
      s_.space(height);
      s_.rule({0.86, 0.86, 0.86});
    }
    s_.end_tag("Table");
    s_.space(k_gap_pt);
  }
  void operator()(const Pictures& b) { pictures(b, heading_); }
  /// `b_name`: of those without a title.
  void pictures(const Pictures& b, const std::string& b_name) {
    for (std::size_t first = 0; first < b.list.size(); first += columns_of(b)) {
      PictureRow row = row_of(b, first);
      if (row.height() > s_.left_pt() && row.least_height() <= s_.left_pt())
        row.shrink_to(s_.left_pt());
      s_.need(row.height());
      double x = 0;
      for (std::size_t i = 0; i < row.placed.size(); ++i) {
        const PictureRow::Placed& p = row.placed[i];
        const Picture& picture = b.list[first + i];
        s_.draw(p.picture, x, row.tallest - p.height, p.width, p.height, picture.raster,
                picture.title.empty() ? b_name : picture.title);
        if (!picture.title.empty())
          s_.at({picture.title, k_small_pt, false}, x, row.tallest + 2, row.width);
        x += row.width + k_between_pt;
      }
      s_.space(row.height());
    }
  }
  void operator()(const LiveFigure& b) {
    if (!b.on_paper.empty()) pictures(Pictures{b.on_paper, 1}, b.title);
  }

 private:
  static constexpr double k_between_pt = 12;
  /// Pictures side by side, standing on one line.
  struct PictureRow {
    struct Placed {
      PdfPicture picture;
      double width, height;
    };
    std::vector<Placed> placed;
    double width = 0, tallest = 0, titles = 0;
    /// With its pictures at such a share of their size.
    [[nodiscard]] double height(double share = 1) const {
      return share * tallest + titles + k_gap_pt;
    }
    [[nodiscard]] double least_height() const {
      return height(placed.size() > 1 ? k_min_beside : k_min_alone);
    }
    void shrink_to(double height_pt) {
      const double share = (height_pt - titles - k_gap_pt) / tallest;
      tallest *= share;
      for (Placed& p : placed) p.width *= share, p.height *= share;
    }
  };
  static std::size_t columns_of(const Pictures& b) {
    return static_cast<std::size_t>(std::max(1, b.columns));
  }
  [[nodiscard]] PictureRow row_of(const Pictures& b, std::size_t first) {
    const std::size_t columns = columns_of(b), end = std::min(b.list.size(), first + columns);
    // three rows of sections to a page: two leave a third of it empty
    const double most = b.sections ? s_.page_height_pt() / 3 - k_gap_pt - 3 * k_small_pt
                                   : k_max_of_page * s_.page_height_pt();
    PictureRow row;
    row.width = (s_.width_pt() - k_between_pt * static_cast<double>(columns - 1)) /
                static_cast<double>(columns);
    for (std::size_t i = first; i < end; ++i) {
      const PdfPicture p(b.list[i].svg);
      const double scale = std::min({k_pt_per_px, row.width / p.width_px(), most / p.height_px()});
      row.placed.push_back({p, p.width_px() * scale, p.height_px() * scale});
      row.tallest = std::max(row.tallest, row.placed.back().height);
      if (!b.list[i].title.empty())
        row.titles =
            std::max(row.titles, s_.height({b.list[i].title, k_small_pt, false}, row.width) + 2);
    }
    return row;
  }
  static TableRow head_of(const ReportTable& t) {
    TableRow head;
    for (const auto& c : t.columns) head.cells.push_back({c.title});
    return head;
  }
  [[nodiscard]] std::vector<double> widths_of(const ReportTable& t) const {
    double sum = 0;
    for (const auto& c : t.columns) sum += c.width;
    std::vector<double> widths;
    for (const auto& c : t.columns) widths.push_back(s_.width_pt() * c.width / sum);
    return widths;
  }
  static PdfText cell_text(const std::string& text, bool number, bool head) {
    PdfText t{text, k_cell_pt, head};
    t.right = number;
    return t;
  }
  double height_of(const ReportTable& t, const TableRow& r, const std::vector<double>& widths,
                   bool head) {
    double height = 0;
    for (std::size_t i = 0; i < r.cells.size(); ++i)
      height = std::max(height, s_.height(cell_text(r.cells[i].text, t.columns[i].number, head),
                                          widths[i] - 2 * k_padding_pt));
    return std::max(height + 2 * k_padding_pt, head ? 0.0 : t.least_row_pt);
  }
  void row(const ReportTable& t, const TableRow& r, const std::vector<double>& widths, bool head,
           double most = 0, bool tagged = true) {
    double x = 0;
    if (tagged) s_.begin_tag("TR");
    for (std::size_t i = 0; i < r.cells.size(); ++i) {
      PdfText text = cell_text(r.cells[i].text, t.columns[i].number, head);
      text.most_pt = most > 0 ? most - 2 * k_padding_pt : 0;
      text.tag = !tagged ? nullptr : head ? "TH" : "TD";
      s_.at(text, x + k_padding_pt, k_padding_pt, widths[i] - 2 * k_padding_pt);
      x += widths[i];
    }
    if (tagged) s_.end_tag("TR");
  }
  PdfSheet& s_;
  double with_next_pt_ = 0;
  std::string heading_;  // the last
};

/// Prints everything; `pages`: how many there will be, 0 when not known yet. Returns how many there
/// were.
int print(const Document& d, int pages, std::string& out, std::vector<std::string>& pictures) {
  PdfSheet sheet(d, pages, out);
  Printer printer(sheet);
  printer.title(d);
  for (std::size_t i = 0; i < d.blocks.size(); ++i) {
    double next = 0;  // headings stand together with what they head
    for (std::size_t j = i + 1; j < d.blocks.size() && std::holds_alternative<Heading>(d.blocks[i]);
         ++j) {
      next += printer.least_height(d.blocks[j]);
      if (next > 0 && !std::holds_alternative<Heading>(d.blocks[j])) break;
    }
    printer.with_next(next);
    std::visit(printer, d.blocks[i]);
  }
  for (const auto& line : d.footer)
    sheet.lines({line, 7, false, {0.35, 0.35, 0.35}}, sheet.width_pt());
  pictures = sheet.picture_words();
  return sheet.finish();
}

}  // namespace

std::string pdf_of(const Document& document) {
  std::string bytes;
  std::vector<std::string> pictures;
  const int pages = print(document, 0, bytes, pictures);
  bytes.clear();
  print(document, pages, bytes, pictures);
  return complete_tags(bytes, document, pictures);
}

}  // namespace cavum::report
