// The tissues that are known by name, a row each: number, words, what it counts as, colours.
// Makers, importers, contact with what stands beside a tooth, sections, keys, reports and the
// station's picture take them from here. Stiffness and removal are the force model's
// (data/materials). A tooth's own table may name others: they are solid, count as tooth, and have
// the colours that stand here where a row gives none.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "engine/base/text.h"

namespace cavum {

/// Tissue labels with fixed numbers; up to 255 in all, further ones are listed in the tooth's
/// table.
enum TissueId : std::uint8_t {
  k_air = 0,
  k_enamel = 1,
  k_dentin = 2,
  k_pulp = 3,
  k_periodontium = 4
};
/// Of what stands beside a tooth (adjacent.h), where a tooth's own table leaves these numbers free.
inline constexpr std::uint8_t k_neighbour_enamel = 12, k_neighbour_dentin = 13, k_gingiva = 14;

/// What it counts as.
enum class TissueKind : std::uint8_t { tooth, pulp, around, gum, neighbour };

struct KnownTissue {
  using Rgb = std::array<float, 3>;
  const char* name = "";    ///< in files, JSON and sessions
  std::uint8_t id = k_air;  ///< air: the next number that a tooth's table leaves free
  bool solid = true;
  TissueKind kind = TissueKind::tooth;
  /// In sections and reports: as a rule, for stronger contrasts, and under what many did; then
  /// behind the curves of a chart.
  const char *usual = "#d8c7e0", *strong = "#b58bd0", *grey = "#e0e0e0", *behind = "#f1f1f1";
  /// In the station's clear light (sRGB, 0..1), and for stronger contrasts. Told apart by lightness
  /// as well as by hue.
  Rgb lit{0.62F, 0.52F, 0.70F}, lit_strong = lit;
  const char* words = name;  ///< what people read in a key
};

/// The four that every tooth lists first, in the order of their numbers; what a maker adds; what
/// only files of teeth name.
// clang-format off
inline constexpr KnownTissue k_tissues[] = {
    {noop("enamel"), k_enamel, true, TissueKind::tooth, "#eef2f6", "#ffffff", "#f7f7f7", "#eef3f8", {0.93F, 0.925F, 0.895F}, {1, 1, 1}},
    {noop("dentin"), k_dentin, true, TissueKind::tooth, "#f2dfa6", "#ffd95a", "#e9e9e9", "#faf3e3", {0.86F, 0.70F, 0.43F}, {0.95F, 0.70F, 0.16F}},
    {noop("pulp"), k_pulp, false, TissueKind::pulp, "#e7a6a1", "#c0143c", "#cfcfcf", "#fbe9ea", {0.70F, 0.20F, 0.20F}, {0.62F, 0.02F, 0.14F}},
    {noop("periodontium"), k_periodontium, false, TissueKind::around, "#cfd8cf", "#9aa39a", "#dddddd", "#f1f1f1", {0.80F, 0.55F, 0.55F}},
    {.name = noop("lesion"), .lit = {0.58F, 0.40F, 0.22F}, .lit_strong = {0.45F, 0.25F, 0.05F}, .words = noop("caries")},
    {"neighbour_enamel", k_neighbour_enamel, true, TissueKind::neighbour, "#c9d6e3", "#a9c6ee", "#ececec", "#f1f1f1",
     {0.62F, 0.70F, 0.78F}, {0.35F, 0.55F, 0.80F}, noop("neighbour's enamel")},
    {"neighbour_dentin", k_neighbour_dentin, true, TissueKind::neighbour, "#b7c2cf", "#7f9cc4", "#e4e4e4", "#f1f1f1",
     {0.62F, 0.70F, 0.78F}, {0.35F, 0.55F, 0.80F}, noop("neighbour's dentin")},
    {noop("gingiva"), k_gingiva, true, TissueKind::gum, "#efb8b8", "#ff9fb5", "#d8d8d8", "#f1f1f1",
     {0.84F, 0.48F, 0.50F}, {0.80F, 0.30F, 0.45F}, noop("gum")},
    {noop("bone")},
    {noop("caries")},
    {noop("cement")},
    {noop("cementum")},
    {noop("composite")},
};
// clang-format on

inline constexpr std::string_view k_neighbour_prefix = "neighbour_";

/// By its name. One without a row: what the fields above are when left out; of a neighbour, as it
/// begins, his enamel.
[[nodiscard]] constexpr KnownTissue known_tissue(std::string_view name) noexcept {
  for (const KnownTissue& t : k_tissues)
    if (name == t.name) return t;
  return name.starts_with(k_neighbour_prefix) ? known_tissue("neighbour_enamel") : KnownTissue();
}
/// By the number that it has of its own.
[[nodiscard]] constexpr KnownTissue known_tissue(std::uint8_t id) noexcept {
  for (const KnownTissue& t : k_tissues)
    if (id != k_air && id == t.id) return t;
  return {};
}

}  // namespace cavum
