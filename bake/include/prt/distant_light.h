#pragma once

// Distant light that rays evaluate by direction. SH lighting approximates it.

#include "prt/environment.h"
#include "prt/sun.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// An environment and suns that can be evaluated, and sampled in proportion to luminance. Immutable,
/// thread-safe.
class DistantLight {
public:
    /// `environment` is a lat-long image, constant over each texel as in `project`; an empty image is black.
    /// All light of a sun comes from its center: split a wide sun into several directional ones.
    explicit DistantLight(Image environment, std::vector<Sun> suns = {});

    struct Sample {
        glm::vec3 direction, radiance;
        float density; ///< per steradian; 0 where the environment is black
    };
    /// Returns the sample of the environment for a random point `u` of the unit square.
    Sample sample(const glm::vec2& u) const;
    /// Returns the radiance of the environment, without suns, in unit direction `direction`.
    glm::vec3 radiance(const glm::vec3& direction) const;
    /// Returns the probability density of `sample` in `direction`, per steradian.
    float density(const glm::vec3& direction) const;
    const std::vector<Sun>& suns() const { return suns_; }
    const Image& environment() const { return environment_; }

private:
    std::size_t texel(const glm::vec3& direction) const;
    double solid_angle(int row) const;

    Image environment_;
    std::vector<Sun> suns_;
    std::vector<double> cumulative_; ///< [height · width + 1] total power of all texels before this one
};

} // namespace prt
