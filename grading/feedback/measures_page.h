// The table of measures as a page for people, made of the records themselves.
#pragma once

#include <string>

namespace cavum::grading {

/// Markdown: one row for each measure of scenarios/file/measures.h, one for all tissues;
/// docs/measures.md.
[[nodiscard]] std::string measures_page();

}  // namespace cavum::grading
