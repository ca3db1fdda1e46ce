#pragma once

// Light from far away as rays meet it: what SH lighting is an approximation of.

#include "prt/environment.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// A light without extent.
struct Sun {
    glm::vec3 towards;    ///< unit, from the receiver to the light
    glm::vec3 irradiance; ///< on a receiver that faces it
};

/// An environment and suns, to be looked at and to be sampled in proportion to luminance. Immutable,
/// thread-safe.
class DistantLight {
public:
    /// `environment` is a lat-long image, constant over its texels as in `project`; empty: black.
    explicit DistantLight(Image environment, std::vector<Sun> suns = {});

    struct Sample {
        glm::vec3 direction, radiance;
        float density; ///< per steradian; 0 where the environment is black
    };
    /// A direction for a point `u` of the unit square.
    Sample sample(const glm::vec2& u) const;
    glm::vec3 radiance(const glm::vec3& direction) const;
    /// With which `sample` finds `direction`, per steradian.
    float density(const glm::vec3& direction) const;
    const std::vector<Sun>& suns() const { return suns_; }
    const Image& environment() const { return environment_; }

private:
    std::size_t texel(const glm::vec3& direction) const;
    double solid_angle(int row) const;

    Image environment_;
    std::vector<Sun> suns_;
    std::vector<double> cumulative_; ///< [height · width + 1] power of the texels before
};

} // namespace prt
