#pragma once

// Sky occlusion of probes as Unity's adaptive probe volumes have it (Unity manual, "Sky occlusion", 2024):
// how much of a grey sky arrives, bounces included, times the sky's own ambient probe. What volumes of
// transfer are compared with.

#include "prt/transfer_volume.h"

#include <array>
#include <vector>

namespace prt::cli {

/// What a probe keeps.
enum class SkyOcclusionKind {
    number,   ///< one for all normals
    linear,   ///< bands 0 and 1 by normal
    directed, ///< these, and from where the ambient probe is read instead of the normal
};

class SkyOcclusion {
public:
    /// Of the probes of `volume`: what arrives under a uniform sky, grey.
    SkyOcclusion(const BakedVolume& volume, int threads);

    /// Irradiance over pi at a place by `sky` alone.
    glm::vec3 irradiance(const VolumeCorners& corners, const glm::vec3& normal, const Light& sky,
                         SkyOcclusionKind kind) const;

private:
    std::vector<std::array<float, 4>> probes_; ///< incident light, bands 0 and 1
};

} // namespace prt::cli
