#include "engine/tooth/tooth_source.h"

#include <type_traits>

#include "engine/base/json_struct.h"

namespace cavum {

// clang-format off
CAVUM_JSON_OF(MadeByFormula, (design), (seed), (leaf_mm), (periodontium_mm))
CAVUM_JSON_OF(MadeBlock::Layer, (tissue), (thickness_mm))
CAVUM_JSON_OF(MadeBlock, (layers))
CAVUM_JSON_OF(SourceMesh, (file), (unused_vertices), (turned))
CAVUM_JSON_OF(SourceFrame, (occlusal_given), (occlusal), (mesial_by), (mesial))
CAVUM_JSON_OF(ImportedMeshes, (enamel), (dentin), (pulp), (unit), (leaf_mm), (frame), (overlap_leaves), (gap_leaves), (periodontium_mm))
CAVUM_JSON_OF(VoxelSpacing, (by), (mm))
CAVUM_JSON_OF(GrayPeaks, (medium), (pulp), (dentin), (enamel))
CAVUM_JSON_OF(GrayReading, (dentin_from), (enamel_from), (dentin_given), (enamel_given), (peaks), (specks), (pores), (rim_percent))
CAVUM_JSON_OF(ImportedVolume, (file), (gray), (spacing), (leaf_mm), (frame), (periodontium_mm))
CAVUM_JSON_OF(LesionPlanted, (centre_mm), (radii_mm), (surface), (width_mm), (depth_mm))
CAVUM_JSON_OF(NeighbourSet, (mesial), (name), (turn_deg), (gap_mm), (at_mm))
void json_fields(auto&, JsonOf<GumSet> auto&) {}
// clang-format on

namespace {

using nlohmann::json;

Message in_words(ToothDesign design) {
  switch (design) {
    case ToothDesign::molar:
      return msg("lower first molar");
    case ToothDesign::premolar:
      return msg("upper second premolar");
    case ToothDesign::incisor:
      break;
  }
  return msg("upper central incisor");
}

Message periodontium(double mm) {
  return mm > 0 ? msg("periodontium {} around the roots", as_mm(mm, k_as_needed))
                : msg("no periodontium");
}

List sentences(std::vector<Message> items) {
  std::erase_if(items, [](const Message& m) { return m.empty(); });
  return {std::move(items), true};
}

Message direction(Vec3 v) {
  return msg("({} {} {})", as_number(v.x, 3), as_number(v.y, 3), as_number(v.z, 3));
}

Message in_words(const SourceFrame& f) {
  const Message occlusal = f.occlusal_given ? msg("occlusal axis given {}", direction(f.occlusal))
                                            : msg("occlusal axis from dentin to enamel centroid {}",
                                                  direction(f.occlusal));
  switch (f.mesial_by) {
    case SourceFrame::Mesial::given:
      return msg("{}, mesial axis given {}", occlusal, direction(f.mesial));
    case SourceFrame::Mesial::file_x:
      return msg("{}, mesial axis assumed along the file's x {}", occlusal, direction(f.mesial));
    case SourceFrame::Mesial::file_y:
      break;
  }
  return msg("{}, mesial axis assumed along the file's y {}", occlusal, direction(f.mesial));
}

Message put_right(const SourceMesh& mesh) {
  const Message unused =
      msgn("{}: {} unused vertex deleted", "{}: {} unused vertices deleted",
           static_cast<std::int64_t>(mesh.unused_vertices), mesh.file, mesh.unused_vertices);
  const Message turned = msg("{}: the faces looked inwards and were turned", mesh.file);
  if (mesh.unused_vertices == 0) return mesh.turned ? turned : Message();
  return mesh.turned ? msg("{}; {}", unused, turned) : unused;
}

Message in_words(const GrayReading& g) {
  const auto by = [](bool given) { return given ? msg("given") : msg("found"); };
  const auto whole = [](double gray) { return as_number(gray, 0); };
  const Message found =
      g.peaks ? msg("gray levels: medium {}, pulp {}, dentin {}, enamel {}", whole(g.peaks->medium),
                    whole(g.peaks->pulp), whole(g.peaks->dentin), whole(g.peaks->enamel))
              : Message();
  return msg(
      "{}", sentences({found,
                       msg("thresholds: dentin {} ({}), enamel {} ({})", whole(g.dentin_from),
                           by(g.dentin_given), whole(g.enamel_from), by(g.enamel_given)),
                       msg("loose specks ignored: {}; voxels of pores filled: {}; rim {}", g.specks,
                           g.pores, as_percent(g.rim_percent, 2))}));
}

Message words_of(const MadeByFormula& t) {
  const Message design = in_words(t.design);
  return msg("{}; leaf {}; {}",
             t.seed ? msg("{} of Cavum, seed {}", design, std::to_string(*t.seed))
                    : msg("parametric {} of Cavum", design),
             as_mm(t.leaf_mm, k_as_needed), periodontium(t.periodontium_mm));
}
Message words_of(const MadeBlock& b) {
  List layers;
  for (const auto& layer : b.layers)
    layers.items.push_back(
        msg("{} {}", Term{layer.tissue}, as_mm(layer.thickness_mm, k_as_needed)));
  return msg("block; layers from the top: {}; origin at the centre of the top face", layers);
}
Message words_of(const ImportedMeshes& m) {
  return msg(
      "{}",
      sentences(
          {msg("meshes {}, {}, {}", m.enamel.file, m.dentin.file, m.pulp.file),
           m.unit.empty() ? msg("unit mm assumed") : msg("unit given: {}", m.unit),
           msg("leaf {}", as_mm(m.leaf_mm, k_as_needed)), in_words(m.frame),
           msg("overlaps (pulp, enamel, dentin) {} leaves, gaps to the nearer hard tissue {} leaves",
               m.overlap_leaves, m.gap_leaves),
           periodontium(m.periodontium_mm), put_right(m.enamel), put_right(m.dentin),
           put_right(m.pulp)}));
}
Message words_of(const ImportedVolume& v) {
  return msg("{}", sentences({v.gray ? msg("CT volume {}", v.file) : msg("label map {}", v.file),
                              v.gray ? in_words(*v.gray) : Message(), in_words(v.spacing),
                              msg("leaf {}", as_mm(v.leaf_mm, k_as_needed)), in_words(v.frame),
                              periodontium(v.periodontium_mm)}));
}
Message words_of(const LesionPlanted& l) {
  const Message where = msg("lesion in the dentin around {}, radii {}", l.centre_mm, l.radii_mm);
  if (l.surface.empty()) return where;
  return msg("{}: {}, {} wide, {} into dentin", where, Term{l.surface}, as_mm(l.width_mm, 1),
             as_mm(l.depth_mm, 1));
}
Message words_of(const NeighbourSet& n) {
  const Message from = msg("{} from it at {}", as_mm(n.gap_mm, 3), n.at_mm);
  const Message side =
      n.mesial ? msg("mesial neighbour '{}'", n.name) : msg("distal neighbour '{}'", n.name);
  return n.turn_deg != 0 ? msg("{} turned by {}, {}", side, as_deg(n.turn_deg, k_as_needed), from)
                         : msg("{}, {}", side, from);
}
Message words_of(const GumSet&) { return msg("gum"); }

template <class... Kinds>
bool read_entry(const std::string& kind, const json& from, const JsonLocation& at,
                std::variant<Kinds...>& out) {
  return (
      (kind == Kinds::k_kind && (read_json_value(from, at, out.template emplace<Kinds>()), true)) ||
      ...);
}

}  // namespace

ToothKind kind_of(ToothDesign design) {
  switch (design) {
    case ToothDesign::molar:
      return {Jaw::lower, ToothClass::molar};
    case ToothDesign::premolar:
      return {Jaw::upper, ToothClass::premolar};
    case ToothDesign::incisor:
      break;
  }
  return {Jaw::upper, ToothClass::incisor};
}

Message in_words(const VoxelSpacing& s) {
  const Message mm =
      msg("{} x {} x {}", as_number(s.mm.x), as_number(s.mm.y), as_mm(s.mm.z, k_as_needed));
  switch (s.by) {
    case VoxelSpacing::By::given:
      return msg("spacing given: {}", mm);
    case VoxelSpacing::By::file:
      return msg("spacing from the file: {}", mm);
    case VoxelSpacing::By::assumed:
      break;
  }
  return msg("spacing assumed: {} (the file gives none); sizes and volumes are not measured", mm);
}

Message in_words(const ToothEntry& entry) {
  return std::visit([](const auto& e) { return words_of(e); }, entry);
}

json encode(const ToothEntry& entry) {
  return std::visit(
      [](const auto& e) {
        json out = to_json_value(e);
        out["kind"] = std::remove_cvref_t<decltype(e)>::k_kind;
        return out;
      },
      entry);
}

ToothEntry decode_tooth_entry(const json& from, const Where& where) {
  const JsonSource source{where, msg("use an intact copy")};
  const JsonLocation at{source};
  at.require(from.is_object() && from.contains("kind") && from["kind"].is_string(),
             msg("is no entry of a tooth's source"));
  json rest = from;
  rest.erase("kind");
  ToothEntry entry;
  at.require(read_entry(from["kind"].get<std::string>(), rest, at, entry),
             msg("is no kind of entry of a tooth's source"), FileError::unknown);
  return entry;
}

}  // namespace cavum
