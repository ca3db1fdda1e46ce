#pragma once

// Families of lightings, as they are drawn: a member, turned about +Y by any angle, with texture of its own.

#include "prt/light_metric.h"

#include <vector>

namespace prt {

struct FamilyMember {
    Lighting lighting; ///< its suns apart
    /// Of the draws: where direct transfer is a part of its own, half of them light it by the sky alone.
    double weight = 1;
};

/// Texture stands for clouds, trees and walls: it is random, any way up, in the sky. A draw is scaled so that
/// open receivers that face any way have a mean squared exit radiance of 1 in what lights direct transfer of
/// it, texture included: an error counts as a share of what is seen.
struct FamilyModel {
    std::vector<FamilyMember> members; ///< grey
    std::vector<double> texture; ///< [order] power of a coefficient of band l over band 0 of the member's sky
};

/// Of `outdoor`, `indoor` or `day`; `natural` has no members.
FamilyModel family_model(LightFamily family, int order);

/// Mean over normals of the squared exit radiance of open receivers under a grey light, whose texture has
/// these powers on average: sum_l (A_l/pi)² sum_m (L_lm² + texture) / (4 pi).
double open_square(const Light& light, const std::vector<double>& texture_powers);

} // namespace prt
