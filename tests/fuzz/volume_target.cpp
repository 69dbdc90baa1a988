// A volume as `cavum tooth import` reads it: the walks that are ours in this process, and, where
// there is ITK, the whole reading in a child with limits, as the program does: it may break, and
// must give a volume, an Error or an end, in time. The first byte chooses the files: MetaImage in
// one file, its header beside sound voxels, NRRD, NIfTI, packed NIfTI, TIFF, a slice of a DICOM
// series, one slice alone, or what the child sends.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "engine/base/file.h"
#include "engine/tooth/volume/dicom_bytes.h"
#include "engine/tooth/volume/itk/itk_volume.h"
#include "engine/tooth/volume/tiff_bytes.h"
#include "engine/tooth/volume/volume_files.h"
#include "engine/tooth/volume/volume_limits.h"
#include "engine/tooth/volume/volume_wire.h"
#include "tests/engine/tooth/import/import_testing.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

namespace fs = std::filesystem;
using testing_import::Voxels;

constexpr std::array<const char*, 6> k_names{"v.mha", "v.mhd",    "v.nrrd",
                                             "v.nii", "v.nii.gz", "v.tif"};
constexpr std::size_t k_slice = k_names.size(), k_alone = k_slice + 1, k_sent = k_alone + 1,
                      k_kinds = k_sent + 1;
constexpr int k_slices = 5;

Voxels small_volume() {
  Voxels v{5, 4, k_slices, 0.25, {}};
  for (int i = 0; i < v.nx * v.ny * v.nz; ++i) v.gray.push_back(static_cast<std::uint8_t>(i));
  return v;
}

void write(const fs::path& path, Data bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

const std::string& folder() {
  static const std::string k_folder = [] {
    const std::string made = work_folder() + "/volume";
    fs::create_directories(made + "/series");
    testing_import::write_bytes(fs::path(made) / "v.raw", small_volume().gray);
    for (int z = 0; z < k_slices; ++z)
      testing_import::write_dicom_slice(
          fs::path(made) / "series" / ("s" + std::to_string(z) + ".dcm"), small_volume(), z);
    return made;
  }();
  return k_folder;
}

#if defined(CAVUM_FUZZ_ITK)

/// Bytes of address space in use.
std::uint64_t address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void read_in_child(const std::string& path, int fd) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGALRM, SIGTERM})
    ::signal(signal, SIG_DFL);  // the fuzzer's are not for it
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int out : {1, 2}) ::dup2(nowhere, out);
  const auto limit = [](auto what, std::uint64_t most) {
    const rlimit both{most, most};
    if (::setrlimit(what, &both) != 0) ::_exit(3);
  };
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, 4 * most_read_seconds(0));  // sanitizers take their time
  limit(RLIMIT_AS, address_space() + 2 * most_read_memory(0));
  ::_exit(send_volume_of(path, fd));
}

#endif

void read_apart([[maybe_unused]] const std::string& path) {
#if defined(CAVUM_FUZZ_ITK)
  constexpr int k_longest_s = 20;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) std::abort();
  const pid_t child = ::fork();
  if (child < 0) std::abort();
  if (child == 0) {
    ::close(ends[0]);
    read_in_child(path, ends[1]);
  }
  ::close(ends[1]);
  const auto began = std::chrono::steady_clock::now();
  try {
    static_cast<void>(receive_volume(ends[0], path, most_voxels(0), k_longest_s));
  } catch (const Error&) {
  }
  ::close(ends[0]);
  const bool late = std::chrono::steady_clock::now() - began >= std::chrono::seconds(k_longest_s);
  if (late) ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (late) std::abort();
#endif
}

/// What a child sends that was led astray.
void receive(Data sent) {
  constexpr std::size_t k_pipe = 65536;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) std::abort();
  const auto size = std::min(k_pipe, sent.size());
  if (::write(ends[1], sent.data(), size) != static_cast<ssize_t>(size)) std::abort();
  ::close(ends[1]);
  try {
    static_cast<void>(receive_volume(ends[0], "volume", most_voxels(0), 1));
  } catch (const Error&) {
  }
  ::close(ends[0]);
}

