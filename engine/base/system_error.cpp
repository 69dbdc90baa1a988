#include "engine/base/system_error.h"

#include <algorithm>
#include <cerrno>
#include <iterator>

#include "engine/base/file_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

struct Row {
  int number;
  ErrorCode code;
  const char* english;
};
constexpr Row k_rows[] = {
    {ENOENT, FileError::missing, noop("there is no such file or folder")},
    {EACCES, SystemError::no_permission, noop("permission is missing")},
    {EPERM, SystemError::no_permission, noop("permission is missing")},
    {ENOSPC, SystemError::no_space, noop("there is no space left")},
    {EDQUOT, SystemError::no_space, noop("there is no space left")},
    {EROFS, SystemError::read_only, noop("the disk may only be read")},
    {EMFILE, SystemError::too_many_open, noop("too many files are open")},
    {ENFILE, SystemError::too_many_open, noop("too many files are open")},
    {EIO, SystemError::input_output, noop("the disk does not read or write")},
    {EEXIST, FileError::exists, noop("it is there already")},
    {ENOTDIR, SystemError::not_a_folder, noop("a part of the path is no folder")},
    {EISDIR, FileError::not_a_file, noop("it is a folder")},
    {ENAMETOOLONG, SystemError::name_too_long, noop("the name is too long")},
    {ENOMEM, SystemError::no_memory, noop("there is not enough memory")}};

const Row* row_of(int number) noexcept {
  const auto* row = std::find_if(std::begin(k_rows), std::end(k_rows),
                                 [number](const Row& r) { return r.number == number; });
  return row == std::end(k_rows) ? nullptr : row;
}

}  // namespace

ErrorCode system_code(int number) noexcept {
  const Row* row = row_of(number);
  return row == nullptr ? SystemError::system_error : row->code;
}

Message system_words(int number) {
  const Row* row = row_of(number);
  return row == nullptr ? msg("system error {}", number) : Message(row->english, nullptr, 0, {});
}

}  // namespace cavum
