// Roofs of round tiles, which slope towards the court and meet in a valley.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <cmath>

namespace examples {
namespace {

using namespace plan;

constexpr float kTile = 0.26f, kCourse = 0.42f, kOverhang = 0.5f;

/// Returns the tiles from x = `from` to `to_x` of a wing that begins at z = 0 and extends towards -z.
Mesh tiled_slope(float from, float to_x) {
    const float length = to_x - from, depth = kWing + kOverhang + 0.15f;
    const int tiles = static_cast<int>(std::lround(length / kTile));
    Mesh mesh = parametric_surface(6 * tiles, 8, [&](float u, float v) {
        const float back = v * depth - kOverhang;
        const float wave = std::cos(kTurn * u * static_cast<float>(tiles));
        return glm::vec3(from + u * length, kEaves + 0.09f + kRoofSlope * back + 0.055f * wave, -back);
    });
    return with_scaled_texcoords(mesh, {static_cast<float>(tiles) / 8, depth / kCourse / 8});
}

/// The overhanging eave from below, and its edge.
Mesh eave(const glm::vec3& from, const glm::vec3& to) {
    const float out = kOverhang - 0.06f, edge = kEaves - kRoofSlope * kOverhang;
    return moulding({{0, kEaves - 0.3f},
                     {0.06f, kEaves - 0.28f},
                     {0.06f, kEaves - 0.28f},
                     {0.08f, kEaves - 0.14f},
                     {0.2f, kEaves - 0.09f},
                     {0.2f, kEaves - 0.09f},
                     {out, edge + 0.03f},
                     {out, edge + 0.03f},
                     {out, edge + 0.12f}},
                    straight_way(from, to));
}

} // namespace

void add_roofs(Courtyard& to) {
    append(to.building.roof_tiles, placed(tiled_slope(-0.25f, kDeep + kWing + 0.15f), left_wing()));
    append(to.building.roof_tiles,
           placed(tiled_slope(-kWing - 0.15f, 2 * kHalf + kOuterWall + 0.25f), back_wing()));
    append(to.building.wood, eave({-kHalf, 0, 0.2f}, {-kHalf, 0, -kDeep - 0.3f}));
    append(to.building.wood, eave({-kHalf, 0, -kDeep}, {kHalf + kOuterWall + 0.2f, 0, -kDeep}));
}

} // namespace examples
