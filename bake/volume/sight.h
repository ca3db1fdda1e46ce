#pragma once

// How far a probe sees along the axes: the box around it that no surface cuts (docs/math.md, section 19).

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace prt {

/// Collects what the rays of a probe meet within `reach` and finds -x, +x, -y, .. distances to the nearest
/// surfaces. Each hit counts for the axis along which the plane of its surface is nearest; a distance is that
/// that a fifth of the rays of its axis do not exceed, so that a pole or a leaf hides nothing behind it.
class SightVotes {
public:
    /// Forgets all hits. Distances are those from a corner, which is so far `off` the start of the rays.
    /// Metres.
    void begin(const glm::vec3& off, float reach);
    /// `weight` rays met a surface after `way`. `face`: its normal, of any length and either sign.
    void add_hit(const glm::vec3& way, const glm::vec3& face, float weight);
    /// `rays`: of the probe in all. `open`: the distance where nothing is in the way.
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
