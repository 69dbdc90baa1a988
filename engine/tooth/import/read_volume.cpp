#include "engine/tooth/import/read_volume.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMImageIOFactory.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageSeriesReader.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIOFactory.h>
#include <itkNiftiImageIOFactory.h>
#include <itkNrrdImageIOFactory.h>
#include <itkPNGImageIOFactory.h>
#include <itkTIFFImageIOFactory.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <sstream>

#include "engine/base/error.h"
#include "engine/tooth/import/volume_files.h"

namespace cavum {
namespace {

namespace fs = std::filesystem;
using Image = itk::Image<float, 3>;

void know_formats() {
  static std::once_flag once;
  std::call_once(once, [] {
    itk::Object::GlobalWarningDisplayOff();  // what matters is thrown as Error, with the file's name
    itk::MetaImageIOFactory::RegisterOneFactory();
    itk::NrrdImageIOFactory::RegisterOneFactory();
    itk::NiftiImageIOFactory::RegisterOneFactory();
    itk::TIFFImageIOFactory::RegisterOneFactory();
    itk::PNGImageIOFactory::RegisterOneFactory();
    itk::GDCMImageIOFactory::RegisterOneFactory();
  });
}

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

Volume from_image(const Image& image) {
  Volume v;
  const auto size = image.GetLargestPossibleRegion().GetSize();
  v.size = {static_cast<std::int32_t>(size[0]), static_cast<std::int32_t>(size[1]), static_cast<std::int32_t>(size[2])};
  const auto& direction = image.GetDirection();
  for (unsigned a = 0; a < 3; ++a) {
    v.spacing_mm[a] = image.GetSpacing()[a];
    v.axis[a] = normalized(Vec3{direction(0, a), direction(1, a), direction(2, a)});
  }
  v.origin_mm = {image.GetOrigin()[0], image.GetOrigin()[1], image.GetOrigin()[2]};
  const float* from = image.GetBufferPointer();
  v.gray.assign(from, from + size[0] * size[1] * size[2]);
  return v;
}

/// Distance between slices, mm, from their positions; throws when one is missing. 0 when the slices carry none.
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
    if (!itk::ExposeMetaData<std::string>(io->GetMetaDataDictionary(), "0020|0032", text)) return 0.0;
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
  std::sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) { return a.at_mm < b.at_mm; });
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i) gaps.push_back(slices[i].at_mm - slices[i - 1].at_mm);
  auto sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < gaps.size(); ++i)
    if (!(std::fabs(gaps[i] - usual) <= 0.02 * usual + 1e-4)) {
      std::ostringstream what;
      what << "the DICOM series has a hole or uneven slices: " << gaps[i] << " mm between " << slices[i].file << " and " << slices[i + 1].file << ", "
           << usual << " mm elsewhere";
      throw Error(folder, what.str(), "export the complete series again");
    }
  return usual;
}

Volume read_dicom(const std::string& folder, const std::string& series, const std::vector<std::string>& files) {
  const double between_mm = slice_spacing_mm(files, folder);
  auto io = itk::GDCMImageIO::New();
  auto reader = itk::ImageSeriesReader<Image>::New();
  reader->SetImageIO(io);
  reader->SetFileNames(files);
  reader->Update();
  double deviation = 0.0;
  if (itk::ExposeMetaData<double>(reader->GetOutput()->GetMetaDataDictionary(), "ITK_non_uniform_sampling_deviation", deviation) && deviation > 1e-3)
    throw Error(folder, "the slices of DICOM series " + series + " are not evenly spaced (off by up to " + std::to_string(deviation) + " mm)",
                "export the complete series again");
  Volume v = from_image(*reader->GetOutput());
  if (between_mm > 0) v.spacing_mm[2] = between_mm;
  return v;
}

Volume read_folder(const std::string& folder) {
  auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(false);
  names->SetDirectory(folder);
  const auto series = names->GetSeriesUIDs();
  if (series.size() > 1)
    throw Error(folder, std::to_string(series.size()) + " DICOM series in one folder", "put the one to import into a folder of its own");
  if (series.size() == 1) return read_dicom(folder, series[0], names->GetFileNames(series[0]));
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto e = lower_extension(entry.path());
    if (e == ".tif" || e == ".tiff" || e == ".png") files.push_back(entry.path().string());
  }
  if (files.size() < 2) throw Error(folder, "neither a DICOM series nor a stack of TIFF slices", "give a folder with the slices of one volume");
  std::sort(files.begin(), files.end(), natural_less);
  auto reader = itk::ImageSeriesReader<Image>::New();
  reader->SetFileNames(files);
  reader->Update();
  Volume v = from_image(*reader->GetOutput());
  v.spacing_mm = {0, 0, 0};  // slices say nothing about their distance
  return v;
}

Volume read_file_or_folder(const std::string& path) {
  know_formats();
  if (fs::is_directory(path)) return read_folder(path);
  if (!fs::is_regular_file(path)) throw Error(path, "no such volume", "check the path");
  check_volume_bytes(path);
  auto reader = itk::ImageFileReader<Image>::New();
  reader->SetFileName(path);
  reader->Update();
  Volume v = from_image(*reader->GetOutput());
  const auto e = lower_extension(path);
  if (e == ".tif" || e == ".tiff") v.spacing_mm = {0, 0, 0};  // the format has no place for it
  return v;
}

}  // namespace

Volume read_volume(const std::string& path, const std::optional<Vec3>& spacing_mm) {
  Volume v;
  try {
    v = read_file_or_folder(path);
  } catch (const itk::ExceptionObject& e) {
    std::string what = e.GetDescription();
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw Error(path, "cannot be read as a volume (" + what.substr(0, 200) + ")", "give an intact MetaImage, NRRD, NIfTI, TIFF or DICOM series");
  } catch (const fs::filesystem_error& e) {
    throw Error(path, e.code().message(), "check the path and its permissions");
  }
  if (v.size.x < 4 || v.size.y < 4 || v.size.z < 4)
    throw Error(path, "not a volume: fewer than 4 voxels along an axis", "give all slices of the volume");
  for (std::size_t i = 0; i < v.gray.size(); ++i)
    if (!std::isfinite(v.gray[i])) throw Error(path, "voxel " + std::to_string(i) + " is not a number", "export the volume again");

  std::ostringstream note;
  const auto& s = v.spacing_mm;
  const bool told = s[0] > 0 && s[1] > 0 && s[2] > 0 && std::isfinite(s[0] + s[1] + s[2]) && !(s[0] == 1 && s[1] == 1 && s[2] == 1);
  if (spacing_mm) {
    for (const double d : {spacing_mm->x, spacing_mm->y, spacing_mm->z})
      if (!(d > 0 && d < 100)) throw Error("--spacing-mm", "must lie between 0 and 100 mm", "give the edge of a voxel, such as 0.125");
    v.spacing_mm = {spacing_mm->x, spacing_mm->y, spacing_mm->z};
    note << "spacing given " << v.spacing_mm[0] << ',' << v.spacing_mm[1] << ',' << v.spacing_mm[2] << " mm";
  } else if (told) {
    note << "spacing from the file " << s[0] << ',' << s[1] << ',' << s[2] << " mm";
  } else {
    v.spacing_mm = {k_assumed_spacing_mm, k_assumed_spacing_mm, k_assumed_spacing_mm};
    v.spacing_assumed = true;
    note << "spacing assumed " << k_assumed_spacing_mm << " mm (the file gives none): sizes and volumes are not measured";
  }
  v.spacing_note = note.str();
  return v;
}

}  // namespace cavum
