// Is what is imported a human tooth, the right way up, in the right unit, and the one it is said to
// be? What geometry contradicts is refused; what it only suggests is said with its reasons; what
// was assumed is named. Nothing of it changes the tooth's leaves.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/import/frame.h"
#include "engine/tooth/import/layers_fit.h"
#include "engine/tooth/mesh/mesh_units.h"
#include "engine/tooth/tooth.h"
#include "engine/tooth/tooth_number.h"

namespace cavum {

/// What an import refuses unless the user confirms it by name: the crown's size, which way is
/// occlusal, the class of the number, where the pulp is wide, a bay in the outline, where mesial
/// is, and on which side of the jaw the tooth stands.
inline constexpr std::array<std::string_view, 7> k_confirmable{
    "size", "upright", "class", "pulp", "outline", "mesial", "side"};

/// What the user says about the tooth.
struct SenseOptions {
  std::optional<ToothNumber> number;
  std::string units;  ///< of the files; empty: mm is assumed, and checked
  std::string
      patient_frame;  ///< "lps" or "ras": the file's axes are the patient's; empty: not known
  std::vector<std::string>
      confirmed;  ///< of k_confirmable: what would be refused becomes a warning
};

/// Mesial in the patient's frame ("lps": +x left, +y back; "ras": +x right, +y front; +z up), a
/// unit vector: forwards at the molars, towards the midline at the incisors, between them along an
/// arch. Throws Error("--patient-frame", ...) for other frames.
[[nodiscard]] Vec3 mesial_in_patient(const ToothNumber& number, const std::string& patient_frame);

/// What was found; every line is for people.
struct ToothSense {
  ClassGuess tooth_class;
  std::vector<Message> guesses;  ///< with reasons: class, mesiodistal line, side
  std::vector<Message>
      warnings;  ///< what was taken although it contradicts, and what could not be checked
};

/// Least and largest width of a human crown, mm: mean mesiodistal widths run from 5 (lower central
/// incisor) to 11 (lower first molar), buccolingual ones from 6 to 11 (Nelson, Wheeler's Dental
/// Anatomy, table of measurements), each with a spread of some 10 %.
inline constexpr double k_min_crown_width_mm = 4.5, k_max_crown_width_mm = 14.0;

/// The frame in which the tooth will stand: mirrored where the number says that +y is lingual, for
/// every later task, picture and word takes +x for mesial and +y for buccal. Throws
/// Error("--mirror", ...) where a mirror would make +y lingual.
[[nodiscard]] FrameOptions settled_frame(const FrameOptions& frame, const SenseOptions& options);

/// Throws Error(`where`, ...) when the enamel's box is no human crown's: says which unit would make
/// it one. `of_volume`: its voxels have a spacing instead of a unit.
void check_crown_size(Vec3 enamel_extent_mm, const SenseOptions& options, const std::string& where,
                      bool of_volume, ToothSense& sense);

/// Throws Error(`where`, ...) when the pulp lies open in the crown (layers_fit.h).
void check_closed_pulp(const OpenPulp& open, const SenseOptions& options, const std::string& where,
                       ToothSense& sense);

/// A warning where the layers overlap or stand apart more than those of human teeth do, and less
/// than what is refused.
void tell_loose_layers(const LayersApart& apart, const Overlaps& overlaps, ToothSense& sense);
/// A warning where dentin lies bare in the crown (layers_fit.h): human teeth wear, but a hole or a
/// crack looks the same.
void tell_bare_dentin(const BareDentin& bare, ToothSense& sense);

/// A warning where enamel lies on dentin apart from the crown's.
void tell_pieces(const EnamelPieces& pieces, ToothSense& sense);

/// Throws Error(`where`, ...) when the occlusal axis runs from the enamel to the root, or across
/// the tooth, or, in a patient's frame, down for a lower tooth. A unit vector, and centroids, in
/// one frame.
void check_upright(Vec3 occlusal, Vec3 dentin_centroid, Vec3 enamel_centroid,
                   const SenseOptions& options, const std::string& where, ToothSense& sense);

/// Looks at the tooth once it stands in its settled frame: class, pulp, outline, buccal and mesial
/// side. Throws Error(`where`, ...) where they contradict the options.
void sense_tooth(const Tooth& tooth, const FrameOptions& frame, const SenseOptions& options,
                 const std::string& where, ToothSense& sense);

/// Writes the number into the tooth's name and kind, and the guesses into its notes.
void name_tooth(const ToothSense& sense, const SenseOptions& options, bool mirrored, Tooth& tooth);

}  // namespace cavum
