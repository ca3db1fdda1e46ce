// A street with many instances of few houses, wall to wall: neighbours are close, and some of them see more
// of each other than of the sky.

#include "chance.h"
#include "example_scenes.h"
#include "shapes.h"

#include <algorithm>
#include <array>

namespace examples {
namespace {

constexpr float kHouseWidth = 9, kHouseDepth = 8; ///< size of a house, metres
constexpr float kSetBack = 7.5f;                  ///< distance of the fronts from the middle of the street

/// Properties that differ between kinds.
struct HouseKind {
    const char* name;
    int storeys;
    float ridge; ///< height of the roof above the walls, metres
    float porch; ///< depth of the canopy over the door; 0: none
    glm::vec3 walls, roof;
};

constexpr std::array<HouseKind, 5> kKinds = {
    {{"cottage", 1, 2.8f, 1.4f, {0.72f, 0.66f, 0.55f}, {0.38f, 0.17f, 0.11f}},
     {"brick house", 2, 2.2f, 0, {0.50f, 0.25f, 0.18f}, {0.16f, 0.16f, 0.18f}},
     {"town house", 3, 1.8f, 1.0f, {0.78f, 0.76f, 0.70f}, {0.30f, 0.16f, 0.11f}},
     {"blue house", 2, 3.2f, 1.2f, {0.36f, 0.45f, 0.56f}, {0.20f, 0.19f, 0.19f}},
     {"tenement", 4, 1.2f, 0, {0.64f, 0.56f, 0.42f}, {0.26f, 0.24f, 0.22f}}}};

constexpr float kStorey = 2.9f;

/// The long wall at z = 0, facing +z, with windows and a door, and panes set back in them.
Mesh front_wall(int storeys, bool door) {
    std::vector<Opening> openings;
    Mesh panes;
    for (int s = 0; s < storeys; ++s)
        for (int w = 0; w < 3; ++w) {
            const float x = (static_cast<float>(w) - 1) * 2.7f, y = kStorey * static_cast<float>(s);
            const bool is_door = door && s == 0 && w == 1;
            const glm::vec2 low(x - 0.6f, y + (is_door ? 0 : 0.9f)), high(x + 0.6f, y + 2.2f);
            openings.push_back({low, high});
            append(panes,
                   box({low.x - 0.1f, low.y - 0.1f, -0.3f}, {high.x + 0.1f, high.y + 0.1f, -0.2f}, 0.7f));
        }
    Mesh wall = wall_with_openings({-kHouseWidth / 2, 0},
                                   {kHouseWidth / 2, kStorey * static_cast<float>(storeys)}, openings, 0.9f);
    append(wall, panes);
    return wall;
}

std::vector<Part> house(const HouseKind& kind) {
    const float eaves = kStorey * static_cast<float>(kind.storeys), half = kHouseWidth / 2;
    Mesh walls = placed(front_wall(kind.storeys, true), placement({0, 0, kHouseDepth / 2}, 0));
    append(walls, placed(front_wall(kind.storeys, false), placement({0, 0, -kHouseDepth / 2}, 180)));
    for (const float side : {-1.0f, 1.0f}) {
        append(walls, rectangle({side * half, 0, side * kHouseDepth / 2}, {0, 0, -side * kHouseDepth},
                                {0, eaves, 0}, 0.9f));
        append(walls, parametric_surface(8, 3, [&](float u, float v) { // a gable
                   return glm::vec3(side * half, eaves + v * kind.ridge,
                                    side * kHouseDepth * (0.5f - u) * (1 - v));
               }));
    }
    Mesh roof;
    for (const float side : {-1.0f, 1.0f}) {
        const glm::vec3 corner(-side * (half + 0.3f), eaves - 0.15f, side * (kHouseDepth / 2 + 0.4f));
        append(roof, rectangle(corner, {side * (kHouseWidth + 0.6f), 0, 0},
                               {0, kind.ridge + 0.15f, -side * (kHouseDepth / 2 + 0.4f)}, 0.7f));
    }
    append(roof,
           box({1.6f, eaves + 0.3f * kind.ridge, -1.9f}, {2.3f, eaves + kind.ridge + 0.8f, -1.2f}, 0.5f));
    if (kind.porch > 0)
        append(roof, box({-1.1f, 2.4f, kHouseDepth / 2}, {1.1f, 2.55f, kHouseDepth / 2 + kind.porch}, 0.4f));
    return {{std::string(kind.name) + " walls", kind.walls, walls},
            {std::string(kind.name) + " roof", kind.roof, roof}};
}

} // namespace

ExampleScene street(int houses) {
    std::vector<Model> models;
    for (const HouseKind& kind : kKinds)
        models.push_back({kind.name, house(kind), {}});
    Chance chance(62);
    const int along = (houses + 1) / 2;
    for (int i = 0; i < houses; ++i) {
        const auto kind = static_cast<std::size_t>(chance.between(0, 4.999f));
        const int position = i / 2; // on either side
        const float gap = chance.between(1.5f, 4),
                    x = (static_cast<float>(position) - 0.5f * static_cast<float>(along - 1)) *
                            (kHouseWidth + 2.9f) +
                        0.2f * gap;
        const float z =
            (kSetBack + kHouseDepth / 2 + chance.between(-0.8f, 0.8f)) * (i % 2 == 0 ? -1.0f : 1.0f);
        models[kind].placements.push_back({{x, 0, z}, i % 2 == 0 ? 0.0f : 180.0f, 1});
    }
    const float half = 0.5f * static_cast<float>(along) * (kHouseWidth + 2.9f) + 12,
                side = kSetBack + kHouseDepth + 12;
    return {.parts = {{"gardens",
                       {0.21f, 0.27f, 0.12f},
                       rectangle({-half, 0, -4}, {2 * half, 0, 0}, {0, 0, 4 - side}, 0.9f)},
                      {"road",
                       {0.24f, 0.24f, 0.25f},
                       rectangle({-half, 0, 4}, {2 * half, 0, 0}, {0, 0, -8}, 0.9f)},
                      {"more gardens",
                       {0.21f, 0.27f, 0.12f},
                       rectangle({-half, 0, side}, {2 * half, 0, 0}, {0, 0, 4 - side}, 0.9f)}},
            .models = std::move(models)};
}

} // namespace examples
