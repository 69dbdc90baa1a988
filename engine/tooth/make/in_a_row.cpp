#include "engine/tooth/make/in_a_row.h"

#include <algorithm>
#include <optional>

namespace cavum {
namespace {

constexpr double k_sure_class = 0.6;  // a class guessed less surely contradicts nobody
constexpr int k_last_place = 8;

/// Places from the midline, 1 to 8; none: 0 to 0.
struct Places {
  int first = 0, last = 0;
};

/// As it was said, else by the shape.
ToothClass class_of(const RowTooth& tooth) {
  if (tooth.kind.tooth_class != ToothClass::unknown) return tooth.kind.tooth_class;
  return tooth.shape.probability < k_sure_class ? ToothClass::unknown : tooth.shape.kind;
}

/// Where a tooth may stand. By shape alone incisors and canines pass for one another.
Places places_of(const RowTooth& tooth) {
  if (const auto& n = tooth.kind.number) return {n->place(), n->place()};
  switch (class_of(tooth)) {
    case ToothClass::incisor:
    case ToothClass::canine:
      return {1, 3};
    case ToothClass::premolar:
      return {4, 5};
    case ToothClass::molar:
      return {6, k_last_place};
    default:
      return {};
  }
}

Message words_for(const RowTooth& tooth) {
  if (const auto& n = tooth.kind.number) return msg("tooth {}", n->fdi);
  return msg("'{}', by its shape {}", tooth.name, in_words(tooth.shape.kind));
}

/// By numbers alone; none where one of them was not said.
std::optional<RowVerdict> by_numbers(const RowTooth& tooth, const RowTooth& beside, int side) {
  const auto &n = tooth.kind.number, &other = beside.kind.number;
  if (!n || !other) return std::nullopt;
  if (side > 0 && n->place() == 1)
    return RowVerdict{
        msg("mesial of tooth {} stands {}, and they meet with their mesial surfaces: here the neighbour's distal one would meet it",
            n->fdi, n->other_side().fdi),
        {}};
  if (side < 0 && n->place() == k_last_place)
    return RowVerdict{msg("no tooth stands distal of tooth {}", n->fdi), {}};
  const int wanted = n->fdi - side;
  if (other->fdi == wanted) return RowVerdict{};
  return RowVerdict{side > 0 ? msg("mesial of tooth {} stands tooth {}, and this is tooth {}",
                                   n->fdi, wanted, other->fdi)
                             : msg("distal of tooth {} stands tooth {}, and this is tooth {}",
                                   n->fdi, wanted, other->fdi),
                    {}};
}

}  // namespace

RowVerdict stand_in_a_row(const RowTooth& tooth, const RowTooth& beside, int side) {
  if (const auto verdict = by_numbers(tooth, beside, side)) return *verdict;
  const Jaw jaw = tooth.kind.jaw, other_jaw = beside.kind.jaw;
  if (jaw != Jaw::unknown && other_jaw != Jaw::unknown && jaw != other_jaw)
    return {jaw == Jaw::upper
                ? msg("'{}' is an upper tooth and '{}' a lower one", tooth.name, beside.name)
                : msg("'{}' is a lower tooth and '{}' an upper one", tooth.name, beside.name),
            {}};
  const Places own = places_of(tooth), other = places_of(beside);
  if (own.first == 0)
    return {
        {},
        msg("whether '{}' may stand beside '{}' could not be checked: the tooth's class is not told",
            beside.name, tooth.name)};
  if (other.first == 0)
    return {{},
            msg("whether '{}' may stand beside '{}' could not be checked: its class is not told",
                beside.name, tooth.name)};
  if (std::max(own.first - side, other.first) > std::min(own.last - side, other.last))
    return {side > 0
                ? msg("no tooth like {} stands mesial of {}", words_for(beside), words_for(tooth))
                : msg("no tooth like {} stands distal of {}", words_for(beside), words_for(tooth)),
            {}};
  const auto made = [](const RowTooth& t) {
    return t.kind.tooth_class != ToothClass::unknown && !t.kind.number;
  };  // by us: without a number
  if (made(tooth) && made(beside)) return {};
  return {
      {},
      msg("whether '{}' is the very neighbour of '{}' was not checked: their numbers were not both said",
          beside.name, tooth.name)};
}

}  // namespace cavum
