#include "ui/parts/say.h"

#include <cstdio>
#include <iostream>

#include "engine/base/text.h"
#include "ui/language/say.h"

namespace cavum::ui {

void say(const Message& message, int indent) {
  std::cout << std::string(static_cast<std::size_t>(indent), ' ') << one_line(tr(message)) << "\n";
}

void say(const Lines& lines) { std::cout << tr(lines); }

void say_error(const Message& message) {
  std::fprintf(stderr, "cavum: %s\n", one_line(tr(message)).c_str());
}

}  // namespace cavum::ui
