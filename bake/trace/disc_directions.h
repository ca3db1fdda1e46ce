#pragma once

// Directions over the disc of a distant light.

#include "runtime/core/support/tangent_frame.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace prt {

/// Directions to a disc or a sphere, distributed evenly over its solid angle on a spiral (R. Swinbank, R. J.
/// Purser, "Fibonacci grids", 2006).
class DiscDirections {
public:
    /// Directions in the cone about unit `towards` with half angle `half_angle` in radians; one direction if
    /// the angle is 0, otherwise `rays`.
    DiscDirections(const glm::vec3& towards, double half_angle, int rays)
        : frame_(tangent_frame(towards)), count_(half_angle > 0 ? rays : 1),
          depth_(1 - std::cos(half_angle)) {}

    int count() const { return count_; }
    /// Cosine of the angle between direction `i` and the axis.
    double cosine(int i) const { return 1 - depth_ * (i + 0.5) / count_; }
    /// Unit direction `i`, rotated about the axis by `rotation` radians; different rotations make the
    /// directions of two positions differ.
    glm::vec3 direction(int i, double rotation) const {
        const double cosine = this->cosine(i), sine = std::sqrt(1 - cosine * cosine);
        const double angle = rotation + i * std::numbers::pi * (3 - std::sqrt(5.0));
        return glm::vec3(glm::normalize(glm::dvec3(frame_.normal) * cosine +
                                        glm::dvec3(frame_.tangent) * (sine * std::cos(angle)) +
                                        glm::dvec3(frame_.bitangent) * (sine * std::sin(angle))));
    }
    /// Mean cosine to the axis: irradiance of a receiver that faces the light, divided by radiance times
    /// solid angle.
    double mean_cosine() const { return 1 - 0.5 * depth_; }

private:
    TangentFrame frame_;
    int count_;
    double depth_; ///< 1 - cosine of the half angle
};

} // namespace prt
