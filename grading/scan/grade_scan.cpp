#include "grading/scan/grade_scan.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/lab/scan/read_scan.h"
#include "engine/lab/scan/scale_fit.h"
#include "engine/lab/scan/smoothed.h"
#include "engine/tooth/mesh/mesh_units.h"
#include "grading/marking/grade.h"

namespace cavum::grading {
namespace {

/// Root of the mean squared distance from the middle, mm: the size of a surface, whichever way it
/// is turned.
double radius_of(const std::vector<SurfacePoint>& points) {
  const double area = area_of(points);
  Vec3 middle;
  for (const auto& p : points) middle += p.at_mm * (p.area_mm2 / area);
  double squares = 0;
  for (const auto& p : points)
    squares += p.area_mm2 / area * dot(p.at_mm - middle, p.at_mm - middle);
  return std::sqrt(squares);
}

/// Throws Error unless the scan is about as large as the crown alone, or the whole tooth: with the
/// unit that would make it so.
void require_size(const std::vector<SurfacePoint>& scan, double unit_mm, const OuterSurface& tooth,
                  const std::string& path) {
  constexpr double k_least = 0.6, k_most = 1.6;
  const double size = radius_of(scan), least = k_least * radius_of(tooth.crown()),
               most = k_most * radius_of(tooth.points());
  if (size >= least && size <= most) return;
  Message hint = msg("scan one tooth, cut out of its neighbours");
  for (const MeshUnit& unit : k_mesh_units)
    if (const double so = size / unit_mm * unit.mm; so >= least && so <= most)
      hint = msg("it is likely in {}: say --units {}", Term{unit.text}, unit.name);
  throw Error(
      path,
      msg("is no scan of this tooth by its size: on average its surface lies {} from its middle, and the tooth's {} (crown alone {})",
          as_mm(size, k_as_needed), as_mm(radius_of(tooth.points()), 1),
          as_mm(radius_of(tooth.crown()), 1)),
      hint);
}

/// Where a scan does not fit: throws Error when it does in another size, or in a mirror, and says
/// so.
void require_size_and_side(const Scan& scan, const Registration& found, const ScanOptions& options,
                           const OuterSurface& outer, const std::string& path) {
  std::vector<Rigid> poses{found.best.to_tooth};
  if (found.second) poses.push_back(found.second->to_tooth);
  for (const Rigid& pose : poses) {
    const auto sized = fit_with_scale(scan.points, pose, outer);
    if (!sized || !fits_tooth(fit_of(in_size(scan.points, sized->scale), sized->to_tooth, outer)))
      continue;
    const double percent = 100 * (1 / sized->scale - 1);
    throw Error(
        path,
        percent > 0
            ? msg("is of this tooth by its form, but {} too large: in the tooth's size it fits",
                  as_percent(percent, 1))
            : msg("is of this tooth by its form, but {} too small: in the tooth's size it fits",
                  as_percent(-percent, 1)),
        msg("calibrate the scanner (or the printer), or multiply the file's lengths by {}",
            as_number(sized->scale, 4)));
  }
  const Scan other = mirrored(scan);
  const auto turned = register_scan(other.points, outer);
  if (turned && fits_tooth(fit_of(other.points, turned->best.to_tooth, outer)))
    throw Error(
        path, msg("is the mirror image of this tooth"),
        options.mirror
            ? msg("leave --mirror out")
            : msg("if the tooth was imported as its mirror image, and the scan is of the real one, say --mirror"));
}

/// Throws Error when another pose fits about as well.
void require_one_pose(const Registration& r, const std::string& path) {
  constexpr double k_as_well = 0.95;
  if (!r.second || r.second->share < k_as_well * r.best.share) return;
  throw Error(
      path,
      msg("can be laid upon the tooth in more than one way: {} of it fit in one pose, {} in another",
          as_percent(100 * r.best.share, 1), as_percent(100 * r.second->share, 1)),
      msg("scan more of the tooth, so that its shape tells how it lies"));
}

TriangleMesh moved(TriangleMesh mesh, const Rigid& pose) {
  for (Vec3& v : mesh.vertices_mm) v = pose * v;
  return mesh;
}

std::vector<SurfacePoint> moved(std::vector<SurfacePoint> points, const Rigid& pose) {
  for (auto& p : points) {
    p.at_mm = pose * p.at_mm;
    p.normal = pose.rotation * p.normal;
  }
  return points;
}

/// A scan in the tooth's frame, without its noise where something was cut.
struct Evened {
  TriangleMesh mesh;
  std::vector<SurfacePoint> points;  // where it was evened
};

/// Noise is averaged as wide as it needs, and no wider; elsewhere the surface is the tooth's own,
/// and is known.
Evened evened(const TriangleMesh& scan, const std::vector<SurfacePoint>& points, double noise_mm,
              const OuterSurface& tooth, const std::string& path) {
  constexpr double k_per_noise = 22.0, k_min_mm = 0.15, k_max_mm = 0.35, k_deep_mm = 0.1,
                   k_around_mm = 0.7, k_cell_mm = 0.25, k_point_mm = 0.12;
  Octree::Cursor cursor;
  std::vector<SurfacePoint> deep;
  for (const auto& p : points)
    if (tooth.distance(p.at_mm, cursor).mm < -k_deep_mm) deep.push_back(p);
  if (deep.empty()) return {scan, {}};
  const double radius = std::clamp(k_per_noise * noise_mm, k_min_mm, k_max_mm);
  const SurfaceIndex index(deep, k_cell_mm, 2.0);
  const auto near = [&](Vec3 p, double mm) { return length(p - index.near(p).at_mm) < mm; };
  std::vector<SurfacePoint> around;
  for (const auto& p : points)
    if (near(p.at_mm, k_around_mm + 2 * radius + k_cell_mm)) around.push_back(p);
  std::vector<std::uint8_t> wanted;
  for (const Vec3 v : scan.vertices_mm) wanted.push_back(near(v, k_around_mm) ? 1 : 0);
  Evened out{smoothed(scan, around, wanted, radius), {}};
  TriangleMesh part;
  part.vertices_mm = out.mesh.vertices_mm;
  for (const auto& t : out.mesh.triangles)
    if (wanted[t[0]] != 0 && wanted[t[1]] != 0 && wanted[t[2]] != 0) part.triangles.push_back(t);
  out.points = surface_points(part, k_point_mm, path);
  return out;
}

/// How far the surface may lie from the true one, by what scatters where nothing was cut.
void put_bounds(const Evened& even, const OuterSurface& tooth, ScanFacts& facts) {
  constexpr double k_sigmas = 4.0, k_min_mm = 0.03, k_max_mm = 0.1, k_min_mean_mm = 0.003;
  // averaging makes no noise: more than the scan's own is something that was cut there
  constexpr double k_finest_mm = k_min_mm / k_sigmas;
  facts.smoothed_noise_mm = even.points.empty()
                                ? facts.fit.noise_mm
                                : std::min(fit_of(even.points, {}, tooth).noise_mm,
                                           std::max(k_finest_mm, facts.fit.noise_mm));
  facts.surface_bound_mm = std::clamp(k_sigmas * facts.smoothed_noise_mm, k_min_mm, k_max_mm);
  facts.surface_mean_bound_mm = std::max(k_min_mean_mm, facts.smoothed_noise_mm);
}

NotShown not_shown_by_scan(const OuterSurface& outer) {
  NotShown n;
  n.tissue = outer.outside();
  n.tissue[k_air] = false;
  return n;
}

/// Another pose fits nearly as well: a person must look whether this is the right one.
constexpr double k_nearly_as_well = 0.92;

/// What a reader must know; what is doubtful asks for a person.
void put_notes(const ScanFacts& f, Result& r) {
  constexpr double k_sure_agreement = 0.93, k_sure_crown = 0.55, k_sure_form_mm = 0.012;
  r.notes.insert(r.notes.end(), f.put_right.begin(), f.put_right.end());
  if (f.cavities == 0) r.notes.push_back(finding<FindingKind::scan_shows_nothing>());
  if (f.cavities > 1) r.notes.push_back(finding<FindingKind::scan_cavities>(f.cavities));
  if (!f.apart.empty()) {
    const auto& deepest = *std::max_element(
        f.apart.begin(), f.apart.end(),
        [](const ThinPiece& a, const ThinPiece& b) { return a.deep_mm < b.deep_mm; });
    r.notes.push_back(
        finding<FindingKind::scan_deeper_apart>(as_mm(deepest.deep_mm), deepest.at_mm));
    if (f.were_they_counted) r.notes.push_back(*f.were_they_counted);
  }
  if (f.second_share > k_nearly_as_well * f.pose.share)
    r.notes.push_back(finding<FindingKind::scan_other_pose>(as_percent(100 * f.second_share, 1),
                                                            as_percent(100 * f.pose.share, 1)));
  if (agreement(f.fit) < k_sure_agreement || f.fit.crown_seen < k_sure_crown ||
      f.fit.form_mm > k_sure_form_mm)
    r.notes.push_back(finding<FindingKind::scan_doubtful>(as_percent(100 * agreement(f.fit), 1),
                                                          as_percent(100 * f.fit.crown_seen, 1)));
}

}  // namespace

GradeInput GradedScan::input(const scenarios::Scenario& scenario, const Tooth& tooth,
                             const scenarios::ZoneMap& zones) const {
  GradeInput in{scenario, tooth, zones, after.octree, {}, {}, removed, {}};
  in.not_shown = &not_shown;
  in.surface_bound_mm = facts.surface_bound_mm;
  in.surface_mean_bound_mm = facts.surface_mean_bound_mm;
  return in;
}

GradedScan grade_scan(const std::string& path, const ScanOptions& options,
                      const scenarios::Scenario& scenario, const scenarios::RubricSpec& rubric,
                      const Tooth& tooth, const scenarios::ZoneMap& zones) {
  const Scan scan = options.mirror ? mirrored(read_scan(path, options.unit_mm))
                                   : read_scan(path, options.unit_mm);
  const OuterSurface outer(tooth);
  require_size(scan.points, options.unit_mm, outer, path);
  const auto registration = register_scan(scan.points, outer);
  if (!registration)
    throw Error(path, msg("cannot be laid upon the tooth anywhere"),
                msg("check that it is a scan of this tooth, in mm"));
  ScanFacts facts;
  facts.triangles = scan.mesh.triangles.size();
  facts.pose = registration->best;
  facts.fit = fit_of(scan.points, facts.pose.to_tooth, outer);
  facts.second_share = registration->second ? registration->second->share : 0.0;
  facts.end_mm = scan.end_mm;
  facts.holes = scan.holes;
  if (scan.parts_left_out > 0)
    facts.put_right.push_back(finding<FindingKind::scan_parts_left_out>(
        scan.parts_left_out, as_percent(scan.left_out_percent, 2)));
  if (scan.faces_turned) facts.put_right.push_back(finding<FindingKind::scan_faces_turned>());
  if (!fits_tooth(facts.fit)) require_size_and_side(scan, *registration, options, outer, path);
  require_same_tooth(facts.fit, path);
  require_one_pose(*registration, path);

  const TriangleMesh mesh = moved(scan.mesh, facts.pose.to_tooth);
  const Evened even =
      evened(mesh, moved(scan.points, facts.pose.to_tooth), facts.fit.noise_mm, outer, path);
  put_bounds(even, outer, facts);
  const TriangleMesh caps = moved(scan.caps, facts.pose.to_tooth);
  const auto graded_by = [&](ScanCut cut, ScanFacts of) {
    GradedScan graded{{}, std::move(of), tooth, {}, not_shown_by_scan(outer)};
    graded.after.octree = std::move(cut.after);
    graded.removed.reserve(cut.removed.size());
    for (const auto& leaf : cut.removed) graded.removed.push_back({k_untimed_tick, leaf});
    graded.result = grade(graded.input(scenario, tooth, zones), rubric);
    return graded;
  };
  ScanCut cut = cut_by_scan(even.mesh, caps, outer, facts.surface_bound_mm, path);
  facts.cavities = cut.cavities;
  facts.unseen_mm3 = cut.unseen_mm3;
  facts.left_as_noise_mm3 = cut.left_as_noise_mm3;
  facts.apart = cut.apart;
  if (!facts.apart.empty()) {
    Result all = graded_by(cut_by_scan(even.mesh, caps, outer, facts.surface_bound_mm, path,
                                       ThinApart::goes),
                           facts)
                     .result;
    mark(all, rubric);
    facts.were_they_counted = finding<FindingKind::scan_apart_counted>(
        word_of(all.verdict), as_points(all.points), as_points(all.max_points));
  }
  GradedScan graded = graded_by(std::move(cut), std::move(facts));
  put_notes(graded.facts, graded.result);
  mark(graded.result, rubric);
  return graded;
}

}  // namespace cavum::grading
