#pragma once

// Visibility distances of a probe along the axes: a box around it that no surface intersects (docs/math.md,
// section 19).

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace prt {

/// Collects hits of a probe's rays within `reach`, and computes the distances -x, +x, -y, .. to the nearest
/// surfaces. Each hit counts for the axis along which the plane of its surface is nearest. A distance is the
/// one that a fifth of the axis's rays do not exceed, so that a thin pole or a leaf does not hide everything
/// behind it.
class VisibilityVotes {
public:
    /// Removes all hits. Distances are measured from a corner, which has the offset `off` from the origin of
    /// the rays. All lengths in metres.
    void begin(const glm::vec3& off, float reach);
    /// Adds `weight` rays that hit a surface after `way`. `face`: normal of the surface, of any length and
    /// either sign.
    void add_hit(const glm::vec3& way, const glm::vec3& face, float weight);
    /// Computes the distances. `rays`: all rays of the probe. `open`: distance if nothing blocks.
    std::array<float, 6> distances(double rays, float open);

private:
    struct Vote {
        float distance, weight;
    };
    std::array<std::vector<Vote>, 6> votes_;
    glm::vec3 off_{0};
    float reach_ = 0;
};

} // namespace prt
