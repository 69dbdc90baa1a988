// A volume, or why there is none, from the process that reads it to the one that uses it: 8 bytes
// "CVVOLUME", then
//   u32 0, three times u32 length and that many bytes (at most 4096) of a message as JSON
//   (engine/base/message_json.h): where, problem and advice of an Error; or u32 1, i32 x 3 size,
//   f64 x 3 spacing, f64 x 9 axes, f64 x 3 origin, f32 for each voxel, x fastest.
// Little-endian. The receiver trusts nothing of it: the sender is a process that damaged files may
// have led astray.
#pragma once

#include <span>
#include <string>

#include "engine/base/error.h"
#include "engine/tooth/volume/volume.h"

namespace cavum {

/// The descriptor that the reading process writes to.
inline constexpr int k_volume_descriptor = 3;

/// The sender is gone, and the volume is not whole.
class VolumeCutOff : public Error {
 public:
  using Error::Error;
};

/// False when nobody takes it.
bool send_volume_error(int fd, const Error& error);
/// `head.gray` is not looked at.
bool send_volume(int fd, const Volume& head, std::span<const float> gray);
/// Waits for at most `seconds`. Throws the Error that was sent, VolumeCutOff, and another Error
/// naming `path` when what comes is neither, has more than `most` voxels, or does not come in time.
[[nodiscard]] Volume receive_volume(int fd, const std::string& path, std::uint64_t most,
                                    int seconds);

}  // namespace cavum
