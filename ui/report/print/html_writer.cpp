#include "ui/report/print/html_writer.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "ui/language/say.h"
#include "ui/report/print/page_assets.h"

namespace cavum::report {
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

/// Text of an element: what as_is() isolated stands in <bdi>, so that a name that is written from
/// right to left leaves its line in order.
std::string text_html(const std::string& text) {
  return with_isolates(text, xml_text, "<bdi>", "</bdi>");
}

class Writer {
 public:
  explicit Writer(std::string& out) : h_(out) {}

  void operator()(const Heading& b) {
    const std::string tag = b.level > 2 ? "h3" : "h2";
    h_ += fmt::format("<{}>{}</{}>\n", tag, text_html(b.text), tag);
  }
  void operator()(const Paragraph& b) {
    const char* kind = b.kind == Paragraph::Kind::small  ? " class='small'"
                       : b.kind == Paragraph::Kind::note ? " class='note'"
                                                         : "";
    h_ += fmt::format("<p{}{}>{}{}</p>\n", kind, data_kind(b.id),
                      b.lead.empty() ? "" : fmt::format("<b>{}</b>: ", text_html(b.lead)),
                      text_html(b.text));
  }
  void operator()(const Bullets& b) {
    h_ += b.small ? "<ul class='small'>\n" : "<ul>\n";
    for (const auto& i : b.items) h_ += fmt::format("<li>{}</li>\n", text_html(i));
    h_ += "</ul>\n";
  }
  void operator()(const ReportTable& b) {
    h_ += fmt::format("<table aria-label='{}'{}><thead><tr>", xml_text(b.name), data_kind(b.id));
    for (const auto& c : b.columns)  // a heading of nothing is no heading
      h_ += c.title.empty() ? "<td></td>"
                            : fmt::format("<th scope='col'{}>{}</th>", c.number ? " class='n'" : "",
                                          text_html(c.title));
    h_ += "</tr></thead><tbody>\n";
    for (const auto& row : b.rows) {
      h_ += fmt::format("<tr{}{}>", row.lost ? " class='lost'" : "", data_kind(row.id));
      for (std::size_t i = 0; i < row.cells.size(); ++i) cell(row.cells[i], b.columns[i].number);
      h_ += "</tr>\n";
    }
    h_ += "</tbody></table>\n";
  }
  void operator()(const VerdictBox& b) {
    h_ += fmt::format("<div class='verdict {}'><div><b>{}</b><br>{}",
                      grading::verdict_name(b.verdict), text_html(b.verdict_words),
                      text_html(b.score));
    for (const auto& line : b.lines) h_ += fmt::format("<br><small>{}</small>", text_html(line));
    h_ += "</div><ul>";
    for (const auto& reason : b.reasons) h_ += fmt::format("<li>{}</li>", text_html(reason));
    h_ += "</ul></div>\n";
  }
  void operator()(const Pictures& b) {
    h_ += b.sections       ? "<div class='sections'>\n"
          : b.columns == 2 ? "<div class='pictures pair'>\n"
                           : "<div class='pictures'>\n";
    for (const auto& p : b.list)
      h_ += p.title.empty() ? p.svg
                            : fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", p.svg,
                                          text_html(p.title));
    h_ += "</div>\n";
  }
  void operator()(const LiveFigure& b) {
    h_ += fmt::format("<section id='{}' aria-label='{}'><p class='fallback'>{}</p></section>\n",
                      b.id, xml_text(b.title), text_html(b.fallback));
  }

  void operator()(const LessonList& b) {
    h_ += "<ol class='lessons'>\n";
    for (const auto& i : b.items) {
      h_ += fmt::format("<li><div><div><p><b>{}</b> {}</p><p class='small'>{}", text_html(i.what),
                        text_html(i.instead), text_html(i.weight));
      if (i.jump) {
        h_ += " · ";
        button(*i.jump, tr("show it"));
      }
      h_ += "</p></div>";
      if (i.picture) h_ += fmt::format("<figure>{}</figure>", i.picture->svg);
      h_ += "</div></li>\n";
    }
    h_ += "</ol>\n";
  }
  void operator()(const Fold& b) {
    h_ += fmt::format("<details><summary>{}</summary>\n", text_html(b.title));
  }
  void operator()(const FoldEnd&) { h_ += "</details>\n"; }
  void operator()(const CutLine&) { h_ += "<hr>\n"; }

 private:
  static std::string data_kind(const std::string& id) {
    return id.empty() ? "" : fmt::format(" data-kind='{}'", xml_text(id));
  }
  void button(const Jump& to, const std::string& text) {
    h_ += fmt::format("<button class='jump' type='button' data-t='{}'", exact(to.t_s));
    if (const auto& p = to.site_mm)
      h_ += fmt::format(" data-x='{}' data-y='{}' data-z='{}'", exact(p->x), exact(p->y),
                        exact(p->z));
    h_ += fmt::format(">{}</button>", text_html(text));
  }
  void cell(const TableCell& c, bool number) {
    h_ += number ? "<td class='n'>" : "<td>";
    if (c.jump) {
      button(*c.jump, c.text);
    } else {
      h_ += text_html(c.text);
    }
    h_ += "</td>";
  }
  std::string& h_;
};

}  // namespace

std::string html_of(const Document& d, const nlohmann::json& data) {
  std::string h = fmt::format(
      "<!doctype html>\n<html lang='{}'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width,initial-scale=1'>\n"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: "
      "blob:\">\n<title>{}</title>\n<style>{}</style></head><body>\n<header><h1>{}</h1>\n<p class='facts'>{}</p></header>\n<main>\n",
      d.language, xml_text(d.title), page_style(), text_html(d.title), text_html(d.subtitle));
  Writer write(h);
  for (const auto& block : d.blocks) std::visit(write, block);
  h += "</main>\n<footer>";
  for (const auto& line : d.footer) h += fmt::format("<p class='small'>{}</p>", text_html(line));
  h += "</footer>\n<script type=\"application/json\" id=\"cavum-data\">";
  h += script_text(data);
  h += "</script>\n<script>";
  h += page_script();
  h += "</script>\n</body></html>\n";
  return h;
}

}  // namespace cavum::report
