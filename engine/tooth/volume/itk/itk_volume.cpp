#include "engine/tooth/volume/itk/itk_volume.h"

#include <fmt/core.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageSeriesReader.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkMultiThreaderBase.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkPNGImageIO.h>
#include <itkTIFFImageIO.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/base/order.h"
#include "engine/base/system_error.h"
#include "engine/base/text.h"
#include "engine/tooth/volume/dicom_bytes.h"
#include "engine/tooth/volume/volume_files.h"
#include "engine/tooth/volume/volume_limits.h"
#include "engine/tooth/volume/volume_wire.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;
using Image = itk::Image<float, 3>;

constexpr const char* k_intact =
    noop("give an intact MetaImage, NRRD, NIfTI, TIFF or DICOM series");

/// What was read, and which of its spacings the format has no place for.
struct Read {
  Image::Pointer image;
  bool no_spacing = false;
  double slice_spacing_mm = 0.0;  ///< > 0: instead of the image's own
};

std::string lower_extension(const fs::path& p) {
  auto s = p.extension().string();
  for (char& c : s) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return s;
}

/// "slice2" before "slice10".
bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      std::size_t ie = i, je = j;
      while (ie < a.size() && digit(a[ie])) ++ie;
      while (je < b.size() && digit(b[je])) ++je;
      auto na = a.substr(i, ie - i), nb = b.substr(j, je - j);
      na.erase(0, std::min(na.find_first_not_of('0'), na.size()));
      nb.erase(0, std::min(nb.find_first_not_of('0'), nb.size()));
      if (na.size() != nb.size()) return na.size() < nb.size();
      if (na != nb) return na < nb;
      i = ie;
      j = je;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

void require_voxels(std::uint64_t voxels, std::uint64_t bytes, const std::string& path) {
  if (voxels > most_voxels(bytes))
    throw Error(FileError::too_large, Name{path},
                msg("claims more than {} voxels, the most for {} bytes of files",
                    most_voxels(bytes), bytes),
                msg("crop the volume to the tooth, or save it uncompressed"));
}

/// Voxels that the header claims, of all dimensions and channels; as many as cannot be when one of
/// them is beyond reason.
std::uint64_t claimed_voxels(itk::ImageIOBase& io) {
  constexpr std::uint64_t k_too_many = std::uint64_t{1} << 40;
  std::uint64_t all = std::max(1U, io.GetNumberOfComponents());
  for (unsigned d = 0; d < io.GetNumberOfDimensions(); ++d) {
    if (io.GetDimensions(d) > 1 << 20) return k_too_many;
    all *= std::max<std::uint64_t>(1, io.GetDimensions(d));
    if (all > k_too_many) return k_too_many;
  }
  return all;
}

void require_claim(itk::ImageIOBase& io, const std::string& file, std::uint64_t slices,
                   std::uint64_t bytes) {
  io.SetFileName(file);
  io.ReadImageInformation();
  require_voxels(claimed_voxels(io) * slices, bytes, file);
}

/// Distance between slices, mm, from their positions; throws when one is missing. 0 when the slices
/// carry none.
double slice_spacing_mm(const std::vector<std::string>& files, const std::string& folder) {
  struct Slice {
    double at_mm;
    std::string file;
  };
  std::vector<Slice> slices;
  Vec3 normal;
  for (const auto& file : files) {
    auto io = itk::GDCMImageIO::New();
    io->SetFileName(file);
    io->ReadImageInformation();
    std::string text;
    if (!itk::ExposeMetaData<std::string>(io->GetMetaDataDictionary(), "0020|0032", text))
      return 0.0;
    std::replace(text.begin(), text.end(), '\\', ' ');
    std::istringstream in(text);
    Vec3 p;
    if (!(in >> p.x >> p.y >> p.z)) return 0.0;
    if (slices.empty()) {
      const auto row = io->GetDirection(0), column = io->GetDirection(1);
      normal = cross({row[0], row[1], row[2]}, {column[0], column[1], column[2]});
    }
    slices.push_back({dot(normal, p), fs::path(file).filename().string()});
  }
  if (slices.size() < 2) return 0.0;
  std::sort(slices.begin(), slices.end(),
            [](const Slice& a, const Slice& b) { return a.at_mm < b.at_mm; });
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i)
    gaps.push_back(slices[i].at_mm - slices[i - 1].at_mm);
  const double usual = median(gaps);
  for (std::size_t i = 0; i < gaps.size(); ++i)
    if (!(std::fabs(gaps[i] - usual) <= 0.02 * usual + 1e-4)) {
      throw Error(
          FileError::inconsistent, Name{folder},
          msg("the DICOM series has a hole or uneven slices: {} between {} and {}, {} elsewhere",
              as_mm(gaps[i], k_as_needed), slices[i].file, slices[i + 1].file,
              as_mm(usual, k_as_needed)),
          msg("export the complete series again"));
    }
  return usual;
}

