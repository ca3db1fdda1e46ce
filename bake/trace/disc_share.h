#pragma once

#include "prt/trace_scene.h"
#include "scene/transmittance.h"
#include "trace/disc_directions.h"

#include <glm/geometric.hpp>

namespace prt {

/// Share of the light of a disc that arrives at a receiver, with its cosine: 1 where it faces it and nothing
/// is in the way. Rays start at `origin` and go as far as `length_of(i)` says of direction `i`.
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
