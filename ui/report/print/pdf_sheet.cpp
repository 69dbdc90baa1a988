#include "ui/report/print/pdf_sheet.h"

#include <cairo-pdf.h>
#include <fmt/core.h>
#include <gio/gio.h>
#include <librsvg/rsvg.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "ui/language/say.h"

#ifdef __SANITIZE_ADDRESS__
// Fontconfig keeps what it once read until the program ends: that is no leak of ours.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }
#endif

namespace cavum::report {
namespace {

constexpr double k_page_width = 595.28, k_page_height = 841.89, k_side = 42, k_top = 50,
                 k_bottom = 50;
constexpr double k_raster_px_per_pt = 200.0 / 72.0;
constexpr char k_font[] = "DejaVu Sans";

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using Layout = std::unique_ptr<PangoLayout, Unref>;

cairo_status_t append(void* to, const unsigned char* data, unsigned n) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), n);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

PdfPicture::PdfPicture(const std::string& svg) {
  GError* error = nullptr;
  GInputStream* stream =
      g_memory_input_stream_new_from_data(svg.data(), static_cast<gssize>(svg.size()), nullptr);
  RsvgHandle* handle = rsvg_handle_new_from_stream_sync(stream, nullptr, RSVG_HANDLE_FLAG_UNLIMITED,
                                                        nullptr, &error);
  g_object_unref(stream);
  if (handle == nullptr) {
    const std::string why = error != nullptr ? error->message : "unknown";
    g_clear_error(&error);
    throw Error(msg("report"), msg("a picture cannot be drawn: {}", one_line(why)),
                msg("write the report as .html"));
  }
  handle_ = std::shared_ptr<void>(handle, Unref{});
  rsvg_handle_set_dpi(handle, 96);
  if (rsvg_handle_get_intrinsic_size_in_pixels(handle, &width_px_, &height_px_) == 0 ||
      !(width_px_ > 0) || !(height_px_ > 0))
    throw Error(msg("report"), msg("a picture has no size"), msg("write the report as .html"));
}

void PdfPicture::draw(void* cairo, double x, double y, double width, double height) const {
  const RsvgRectangle place{x, y, width, height};
  GError* error = nullptr;
  if (rsvg_handle_render_document(static_cast<RsvgHandle*>(handle_.get()),
                                  static_cast<cairo_t*>(cairo), &place, &error) != 0)
    return;
  const std::string why = error != nullptr ? error->message : "unknown";
  g_clear_error(&error);
  throw Error(msg("report"), msg("a picture cannot be drawn: {}", one_line(why)),
              msg("write the report as .html"));
}

struct PdfSheet::State {
  const Document& document;
  int pages, page = 0;
  double y = 0;  // from the page's upper edge
  std::string& out;
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;
  PangoFontMap* fonts = nullptr;
  PangoContext* context = nullptr;
  bool finished = false;
  std::vector<std::string> picture_words = {};

