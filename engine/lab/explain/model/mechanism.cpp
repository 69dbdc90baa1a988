#include "engine/lab/explain/model/mechanism.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace cavum::explain {
namespace {

/// What a record leaves out.
void complete(Mechanism& m) {
  m.term = find_term_kind(m.name);
  if (!m.grid && m.shape.empty())
    m.grid = [](const Scene&) { return std::vector<std::vector<double>>(1); };
  const bool all_fitted =
      std::all_of(m.shape.begin(), m.shape.end(), [](const ShapeRange& s) { return s.fitted; });
  if (m.parameters || (m.coefficients.empty() && m.shape.empty())) return;
  m.parameters = [names = m.coefficients, ranges = m.shape](const auto& shape, const auto& own,
                                                            Base) {
    std::vector<NamedValue> out;
    for (std::size_t i = 0; i < std::min(names.size(), own.size()); ++i)
      out.push_back({names[i], own[i]});
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (ranges[i].fitted) out.push_back({ranges[i].name, shape[i]});
    return out;
  };
  if (m.term == nullptr || m.from_term || !all_fitted) return;
  m.from_term = [names = m.coefficients, ranges = m.shape](const TermReader& value, Base) {
    Numbers n;
    for (const ShapeRange& s : ranges) n.shape.push_back(value(s.name));
    for (const char* name : names) n.own.push_back(value(name));
    return std::optional(n);
  };
}

/// Throws std::logic_error on a record that cannot be used.
void check(const std::vector<Mechanism>& all) {
  const auto wrong = [](const std::string& what) {
    throw std::logic_error("table of laws: " + what);
  };
  std::set<std::string> names;
  for (const auto& m : all) {
    for (const char* text : {m.name, m.equation, m.words, m.separate})
      if (text == nullptr)
        wrong(fmt::format("{} lacks a text", m.name != nullptr ? m.name : "a record"));
    const std::string name = m.name;
    if (!names.insert(name).second) wrong("two are called " + name);
    if (!m.grid || !m.columns || !m.parameters) wrong(name + " lacks a function");
    if (m.simpler)
      if (const auto fewer = m.simpler(std::vector<double>(m.shape.size(), 1.0));
          !fewer.empty() && fewer.size() != m.shape.size())
        wrong(name + " says its law with fewer numbers in another number of shapes");
    if (m.term == nullptr) {
      if (m.from_term || m.shape_in_term) wrong(name + " has no force term, and speaks of one");
      continue;
    }
    if (!m.from_term && !m.from_residual) wrong(name + " cannot be read from its force term");
  }
  for (const auto& m : all)
    for (const char* other : {m.variant_of, m.like_when_short})
      if (other != nullptr && !names.contains(other))
        wrong(fmt::format("{} speaks of {}, which is not there", m.name, other));
  for (const auto& kind : term_kinds())
    if (!names.contains(kind.name)) wrong(fmt::format("the force term {} is no law", kind.name));
}

}  // namespace

const std::vector<Mechanism>& mechanisms() {
  static const std::vector<Mechanism> all = [] {
    std::vector<Mechanism> found;
    for (const auto family : {offset_mechanisms, friction_mechanisms, sensor_mechanisms,
                              play_mechanisms, tissue_mechanisms, cutting_mechanisms})
      for (auto& m : family()) {
        complete(m);
        found.push_back(std::move(m));
      }
    check(found);
    return found;
  }();
  return all;
}

std::vector<std::vector<double>> starts(const Mechanism& m, const Scene& scene) {
  const auto there = [&](const char* column) { return scene.recording->column(column) != nullptr; };
  if (!m.needs.empty() && std::none_of(m.needs.begin(), m.needs.end(), there)) return {};
  return m.grid(scene);
}

std::vector<ShapeRange> ranges_of(const Mechanism& m, const Scene& scene) {
  std::vector<ShapeRange> out = m.shape;
  if (!m.ends || out.empty()) return out;
  const auto [low, high] = m.ends(scene);
  out[0].low = std::clamp(low, out[0].low, out[0].high);
  out[0].high = std::clamp(high, out[0].low, out[0].high);
  return out;
}

bool makes_sense(const Mechanism& m, const double* own, std::size_t count) {
  return std::all_of(own, own + count, [&](double v) { return v > m.own.low && v < m.own.high; });
}

std::size_t session_groups(const Recording& r) {
  return r.sessions.size() <= 12 ? std::max<std::size_t>(1, r.sessions.size()) : 1;
}

int law_of(int at) {
  const char* law = mechanism_at(at).variant_of;
  return law != nullptr ? known_mechanism(law) : at;
}

int find_mechanism(const std::string& name) {
  const auto& all = mechanisms();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (name == all[i].name) return static_cast<int>(i);
  return -1;
}

int known_mechanism(const std::string& name) {
  const int at = find_mechanism(name);
  if (at < 0) throw std::logic_error(fmt::format("there is no mechanism '{}'", name));
  return at;
}

}  // namespace cavum::explain
