#include "engine/tooth/anatomy/landmarks_file.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/json_reader.h"

namespace cavum {
namespace {

using Kept = nlohmann::json;

constexpr double k_furthest_landmark_mm = 1000.0;
constexpr std::size_t k_most_landmark_points = 20'000;
constexpr JsonLimits k_landmark_json{8U << 20, 400'000, 8};
constexpr std::array<ToothClass, 5> k_classes{ToothClass::unknown, ToothClass::incisor, ToothClass::canine, ToothClass::premolar, ToothClass::molar};

Kept written(double number) { return number; }
Kept written(const std::string& text) { return text; }
Kept written(Vec3 p) { return Kept::array({p.x, p.y, p.z}); }
Kept written(ToothClass kind) { return std::string(name_of(kind)); }
Kept written(const CuspTip& c) { return {{"name", c.name}, {"tip_mm", written(c.tip_mm)}, {"prominence_mm", c.prominence_mm}}; }
Kept written(const CanalOpening& o) { return {{"at_mm", written(o.at_mm)}, {"radius_mm", o.radius_mm}}; }
template <class One>
Kept written(const std::optional<One>& one) {
  return one ? written(*one) : Kept(nullptr);
}
template <class One>
Kept written(const std::vector<One>& all) {
  Kept list = Kept::array();
  for (const auto& one : all) list.push_back(written(one));
  return list;
}

/// Reads values that `written` made; every refusal names its key.
class Reader {
 public:
  Reader(const Kept& object, const std::string& where) : object_(object), where_(where) {}

  template <class One>
  void get(const char* key, One& out) const {
    const auto at = object_.is_object() ? object_.find(key) : object_.end();
    if (at == object_.end()) refuse(FileError::missing, key, msg("is missing"));
    read(key, *at, out);
  }

 private:
  [[noreturn]] void refuse(FileError code, const std::string& key, const Message& what) const {
    throw Error(code, Name{where_}, msg("'{}' {}", key, what), msg("the file was changed or is damaged: use the original"));
  }
  void read(const char* key, const Kept& from, double& out) const {
    if (!from.is_number() || !(std::fabs(from.get<double>()) <= k_furthest_landmark_mm))
      refuse(FileError::wrong_type, key, msg("is no number of at most 1000"));
    out = from.get<double>();
  }
  void read(const char* key, const Kept& from, std::string& out) const {
    if (!from.is_string()) refuse(FileError::wrong_type, key, msg("is no text"));
    out = from.get<std::string>();
  }
  void read(const char* key, const Kept& from, ToothClass& out) const {
    std::string name;
    read(key, from, name);
    for (const ToothClass kind : k_classes)
      if (name == name_of(kind)) {
        out = kind;
        return;
      }
    refuse(FileError::wrong_type, key, msg("is no class of teeth"));
  }
  void read(const char* key, const Kept& from, Vec3& out) const {
    if (!from.is_array() || from.size() != 3) refuse(FileError::wrong_type, key, msg("is no point of three numbers"));
    read(key, from[0], out.x);
    read(key, from[1], out.y);
    read(key, from[2], out.z);
  }
  void read(const char* /*key*/, const Kept& from, CuspTip& out) const {
    const Reader r(from, where_);
    r.get("name", out.name);
    r.get("tip_mm", out.tip_mm);
    r.get("prominence_mm", out.prominence_mm);
  }
  void read(const char* /*key*/, const Kept& from, CanalOpening& out) const {
    const Reader r(from, where_);
    r.get("at_mm", out.at_mm);
    r.get("radius_mm", out.radius_mm);
  }
  template <class One>
  void read(const char* key, const Kept& from, std::optional<One>& out) const {
    out.reset();
    if (!from.is_null()) read(key, from, out.emplace());
  }
  template <class One>
  void read(const char* key, const Kept& from, std::vector<One>& out) const {
    if (!from.is_array() || from.size() > k_most_landmark_points)
      refuse(from.is_array() ? FileError::too_large : FileError::wrong_type, key, msg("is no list of at most {}", k_most_landmark_points));
    out.clear();
    for (const auto& one : from) read(key, one, out.emplace_back());
  }

  const Kept& object_;
  const std::string& where_;
};

/// Every field that is kept, by its name: the one list for writing and reading.
template <class Marks, class Visit>
void each_field(Marks& l, const Visit& visit) {
  visit("tooth_class", l.tooth_class.kind);
  visit("axis_through_mm", l.long_axis.through_mm);
  visit("axis_occlusal", l.long_axis.occlusal);
  visit("axis_tilt_deg", l.long_axis.tilt_deg);
  visit("cusps", l.cusps);
  visit("cusp_ridges", l.cusp_ridges);
  visit("mesial_ridge_crest_mm", l.mesial_ridge.crest_mm);
  visit("mesial_ridge_lowest_mm", l.mesial_ridge.lowest_mm);
  visit("distal_ridge_crest_mm", l.distal_ridge.crest_mm);
  visit("distal_ridge_lowest_mm", l.distal_ridge.lowest_mm);
  visit("central_fissure_mm", l.central_fissure_mm);
  visit("fissure_branches_mm", l.fissure_branches_mm);
  visit("mesial_pit_mm", l.mesial_pit_mm);
  visit("central_pit_mm", l.central_pit_mm);
  visit("distal_pit_mm", l.distal_pit_mm);
  visit("incisal_edge_mm", l.incisal_edge_mm);
  visit("occlusal_table_mm", l.occlusal_table_mm);
  visit("height_of_contour_mm", l.height_of_contour_mm);
  visit("neck_mm", l.neck_mm);
  visit("pulp_horns_mm", l.pulp_horns_mm);
  visit("chamber_roof_mm", l.chamber_roof_mm);
  visit("chamber_floor_mm", l.chamber_floor_mm);
  visit("canal_mouths", l.canal_mouths);
  visit("apices_mm", l.apices_mm);
  visit("moved", l.moved);
}

}  // namespace

std::string landmarks_text(const Landmarks& landmarks) {
  Kept all = Kept::object();
  each_field(landmarks, [&](const char* key, const auto& field) { all[key] = written(field); });
  return all.dump();  // the shortest digits that give each double back
}

Landmarks parse_landmarks(std::string_view text, const std::string& where) {
  const Kept all = parse_json(text, where, k_landmark_json);
  Landmarks l;
  const Reader reader(all, where);
  each_field(l, [&](const char* key, auto& field) { reader.get(key, field); });
  return l;
}

}  // namespace cavum
