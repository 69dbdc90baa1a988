// The office's pages, bundled by the build and held in the program itself (page/).
#pragma once

#include <string_view>

namespace cavum::office {

[[nodiscard]] std::string_view page_html() noexcept;
[[nodiscard]] std::string_view page_script() noexcept;
[[nodiscard]] std::string_view page_style() noexcept;

}  // namespace cavum::office
