// Moves probes off the surfaces that they are too near to.

#include "bake/products/volumes/probe_positions.h"

#include "bake/scene/lit_side.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace prt {
namespace {

/// Minimum distance of a probe from a surface, in cells.
constexpr float kClear = 0.1f;
constexpr int kTries = 3; // a corner has three walls

/// Directions to the corners, edges and faces of a cube, slightly rotated so that they are not within
/// axis-aligned planes.
std::array<glm::vec3, 26> directions_around() {
    std::array<glm::vec3, 26> directions;
    std::size_t n = 0;
    for (int i = 0; i < 27; ++i)
        if (i != 13)
            directions[n++] = glm::normalize(glm::vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) +
                                             glm::vec3(0.011f, 0.017f, 0.013f));
    return directions;
}

/// Surroundings of a position.
struct Around {
    float nearest = std::numeric_limits<float>::infinity(); ///< distance to the nearest surface, metres
    glm::vec3 off{0};                                       ///< unit, away from this surface, to its front
    bool two_sided = false; ///< the surface has no front: `off` points to the side of the position
    /// Whether the surface is too near for a probe of cells with this width.
    bool is_near(float cell) const { return nearest < 0.9f * kClear * cell; }
    int far = 0; ///< directions in which a surface is farther than a cell
};

Around look_around(const TraceScene& scene, const glm::vec3& position, float cell) {
    static const std::array<glm::vec3, 26> directions = directions_around();
    Around around;
    for (const glm::vec3& d : directions) {
        const auto hit = scene.rays().nearest({position, d});
        if (!hit)
            continue;
        around.far += hit->distance > cell ? 1 : 0;
        const MetSurface met = met_surface(scene.scene(), scene.rays(), {hit->triangle, hit->uv, 0}, d);
        const float distance = hit->distance * std::abs(glm::dot(met.side.face, d));
        if (distance < around.nearest) {
            around.nearest = distance;
            around.two_sided = scene.surfaces().two_sided(hit->triangle);
            around.off = met.back && !around.two_sided ? -met.side.face : met.side.face;
        }
    }
    return around;
}

/// Whether `position`, and not `other` on the other side of a wall, is inside a room: there are surfaces on
/// all sides, and it is neither outdoors nor between the two faces of a wall.
bool is_inside(const TraceScene& scene, const glm::vec3& position, const glm::vec3& other, float cell) {
    const Around around = look_around(scene, position, cell);
    return !around.is_near(cell) && around.far > look_around(scene, other, cell).far;
}

glm::vec3 free_position(const TraceScene& scene, const ProbeCell& cell) {
    glm::vec3 moved = cell.corner;
    for (int i = 0; i < kTries; ++i) {
        const Around around = look_around(scene, moved, cell.width);
        if (!around.is_near(cell.width))
            break;
        const glm::vec3 way = (kClear * cell.width) * around.off;
        moved += around.two_sided && is_inside(scene, moved - way, moved + way, cell.width) ? -way : way;
    }
    return moved;
}

} // namespace

std::vector<glm::vec3> free_positions(const TraceScene& scene, std::span<const ProbeCell> cells,
                                      int threads) {
    std::vector<glm::vec3> moved(cells.size());
    parallel_for(cells.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            moved[p] = free_position(scene, cells[p]);
    });
    return moved;
}

} // namespace prt
