// Finds visibility distances of probes from the hits of their rays.

#include "bake/products/volumes/visibility.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace prt {
namespace {

/// Share of an axis's rays, which are a sixth of all, that must be blocked before the axis counts as blocked.
constexpr double kBlockedShare = 0.2;

std::size_t largest_axis(const glm::vec3& v) {
    return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2;
}

} // namespace

void VisibilityVotes::begin(const glm::vec3& off, float reach) {
    off_ = off;
    reach_ = reach;
    for (auto& votes : votes_)
        votes.clear();
}

void VisibilityVotes::add_hit(const glm::vec3& way, const glm::vec3& face, float weight) {
    const glm::vec3 away = glm::dot(face, way) < 0 ? -face : face, hit = way - off_;
    // The plane is where away·x = away·hit; it is assigned to the axis that contributes the largest term.
    const glm::vec3 part = away * hit;
    const bool behind = !(part.x + part.y + part.z > 0); // the corner is behind the surface: it sees nothing
                                                         // on that side
    const std::size_t axis = largest_axis(behind ? glm::abs(away) : part);
    const float distance = behind ? 0 : std::abs(hit[static_cast<int>(axis)]);
    if (distance < reach_)
        votes_[2 * axis + (away[static_cast<int>(axis)] > 0 ? 1 : 0)].push_back({distance, weight});
}

std::array<float, 6> VisibilityVotes::distances(double rays, float open) {
    std::array<float, 6> distances;
    for (std::size_t a = 0; a < 6; ++a) {
        std::ranges::sort(votes_[a], {}, &Vote::distance);
        distances[a] = open;
        double blocked = 0;
        for (const Vote& vote : votes_[a]) {
            blocked += static_cast<double>(vote.weight);
            if (blocked >= kBlockedShare * rays / 6) {
                distances[a] = vote.distance;
                break;
            }
        }
    }
    return distances;
}

} // namespace prt