/// Slices of one series say in the same way how their bytes are to be read.
void require_alike(const DicomSlice& first, const std::string& first_file, const DicomSlice& other,
                   const std::string& file) {
  if (first.common == other.common) return;
  for (const auto& [name, value] : first.common) {
    const auto found = other.common.find(name);
    if (found == other.common.end() || found->second != value)
      throw Error(FileError::inconsistent, Name{file},
                  msg("has another {} than {} of the same series", name, first_file),
                  msg("export the complete series again"));
  }
  throw Error(FileError::inconsistent, Name{file},
              msg("has fields that {} of the same series does not have", first_file),
              msg("export the complete series again"));
}

bool is_dicom_file(const std::string& file) {
  std::array<std::uint8_t, 132> head{};
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(head.data()), head.size());
  return says_dicom(head);
}

void require_voxels(const DicomSlice& slice, std::uint64_t slices, std::uint64_t bytes,
                    const std::string& file) {
  require_voxels(slice.rows * slice.columns * slice.frames * slices, bytes, file);
}

DicomSlice whole_slice(const std::string& file) {
  return check_dicom_bytes(read_file(file, k_largest_slice), file);
}

using WholeSlices = std::map<std::string, DicomSlice>;  ///< by their files

/// All that say that they are DICOM: GDCM aborts on some damaged ones while it only looks for
/// series, so they are walked before.
WholeSlices whole_slices(const std::vector<std::string>& files) {
  WholeSlices whole;
  for (const auto& file : files)
    if (is_dicom_file(file) && fs::path(file).filename() != "DICOMDIR")
      whole[file] = whole_slice(file);
  return whole;
}

Read read_dicom(const std::string& folder, const std::string& series,
                const std::vector<std::string>& files, WholeSlices whole, std::uint64_t bytes) {
  for (const auto& file : files) {
    if (!whole.contains(file)) whole[file] = whole_slice(file);  // some have no preamble
    require_voxels(whole[file], files.size(), bytes, file);
    require_alike(whole[files[0]], files[0], whole[file], file);
  }
  Read out;
  auto io = itk::GDCMImageIO::New();
  for (const auto& file : files) require_claim(*io, file, files.size(), bytes);
  out.slice_spacing_mm = slice_spacing_mm(files, folder);
  auto reader = itk::ImageSeriesReader<Image>::New();
  reader->SetImageIO(io);
  reader->SetFileNames(files);
  reader->Update();
  double deviation = 0.0;
  if (itk::ExposeMetaData<double>(reader->GetOutput()->GetMetaDataDictionary(),
                                  "ITK_non_uniform_sampling_deviation", deviation) &&
      deviation > 1e-3)
    throw Error(FileError::inconsistent, Name{folder},
                msg("the slices of DICOM series {} are not evenly spaced (off by up to {})", series,
                    as_mm(deviation, k_as_needed)),
                msg("export the complete series again"));
  out.image = reader->GetOutput();
  return out;
}

/// The ordinary files of a folder. A pipe or a device among them would hold whoever opens it.
std::vector<std::string> files_of(const std::string& folder, std::uint64_t& bytes) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    if (!entry.is_regular_file())
      throw Error(FileError::not_a_file, Name{entry.path().string()}, msg("is no ordinary file"),
                  msg("give a folder with nothing but the slices of one volume"));
    bytes += entry.file_size();
    files.push_back(entry.path().string());
    if (files.size() > k_max_slice_files)
      throw Error(FileError::too_large, Name{folder},
                  msg("holds more than {} files", k_max_slice_files),
                  msg("give a folder with nothing but the slices of one volume"));
  }
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

