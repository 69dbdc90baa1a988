// The access to a front tooth: a column like that of a back tooth, but along a way in that leans
// towards lingual, told by landmarks.
#pragma once

#include <memory>
#include <string>

#include "engine/base/message.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "scenarios/zones/relief.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {

/// The way into a front tooth: its z runs from the middle of the canal's mouth at the neck through
/// the middle of the lingual surface (half way between neck and incisal edge), out of the tooth; x
/// towards mesial, y towards the incisal edge; its origin is the canal's mouth. Entry in the middle
/// of the lingual surface, incisal to the cingulum, then towards the canal: the usual access
/// (Krapez and Fidler, J Conserv Dent 2013; 16: 404, found that the straight line into the canal
/// leaves upper central incisors through the incisal edge or the lingual surface). Throws Error
/// when the tooth shows no incisal edge, neck or canal, or the way leans by more than 45 degrees.
[[nodiscard]] ShapeFrame lingual_way(const Tooth& tooth, const Landmarks& landmarks,
                                     const Message& where);

/// A tissue seen along a frame's z, in the frame's own lengths; the chamber is what lies occlusal
/// of the frame's origin, along the tooth's z. Throws Error when nothing of it does.
[[nodiscard]] TissueRelief relief_along(const Tooth& tooth, const ShapeFrame& frame,
                                        const std::string& tissue, TissuePart part,
                                        const Message& where);

/// The column whose outline and bottom follow a tissue (projection; tissue_roof or tissue_floor),
/// seen along `way`.
[[nodiscard]] std::unique_ptr<Shape> leaning_column(const Tooth& tooth, const ShapeSpec& spec,
                                                    const ShapeFrame& way, const Message& where,
                                                    ZoneWork& work);

}  // namespace cavum::scenarios
