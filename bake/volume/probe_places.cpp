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
    bool two_sided = false; ///< it has no front: `off` is the side of the place
    /// Too near for a probe of cells that wide.
    bool is_near(float cell) const { return nearest < 0.9f * kClear * cell; }
    int far = 0; ///< directions in which a surface is beyond a cell
};

Around look_around(const TraceScene& scene, const glm::vec3& place, float cell) {
    static const std::array<glm::vec3, 26> directions = directions_around();
    Around around;
    for (const glm::vec3& d : directions) {
        const auto hit = scene.rays().nearest({place, d});
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

/// Whether `place` rather than `other`, on the other side of a wall, is in a room: there surfaces are all
/// round, neither in the open nor between the two faces of a wall.
bool is_inside(const TraceScene& scene, const glm::vec3& place, const glm::vec3& other, float cell) {
    const Around around = look_around(scene, place, cell);
    return !around.is_near(cell) && around.far > look_around(scene, other, cell).far;
}

glm::vec3 free_place(const TraceScene& scene, const ProbeCell& cell) {
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

std::vector<glm::vec3> free_places(const TraceScene& scene, std::span<const ProbeCell> cells, int threads) {
    std::vector<glm::vec3> moved(cells.size());
    parallel_for(cells.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            moved[p] = free_place(scene, cells[p]);
    });
    return moved;
}

} // namespace prt
