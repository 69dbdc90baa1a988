#include "engine/tooth/make/make_block.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/where.h"
#include "engine/tooth/distance.h"

namespace cavum {
namespace {

constexpr int k_margin_leaves = 4;
constexpr double k_tie_mm =
    1e-9;  // a centre on a border belongs to the side above it, whatever the rounding

/// Box with half-open sides, mm.
struct Slab {
  Vec3 low, high;
};

/// Signed distance to the surface of a box, mm, negative inside.
double box_distance_mm(const Slab& box, Vec3 p) {
  const Vec3 middle = (box.low + box.high) * 0.5, half = (box.high - box.low) * 0.5;
  const Vec3 d{std::fabs(p.x - middle.x) - half.x, std::fabs(p.y - middle.y) - half.y,
               std::fabs(p.z - middle.z) - half.z};
  const Vec3 out{std::max(d.x, 0.0), std::max(d.y, 0.0), std::max(d.z, 0.0)};
  return length(out) + std::min(std::max({d.x, d.y, d.z}), 0.0);
}

bool holds(double low, double high, double v) { return v >= low - k_tie_mm && v < high - k_tie_mm; }

constexpr double k_rounding_mm = 1e-9;  // 3 * 0.1 is a little more than 0.3

/// Throws unless `mm` can be built of leaves at all; `named` and `option` are the words of the
/// error.
void check_extent(double mm, double leaf_mm, const Where& where, const Message& named,
                  const Message& advice) {
  if (!(mm > 0 && std::isfinite(mm)))
    throw Error(where, msg("{} must be larger than 0 mm", named), advice);
  if (mm < leaf_mm - k_rounding_mm)
    throw Error(where,
                msg("{} is {}, less than a leaf of {}", named, as_mm(mm, k_as_needed),
                    as_mm(leaf_mm, k_as_needed)),
                msg("use a smaller --leaf-mm"));
}

void check_leaf(double leaf_mm, const Where& where) {
  if (!(leaf_mm > 0 && std::isfinite(leaf_mm)))
    throw Error(where, msg("the leaf must be larger than 0 mm"),
                msg("give --leaf-mm 0.05, for example"));
}

void check_tissue_name(const std::string& name, const Where& where) {
  if (!is_plain_text(name))
    throw Error(where,
                msg("the name of a tissue holds a control character or bytes that are no UTF-8"),
                msg("use letters and digits"));
  if (name == "air" || name == "solid" || name.empty())
    throw Error(where, msg("a tissue cannot be named '{}'", name),
                msg("name a tissue: enamel, dentin, pulp, or one of your own"));
}

void check_layers(Vec3 size_mm, const std::vector<Layer>& layers, double leaf_mm,
                  const Where& where) {
  double sum = 0.0;
  for (const auto& layer : layers) {
    check_tissue_name(layer.tissue, where);
    check_extent(layer.thickness_mm, leaf_mm, where, msg("layer '{}'", layer.tissue),
                 msg("give every layer a thickness such as 1.2"));
    sum += layer.thickness_mm;
  }
  if (std::fabs(sum - size_mm.z) > 1e-6)
    throw Error(where,
                msg("the layers are {} together, the height is {}", as_mm(sum, k_as_needed),
                    as_mm(size_mm.z, k_as_needed)),
                msg("make them equal"));
}

/// The tissue of each layer; a name that is new gets the next free number.
std::vector<std::uint8_t> number_tissues(const std::vector<Layer>& layers,
                                         std::vector<Tissue>& tissues, const Where& where) {
  std::vector<std::uint8_t> ids;
  for (const auto& layer : layers) {
    const auto found = std::find_if(tissues.begin(), tissues.end(),
                                    [&](const Tissue& t) { return t.name == layer.tissue; });
    if (found != tissues.end()) {
      ids.push_back(found->id);
      continue;
    }
    if (tissues.size() >= 255)
      throw Error(where, msg("more than 255 tissues"), msg("use fewer names"));
    ids.push_back(static_cast<std::uint8_t>(tissues.size() + 1));
    tissues.push_back({ids.back(), layer.tissue, true});
  }
  return ids;
}

}  // namespace

Tooth make_block(Vec3 size_mm, const std::vector<Layer>& layers, double leaf_mm) {
  const Message where = msg("block");
  check_leaf(leaf_mm, where);
  for (const auto& [axis, mm] :
       {std::pair{msg("the length"), size_mm.x}, std::pair{msg("the width"), size_mm.y},
        std::pair{msg("the height"), size_mm.z}})
    check_extent(mm, leaf_mm, where, axis, msg("give --size-mm 10,10,6, for example"));
  check_layers(size_mm, layers, leaf_mm, where);
  Tooth tooth;
  const std::vector<std::uint8_t> ids = number_tissues(layers, tooth.tissues, where);

  const auto half_leaves = [&](double mm) {
    return std::ceil(mm / 2 / leaf_mm - 1e-6) + k_margin_leaves;
  };
  const double nx = half_leaves(size_mm.x), ny = half_leaves(size_mm.y),
               nz = std::ceil(size_mm.z / leaf_mm - 1e-6) + k_margin_leaves;
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
      solids.push_back(
          {{-size_mm.x / 2, -size_mm.y / 2, top[i + 1]}, {size_mm.x / 2, size_mm.y / 2, top[i]}});
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
  tooth.name = fmt::format("block {} x {} x {} mm", plain_number(size_mm.x),
                           plain_number(size_mm.y), plain_number(size_mm.z));
  tooth.source = {MadeBlock{layers}};
  return tooth;
}

Tooth make_cube(double edge_mm, const std::string& tissue, double leaf_mm) {
  check_leaf(leaf_mm, msg("cube"));
  check_tissue_name(tissue, msg("cube"));
  check_extent(edge_mm, leaf_mm, msg("cube"), msg("the edge"),
               msg("give --edge-mm 10, for example"));
  Tooth tooth = make_block({edge_mm, edge_mm, edge_mm}, {{tissue, edge_mm}}, leaf_mm);
  tooth.name = fmt::format("{} cube {} mm", tissue, plain_number(edge_mm));
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
      throw Error("--layers", msg("cannot read '{}'", one_line(part)),
                  msg("write name:thickness, such as enamel:1.2,dentin:2.0"));
    check_tissue_name(layer.tissue, "--layers");
    layers.push_back(layer);
  }
  if (layers.empty())
    throw Error("--layers", msg("no layer given"),
                msg("write name:thickness, such as enamel:1.2,dentin:2.0"));
  return layers;
}

}  // namespace cavum
