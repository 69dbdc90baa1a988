#include "ui/station/keyboard_watch.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace cavum::station {
namespace {

/// A bit of a mask as Linux prints it: words of 64 bits in hex, the highest first.
bool has_bit(const std::string& mask, std::size_t bit) {
  std::istringstream words(mask);
  std::vector<std::string> all;
  for (std::string w; words >> w;) all.push_back(w);
  constexpr std::size_t k_word_bits = 64;
  if (bit / k_word_bits >= all.size()) return false;
  const std::string& word = all[all.size() - 1 - bit / k_word_bits];
  if (word.empty() || word.size() > 16 ||
      word.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
    return false;
  return (std::stoull(word, nullptr, 16) >> (bit % k_word_bits) & 1U) != 0;
}

/// Of the kernel's input-event-codes.h: Q, A, Z and the space bar, which every keyboard to write
/// with has.
bool has_letters(const std::string& mask) {
  for (const std::size_t key : {16U, 30U, 44U, 57U})
    if (!has_bit(mask, key)) return false;
  return true;
}

std::string after(const std::string& line, const std::string& head) {
  return line.starts_with(head) ? line.substr(head.size()) : "";
}

}  // namespace

std::set<std::string> keyboards_in(const std::string& devices) {
  std::set<std::string> found;
  std::istringstream lines(devices);
  std::string name, place, keys;
  const auto take = [&] {
    if (has_letters(keys)) found.insert(name + " at " + (place.empty() ? "no place" : place));
    name = place = keys = "";
  };
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) take();
    if (const std::string n = after(line, "N: Name="); !n.empty()) {
      name = n;
      name.erase(std::remove(name.begin(), name.end(), '"'), name.end());
    }
    if (const std::string p = after(line, "P: Phys="); !p.empty()) place = p;
    if (const std::string k = after(line, "B: KEY="); !k.empty()) keys = k;
  }
  take();
  return found;
}

KeyboardWatch::KeyboardWatch(std::string path) : path_(std::move(path)), known_(now()) {}

std::set<std::string> KeyboardWatch::now() const {
  std::ifstream file(path_);
  std::ostringstream text;
  text << file.rdbuf();
  return keyboards_in(text.str());
}

std::vector<std::string> KeyboardWatch::added() {
  std::set<std::string> is = now();
  std::vector<std::string> more;
  std::set_difference(is.begin(), is.end(), known_.begin(), known_.end(), std::back_inserter(more));
  known_ = std::move(is);
  return more;
}

}  // namespace cavum::station