itk::ImageIOBase::Pointer slice_reader(const std::string& extension) {
  if (extension == ".png") return itk::PNGImageIO::New().GetPointer();
  return itk::TIFFImageIO::New().GetPointer();
}

Read read_folder(const std::string& folder, std::uint64_t bytes,
                 const std::vector<std::string>& files) {
  WholeSlices whole = whole_slices(files);
  auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(false);
  names->SetDirectory(folder);
  const auto series = names->GetSeriesUIDs();
  if (series.size() > 1)
    throw Error(FileError::inconsistent, Name{folder},
                msg("{} DICOM series in one folder", series.size()),
                msg("put the one to import into a folder of its own"));
  const std::vector<std::string> slices =
      series.empty() ? std::vector<std::string>() : names->GetFileNames(series[0]);
  const std::set<std::string> known(slices.begin(), slices.end());
  const auto named_as_slice = [&](const std::string& file) {
    return !slices.empty() && lower_extension(file) == lower_extension(slices[0]);
  };
  for (const auto& file : files)
    if (!known.contains(file) && (is_dicom_file(file) || named_as_slice(file)) &&
        fs::path(file).filename() != "DICOMDIR") {
      if (!whole.contains(file)) static_cast<void>(whole_slice(file));
      throw Error(FileError::inconsistent, Name{file},
                  msg("is DICOM and belongs to no series: its header is damaged"),
                  msg("export the complete series again"));
    }
  if (!slices.empty()) return read_dicom(folder, series[0], slices, std::move(whole), bytes);
  std::vector<std::string> pictures;
  for (const auto& file : files)
    if (const auto e = lower_extension(file); e == ".tif" || e == ".tiff" || e == ".png")
      pictures.push_back(file);
  if (pictures.size() < 2)
    throw Error(FileError::malformed, Name{folder},
                msg("neither a DICOM series nor a stack of TIFF slices"),
                msg("give a folder with the slices of one volume"));
  for (const auto& file : pictures)
    if ((lower_extension(file) == ".png") != (lower_extension(pictures[0]) == ".png"))
      throw Error(FileError::inconsistent, Name{folder}, msg("holds slices as PNG and as TIFF"),
                  msg("put the slices of one volume into a folder of their own"));
  Read out;
  const auto io = slice_reader(lower_extension(pictures[0]));
  for (const auto& file : pictures) {
    check_volume_bytes(file);
    require_claim(*io, file, pictures.size(), bytes);
  }
  auto reader = itk::ImageSeriesReader<Image>::New();
  reader->SetImageIO(io);
  reader->SetFileNames(pictures);
  reader->Update();
  out.image = reader->GetOutput();
  out.no_spacing = true;  // slices say nothing about their distance
  return out;
}

/// By the file's name, as its format's own programs go by it; what has another name must say that
/// it is DICOM.
itk::ImageIOBase::Pointer reader_of(const std::string& path, std::uint64_t bytes) {
  const std::string e = lower_extension(path);
  if (e == ".mhd" || e == ".mha") return itk::MetaImageIO::New().GetPointer();
  if (e == ".nrrd" || e == ".nhdr") return itk::NrrdImageIO::New().GetPointer();
  if (e == ".nii" || (e == ".gz" && lower_extension(fs::path(path).stem()) == ".nii"))
    return itk::NiftiImageIO::New().GetPointer();
  if (e == ".tif" || e == ".tiff") return itk::TIFFImageIO::New().GetPointer();
  if (!is_dicom_file(path))
    throw Error(FileError::malformed, Name{path}, msg("is no volume by its name, nor DICOM"),
                msg("name a .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz, .tif or DICOM file"));
  require_voxels(whole_slice(path), 1, bytes, path);
  return itk::GDCMImageIO::New().GetPointer();
}

