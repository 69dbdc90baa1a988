// What a tooth was made from, and every assumption made on the way, as a tooth file keeps it: one
// entry for each thing that was done to it, in order.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/where.h"
#include "engine/tooth/tooth_number.h"

namespace cavum {

/// A tooth of Cavum's own.
enum class ToothDesign : std::uint8_t { molar, premolar, incisor };
inline constexpr std::array k_tooth_designs{"molar", "premolar", "incisor"};
[[nodiscard]] constexpr auto names_of(ToothDesign) { return k_tooth_designs; }
[[nodiscard]] ToothKind kind_of(ToothDesign design);

struct MadeByFormula {
  static constexpr char k_kind[] = "formula";
  ToothDesign design{};
  std::optional<std::uint64_t> seed;  ///< of an individual; none: the parametric tooth
  double leaf_mm = 0.0;
  double periodontium_mm = 0.0;  ///< around the roots; 0: none
};
struct MadeBlock {
  static constexpr char k_kind[] = "block";
  /// One layer of a block. `pulp` and `periodontium` are not solid: a layer of them is a cavity,
  /// open at the block's sides. A name outside the standard four becomes a new solid tissue with
  /// the next free id (>= 5).
  struct Layer {
    std::string tissue;
    double thickness_mm = 0.0;  ///< > 0
  };
  std::vector<Layer> layers;  ///< from the top, at whose centre the origin lies
};

/// A closed surface as it was read, and what was put right on the way.
struct SourceMesh {
  std::string file;  ///< name without folder
  std::uint64_t unused_vertices = 0;
  bool turned = false;  ///< its faces looked inwards
};
/// The tooth's axes in the frame of the file, unit vectors.
struct SourceFrame {
  /// Where mesial is not given, the file's x is taken for it, or its y where the x stands upright.
  enum class Mesial : std::uint8_t { given, file_x, file_y };
  bool occlusal_given = false;  ///< else from the dentin's centroid to the enamel's
  Vec3 occlusal;
  Mesial mesial_by{};
  Vec3 mesial;
};
[[nodiscard]] constexpr auto names_of(SourceFrame::Mesial) {
  return std::array{"given", "file_x", "file_y"};
}
struct ImportedMeshes {
  static constexpr char k_kind[] = "meshes";
  SourceMesh enamel, dentin, pulp;
  std::string unit;  ///< given; empty: mm were assumed
  double leaf_mm = 0.0;
  SourceFrame frame;
  std::uint64_t overlap_leaves = 0;  ///< given to pulp, enamel, dentin, in this order
  std::uint64_t gap_leaves = 0;      ///< given to the nearer hard tissue
  double periodontium_mm = 0.0;
};

struct VoxelSpacing {
  enum class By : std::uint8_t { given, file, assumed };
  By by{};
  Vec3 mm;
};
[[nodiscard]] constexpr auto names_of(VoxelSpacing::By) {
  return std::array{"given", "file", "assumed"};
}
/// "spacing assumed 0.125 mm …: sizes and volumes are not measured"
[[nodiscard]] Message in_words(const VoxelSpacing& spacing);
/// Grays of the tissues, where their peaks were found.
struct GrayPeaks {
  double medium = 0.0, pulp = 0.0, dentin = 0.0, enamel = 0.0;
};
/// How the tissues of a CT volume were told apart.
struct GrayReading {
  double dentin_from = 0.0, enamel_from = 0.0;
  bool dentin_given = false, enamel_given = false;
  std::optional<GrayPeaks> peaks;       ///< none: both were given
  std::uint64_t specks = 0, pores = 0;  ///< loose ones ignored, voxels of them filled
  double rim_percent = 0.0;
};
struct ImportedVolume {
  static constexpr char k_kind[] = "volume";
  std::string file;                 ///< or folder, name alone
  std::optional<GrayReading> gray;  ///< none: it was a label map
  VoxelSpacing spacing;
  double leaf_mm = 0.0;
  SourceFrame frame;
  double periodontium_mm = 0.0;
};

struct LesionPlanted {
  static constexpr char k_kind[] = "lesion";
  Vec3 centre_mm, radii_mm;
  std::string surface;  ///< of the crown, under which it begins; empty: it was placed by its centre
  double width_mm = 0.0, depth_mm = 0.0;
};
struct NeighbourSet {
  static constexpr char k_kind[] = "neighbour";
  bool mesial = false;
  std::string name;
  double turn_deg = 0.0, gap_mm = 0.0;
  Vec3 at_mm;
};
struct GumSet {
  static constexpr char k_kind[] = "gum";
};

using ToothEntry = std::variant<MadeByFormula, MadeBlock, ImportedMeshes, ImportedVolume,
                                LesionPlanted, NeighbourSet, GumSet>;
using ToothSource = std::vector<ToothEntry>;

/// What was done, for people.
[[nodiscard]] Message in_words(const ToothEntry& entry);
/// An object with the kind and its members.
[[nodiscard]] nlohmann::json encode(const ToothEntry& entry);
/// Throws Error at `where` for what `encode` does not write.
[[nodiscard]] ToothEntry decode_tooth_entry(const nlohmann::json& from, const Where& where);

}  // namespace cavum
