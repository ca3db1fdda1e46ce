#pragma once

// Random lightings of a family: a member, rotated about +Y by any angle, with added random texture.

#include "prt/compress/light_metric.h"

#include <vector>

namespace prt {

/// A lighting of a family with its weight.
struct FamilyMember {
    Lighting lighting; ///< with separate suns
    /// Weight of the draws. If direct transfer is a separate term, half of the draws light it by the sky
    /// alone.
    double weight = 1;
};

/// Model of a family. Texture represents clouds, trees and walls: it is random, with any orientation, and
/// part of the sky. A draw is scaled so that open receivers of all orientations have a mean squared exit
/// radiance of 1 under the light of direct transfer, including texture: errors are relative to the visible
/// light.
struct FamilyModel {
    std::vector<FamilyMember> members; ///< grey
    std::vector<double> texture;       ///< [order] power of a coefficient of band l relative to band 0 of the
                                       ///< member's sky
};

/// Returns the model of `outdoor`, `indoor` or `day`; `natural` has no members.
FamilyModel family_model(LightFamily family, int order);

/// Returns the mean over normals of the squared exit radiance of open receivers under a grey light with
/// texture of these mean powers: sum_l (A_l/pi)² sum_m (L_lm² + texture) / (4 pi).
double open_square(const Light& light, const std::vector<double>& texture_powers);

} // namespace prt
