#include "tests/hands/drill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "engine/device/simulated_omni.h"
#include "engine/tooth/fill.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum::hands {
namespace {

using namespace testing_engine;

constexpr std::int64_t k_longest_ticks = 60000;
constexpr double k_start_mm = 3.0;  // above the entry

struct KnownTooth {
  Tooth tooth, filled;
  std::array<bool, 256> voids{};
  bool block = false;
};

Tooth raw_tooth(const std::string& name) {
  const auto file = [](const char* n) {
    return load_tooth_file(std::string(CAVUM_SOURCE_DIR) + "/data/teeth/" + n);
  };
  if (name == "molar") return file("lower_molar.cvt");
  if (name == "premolar") return file("upper_premolar.cvt");
  if (name == "incisor") return file("upper_incisor.cvt");
  if (name == "molar with a lesion") return file("molar_lesion.cvt");
  if (name == "thin roof")
    return make_block({6, 6, 5}, {{"enamel", 0.6}, {"dentin", 0.9}, {"pulp", 1.5}, {"dentin", 2.0}},
                      0.05);
  if (name == "shallow chamber")
    return make_block({6, 6, 5}, {{"enamel", 1.0}, {"dentin", 1.0}, {"pulp", 0.4}, {"dentin", 2.6}},
                      0.05);
  if (name == "furcation")
    return make_block({6, 6, 5}, {{"dentin", 2.0}, {"periodontium", 0.3}, {"dentin", 2.7}}, 0.05);
  if (name == "lesion over the pulp")
    return make_block({6, 6, 5},
                      {{"enamel", 0.8},
                       {"dentin", 0.5},
                       {"lesion", 0.8},
                       {"dentin", 0.5},
                       {"pulp", 1.0},
                       {"dentin", 1.4}},
                      0.05);
  throw std::logic_error("no tooth " + name);
}

const KnownTooth& tooth_named(const std::string& name) {
  static std::mutex mutex;
  static std::map<std::string, KnownTooth> known;
  const std::scoped_lock lock(mutex);
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  KnownTooth k;
  k.tooth = raw_tooth(name);
  for (const auto& t : k.tooth.tissues) k.voids[t.id] = !t.solid;
  k.filled = filled_tooth(k.tooth, k.voids);
  k.block = k.tooth.octree.size().x * k.tooth.octree.leaf_mm() < 6.5 && name != "premolar" &&
            name != "incisor";
  return known.emplace(name, std::move(k)).first->second;
}

struct Way {
  Vec3 entry, into;
  double void_at_mm = 0.0;  // along the axis; 0: it meets none within 6 mm
};

/// A straight way in, from a place on the surface at which the bur may begin.
std::optional<Way> find_way(const KnownTooth& k, Random& r, double most_tilt_rad) {
  const Octree& o = k.tooth.octree;
  const double tilt = r.uniform(0.0, most_tilt_rad), about = r.uniform(0.0, 6.2832);
  Way w;
  w.into = normalized(
      Vec3{std::sin(tilt) * std::cos(about), std::sin(tilt) * std::sin(about), -std::cos(tilt)});
  const double top = o.origin_mm().z + o.size().z * o.leaf_mm() + 1.0;
  Vec3 at{r.uniform(-2.0, 2.0), r.uniform(-2.0, 2.0), top};
  at = at - w.into * 0.5;
  for (int i = 0; i < 2500 && !o.is_solid(o.tissue_at(at)); ++i) at += w.into * 0.01;
  if (!o.is_solid(o.tissue_at(at))) return std::nullopt;
  w.entry = at;
  for (double d = 0.0; d < 6.0; d += 0.02) {
    const auto t = o.tissue_at(at + w.into * d);
    if (o.is_solid(t)) continue;
    if (t == k_air) return std::nullopt;  // out at the other side
    w.void_at_mm = d;
    return w;
  }
  return w;
}

bool void_near(const KnownTooth& k, Vec3 at, Vec3 into, double depth_mm, double radius_mm) {
  const Vec3 a = normalized(cross(into, Vec3{0.3, 0.7, 0.2})), b = cross(into, a);
  for (double d = 0; d < depth_mm; d += 0.1)
    for (int ring = 0; ring <= 2; ++ring)
      for (int i = 0; i < 12; ++i) {
        const double angle = i * 0.5236, rr = radius_mm * ring / 2.0;
        const auto t = k.tooth.octree.tissue_at(at + into * d + a * (rr * std::cos(angle)) +
                                                b * (rr * std::sin(angle)));
        if (t != k_air && k.voids[t]) return true;
      }
  return false;
}

}  // namespace

