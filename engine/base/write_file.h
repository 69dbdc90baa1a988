// Whole files out. Every file is made under a name that nobody can guess, in its own folder and
// only if nothing has that name; it is synced, renamed, and the folder is synced. So a full disk or
// a killed process never leaves half a file under the name, no link that somebody planted is
// followed, and programs that write one file at the same time each write all of it: the last one
// stands.
#pragma once

#include <span>
#include <string>

#include "engine/base/bytes.h"

namespace cavum {

/// Throws Error when no file can be put at `path`: it is a folder, a device, a pipe or a socket, or
/// its own folder is missing or closed to us. For asking before long work; the disk may still be
/// full afterwards.
void require_writable(const std::string& path);

/// How a file is written.
struct Writing {
  bool is_private = false;  ///< mode 0600; else what the user's umask leaves of 0666
  bool may_replace = true;  ///< false: Error when there is something at the path already, a link
                            ///< that leads nowhere, too
};

/// Puts `bytes` at `path` as one step. A link at `path` is replaced by the file; what it led to
/// stays as it is. Throws Error when it cannot be written, or is a device, a pipe or a socket, or a
/// link to one; the old file then still stands, unless it says that the folder could not be synced.
void write_file(const std::string& path, std::span<const std::uint8_t> bytes,
                const Writing& how = {});
void write_text_file(const std::string& path, const std::string& text, const Writing& how = {});
/// The same for what concerns one person or the school alone: keys, sessions, receipts, marks.
void write_private_file(const std::string& path, std::span<const std::uint8_t> bytes);
void write_private_text_file(const std::string& path, const std::string& text);

/// An empty file of mode 0600, for a library that writes it itself. Throws Error when there is
/// something at `path` already, even a link.
void make_private_file(const std::string& path);
/// Makes a folder and those above it that are missing, each of mode 0700; one that is there stays
/// as it is. Throws Error when it cannot be made.
void make_private_folder(const std::string& path);

/// Renames a finished file of the same folder to `path`, in one step and never over another, and
/// syncs the folder. False when something is at `path` already. Throws Error when it cannot. `made`
/// then still stands.
[[nodiscard]] bool put_in_place(const std::string& made, const std::string& path);
/// What was made, renamed or removed in the folder that holds `path` is on disk afterwards. Throws
/// Error when the disk refuses.
void sync_folder_of(const std::string& path);

/// A name beside `path` that nobody can guess, hidden and ending in ".part".
[[nodiscard]] std::string temporary_name_next_to(const std::string& path);

}  // namespace cavum
