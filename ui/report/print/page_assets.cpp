#include "ui/report/print/page_assets.h"

// The assembler copies the files' bytes; CMake rebuilds this source when they change.
asm(R"(
  .section .rodata
  .balign 16
cavum_page_script_begin:
  .incbin ")" CAVUM_PAGE_DIR R"(/page.js"
cavum_page_script_end:
  .balign 16
cavum_page_style_begin:
  .incbin ")" CAVUM_PAGE_DIR R"(/page.css"
cavum_page_style_end:
  .previous
  .globl cavum_page_script_begin, cavum_page_script_end, cavum_page_style_begin, cavum_page_style_end
)");

extern "C" {
extern const char cavum_page_script_begin[], cavum_page_script_end[], cavum_page_style_begin[],
    cavum_page_style_end[];
}

namespace cavum::report {

std::string_view page_script() noexcept {
  return {cavum_page_script_begin,
          static_cast<std::size_t>(cavum_page_script_end - cavum_page_script_begin)};
}

std::string_view page_style() noexcept {
  return {cavum_page_style_begin,
          static_cast<std::size_t>(cavum_page_style_end - cavum_page_style_begin)};
}

}  // namespace cavum::report
