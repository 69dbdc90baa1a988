// Prints a report's document as PDF on A4: head and page numbers on every page, tables that repeat
// their heads, fonts embedded, pictures from the same SVG as the HTML's.
#pragma once

#include <string>

#include "ui/report/print/document.h"

namespace cavum::report {

/// The bytes of the file; the same document gives the same bytes on the same computer. Throws Error
/// when a picture cannot be drawn.
[[nodiscard]] std::string pdf_of(const Document& document);

}  // namespace cavum::report
