#include "ui/parts/terminal.h"

#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <string>

#include "engine/base/text.h"

namespace cavum::ui {
namespace {

bool write_whole(int fd, std::string_view text) {
  while (!text.empty()) {
    const auto n = ::write(fd, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

/// A stream of C++ that writes to one of C.
class ToFile : public std::streambuf {
 public:
  explicit ToFile(std::FILE* file) : file_(file) {}

 private:
  int overflow(int c) override {
    return traits_type::eq_int_type(c, traits_type::eof()) ? traits_type::not_eof(c)
                                                           : std::fputc(c, file_);
  }
  std::streamsize xsputn(const char* text, std::streamsize n) override {
    return static_cast<std::streamsize>(std::fwrite(text, 1, static_cast<std::size_t>(n), file_));
  }
  int sync() override { return std::fflush(file_); }

  std::FILE* file_;
};

}  // namespace

struct SafeTerminal::Stream {
  Stream(std::FILE*& standard, int fd, std::ostream& stream, int buffering)
      : standard_(standard), before_(standard), fd_(fd), stream_(stream) {
    cookie_io_functions_t functions{};
    functions.write = [](void* self, const char* text, std::size_t n) {
      return static_cast<Stream*>(self)->write({text, n});
    };
    std::fflush(before_);
    filtered_ = ::fopencookie(this, "w", functions);
    if (filtered_ == nullptr) return;  // without memory for it there is nothing to print either
    std::setvbuf(filtered_, nullptr, buffering, BUFSIZ);
    standard_ = filtered_;
    to_file_ = std::make_unique<ToFile>(filtered_);
    buffer_before_ = stream_.rdbuf(to_file_.get());
  }
  ~Stream() {
    if (filtered_ == nullptr) return;
    stream_.flush();
    stream_.rdbuf(buffer_before_);
    standard_ = before_;
    std::fclose(filtered_);
    write_whole(fd_, terminal_text(rest_));
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// What fopencookie asks for: the bytes that were taken, 0 when it failed. No exception may pass
  /// through the C library.
  ssize_t write(std::string_view text) noexcept try {
    rest_ += text;
    const std::size_t whole = whole_characters(rest_);
    const std::string safe = terminal_text(std::string_view(rest_).substr(0, whole));
    rest_.erase(0, whole);
    return write_whole(fd_, safe) ? static_cast<ssize_t>(text.size()) : 0;
  } catch (const std::exception&) {
    return 0;
  }

 private:
  std::FILE*& standard_;
  std::FILE* before_;
  std::FILE* filtered_ = nullptr;
  int fd_;
  std::ostream& stream_;
  std::streambuf* buffer_before_ = nullptr;
  std::unique_ptr<ToFile> to_file_;
  std::string rest_;  // the first bytes of a character that is still to come
};

SafeTerminal::SafeTerminal()
    : out_(std::make_unique<Stream>(stdout, STDOUT_FILENO, std::cout,
                                    ::isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF)),
      err_(std::make_unique<Stream>(stderr, STDERR_FILENO, std::cerr, _IONBF)) {}

SafeTerminal::~SafeTerminal() = default;

void command_terminal(const char* sequence) {
  std::cout.flush();
  std::fflush(stdout);
  write_whole(STDOUT_FILENO, sequence);
}

}  // namespace cavum::ui
