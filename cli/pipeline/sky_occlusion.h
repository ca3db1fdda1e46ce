#pragma once

// Sky occlusion of probes as in Unity's adaptive probe volumes (Unity manual, "Sky occlusion", 2024): the
// fraction of a grey sky that arrives, including bounces, times the sky's ambient probe. Baseline for volumes
// of transfer.

#include "prt/core/transfer_volume.h"

#include <array>
#include <vector>

namespace prt::pipeline {

/// Data stored per probe.
enum class SkyOcclusionKind {
    number,   ///< one for all normals
    linear,   ///< bands 0 and 1 by normal
    directed, ///< bands 0 and 1, and a direction to read the ambient probe instead of the normal
};

class SkyOcclusion {
public:
    /// Computes the incident light at the probes of `volume` under a uniform sky, as grey.
    SkyOcclusion(const BakedVolume& volume, int threads);

    /// Returns the irradiance over pi at a position, from `sky` only.
    glm::vec3 irradiance(const VolumeCorners& corners, const glm::vec3& normal, const Light& sky,
                         SkyOcclusionKind kind) const;

private:
    std::vector<std::array<float, 4>> probes_; ///< incident light, bands 0 and 1
};

} // namespace prt::pipeline
