#include "engine/tooth/make_block.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"

namespace cavum {
namespace {

constexpr int k_margin_leaves = 4;
constexpr double k_tie_mm = 1e-9;  // a centre on a border belongs to the side above it, whatever the rounding

/// Box with half-open sides, mm.
struct Slab {
  Vec3 low, high;
};

/// Signed distance to the surface of a box, mm, negative inside.
double box_distance_mm(const Slab& box, Vec3 p) {
  const Vec3 middle = (box.low + box.high) * 0.5, half = (box.high - box.low) * 0.5;
  const Vec3 d{std::fabs(p.x - middle.x) - half.x, std::fabs(p.y - middle.y) - half.y, std::fabs(p.z - middle.z) - half.z};
  const Vec3 out{std::max(d.x, 0.0), std::max(d.y, 0.0), std::max(d.z, 0.0)};
  return length(out) + std::min(std::max({d.x, d.y, d.z}), 0.0);
}

bool holds(double low, double high, double v) { return v >= low - k_tie_mm && v < high - k_tie_mm; }

std::string number(double v) {
  std::ostringstream s;
  s << v;
  return s.str();
}

}  // namespace

Tooth make_block(Vec3 size_mm, const std::vector<Layer>& layers, double leaf_mm) {
  const std::string where = "block";
  for (const double v : {size_mm.x, size_mm.y, size_mm.z})
    if (!(v > 0 && std::isfinite(v))) throw Error(where, "every size must be larger than 0 mm", "give --size-mm 10,10,6, for example");
  if (!(leaf_mm > 0 && std::isfinite(leaf_mm))) throw Error(where, "the leaf must be larger than 0 mm", "give --leaf-mm 0.05, for example");
  Tooth tooth;
  std::vector<std::uint8_t> ids;
  double sum = 0.0;
  for (const auto& layer : layers) {
    if (!(layer.thickness_mm > 0 && std::isfinite(layer.thickness_mm)))
      throw Error(where, "layer '" + layer.tissue + "' has no thickness", "give every layer a thickness above 0 mm");
    if (layer.tissue == "air" || layer.tissue == "solid" || layer.tissue.empty())
      throw Error(where, "a layer cannot be named '" + layer.tissue + "'", "name a tissue: enamel, dentin, pulp, or one of your own");
    sum += layer.thickness_mm;
    std::uint8_t id = k_air;
    for (const auto& t : tooth.tissues)
      if (t.name == layer.tissue) id = t.id;
    if (id == k_air) {
      if (tooth.tissues.size() >= 255) throw Error(where, "more than 255 tissues", "use fewer names");
      id = static_cast<std::uint8_t>(tooth.tissues.size() + 1);
      tooth.tissues.push_back({id, layer.tissue, true});
    }
    ids.push_back(id);
  }
  if (std::fabs(sum - size_mm.z) > 1e-6)
    throw Error(where, "the layers are " + number(sum) + " mm together, the height is " + number(size_mm.z) + " mm", "make them equal");

  const auto half_leaves = [&](double mm) { return std::ceil(mm / 2 / leaf_mm - 1e-6) + k_margin_leaves; };
  const double nx = half_leaves(size_mm.x), ny = half_leaves(size_mm.y), nz = std::ceil(size_mm.z / leaf_mm - 1e-6) + k_margin_leaves;
  const auto whole = [](double v) { return static_cast<std::int32_t>(std::min(v, 1e6)); };
  const IVec3 leaves{2 * whole(nx), 2 * whole(ny), whole(nz) + k_margin_leaves};
  check_lattice(leaves, leaf_mm, where);
  TissueGrid grid;
  grid.allocate(leaves, leaf_mm, Vec3{-nx, -ny, -nz} * leaf_mm);

  bool is_solid[256] = {};
  for (const auto& t : tooth.tissues) is_solid[t.id] = t.solid;
  std::vector<double> top{0.0};  // of each layer, and the bottom of the last
  for (const auto& layer : layers) top.push_back(top.back() - layer.thickness_mm);
  top.back() = -size_mm.z;
  std::vector<Slab> solids;  // neighbouring solid layers are one body: their border is no surface
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (!is_solid[ids[i]]) continue;
    if (i > 0 && is_solid[ids[i - 1]])
      solids.back().low.z = top[i + 1];
    else
      solids.push_back({{-size_mm.x / 2, -size_mm.y / 2, top[i + 1]}, {size_mm.x / 2, size_mm.y / 2, top[i]}});
  }
  for (std::int32_t z = 0; z < leaves.z; ++z)
    for (std::int32_t y = 0; y < leaves.y; ++y)
      for (std::int32_t x = 0; x < leaves.x; ++x) {
        const auto i = grid.index({x, y, z});
        const Vec3 p = grid.centre_mm({x, y, z});
        if (holds(-size_mm.x / 2, size_mm.x / 2, p.x) && holds(-size_mm.y / 2, size_mm.y / 2, p.y))
          for (std::size_t l = 0; l < layers.size(); ++l)
            if (holds(top[l + 1], top[l], p.z)) grid.tissue[i] = ids[l];
        double d = 1e9;
        for (const auto& box : solids) d = std::min(d, box_distance_mm(box, p));
        grid.distance[i] = encode_distance(d / leaf_mm);
      }
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  tooth.name = "block " + number(size_mm.x) + " x " + number(size_mm.y) + " x " + number(size_mm.z) + " mm";
  tooth.source = "make block; layers from the top:";
  for (const auto& layer : layers) tooth.source += " " + layer.tissue + " " + number(layer.thickness_mm) + " mm,";
  tooth.source.back() = ';';
  tooth.source += " origin at the centre of the top face";
  return tooth;
}

Tooth make_cube(double edge_mm, const std::string& tissue, double leaf_mm) {
  Tooth tooth = make_block({edge_mm, edge_mm, edge_mm}, {{tissue, edge_mm}}, leaf_mm);
  tooth.name = tissue + " cube " + number(edge_mm) + " mm";
  return tooth;
}

std::vector<Layer> parse_layers(const std::string& text) {
  std::vector<Layer> layers;
  std::istringstream parts(text);
  std::string part;
  while (std::getline(parts, part, ',')) {
    const auto colon = part.find(':');
    Layer layer{part.substr(0, colon), 0.0};
    const char* end = part.data() + part.size();
    const char* from = colon == std::string::npos ? end : part.data() + colon + 1;
    const auto read = std::from_chars(from, end, layer.thickness_mm);
    if (read.ec != std::errc{} || read.ptr != end)
      throw Error("--layers", "cannot read '" + part + "'", "write name:thickness, such as enamel:1.2,dentin:2.0");
    layers.push_back(layer);
  }
  if (layers.empty()) throw Error("--layers", "no layer given", "write name:thickness, such as enamel:1.2,dentin:2.0");
  return layers;
}

}  // namespace cavum
