#include "ui/report/print/html_writer.h"

#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "ui/report/print/page_assets.h"

namespace cavum {
namespace {

std::string exact(double v) { return fixed(v, 4); }

/// A JSON object as the content of a `<script>` element: nothing in it can end the element.
std::string script_text(const nlohmann::json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

class Writer {
 public:
  explicit Writer(std::string& out) : h_(out) {}

  void operator()(const Heading& b) {
    const std::string tag = b.level > 2 ? "h3" : "h2";
    h_ += "<" + tag + ">" + xml_text(b.text) + "</" + tag + ">\n";
  }
  void operator()(const Paragraph& b) {
    const char* kind = b.kind == Paragraph::Kind::small ? " class='small'" : b.kind == Paragraph::Kind::note ? " class='note'" : "";
    h_ += "<p" + std::string(kind) + ">" + (b.lead.empty() ? "" : "<b>" + xml_text(b.lead) + "</b>: ") + xml_text(b.text) + "</p>\n";
  }
  void operator()(const Bullets& b) {
    h_ += b.small ? "<ul class='small'>\n" : "<ul>\n";
    for (const auto& i : b.items) h_ += "<li>" + xml_text(i) + "</li>\n";
    h_ += "</ul>\n";
  }
  void operator()(const ReportTable& b) {
    h_ += "<table aria-label='" + xml_text(b.name) + "'><thead><tr>";
    for (const auto& c : b.columns)  // a heading of nothing is no heading
      h_ += c.title.empty() ? "<td></td>" : "<th scope='col'" + std::string(c.number ? " class='n'" : "") + ">" + xml_text(c.title) + "</th>";
    h_ += "</tr></thead><tbody>\n";
    for (const auto& row : b.rows) {
      h_ += row.lost ? "<tr class='lost'>" : "<tr>";
      for (std::size_t i = 0; i < row.cells.size(); ++i) cell(row.cells[i], b.columns[i].number);
      h_ += "</tr>\n";
    }
    h_ += "</tbody></table>\n";
  }
  void operator()(const VerdictBox& b) {
    h_ += "<div class='verdict " + xml_text(b.verdict) + "'><div><b>" + xml_text(b.verdict) + "</b><br>" + xml_text(b.score);
    for (const auto& line : b.lines) h_ += "<br><small>" + xml_text(line) + "</small>";
    h_ += "</div><ul>";
    for (const auto& reason : b.reasons) h_ += "<li>" + xml_text(reason) + "</li>";
    h_ += "</ul></div>\n";
  }
  void operator()(const Pictures& b) {
    h_ += b.sections ? "<div class='sections'>\n" : "<div class='pictures'>\n";
    for (const auto& p : b.list) h_ += p.title.empty() ? p.svg : "<figure>" + p.svg + "<figcaption>" + xml_text(p.title) + "</figcaption></figure>\n";
    h_ += "</div>\n";
  }
  void operator()(const LiveFigure& b) {
    h_ += "<section id='" + b.id + "' aria-label='" + xml_text(b.title) + "'><p class='fallback'>" + xml_text(b.fallback) + "</p></section>\n";
  }

 private:
  void cell(const TableCell& c, bool number) {
    h_ += number ? "<td class='n'>" : "<td>";
    if (c.jump) {
      h_ += "<button class='jump' type='button' data-t='" + exact(c.jump->t_s) + "'";
      if (const auto& p = c.jump->site_mm) h_ += " data-x='" + exact(p->x) + "' data-y='" + exact(p->y) + "' data-z='" + exact(p->z) + "'";
      h_ += ">" + xml_text(c.text) + "</button>";
    } else {
      h_ += xml_text(c.text);
    }
    h_ += "</td>";
  }
  std::string& h_;
};

}  // namespace

std::string html_of(const Document& d, const nlohmann::json& data) {
  std::string h = "<!doctype html>\n<html lang='" + d.language +
                  "'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width,initial-scale=1'>\n"
                  "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
                  "img-src data: blob:\">\n<title>" +
                  xml_text(d.title) + "</title>\n<style>" + std::string(page_style()) + "</style></head><body>\n<header><h1>" + xml_text(d.title) +
                  "</h1>\n<p class='facts'>" + xml_text(d.subtitle) + "</p></header>\n<main>\n";
  Writer write(h);
  for (const auto& block : d.blocks) std::visit(write, block);
  h += "</main>\n<footer>";
  for (const auto& line : d.footer) h += "<p class='small'>" + xml_text(line) + "</p>";
  h += "</footer>\n<script type=\"application/json\" id=\"cavum-data\">";
  h += script_text(data);
  h += "</script>\n<script>";
  h += page_script();
  h += "</script>\n</body></html>\n";
  return h;
}

}  // namespace cavum
