// Several lines for a person: sentences, and rows whose cells stand below each other. Like a
// message, without a language until a face renders them.
#pragma once

#include <string>
#include <vector>

#include "engine/base/message.h"

namespace cavum {

class Lines {
 public:
  struct Line {
    int indent = 0;              ///< spaces before it
    std::vector<Message> cells;  ///< one: a sentence; more: a row; none: an empty line
  };
  void add(Message sentence, int indent = 0) { all_.push_back({indent, {std::move(sentence)}}); }
  /// Rows one after another with the same indent and number of cells make a table: each column as
  /// wide as its widest cell, figures to the right.
  void row(std::vector<Message> cells, int indent = 0) {
    all_.push_back({indent, std::move(cells)});
  }
  void gap() { all_.emplace_back(); }
  void append(const Lines& more, int indent = 0) {
    for (Line l : more.all_) {
      l.indent += indent;
      all_.push_back(std::move(l));
    }
  }
  [[nodiscard]] bool empty() const noexcept { return all_.empty(); }
  [[nodiscard]] const std::vector<Line>& all() const noexcept { return all_; }

 private:
  std::vector<Line> all_;
};

/// Each line with its end. What is rendered of a cell stands on one line, whatever a file wrote
/// there.
[[nodiscard]] std::string render(const Lines& lines, const Locale& locale);
[[nodiscard]] std::string english_text(const Lines& lines);

}  // namespace cavum
