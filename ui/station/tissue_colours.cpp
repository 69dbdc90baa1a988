#include "ui/station/tissue_colours.h"

#include "engine/tooth/beside.h"

namespace cavum::station {

glm::vec3 tissue_colour(const Tissue& tissue, bool high_contrast) {
  const auto either = [high_contrast](glm::vec3 plain, glm::vec3 strong) { return high_contrast ? strong : plain; };
  if (tissue.name == "lesion") return either({0.58F, 0.40F, 0.22F}, {0.45F, 0.25F, 0.05F});
  // what stands beside the tooth is cooler and greyer than it, the gum pink
  if (is_of_neighbour(tissue.name)) return either({0.62F, 0.70F, 0.78F}, {0.35F, 0.55F, 0.80F});
  if (tissue.name == k_gum) return either({0.84F, 0.48F, 0.50F}, {0.80F, 0.30F, 0.45F});
  switch (tissue.id) {
    case k_air:
      return glm::vec3(0.5F);
    case k_enamel:
      return either({0.93F, 0.925F, 0.895F}, glm::vec3(1.0F));
    case k_dentin:
      return either({0.86F, 0.70F, 0.43F}, {0.95F, 0.70F, 0.16F});
    case k_pulp:
      return either({0.70F, 0.20F, 0.20F}, {0.62F, 0.02F, 0.14F});
    case k_periodontium:
      return {0.80F, 0.55F, 0.55F};
    default:
      return {0.62F, 0.52F, 0.70F};
  }
}

}  // namespace cavum::station
