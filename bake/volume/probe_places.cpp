#include "volume/probe_places.h"

#include "pictures/lit_side.h"
#include "prt/support/parallel.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace prt {
namespace {

/// How near to a surface a probe may stand, in cells.
constexpr float kClear = 0.1f;
constexpr int kTries = 3; // a corner has three walls

/// The corners, edges and faces of a cube, and what keeps them from running within planes along the axes.
std::array<glm::vec3, 26> directions_around() {
    std::array<glm::vec3, 26> directions;
    std::size_t n = 0;
    for (int i = 0; i < 27; ++i)
        if (i != 13)
            directions[n++] = glm::normalize(glm::vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) +
                                             glm::vec3(0.011f, 0.017f, 0.013f));
    return directions;
}

/// What is around a place.
struct Around {
    float nearest = std::numeric_limits<float>::infinity(); ///< surface, metres
    glm::vec3 off{0};                                       ///< unit, the way off it, to its front
};

Around look_around(const TraceScene& scene, const glm::vec3& place) {
    static const std::array<glm::vec3, 26> directions = directions_around();
    Around around;
    for (const glm::vec3& d : directions) {
        const auto hit = scene.rays().nearest({place, d});
        if (!hit)
            continue;
        const MetSurface met = met_surface(scene.scene(), scene.rays(), {hit->triangle, hit->uv, 0}, d);
        const float distance = hit->distance * std::abs(glm::dot(met.side.face, d));
        if (distance < around.nearest) {
            around.nearest = distance;
            around.off =
                met.back && !scene.surfaces().two_sided(hit->triangle) ? -met.side.face : met.side.face;
        }
    }
    return around;
}

glm::vec3 free_place(const TraceScene& scene, const glm::vec3& place, float cell) {
    glm::vec3 moved = place;
    for (int i = 0; i < kTries; ++i) {
        const Around around = look_around(scene, moved);
        if (!(around.nearest < 0.9f * kClear * cell))
            break;
        moved += (kClear * cell) * around.off;
    }
    return moved;
}

} // namespace

std::vector<glm::vec3> free_places(const TraceScene& scene, std::span<const glm::vec3> places,
                                   std::span<const float> cells, int threads) {
    std::vector<glm::vec3> moved(places.size());
    parallel_for(places.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            moved[p] = free_place(scene, places[p], cells[p]);
    });
    return moved;
}

} // namespace prt
