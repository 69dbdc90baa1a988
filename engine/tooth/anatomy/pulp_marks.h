// The pulp's horns, the chamber's roof and floor, where canals begin, and the ends of the roots. In
// the crown's frame, mm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/tooth/anatomy/crown_frame.h"
#include "engine/tooth/anatomy/landmarks.h"

namespace cavum {

struct PulpMarks {
  std::vector<Vec3> horns;
  std::optional<Vec3> roof, floor;
  std::vector<CanalOpening> mouths;
  std::vector<Message> notes;
};

/// `neck_z`: mean height of the neck, where a single canal's mouth lies; none: such a canal has no
/// mouth. `front`: an incisor or canine, whose chamber has no roof but between its horns.
[[nodiscard]] PulpMarks find_pulp_marks(const Tooth& tooth, const CrownFrame& frame,
                                        std::uint8_t pulp, std::optional<double> neck_z,
                                        bool front);

/// Ends of the roots: the lowest places of the solid tissue that hang at least 1 mm below where
/// they join others, below `neck_z`. An end that is flat (1 mm2 and more within 0.1 mm) was cut or
/// broken: it is no apex, and `notes` says so.
[[nodiscard]] std::vector<Vec3> find_apices(const Tooth& tooth, const CrownFrame& frame,
                                            double neck_z, std::vector<Message>& notes);

}  // namespace cavum
