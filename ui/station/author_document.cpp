#include "ui/station/author_document.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/shipped.h"
#include "scenarios/file/parse.h"

namespace cavum::station {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent;
}

bool same_folder(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::equivalent(a, b, none);
}

}  // namespace

AuthorDocument::AuthorDocument(const std::string& path)
    : path_(path), now_{read_text_file(path), {}}, on_disk_(now_) {
  read_landmarks();
}

void AuthorDocument::read_landmarks() {
  const bool knew = !tooth_path_.empty();
  tooth_path_.clear();
  try {
    ToothFile file = tooth_of(now_.text);
    now_.landmarks = std::move(file.tooth.placed_landmarks);
    tooth_path_ = std::move(file.path);
    tooth_sum_ = file.sum;
  } catch (const Error&) {
    now_.landmarks.clear();  // the check says why
  }
  on_disk_.landmarks = now_.landmarks;
  if (knew) return;
  for (auto* list : {&before_, &after_})  // they come from a time when nobody knew the tooth
    for (Draft& d : *list) d.landmarks = now_.landmarks;
}

void AuthorDocument::set(const Draft& draft) {
  now_ = draft;
  ++version_;
}

void AuthorDocument::change_to(const Draft& draft, const std::string& name) {
  constexpr std::size_t k_most = 1000;
  if (name != pulled_ || before_.empty()) before_.push_back(now_);
  if (before_.size() > k_most) before_.erase(before_.begin());
  pulled_ = name;
  after_.clear();
  set(draft);
}

void AuthorDocument::make(const scenarios::TextChange& change, const std::string& name) {
  if (!change.empty()) change_to({scenarios::with_change(now_.text, change), now_.landmarks}, name);
}

void AuthorDocument::put(const std::vector<NamedPoint>& landmarks, const std::string& name) {
  if (tooth_path_.empty())
    throw Error(Name{path_}, msg("names a tooth that could not be read"),
                msg("mend the text or put the tooth there, then press F5"));
  if (landmarks != now_.landmarks) change_to({now_.text, landmarks}, name);
}

bool AuthorDocument::undo() {
  rest();
  if (before_.empty()) return false;
  after_.push_back(now_);
  set(before_.back());
  before_.pop_back();
  return true;
}

bool AuthorDocument::redo() {
  rest();
  if (after_.empty()) return false;
  before_.push_back(now_);
  set(after_.back());
  after_.pop_back();
  return true;
}

AuthorDocument::ToothFile AuthorDocument::tooth_of(const std::string& text) const {
  const scenarios::Scenario s = scenarios::read_scenario(text, path_).scenario;
  if (s.tooth_file.empty())
    throw Error(Name{path_}, msg("names no tooth"), msg("write tooth = \"...\" in a text editor"));
  ToothFile file{scenarios::find_tooth_file(s), {}, {}};
  const Bytes bytes = read_file(file.path);
  file.sum = sha256(bytes);
  file.tooth = load_tooth(bytes, file.path);
  return file;
}

std::optional<AuthorDocument::ToothFile> AuthorDocument::tooth_to_write() const {
  if (tooth_path_.empty()) return std::nullopt;
  const auto named = [this](const std::string& text) {
    return scenarios::read_scenario(text, path_).scenario.tooth_file;
  };
  if (now_.landmarks == on_disk_.landmarks &&
      (now_.text == on_disk_.text || named(now_.text) == named(on_disk_.text)))
    return std::nullopt;
  ToothFile file = tooth_of(now_.text);
  if (file.tooth.placed_landmarks == now_.landmarks) return std::nullopt;
  return file;
}

bool AuthorDocument::may_be_overwritten(const ToothFile& file) const {
  std::error_code none;
  const fs::path folder = folder_of(path_);
  if (fs::is_symlink(file.path, none) || !same_folder(folder_of(file.path), folder)) return false;
  const auto shipped = shipped_folders(path_);
  // another tooth than the one that was read: the text's name of it was taken back
  return file.path == tooth_path_ &&
         std::none_of(shipped.begin(), shipped.end(),
                      [&](const fs::path& f) { return same_folder(f / "teeth", folder); });
}

std::optional<std::string> AuthorDocument::new_tooth_name() const {
  const auto file = tooth_to_write();
  if (!file || may_be_overwritten(*file)) return std::nullopt;
  const std::string stem =
      fs::path(file->path).stem().string() + "_" + fs::path(path_).stem().string();
  std::string name = stem + ".cvt";
  std::error_code none;
  for (int i = 2; fs::exists(folder_of(path_) / name, none); ++i)
    name = fmt::format("{}_{}.cvt", stem, i);
  return name;
}

void AuthorDocument::save(const std::string& tooth_name) {
  rest();
  if (read_text_file(path_) != on_disk_.text)
    throw Error(
        Name{path_}, msg("was changed by somebody else meanwhile and is not overwritten"),
        msg("press F5 to read it again; Ctrl+Z then brings your text back, and Ctrl+S saves it over theirs"));
  Draft saved = now_;
  if (auto file = tooth_to_write()) {
    const bool anew = may_be_overwritten(*file);
    std::string to = file->path;
    if (!anew) {
      if (tooth_name.empty() || fs::path(tooth_name).filename() != tooth_name ||
          !tooth_name.ends_with(".cvt"))
        throw Error(Name{file->path},
                    msg("stays as it is, and the landmarks need a tooth of their own"),
                    msg("give it a name without folders that ends in .cvt"));
      to = (folder_of(path_) / tooth_name).string();
      saved.text = scenarios::with_change(
          now_.text, scenarios::set_text(now_.text, path_, "tooth", tooth_name));
    } else if (file->sum != tooth_sum_) {
      throw Error(Name{to}, msg("was changed by somebody else meanwhile and is not overwritten"),
                  msg("press F5 to read it again; Ctrl+Z then brings your points back"));
    }
    file->tooth.placed_landmarks = now_.landmarks;
    const Bytes bytes = save_tooth(file->tooth);
    if (anew && std::find(kept_.begin(), kept_.end(), to) == kept_.end()) {
      write_file(to + ".before", read_file(to));
      kept_.push_back(to);
    }
    write_file(to, bytes, {.may_replace = anew});
    if (!anew) kept_.push_back(to);  // its first state is that of the tooth it was made from
    tooth_path_ = fs::path(to).lexically_normal().string();
    tooth_sum_ = sha256(bytes);
  }
  if (saved != now_) change_to(saved, "");
  write_text_file(path_, now_.text);
  on_disk_ = now_;
}

void AuthorDocument::read_again() {
  rest();
  std::string text = read_text_file(path_);
  before_.push_back(std::exchange(now_, {std::move(text), {}}));
  on_disk_ = now_;
  read_landmarks();
  ++reading_;
  ++version_;
  if (before_.back() == now_)
    before_.pop_back();
  else
    after_.clear();
}

std::vector<std::string> AuthorDocument::keep_aside() const {
  std::string aside = path_ + ".unsaved";
  write_text_file(aside, now_.text);
  if (now_.landmarks == on_disk_.landmarks) return {aside};
  Tooth tooth = tooth_of(now_.text).tooth;
  tooth.placed_landmarks = now_.landmarks;
  save_tooth_file(tooth, aside + ".cvt");
  return {aside, aside + ".cvt"};
}

}  // namespace cavum::station