Drilled drill(const HandKind& kind, std::uint64_t seed) {
  Random r(seed);
  static constexpr std::array<const char*, 8> teeth{
      "molar",     "premolar",        "incisor",   "molar with a lesion",
      "thin roof", "shallow chamber", "furcation", "lesion over the pulp"};
  Drilled out;
  out.hand = kind.name;
  out.tooth = teeth[r.below(teeth.size())];
  const KnownTooth& known = tooth_named(out.tooth);
  out.before = &known.tooth;
  out.filled = known.filled;
  out.voids = known.voids;
  const auto burs = bur_names();
  out.bur = burs[r.below(burs.size())];
  const Bur bur = shipped_bur(out.bur);
  const bool perforates = r.below(2) == 0;
  Task task;
  task.head_radius_mm = bur.head_radius_mm;
  task.head_length_mm = bur.cutting_length_mm;
  task.width_mm = r.uniform(2.2, 4.0) * bur.head_radius_mm;
  bool found = false;
  for (int i = 0; i < 4000 && !found; ++i) {
    const auto way = find_way(known, r, 0.7);
    if (!way) continue;
    task.entry_mm = way->entry, task.into = way->into;
    if (perforates) {
      if (way->void_at_mm < 0.8 || way->void_at_mm > 4.0) continue;
      task.into_the_chamber = r.below(2) == 0;
      // one who means to stop has the pulp in his way: the plan is wrong, or he goes too deep
      task.depth_mm = way->void_at_mm + r.uniform(-0.05, 0.8);
      found = true;
    } else {
      task.depth_mm = r.uniform(0.6, 2.5);
      found =
          !void_near(known, way->entry, way->into, task.depth_mm + 0.5, 0.5 * task.width_mm + 0.4);
    }
  }
  if (!found)
    return drill(
        kind, seed + 0x9e3779b97f4a7c15ULL);  // this tooth and bur have no such way: another draw
  out.meant_to_open = task.into_the_chamber;
  out.tilt_deg = std::acos(std::clamp(-task.into.z, -1.0, 1.0)) * 57.29578;

  ForceModel force = shipped_model(r.below(2) == 0 ? "paper" : "consistent");
  auto& enamel = force.materials.find("enamel")->second;
  auto& dentin = force.materials.find("dentin")->second;
  auto& lesion = force.materials.find("lesion")->second;
  const double damping =
      enamel.voigt.damping_n_s_per_mm / std::sqrt(enamel.voigt.stiffness_n_per_mm);
  const double k = r.uniform(0.5, 1.2), share = r.uniform(0.6, 1.0), soft = r.uniform(0.2, 0.5);
  enamel.voigt = {k, damping * std::sqrt(k)};
  dentin.voigt = {k * share, damping * std::sqrt(k * share)};
  lesion.voigt = {k * share * soft, damping * std::sqrt(k * share * soft)};
  enamel.tau_s = r.uniform(1.6, 2.4);
  dentin.tau_s = enamel.tau_s * r.uniform(0.8, 1.0);
  lesion.tau_s = dentin.tau_s * r.uniform(0.4, 0.8);

  for (const auto& t : known.tooth.tissues)
    if (t.solid && known.tooth.octree.count_leaves()[t.id] > 0) {
      const Material& m = force.materials.find(t.name)->second;
      out.solids.emplace_back(m.voigt.stiffness_n_per_mm, m.tau_s);
    }
  OmniModel omni;
  static constexpr std::array<double, 4> frictions{0.0, 0.1, 0.26, 0.45},
      noises{0.0, 0.01, 0.03, 0.05}, quanta{0.0, 0.01, 0.03, 0.055};
  out.friction_n = omni.coulomb_n = frictions[r.below(4)];
  out.noise_n = noises[r.below(4)];
  out.quantum_mm = omni.quantum_mm = quanta[r.below(4)];
  omni.delay_ticks = static_cast<int>(r.below(3));

  ServoConfig config;
  config.position_quantum_mm = omni.quantum_mm;
  const ServoModel model = make_servo_model(known.tooth, {bur}, force, config);
  out.filled_model = make_servo_model(out.filled, {bur}, force, config);
  out.first_tip_mm = task.entry_mm - task.into * k_start_mm;
  ServoState state = make_servo_state(model, known.tooth, out.first_tip_mm);
  OmniState omni_state = make_omni_state(out.first_tip_mm);
  auto hand = kind.make(task, Random(r.next()));
  Random noise(r.next());
  TickInput input =
      make_tick_input({out.first_tip_mm, rotation_between({0, 0, 1}, -task.into)}, 0.0, 0, 0, {});
  TickOutput last;
  for (std::int64_t tick = 0; tick < k_longest_ticks; ++tick) {
    Felt felt{static_cast<double>(tick) * k_tick_s,
              last.rendered_force_n,
              state.contact.proxy_mm,
              omni_state.position_mm,
              last.rpm,
              last.cutting};
    const Doing doing = hand->act(felt);
    if (doing.done) break;
    HandModel grip;
    grip.stiffness_n_per_mm = std::clamp(doing.stiffness_n_per_mm, 0.05, 4.0);
    grip.damping_n_s_per_mm = std::clamp(doing.damping_n_s_per_mm, 0.01, 0.5);
    const Vec3 tip =
        advance_omni(omni, grip, omni_state, last.rendered_force_n, doing.wanted_mm, k_tick_s);
    input = make_tick_input({tip, rotation_between({0, 0, 1}, normalized(doing.handle))},
                            std::clamp(doing.pedal, 0.0, 1.0), k_stylus_fresh | k_pedal_fresh, 0,
                            input);
    last = step(model, state, input);
    TickRecord record = make_tick_record(last);
    out.true_records.push_back(record);
    for (auto& f : record.rendered_un)
      f += static_cast<std::int32_t>(out.noise_n * 1e6 * noise.normal());
    out.inputs.push_back(input);
    out.records.push_back(record);
    for (const auto& leaf : state.removed) out.removed.push_back({tick, leaf});
  }
  out.style = hand->style();
  return out;
}

}  // namespace cavum::hands
