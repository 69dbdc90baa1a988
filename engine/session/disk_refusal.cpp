#include "engine/session/disk_refusal.h"

#include "engine/base/system_error.h"

namespace cavum {
namespace {

Message in_words(DiskFault fault) {
  switch (fault) {
    case DiskFault::full:
      return msg("the disk is full");
    case DiskFault::input_output:
      return msg("the disk refuses");
    case DiskFault::held:
      return msg("another program holds the file");
    case DiskFault::not_opened:
      return msg("the file cannot be opened");
    case DiskFault::read_only:
      return msg("the file may only be read");
    case DiskFault::damaged:
      return msg("the file is damaged");
    case DiskFault::other:
      break;
  }
  return msg("the file cannot be written");
}

}  // namespace

Message in_words(const DiskRefusal& refusal) {
  return refusal.error == 0 ? in_words(refusal.fault)
                            : msg("{} ({})", in_words(refusal.fault), system_words(refusal.error));
}

}  // namespace cavum
