#include "engine/tooth/volume/dicom_bytes.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr std::size_t k_preamble = 128;
constexpr std::uint32_t k_undefined = 0xffffffff;
constexpr std::uint32_t k_item = 0xfffee000, k_item_end = 0xfffee00d, k_sequence_end = 0xfffee0dd,
                        k_picture = 0x7fe00010;
constexpr std::uint32_t k_transfer_syntax = 0x00020010, k_frames = 0x00280008, k_rows = 0x00280010,
                        k_columns = 0x00280011, k_samples = 0x00280002, k_bits = 0x00280100;
constexpr int k_deepest = 16;

struct Field {
  std::uint32_t tag;
  const char* name;
};
constexpr std::array<Field, 9> k_common{{{k_samples, "samples"},
                                         {0x00280004, "photometric interpretation"},
                                         {k_rows, "rows"},
                                         {k_columns, "columns"},
                                         {0x00280030, "pixel spacing"},
                                         {k_bits, "bits allocated"},
                                         {0x00280101, "bits stored"},
                                         {0x00280103, "pixel representation"},
                                         {0x00200037, "orientation"}}};

struct Element {
  std::uint32_t tag = 0, length = 0;
  char vr[2] = {0, 0};  // zero where implicit
  [[nodiscard]] bool is(std::string_view v) const { return v[0] == vr[0] && v[1] == vr[1]; }
};

class Walk {
 public:
  Walk(std::span<const std::uint8_t> file, std::string where)
      : file_(file), where_(std::move(where)) {}

  DicomSlice run() {
    std::string syntax;
    if (says_dicom(file_)) {
      at_ = k_preamble + 4;
      while (at_ + 2 <= file_.size() &&
             (file_[at_] | file_[at_ + 1] << 8) == 2) {  // always explicit, little-endian
        const Element e = element();
        const auto value = take(e.length);
        if (e.tag == k_transfer_syntax) syntax = text_of(value);
      }
    } else {
      explicit_ = file_.size() > 6 && file_[4] >= 'A' && file_[4] <= 'Z' && file_[5] >= 'A' &&
                  file_[5] <= 'Z';
    }
    if (syntax == "1.2.840.10008.1.2") explicit_ = false;
    if (syntax == "1.2.840.10008.1.2.2") big_ = true;
    if (syntax == "1.2.840.10008.1.2.1.99")
      throw Error(FileError::unsupported, Name{where_}, msg("is deflated DICOM"),
                  msg("export it uncompressed: whether it is whole cannot be seen"));
    for (;;) {
      if (at_ >= file_.size()) fail(FileError::truncated, msg("holds no picture"));
      const Element e = element();
      if (e.tag == k_picture) return picture(e);
      if (e.length == k_undefined)
        skip_sequence(e, 0);
      else
        keep(e.tag, take(e.length));
    }
  }

 private:
  [[noreturn]] void fail(FileError code, const Message& what) const {
    throw Error(code, Name{where_}, what, msg("use a complete copy of the slice"));
  }

