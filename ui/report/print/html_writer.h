// Prints a report's document as one HTML file that needs nothing else: words and tables read
// without script; the script only moves what is there. A content security policy forbids it every
// use of the network.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ui/report/print/document.h"

namespace cavum::report {

/// `data`: what the page moves (report_data.h). `colours` and layout are those of page_style().
[[nodiscard]] std::string html_of(const Document& document, const nlohmann::json& data);

}  // namespace cavum::report
