// An octagonal basin with a bowl on a foot and falling water.

#include "courtyard_parts.h"
#include "shapes.h"

#include <array>
#include <cmath>

namespace examples {
namespace {

const glm::vec3 kFountain(-0.7f, 0, -4.9f);
constexpr float kRim = 0.66f, kLevel = 0.56f, kInner = 1.34f; ///< basin
constexpr float kBowl = 1.62f;                                ///< height of the bowl's rim

/// The basin's water, with rings about where the streams fall.
Mesh basin_water() {
    std::vector<std::vector<glm::vec3>> rows;
    constexpr int kSides = 8, kSteps = 8, kRings = 12;
    for (int ring = kRings; ring >= 0; --ring) {
        auto& row = rows.emplace_back();
        const float radius = 0.25f + (kInner - 0.25f) * static_cast<float>(ring) / kRings;
        for (int i = 0; i <= kSides * kSteps; ++i) {
            // Round in the middle, eight-sided at the wall.
            const float angle = kTurn * static_cast<float>(i % (kSides * kSteps)) / (kSides * kSteps);
            const float side = kTurn / kSides, to_side = std::remainder(angle, side);
            const float round = radius / kInner,
                        reach = radius * std::lerp(1.0f, 1 / std::cos(to_side), round);
            const float ripple = 0.007f * std::sin(26 * std::abs(radius - 0.8f));
            row.push_back(kFountain +
                          glm::vec3(reach * std::sin(angle), kLevel + ripple, reach * std::cos(angle)));
        }
    }
    return lofted(rows);
}

/// A stream over the bowl's rim.
Mesh stream(float angle) {
    constexpr int kSteps = 9;
    const glm::vec3 out(std::sin(angle), 0, std::cos(angle));
    std::array<glm::vec3, kSteps> points;
    std::array<float, kSteps> radii;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const float t = static_cast<float>(i) / (kSteps - 1), fall = kBowl + 0.01f - kLevel;
        points[i] = kFountain + (0.62f + 0.22f * t) * out + glm::vec3(0, kBowl + 0.01f - fall * t * t, 0);
        radii[i] = 0.018f - 0.006f * t;
    }
    return bar(points, radii, 6);
}

} // namespace

void add_fountain(Courtyard& to) {
    append(to.building.stone,
           polygonal_lathe(
               kFountain,
               {{1.95f, 0}, {1.95f, 0.11f}, {1.95f, 0.11f}, {1.92f, 0.13f}, {1.92f, 0.13f}, {1.56f, 0.13f}},
               8));
    append(to.building.glazed_tiles, polygonal_lathe(kFountain, {{1.56f, 0.13f}, {1.56f, 0.53f}}, 8));
    append(to.building.stone, polygonal_lathe(kFountain,
                                              {{1.56f, 0.53f},
                                               {1.62f, 0.55f},
                                               {1.66f, 0.6f},
                                               {1.65f, 0.64f},
                                               {1.62f, kRim},
                                               {1.62f, kRim},
                                               {kInner, kRim},
                                               {kInner, kRim},
                                               {kInner, kLevel - 0.05f}},
                                              8));
    append(to.garden.water, basin_water());
    const Outline foot = {
        {0.34f, 0.3f},         {0.34f, 0.66f}, {0.34f, 0.66f}, {0.3f, 0.7f},           {0.2f, 0.76f},
        {0.13f, 0.9f},         {0.12f, 1.02f}, {0.17f, 1.1f},  {0.17f, 1.1f},          {0.19f, 1.12f},
        {0.17f, 1.16f},        {0.12f, 1.2f},  {0.12f, 1.2f},  {0.2f, 1.27f},          {0.45f, 1.4f},
        {0.62f, 1.54f},        {0.67f, kBowl}, {0.67f, kBowl}, {0.65f, kBowl + 0.03f}, {0.61f, kBowl + 0.02f},
        {0.57f, kBowl - 0.05f}};
    append(to.building.stone, lathe(kFountain, foot, 32));
    append(to.garden.water,
           lathe(kFountain, {{0.6f, kBowl - 0.005f}, {0.3f, kBowl + 0.005f}, {0.05f, kBowl + 0.02f}}, 32));
    append(to.building.stone, lathe(kFountain,
                                    {{0.09f, kBowl - 0.03f},
                                     {0.07f, kBowl + 0.12f},
                                     {0.1f, kBowl + 0.2f},
                                     {0.13f, kBowl + 0.28f},
                                     {0.1f, kBowl + 0.36f},
                                     {0.04f, kBowl + 0.42f},
                                     {0.05f, kBowl + 0.46f},
                                     {0, kBowl + 0.52f}},
                                    20));
    for (int i = 0; i < 8; ++i)
        append(to.garden.water, stream(kTurn * (static_cast<float>(i) + 0.5f) / 8));
}

} // namespace examples
