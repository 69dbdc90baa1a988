#include "scenarios/file/surface_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/tooth/mesh/read_mesh.h"

namespace cavum::scenarios {
namespace {

constexpr std::size_t k_max_bytes = 32u << 20;
constexpr double k_furthest_mm = 200;

/// Calls `visit(shape, place)` for every STL of the zones.
template <class AnyScenario, class Visit>
void for_each_surface(AnyScenario& s, const Visit& visit) {
  const auto all = [&](auto& list, const std::string& key) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (!list[i].file.empty()) visit(list[i], fmt::format("zones/{}/{}/file", key, i));
  };
  all(s.zones.target, "target");
  all(s.zones.protected_shapes, "protected");
}

/// Throws Error(name, ...).
void take(ShapeSpec& shape, const Bytes& bytes, const std::string& name) {
  ReadMesh read = read_closed_stl(bytes, name);
  for (const Vec3 v : read.mesh.vertices_mm)
    if (std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}) > k_furthest_mm)
      throw Error(name, msg("the surface reaches further than 200 mm from the tooth's origin"),
                  msg("export it in mm, in the tooth's frame"));
  shape.file_sha256 = sha256(bytes);
  shape.surface = std::make_shared<const TriangleMesh>(std::move(read.mesh));
}

const Bytes* find(const SurfaceFiles& files, const std::string& name) {
  const auto at =
      std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.first == name; });
  return at == files.end() ? nullptr : &at->second;
}

}  // namespace

std::vector<Problem> read_surfaces(Scenario& scenario, SurfaceFiles& files) {
  namespace fs = std::filesystem;
  std::vector<Problem> problems;
  for_each_surface(scenario, [&](ShapeSpec& shape, const std::string& place) {
    if (!shape.file.ends_with(".stl") && !shape.file.ends_with(".STL"))
      return;  // a mistake of the text, named already
    const auto wrong = [&](const Message& what, const Message& what_to_do) {
      problems.push_back(problem_at(scenario, place, msg("'{}': {}", shape.file, what), what_to_do,
                                    Mistake::surface));
    };
    const fs::path path = fs::path(scenario.path).parent_path() / shape.file;
    std::error_code none;
    if (fs::is_directory(path, none))
      return wrong(msg("it is a folder, not a file"), msg("name the STL file in it"));
    if (!fs::is_regular_file(path, none))
      return wrong(msg("there is no such file"),
                   msg("put it beside the scenario, or give the way to it from there"));
    if (fs::file_size(path, none) > k_max_bytes)
      return wrong(msg("the file is larger than 32 MB"),
                   msg("thin the surface out: a leaf is 0.05 mm wide"));
    try {
      if (find(files, shape.file) == nullptr)
        files.emplace_back(shape.file, read_file(path.string()));
      take(shape, *find(files, shape.file), shape.file);
    } catch (const Error& e) {
      wrong(e.problem(), e.advice());
    }
  });
  return problems;
}

void use_surfaces(Scenario& scenario, const SurfaceFiles& files) {
  for_each_surface(scenario, [&](ShapeSpec& shape, const std::string&) {
    const Bytes* bytes = find(files, shape.file);
    if (bytes == nullptr)
      throw Error(Mistake::missing, Name{scenario.path},
                  msg("the session does not hold the surface '{}'", shape.file),
                  msg("use an intact copy"));
    take(shape, *bytes, fmt::format("{}: {}", scenario.path, shape.file));
  });
}

void require_same_surfaces(const Scenario& scenario, const Scenario& recorded) {
  for_each_surface(scenario, [&](const ShapeSpec& now, const std::string& place) {
    for_each_surface(recorded, [&](const ShapeSpec& then, const std::string&) {
      if (now.file != then.file || now.file_sha256 == then.file_sha256) return;
      const auto begin = [](const Sha256& hash) { return to_hex(hash).substr(0, 12); };
      const Problem p = problem_at(
          scenario, place,
          msg("'{}' is not the surface that the session ran with (SHA-256 {}... instead of {}...)",
              now.file, begin(now.file_sha256), begin(then.file_sha256)),
          msg("put the old one back, or give the corrected surface a name of its own"));
      throw Error(Mistake::surface, p.where, p.what, p.what_to_do);
    });
  });
}

}  // namespace cavum::scenarios