Read read_one(const std::string& path, std::uint64_t bytes) {
  require_no_neighbour(path);
  const auto io = reader_of(path, bytes);
  const auto e = lower_extension(path);
  const bool tiff = e == ".tif" || e == ".tiff";
  if (tiff)
    check_volume_bytes(path);  // libtiff does not open a file that was cut, and does not say why
  require_claim(*io, path, 1, bytes);
  if (!tiff)
    check_volume_bytes(path);  // what is packed is unpacked in this, so its claim comes before
  auto reader = itk::ImageFileReader<Image>::New();
  reader->SetImageIO(io);
  reader->SetFileName(path);
  reader->Update();
  return {reader->GetOutput(), tiff, 0.0};
}

/// Everything of the volume but its voxels.
Volume head_of(const Read& read) {
  Volume v;
  const auto size = read.image->GetLargestPossibleRegion().GetSize();
  v.size = {static_cast<std::int32_t>(size[0]), static_cast<std::int32_t>(size[1]),
            static_cast<std::int32_t>(size[2])};
  const auto& direction = read.image->GetDirection();
  for (unsigned a = 0; a < 3; ++a) {
    v.spacing_mm[a] = read.image->GetSpacing()[a];
    v.axis[a] = normalized(Vec3{direction(0, a), direction(1, a), direction(2, a)});
  }
  v.origin_mm = {read.image->GetOrigin()[0], read.image->GetOrigin()[1],
                 read.image->GetOrigin()[2]};
  if (read.no_spacing) v.spacing_mm = {0, 0, 0};
  if (read.slice_spacing_mm > 0) v.spacing_mm[2] = read.slice_spacing_mm;
  return v;
}

void limit(int what, std::uint64_t most) {
  const rlimit both{most, most};
  if (::setrlimit(static_cast<decltype(RLIMIT_AS)>(what), &both) != 0)
    throw Error(msg("the reading of volumes"), msg("cannot be limited"),
                msg("use another computer"));
}

void limit_this_process(std::uint64_t bytes) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, most_read_seconds(bytes));
#if !defined(__SANITIZE_ADDRESS__)  // its shadow lies everywhere
  limit(RLIMIT_AS, most_read_memory(bytes));
#endif
}

template <class Limit>
int send(const std::string& path, int fd, const Limit& set_limits) {
  std::uint64_t bytes = 0;
  std::optional<Error> error;
  try {
    const bool folder = fs::is_directory(path);
    if (!folder && !fs::is_regular_file(path))
      throw Error(FileError::missing, Name{path}, msg("no such volume"), msg("check the path"));
    std::vector<std::string> files;
    if (folder)
      files = files_of(path, bytes);
    else
      bytes = bytes_of_volume(path);
    set_limits(bytes);
    itk::Object::GlobalWarningDisplayOff();  // what matters is thrown as Error, with the file's
                                             // name
    itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
    const Read read = folder ? read_folder(path, bytes, files) : read_one(path, bytes);
    const Volume head = head_of(read);
    return send_volume(fd, head, {read.image->GetBufferPointer(), head.voxels()}) ? 0 : 1;
  } catch (const Error& e) {
    error = e;
  } catch (const itk::ExceptionObject& e) {
    std::string what = e.GetDescription();
    std::replace(what.begin(), what.end(), '\n', ' ');
    error.emplace(path, msg("cannot be read as a volume ({})", what.substr(0, 200)), msg(k_intact));
  } catch (const fs::filesystem_error& e) {
    error.emplace(path, system_words(e.code().value()), msg("check the path and its permissions"));
  } catch (const std::bad_alloc&) {
    error.emplace(path,
                  msg("needs more memory than the limit of {} bytes", most_read_memory(bytes)),
                  msg(k_intact));
  } catch (const std::exception& e) {
    error.emplace(path, msg("cannot be read as a volume ({})", e.what()), msg(k_intact));
  }
  return send_volume_error(fd, *error) ? 0 : 1;
}

}  // namespace

int serve_volume(const std::string& path, int fd) { return send(path, fd, limit_this_process); }

int send_volume_of(const std::string& path, int fd) {
  return send(path, fd, [](std::uint64_t) {});
}

}  // namespace cavum
