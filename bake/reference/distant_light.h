#pragma once

// Distant light that rays evaluate by direction, in exact form. SH lighting approximates distant light.

#include "prt/core/environment.h"
#include "prt/core/light.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// An environment and suns. The environment can be evaluated in any direction, and sampled in proportion to
/// its luminance. Immutable, thread-safe.
class DistantLight {
public:
    /// `environment`: lat-long image with +Y at the top and +Z at the center column (LatLongCenter::z); its
    /// radiance is constant over each texel, as in `project`. An empty image is black. All light of a sun
    /// comes from its center, and Sun::half_angle is ignored: split a wide sun into several directional suns.
    explicit DistantLight(Image environment, std::vector<Sun> suns = {});

    /// A random direction towards the environment, and the light from there.
    struct Sample {
        /// `direction`: unit vector towards the light; `radiance`: radiance of the environment from there,
        /// linear Rec. 709.
        glm::vec3 direction, radiance;
        float density; ///< probability density of `direction` per steradian; 0 if the whole environment is
                       ///< black: `radiance` is then 0 and `direction` is +Y
    };
    /// Returns a sample of the environment for a random point `u` of the unit square. The probability of a
    /// texel is proportional to its luminance times its solid angle; the direction is uniform over the texel.
    /// Suns are not sampled.
    Sample sample(const glm::vec2& u) const;
    /// Returns the radiance of the environment in unit direction `direction`, excluding suns; linear Rec.
    /// 709.
    glm::vec3 radiance(const glm::vec3& direction) const;
    /// Returns the probability density with which `sample` chooses unit direction `direction`, per steradian;
    /// 0 if the whole environment is black.
    float density(const glm::vec3& direction) const;
    /// Returns the suns that were passed to the constructor.
    const std::vector<Sun>& suns() const { return suns_; }
    /// Returns the environment that was passed to the constructor.
    const Image& environment() const { return environment_; }

private:
    std::size_t texel(const glm::vec3& direction) const;
    double solid_angle(int row) const;

    Image environment_;
    std::vector<Sun> suns_;
    std::vector<double> cumulative_; ///< [height · width + 1] total power of all texels before this one
};

} // namespace prt
