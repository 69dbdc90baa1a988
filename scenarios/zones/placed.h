// Bodies that are told by a tooth's landmarks, placed on one tooth: the same scenario moves to
// another tooth.
#pragma once

#include <string>

#include "engine/base/message.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "scenarios/file/scenario.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

/// Whether a body of the target or of what is protected is told by landmarks.
[[nodiscard]] bool follows_landmarks(const ZoneSpec& zones) noexcept;

/// `build_zones` (zone_map.h) by landmarks that are known already: those of the same tooth in finer
/// leaves, say.
[[nodiscard]] ZoneMap build_zones(const Scenario& scenario, const Tooth& tooth,
                                  const Landmarks& landmarks);

/// What an exam keeps of its tooth's landmarks (landmarks_text); empty when its zones follow none.
[[nodiscard]] std::string landmarks_to_keep(const Scenario& scenario, const Tooth& tooth);
/// The zones of an exam that kept `landmarks_json`; where it is empty (its own scenario follows
/// none) they are found anew. Throws Error as build_zones does, and when the text is none that
/// landmarks_text wrote; `where` names the exam.
[[nodiscard]] ZoneMap build_zones_of_exam(const Scenario& scenario, const Tooth& tooth,
                                          const std::string& landmarks_json,
                                          const std::string& where);

/// A fissure's outline with its lines (`paths_mm`) on the tooth: the central fissure from ridge to
/// ridge, as far as `ridge_mm` lets it, and the branches when they are asked for. Every line is
/// known to 0.03 mm. Throws Error when the tooth has no central fissure, or nothing of it is left.
[[nodiscard]] OutlineSpec place_fissure(const OutlineSpec& spec, const Landmarks& landmarks,
                                        const Message& where);

/// A proximal box as a plain box: from its axial wall out beyond the tooth, from its floor up
/// beyond the cusps. `where` names the asker. Throws Error when the tooth shows no contact area or
/// no neck there, or ends below the floor.
[[nodiscard]] ShapeSpec place_proximal_box(const ShapeSpec& spec, const Tooth& tooth,
                                           const Landmarks& landmarks, const Message& where);

}  // namespace cavum::scenarios
