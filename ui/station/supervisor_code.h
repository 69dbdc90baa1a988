// The code that lets a supervisor leave a locked station. Only its salted hash is kept (Argon2id,
// as libsodium writes it), in a file.
#pragma once

#include <string>

namespace cavum::station {

constexpr std::size_t k_shortest_supervisor_code = 6, k_longest_supervisor_code = 47;

/// Where it lies unless another file is named: supervisor.code of the station's own folder
/// ($CAVUM_HOME, else ~/.config/cavum).
[[nodiscard]] std::string supervisor_code_path();
/// Writes the hash of `code`, mode 0600. Throws Error when it is too short or too long, or cannot
/// be written.
void set_supervisor_code(const std::string& code, const std::string& path);
/// The hash in a file. Throws Error when there is none.
[[nodiscard]] std::string read_supervisor_code(const std::string& path);
/// Takes a tenth of a second or more, as it shall.
[[nodiscard]] bool is_supervisor_code(const std::string& hash, const std::string& code);

}  // namespace cavum::station
