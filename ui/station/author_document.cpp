#include "ui/station/author_document.h"

#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"

namespace cavum::station {

AuthorDocument::AuthorDocument(const std::string& path) : path_(path), text_(read_text_file(path)), on_disk_(text_) {}

void AuthorDocument::set(const std::string& text) {
  text_ = text;
  ++version_;
}

void AuthorDocument::make(const scenarios::TextChange& change, const std::string& name) {
  if (change.empty()) return;
  const std::string changed = scenarios::with_change(text_, change);
  constexpr std::size_t k_most = 1000;
  if (name != pulled_ || before_.empty()) before_.push_back(text_);
  if (before_.size() > k_most) before_.erase(before_.begin());
  pulled_ = name;
  after_.clear();
  set(changed);
}

bool AuthorDocument::undo() {
  rest();
  if (before_.empty()) return false;
  after_.push_back(text_);
  set(before_.back());
  before_.pop_back();
  return true;
}

bool AuthorDocument::redo() {
  rest();
  if (after_.empty()) return false;
  before_.push_back(text_);
  set(after_.back());
  after_.pop_back();
  return true;
}

void AuthorDocument::save() {
  rest();
  if (read_text_file(path_) != on_disk_)
    throw Error(path_, "was changed by somebody else meanwhile and is not overwritten",
                "press F5 to read it again; Ctrl+Z then brings your text back, and Ctrl+S saves it over theirs");
  write_text_file(path_, text_);
  on_disk_ = text_;
}

void AuthorDocument::read_again() {
  rest();
  on_disk_ = read_text_file(path_);
  if (text_ == on_disk_) return;
  before_.push_back(text_);
  after_.clear();
  set(on_disk_);
}

std::string AuthorDocument::keep_aside() const {
  std::string aside = path_ + ".unsaved";
  write_text_file(aside, text_);
  return aside;
}

}  // namespace cavum::station
