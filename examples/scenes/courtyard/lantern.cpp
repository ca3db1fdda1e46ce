// Lanterns of iron with panes of amber glass: in arches, and on the garden wall.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <glm/common.hpp>

#include <string>

namespace examples {
namespace {

using namespace plan;

constexpr float kRadius = 0.12f, kHeight = 0.34f;
constexpr float kIntensity = 8; ///< white paper 1.6 m away is white
constexpr int kSides = 6;

/// Adds a lantern with its ring at `top`, and its lamp.
void add_lantern(Courtyard& to, const glm::vec3& top) {
    const glm::vec3 foot = top - glm::vec3(0, kHeight + 0.2f, 0);
    append(to.building.iron, polygonal_lathe(foot,
                                             {{0.02f, -0.05f},
                                              {0.05f, -0.03f},
                                              {kRadius + 0.015f, 0},
                                              {kRadius + 0.015f, 0},
                                              {kRadius + 0.015f, 0.02f},
                                              {kRadius + 0.015f, 0.02f},
                                              {kRadius - 0.02f, 0.02f}},
                                             kSides));
    append(to.building.iron, polygonal_lathe(foot + glm::vec3(0, kHeight, 0),
                                             {{kRadius - 0.02f, -0.01f},
                                              {kRadius + 0.04f, -0.01f},
                                              {kRadius + 0.04f, -0.01f},
                                              {kRadius + 0.04f, 0.01f},
                                              {kRadius + 0.04f, 0.01f},
                                              {0.06f, 0.1f},
                                              {0.05f, 0.13f},
                                              {0.015f, 0.2f}},
                                             kSides));
    append(to.glass.lantern_panes,
           polygonal_lathe(foot, {{kRadius - 0.012f, 0.02f}, {kRadius, kHeight - 0.01f}}, kSides));
    for (int i = 0; i < kSides; ++i) {
        const float angle = kTurn * (static_cast<float>(i) + 0.5f) / kSides;
        const glm::vec3 post = 1.15f * kRadius * glm::vec3(std::sin(angle), 0, std::cos(angle));
        append(to.building.iron, bar(foot + post, foot + post + glm::vec3(0, kHeight, 0), 0.01f, 4));
    }
    append(to.glass.flames, lathe(foot, {{0.012f, 0.02f}, {0.03f, 0.06f}, {0.022f, 0.1f}, {0, 0.15f}}, 8));
    // Above the flame, so that the flame does not block the lamp.
    const std::string name = "Lantern" + std::to_string(to.lamps.size() + 1);
    to.lamps.push_back({name, foot + glm::vec3(0, 0.2f, 0), {1, 0.62f, 0.27f}, kIntensity, 14});
}

void add_bracket(Courtyard& to, const glm::vec3& wall, const glm::vec3& ring) {
    append(to.building.iron, bar(wall, {ring.x, wall.y, ring.z}, 0.015f));
    append(to.building.iron, bar(wall - glm::vec3(0, 0.3f, 0),
                                 glm::mix(wall, glm::vec3(ring.x, wall.y, ring.z), 0.7f), 0.012f));
    append(to.building.iron, bar(ring, {ring.x, wall.y, ring.z}, 0.008f));
}

} // namespace

void add_lanterns(Courtyard& to) {
    for (const glm::mat4& wing : {left_wing(), back_wing()})
        for (const float bay : {0.5f, 2.5f, 4.5f}) {
            const glm::vec3 crown = wing * glm::vec4(bay * kBay, kSpring + kArch, -kArcadeWall / 2, 1);
            const glm::vec3 ring = crown - glm::vec3(0, 0.22f, 0);
            append(to.building.iron, bar(ring, crown, 0.008f));
            add_lantern(to, ring);
        }
    for (const float z : {-3.1f, -9.9f}) {
        const glm::vec3 wall(kHalf, 2.6f, z), ring(kHalf - 0.4f, 2.5f, z);
        add_bracket(to, wall, ring);
        add_lantern(to, ring);
    }
}

} // namespace examples