template <class Walk>
void walk(const Walk& ours) {
  try {
    ours();
  } catch (const Error&) {
  }
}

}  // namespace

void fuzz_volume(Data data) {
  if (data.empty()) return;
  const std::size_t kind = data[0] % k_kinds;
  data = data.subspan(1);
  walk([&] { static_cast<void>(check_dicom_bytes(data, "slice")); });
  walk([&] { check_tiff_bytes(data, "stack.tif"); });
  if (kind < k_names.size()) {
    const std::string path = folder() + "/" + k_names[kind];
    write(path, data);
    walk([&] { static_cast<void>(bytes_of_volume(path)); });
    walk([&] { check_volume_bytes(path); });
    return read_apart(path);
  }
  const std::string series = folder() + "/series";
  if (kind == k_sent) return walk([&] { receive(data); });
  if (kind == k_slice) {
    write(series + "/s2.dcm", data);
    return read_apart(series);
  }
  write(folder() + "/alone.dcm", data);
  read_apart(folder() + "/alone.dcm");
}

std::vector<Bytes> volume_seeds() {
  std::vector<Bytes> seeds;
  const auto add = [&](std::size_t kind, const Bytes& file) {
    Bytes seed{static_cast<std::uint8_t>(kind)};
    seed.insert(seed.end(), file.begin(), file.end());
    seeds.push_back(std::move(seed));
  };
  const Voxels v = small_volume();
  const fs::path made = folder();
  const std::string head = read_text_file(testing_import::write_mhd(made, v, "0.25 0.25 0.25"));
  add(1, bytes_of(head));
  Bytes local = bytes_of(head.substr(0, head.find("v.raw")) + "LOCAL\n");
  local.insert(local.end(), v.gray.begin(), v.gray.end());
  add(0, local);
  add(2, read_file(testing_import::write_nrrd(made / "v.nrrd", v)));
  add(3, read_file(testing_import::write_nifti(made / "v.nii", v)));
  const Bytes slice = read_file((made / "series" / "s2.dcm").string());
  add(k_slice, slice);
  add(k_alone, slice);
  add(k_slice, Bytes(slice.begin(), slice.begin() + std::ssize(slice) / 2));
  for (const bool refused : {false, true}) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) std::abort();
    Volume sound;
    sound.size = {v.nx, v.ny, v.nz};
    sound.spacing_mm = {0.25, 0.25, 0.25};
    const std::vector<float> gray(v.gray.begin(), v.gray.end());
    static_cast<void>(refused ? send_volume_error(ends[1], Error("v.mha", msg("is cut off"),
                                                                 msg("copy it again")))
                              : send_volume(ends[1], sound, gray));
    ::close(ends[1]);
    Bytes sent(4096);
    sent.resize(
        static_cast<std::size_t>(std::max<ssize_t>(0, ::read(ends[0], sent.data(), sent.size()))));
    ::close(ends[0]);
    add(k_sent, sent);
  }
  // a TIFF of two pages of 4 x 4 bytes, one strip each
  ByteWriter tiff;
  for (const char c : {'I', 'I', '*', '\0'}) tiff.put(c);
  constexpr std::uint32_t k_first = 8 + 32, k_fields = 9, k_page = 2 + k_fields * 12 + 4;
  tiff.put(k_first);
  for (int i = 0; i < 32; ++i) tiff.put(static_cast<std::uint8_t>(i));
  for (const std::uint32_t page : {0U, 1U}) {
    tiff.put(static_cast<std::uint16_t>(k_fields));
    for (const auto& [tag, value] :
         std::initializer_list<std::pair<std::uint16_t, std::uint32_t>>{{256, 4},
                                                                        {257, 4},
                                                                        {258, 8},
                                                                        {259, 1},
                                                                        {262, 1},
                                                                        {273, 8 + 16 * page},
                                                                        {277, 1},
                                                                        {278, 4},
                                                                        {279, 16}}) {
      tiff.put(tag);
      tiff.put(std::uint16_t{4});
      tiff.put(std::uint32_t{1});
      tiff.put(value);
    }
    tiff.put(page == 0 ? k_first + k_page : std::uint32_t{0});
  }
  add(5, tiff.take());
  return seeds;
}

}  // namespace cavum::fuzz
