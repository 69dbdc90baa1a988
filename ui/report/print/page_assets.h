// What makes a report's HTML file move: the script and the style sheet that the build bundles from
// `page/`, held in the program itself, so that a report is one file and needs no network.
#pragma once

#include <string_view>

namespace cavum::report {

/// One minified script, UTF-8, to stand in a `<script>` element as it is: it contains no
/// `</script`. Licences of what is bundled are in it.
[[nodiscard]] std::string_view page_script() noexcept;

/// The style sheet for screen and print, UTF-8, to stand in a `<style>` element as it is.
[[nodiscard]] std::string_view page_style() noexcept;

}  // namespace cavum::report
