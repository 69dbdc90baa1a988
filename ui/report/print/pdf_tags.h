// What cairo does not write into a tagged PDF: the document's language and title, words for its
// pictures, what the heads of tables head, and that head, foot, rules and grounds of the pages are
// no content.
#pragma once

#include <string>
#include <vector>

#include "ui/report/print/document.h"

namespace cavum::report {

/// `pdf` with that in it. `pictures`: words for each Figure, in their order. The same input gives
/// the same bytes. Throws Error when `pdf` cannot be read.
[[nodiscard]] std::string complete_tags(const std::string& pdf, const Document& document,
                                        const std::vector<std::string>& pictures);

}  // namespace cavum::report
