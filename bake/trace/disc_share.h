#pragma once

// Visibility of the disc of a light.

#include "bake/scene/trace_scene.h"
#include "bake/scene/transmittance.h"
#include "bake/trace/disc_directions.h"

#include <glm/geometric.hpp>

namespace prt {

/// Share of a disc's light that arrives at a receiver, including the cosine: 1 if the receiver faces the disc
/// and nothing blocks it. Rays start at `origin`; `length_of(i)` is the length of the ray in direction `i`.
template <class Length>
double share_of_disc(const TraceScene& scene, const glm::vec3& origin, const glm::vec3& normal,
                     const DiscDirections& directions, double turn, Length&& length_of) {
    double sum = 0;
    for (int i = 0; i < directions.count(); ++i) {
        const glm::vec3 towards = directions.direction(i, turn);
        const auto cosine = static_cast<double>(glm::dot(normal, towards));
        if (cosine > 0)
            sum += cosine * static_cast<double>(
                                transmittance(scene.rays(), scene.surfaces(), origin, towards, length_of(i)));
    }
    return sum / (directions.count() * directions.mean_cosine());
}

} // namespace prt