  std::span<const std::uint8_t> take(std::uint64_t n) {
    if (n > file_.size() - at_)
      fail(FileError::truncated, msg("truncated: an element at byte {} has {} bytes, {} are there",
                                     at_, n, file_.size() - at_));
    const auto value = file_.subspan(at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
    return value;
  }
  std::uint32_t number(std::size_t bytes) {
    const auto v = take(bytes);
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      n |= static_cast<std::uint32_t>(v[big_ ? bytes - 1 - i : i]) << (8 * i);
    return n;
  }

  Element element() {
    Element e;
    e.tag = number(2) << 16;
    e.tag |= number(2);
    if (e.tag == k_item || e.tag == k_item_end || e.tag == k_sequence_end || !explicit_) {
      e.length = number(4);
      return e;
    }
    const auto vr = take(2);
    std::copy(vr.begin(), vr.end(), e.vr);
    static constexpr std::array<std::string_view, 13> k_long{
        "OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"};
    if (std::any_of(k_long.begin(), k_long.end(), [&](std::string_view v) { return e.is(v); })) {
      static_cast<void>(take(2));
      e.length = number(4);
    } else {
      if (e.vr[0] < 'A' || e.vr[0] > 'Z' || e.vr[1] < 'A' || e.vr[1] > 'Z')
        fail(FileError::damaged, msg("damaged: no element begins at byte {}", at_ - 6));
      e.length = number(2);
    }
    return e;
  }

  /// Items up to the mark of their end.
  void skip_sequence(const Element& of, int depth) {
    if (depth > k_deepest)
      fail(FileError::damaged, msg("damaged: sequences are nested deeper than {}", k_deepest));
    const bool was_explicit = explicit_;
    if (of.is("UN")) explicit_ = false;
    for (Element e = element(); e.tag != k_sequence_end; e = element()) {
      if (e.tag != k_item)
        fail(FileError::damaged,
             msg("damaged: a sequence holds something else than items, at byte {}", at_));
      if (e.length != k_undefined) {
        static_cast<void>(take(e.length));
        continue;
      }
      for (Element inner = element(); inner.tag != k_item_end; inner = element()) {
        if (inner.length == k_undefined)
          skip_sequence(inner, depth + 1);
        else
          static_cast<void>(take(inner.length));
      }
    }
    explicit_ = was_explicit;
  }

  void keep(std::uint32_t tag, std::span<const std::uint8_t> value) {
    for (const Field& f : k_common)
      if (f.tag == tag) slice_.common[f.name] = text_of(value);
    if (tag == k_rows) slice_.rows = small(value);
    if (tag == k_columns) slice_.columns = small(value);
    if (tag == k_samples) samples_ = small(value);
    if (tag == k_bits) bits_ = small(value);
    if (tag == k_frames) {
      const std::string text = text_of(value);
      if (!text.empty() &&
          std::from_chars(text.data(), text.data() + text.size(), slice_.frames).ec != std::errc{})
        fail(FileError::damaged, msg("damaged: its number of frames is none"));
    }
  }
  [[nodiscard]] std::uint64_t small(std::span<const std::uint8_t> v) const {
    return v.size() < 2 ? 0 : big_ ? v[0] << 8 | v[1] : v[0] | v[1] << 8;
  }
  /// Without the padding.
  static std::string text_of(std::span<const std::uint8_t> v) {
    std::string text(v.begin(), v.end());
    while (!text.empty() && (text.back() == ' ' || text.back() == 0)) text.pop_back();
    text.erase(0, text.find_first_not_of(' '));
    return text;
  }

  DicomSlice picture(const Element& e) {
    if (slice_.rows == 0 || slice_.columns == 0 || samples_ == 0 || bits_ == 0 || bits_ > 64 ||
        slice_.frames == 0 || slice_.frames > 1U << 20)
      fail(FileError::damaged, msg("damaged: its picture has no size"));
    if (e.length == k_undefined) {
      std::size_t pieces = 0;
      for (Element piece = element(); piece.tag != k_sequence_end; piece = element(), ++pieces) {
        if (piece.tag != k_item || piece.length == k_undefined)
          fail(FileError::damaged, msg("damaged: its compressed picture is no list of pieces"));
        static_cast<void>(take(piece.length));
      }
      if (pieces < 2)
        fail(FileError::truncated,
             msg("holds no picture"));  // the first is the table of where the others begin
      return slice_;
    }
    const std::uint64_t needed =
                            (slice_.rows * slice_.columns * samples_ * slice_.frames * bits_ + 7) /
                            8,
                        there = file_.size() - at_;
    if (there < e.length || e.length < needed)
      fail(FileError::truncated, msg("truncated: its picture needs {} bytes, {} are there",
                                     std::max<std::uint64_t>(needed, e.length),
                                     std::min<std::uint64_t>(there, e.length)));
    return slice_;
  }

  std::span<const std::uint8_t> file_;
  std::string where_;
  std::size_t at_ = 0;
  bool explicit_ = true, big_ = false;
  std::uint64_t samples_ = 1, bits_ = 0;
  DicomSlice slice_;
};

}  // namespace

bool says_dicom(std::span<const std::uint8_t> file) noexcept {
  return file.size() >= k_preamble + 4 && std::memcmp(file.data() + k_preamble, "DICM", 4) == 0;
}

DicomSlice check_dicom_bytes(std::span<const std::uint8_t> file, const std::string& where) {
  return Walk(file, where).run();
}

}  // namespace cavum
