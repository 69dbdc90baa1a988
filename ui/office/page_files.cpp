#include "ui/office/page_files.h"

// The assembler copies the files' bytes; CMake rebuilds this source when they change.
asm(R"(
  .section .rodata
  .balign 16
cavum_office_html_begin:
  .incbin ")" CAVUM_OFFICE_PAGE R"(/office.html"
cavum_office_html_end:
  .balign 16
cavum_office_script_begin:
  .incbin ")" CAVUM_OFFICE_PAGE R"(/office.js"
cavum_office_script_end:
  .balign 16
cavum_office_style_begin:
  .incbin ")" CAVUM_OFFICE_PAGE R"(/office.css"
cavum_office_style_end:
  .previous
  .globl cavum_office_html_begin, cavum_office_html_end, cavum_office_script_begin, cavum_office_script_end
  .globl cavum_office_style_begin, cavum_office_style_end
)");

extern "C" {
extern const char cavum_office_html_begin[], cavum_office_html_end[], cavum_office_script_begin[],
    cavum_office_script_end[], cavum_office_style_begin[], cavum_office_style_end[];
}

namespace cavum::office {
namespace {

std::string_view between(const char* begin, const char* end) noexcept {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view page_html() noexcept {
  return between(cavum_office_html_begin, cavum_office_html_end);
}
std::string_view page_script() noexcept {
  return between(cavum_office_script_begin, cavum_office_script_end);
}
std::string_view page_style() noexcept {
  return between(cavum_office_style_begin, cavum_office_style_end);
}

}  // namespace cavum::office