  [[nodiscard]] Layout layout(const PdfText& t, double width) const {
    Layout l(pango_layout_new(context));
    PangoFontDescription* font = pango_font_description_from_string(k_font);
    pango_font_description_set_absolute_size(font, t.size_pt * PANGO_SCALE);
    if (t.bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
    pango_layout_set_font_description(l.get(), font);
    pango_font_description_free(font);
    pango_layout_set_width(l.get(), static_cast<int>(width * PANGO_SCALE));
    pango_layout_set_wrap(l.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_alignment(l.get(), t.right ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_LEFT);
    if (t.most_pt > 0) {
      pango_layout_set_height(l.get(), static_cast<int>(t.most_pt * PANGO_SCALE));
      pango_layout_set_ellipsize(l.get(), PANGO_ELLIPSIZE_END);
    }
    const std::string text = with_isolates(t.text, one_line, k_isolate, k_isolate_end);
    if (t.lead.empty()) {
      pango_layout_set_text(l.get(), text.c_str(), -1);
    } else {
      const std::string markup =
          fmt::format("<b>{}</b>: {}", xml_text(one_line(t.lead)),
                      with_isolates(text, xml_text, k_isolate, k_isolate_end));
      pango_layout_set_markup(l.get(), markup.c_str(), -1);
    }
    return l;
  }
  static double height_of(const Layout& l) {
    int height = 0;
    pango_layout_get_size(l.get(), nullptr, &height);
    return static_cast<double>(height) / PANGO_SCALE;
  }
  void colour(PdfColour c) const { cairo_set_source_rgb(cairo, c.r, c.g, c.b); }
  void begin_tag(const char* tag) const {
    if (tag != nullptr) cairo_tag_begin(cairo, tag, nullptr);
  }
  void end_tag(const char* tag) const {
    if (tag != nullptr) cairo_tag_end(cairo, tag);
  }
  void put(const Layout& l, double x, double top, const char* tag) const {
    begin_tag(tag);
    cairo_move_to(cairo, x, top);
    pango_cairo_show_layout(cairo, l.get());
    end_tag(tag);
  }
  /// One line, cut short where it does not fit.
  void furniture(const std::string& text, double x, double top, double width, bool right) const {
    PdfText t{text, 6.5, false, {0.35, 0.35, 0.35}};
    t.right = right;
    t.most_pt = 1;  // one line
    colour(t.colour);
    put(layout(t, width), x, top, nullptr);
  }
  void begin_page() {
    ++page;
    y = k_top;
    const double width = k_page_width - 2 * k_side;
    if (page > 1) {
      furniture(document.title, k_side, 24, width, false);
      furniture(document.subtitle, k_side, 33, width, false);
    }
    const double foot = k_page_height - 32;
    cairo_set_line_width(cairo, 0.5);
    colour({0.75, 0.75, 0.75});
    cairo_move_to(cairo, k_side, foot - 4);
    cairo_line_to(cairo, k_page_width - k_side, foot - 4);
    cairo_stroke(cairo);
    if (!document.footer.empty())
      furniture(document.footer.front(), k_side, foot, width - 70, false);
    furniture(pages > 0 ? tr("page {} of {}", page, pages) : tr("page {}", page),
              k_page_width - k_side - 66, foot, 66, true);
  }
  void new_page() {
    cairo_show_page(cairo);
    begin_page();
  }
  [[nodiscard]] double left() const { return k_page_height - k_bottom - y; }
};

PdfSheet::PdfSheet(const Document& document, int pages, std::string& out)
    : s_(new State{.document = document, .pages = pages, .out = out}) {
  State& s = *s_;
  s.surface = cairo_pdf_surface_create_for_stream(append, &s.out, k_page_width, k_page_height);
  cairo_pdf_surface_set_metadata(s.surface, CAIRO_PDF_METADATA_TITLE,
                                 one_line(document.title).c_str());
  cairo_pdf_surface_set_metadata(s.surface, CAIRO_PDF_METADATA_CREATOR,
                                 ("Cavum " + std::string(version())).c_str());
  // the exam's own date, so that the same report gives the same bytes
  cairo_pdf_surface_set_metadata(s.surface, CAIRO_PDF_METADATA_CREATE_DATE,
                                 one_line(document.created).c_str());
  s.cairo = cairo_create(s.surface);
  s.fonts = pango_cairo_font_map_new();
  s.context = pango_font_map_create_context(s.fonts);
  pango_cairo_update_context(s.cairo, s.context);
  s.begin_tag("Document");
  s.begin_page();
}

PdfSheet::~PdfSheet() {
  g_object_unref(s_->context);
  g_object_unref(s_->fonts);
  cairo_destroy(s_->cairo);
  cairo_surface_finish(s_->surface);
  cairo_surface_destroy(s_->surface);
}

double PdfSheet::width_pt() const noexcept { return k_page_width - 2 * k_side; }
double PdfSheet::page_height_pt() const noexcept { return k_page_height - k_top - k_bottom; }

double PdfSheet::left_pt() const noexcept { return s_->left(); }

bool PdfSheet::need(double height_pt) {
  if (height_pt <= s_->left() || s_->y <= k_top) return false;
  s_->new_page();
  return true;
}

void PdfSheet::space(double height_pt) { s_->y += height_pt; }

double PdfSheet::height(const PdfText& text, double width_pt) {
  return State::height_of(s_->layout(text, width_pt));
}

void PdfSheet::lines(const PdfText& text, double width_pt) {
  State& s = *s_;
  const Layout l = s.layout(text, width_pt);
  const double all = State::height_of(l);
  if (all <= page_height_pt()) {
    need(all);
    if (text.fill) fill(0, width_pt, all, *text.fill);
    s.colour(text.colour);
    s.put(l, k_side, s.y, text.tag);
    s.y += all;
    return;
  }
  s.colour(text.colour);
  s.begin_tag(text.tag);
  for (int i = 0; i < pango_layout_get_line_count(l.get());
       ++i) {  // longer than a page: line by line
    PangoLayoutLine* line = pango_layout_get_line_readonly(l.get(), i);
    PangoRectangle box;
    pango_layout_line_get_extents(line, nullptr, &box);
    const double height = static_cast<double>(box.height) / PANGO_SCALE;
    if (need(height)) s.colour(text.colour);
    cairo_move_to(s.cairo, k_side, s.y - static_cast<double>(box.y) / PANGO_SCALE);
    pango_cairo_show_layout_line(s.cairo, line);
    s.y += height;
  }
  s.end_tag(text.tag);
}

double PdfSheet::at(const PdfText& text, double x_pt, double y_pt, double width_pt) {
  const Layout l = s_->layout(text, width_pt);
  s_->colour(text.colour);
  s_->put(l, k_side + x_pt, s_->y + y_pt, text.tag);
  return State::height_of(l);
}

void PdfSheet::rule(PdfColour colour, Rule kind) {
  constexpr double k_dash_pt = 4;
  s_->colour(colour);
  cairo_set_dash(s_->cairo, &k_dash_pt, kind == Rule::dashed ? 1 : 0, 0);
  cairo_set_line_width(s_->cairo, 0.5);
  cairo_move_to(s_->cairo, k_side, s_->y);
  cairo_line_to(s_->cairo, k_side + width_pt(), s_->y);
  cairo_stroke(s_->cairo);
  cairo_set_dash(s_->cairo, nullptr, 0, 0);
}

void PdfSheet::fill(double x_pt, double width_pt, double height_pt, PdfColour colour) {
  s_->colour(colour);
  cairo_rectangle(s_->cairo, k_side + x_pt, s_->y, width_pt, height_pt);
  cairo_fill(s_->cairo);
}

void PdfSheet::frame(double x_pt, double width_pt, double height_pt, PdfColour colour,
                     double line_pt) {
  s_->colour(colour);
  cairo_set_line_width(s_->cairo, line_pt);
  cairo_rectangle(s_->cairo, k_side + x_pt, s_->y, width_pt, height_pt);
  cairo_stroke(s_->cairo);
}

void PdfSheet::draw(const PdfPicture& picture, double x_pt, double y_pt, double width_pt,
                    double height_pt, bool raster, const std::string& words) {
  cairo_t* cairo = s_->cairo;
  s_->picture_words.push_back(one_line(words));
  s_->begin_tag("Figure");
  const double x = k_side + x_pt, y = s_->y + y_pt;
  if (!raster) {
    cairo_save(cairo);
    picture.draw(cairo, x, y, width_pt, height_pt);
    cairo_restore(cairo);
    s_->end_tag("Figure");
    return;
  }
  const int columns = static_cast<int>(std::ceil(width_pt * k_raster_px_per_pt)),
            rows = static_cast<int>(std::ceil(height_pt * k_raster_px_per_pt));
  cairo_surface_t* image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows);
  cairo_t* on_image = cairo_create(image);
  cairo_set_source_rgb(on_image, 1, 1, 1);
  cairo_paint(on_image);
  try {
    picture.draw(on_image, 0, 0, columns, rows);
  } catch (...) {
    cairo_destroy(on_image);
    cairo_surface_destroy(image);
    throw;
  }
  cairo_destroy(on_image);
  cairo_save(cairo);
  cairo_translate(cairo, x, y);
  cairo_scale(cairo, width_pt / columns, height_pt / rows);
  cairo_set_source_surface(cairo, image, 0, 0);
  cairo_rectangle(cairo, 0, 0, columns, rows);
  cairo_fill(cairo);
  cairo_restore(cairo);
  cairo_surface_destroy(image);
  s_->end_tag("Figure");
}

void PdfSheet::begin_tag(const char* tag) { s_->begin_tag(tag); }
void PdfSheet::end_tag(const char* tag) { s_->end_tag(tag); }
const std::vector<std::string>& PdfSheet::picture_words() const noexcept {
  return s_->picture_words;
}

int PdfSheet::finish() {
  if (!s_->finished) {
    s_->end_tag("Document");
    cairo_show_page(s_->cairo);
    cairo_surface_finish(s_->surface);
    s_->finished = true;
  }
  if (const cairo_status_t status = cairo_surface_status(s_->surface);
      status != CAIRO_STATUS_SUCCESS)
    throw Error(msg("report"), msg("the PDF cannot be made: {}", cairo_status_to_string(status)),
                msg("write the report as .html"));
  return s_->page;
}

}  // namespace cavum::report
