#include "grading/ledger/witness.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/session/session.h"
#include "grading/ledger/ledger_key.h"

namespace cavum {

std::string witness_path(const std::string& ledger_id) { return station_path("witness/" + file_name_of(ledger_id)); }

std::vector<Checkpoint> read_witness(const std::string& id, std::vector<std::string>& findings) {
  std::vector<Checkpoint> out;
  const std::string path = witness_path(id);
  if (!std::filesystem::exists(path)) return out;
  std::istringstream lines(read_text_file(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Checkpoint p;
    std::string root;
    if (!(words >> p.size >> root >> p.utc_ns)) break;  // a line that a power cut left short
    try {
      p.root = fixed_from_hex<32>(root, path);
    } catch (const Error&) {
      findings.push_back(path + ": the witness was changed at entry " + std::to_string(p.size));
      break;
    }
    out.push_back(p);
  }
  return out;
}

void tell_witness(const std::string& id, const Checkpoint& p) {
  const std::string path = witness_path(id);
  make_private_folder(std::filesystem::path(path).parent_path().string());
  const std::string line = std::to_string(p.size) + " " + to_hex(p.root) + " " + std::to_string(p.utc_ns) + "\n";
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0600);
  const bool told = fd >= 0 && ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size()) && ::fsync(fd) == 0;
  const int why = errno;
  if (fd >= 0) ::close(fd);
  if (!told)
    throw Error(path, std::string("the entry is in the ledger, but its witness cannot be told (") + std::strerror(why) + ")",
                "make the folder writable; the next entry tells it again");
}

}  // namespace cavum
