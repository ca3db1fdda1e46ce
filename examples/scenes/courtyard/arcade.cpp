// The ground floor: round arches on columns, and galleries with beams behind them.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <algorithm>
#include <cmath>

namespace examples {
namespace {

using namespace plan;

constexpr float kRing = 0.15f; ///< breadth of the stones round an arch
constexpr float kCeiling = 4.06f;

/// Returns the lower edge of the wall over an arch from `x` to `x + width` in the plane z = 0, from left to
/// right: from the foot of the arch to the storey. The first and the last point are on the pier.
std::vector<glm::vec2> arch_feet(float x, float width) {
    constexpr int kSteps = 22;
    const float middle = x + width / 2, radius = kArch + kRing - 0.02f;
    std::vector<glm::vec2> feet = {{x, kSpring}};
    for (int i = 0; i <= kSteps; ++i) {
        const float angle = kTurn / 2 * (1 - static_cast<float>(i) / kSteps);
        feet.emplace_back(middle + radius * std::cos(angle), kSpring + radius * std::sin(angle));
    }
    feet.emplace_back(x + width, kSpring);
    return feet;
}

/// Returns the wall above a row of arches, facing +z.
Mesh spandrels(float width, int bays) {
    constexpr int kRows = 9;
    std::vector<std::vector<glm::vec3>> rows(kRows + 1);
    for (int bay = 0; bay < bays; ++bay) {
        const std::vector<glm::vec2> feet = arch_feet(static_cast<float>(bay) * width, width);
        for (std::size_t i = bay == 0 ? 0 : 1; i < feet.size(); ++i)
            for (int row = 0; row <= kRows; ++row)
                rows[static_cast<std::size_t>(row)].emplace_back(
                    feet[i].x, std::lerp(feet[i].y, kStorey, static_cast<float>(row) / kRows), 0);
    }
    return lofted(rows);
}

/// Returns the back of this wall, at z = -kArcadeWall.
Mesh spandrels_behind(float width, int bays) {
    return placed(spandrels(width, bays),
                  placement({width * static_cast<float>(bays), 0, -kArcadeWall}, 180));
}

/// Returns the stones around an arch, which protrude from the wall, and their visible underside.
Mesh arch_ring(float middle) {
    std::vector<Station> way;
    constexpr int kSteps = 26;
    for (int i = 0; i <= kSteps; ++i) {
        const float angle = kTurn / 2 * (1 - static_cast<float>(i) / kSteps);
        const glm::vec3 radial(std::cos(angle), std::sin(angle), 0);
        way.push_back({glm::vec3(middle, kSpring, 0) + kArch * radial, {0, 0, 1}, radial});
    }
    constexpr float kProud = 0.045f, kBack = -kArcadeWall - 0.03f;
    const Outline outline = {{kBack, kRing},
                             {kBack, 0},
                             {kBack, 0},
                             {kProud, 0},
                             {kProud, 0},
                             {kProud, 0.09f},
                             {kProud, 0.09f},
                             {kProud - 0.02f, 0.1f},
                             {kProud - 0.02f, 0.1f},
                             {kProud - 0.02f, kRing},
                             {kProud - 0.02f, kRing},
                             {-0.01f, kRing}};
    return moulding(outline, way);
}

/// A column with base and capital, from the step to the spring of the arches.
Mesh arcade_column(float x) {
    const glm::vec3 foot(x, kStep, -kArcadeWall / 2);
    const float height = kSpring - kStep;
    const Outline shaft = {{0.215f, 0.1f},           {0.215f, 0.13f},          {0.215f, 0.13f},
                           {0.235f, 0.15f},          {0.24f, 0.175f},          {0.225f, 0.2f},
                           {0.19f, 0.215f},          {0.19f, 0.215f},          {0.175f, 0.24f},
                           {0.165f, 0.3f},           {0.165f, 1.0f},           {0.15f, height - 0.42f},
                           {0.15f, height - 0.42f},  {0.175f, height - 0.41f}, {0.18f, height - 0.385f},
                           {0.165f, height - 0.37f}, {0.165f, height - 0.37f}, {0.165f, height - 0.3f},
                           {0.19f, height - 0.2f},   {0.25f, height - 0.13f}};
    Mesh mesh = lathe(foot, shaft, 20);
    append(mesh, box(foot + glm::vec3(-0.25f, 0, -0.25f), foot + glm::vec3(0.25f, 0.1f, 0.25f)));
    append(mesh, box(foot + glm::vec3(-0.25f, height - 0.13f, -0.25f),
                     foot + glm::vec3(0.25f, height + 0.015f, 0.25f)));
    return mesh;
}

/// A row of arches with columns between them, in the frame of its wing.
void add_arches(Mesh& stone, Mesh& plaster, const glm::mat4& wing) {
    append(plaster, placed(spandrels(kBay, kBays), wing));
    append(plaster, placed(spandrels_behind(kBay, kBays), wing));
    for (int bay = 0; bay < kBays; ++bay)
        append(stone, placed(arch_ring((static_cast<float>(bay) + 0.5f) * kBay), wing));
    for (int i = 1; i < kBays; ++i)
        append(stone, placed(arcade_column(static_cast<float>(i) * kBay), wing));
}

/// A pillar with a base, as high as the storey.
void add_pillar(Mesh& stone, const glm::vec2& low, const glm::vec2& high) {
    append(stone, box({low.x, 0, low.y}, {high.x, kStorey, high.y}));
    append(stone, box({low.x - 0.05f, 0, low.y - 0.05f}, {high.x + 0.05f, 0.4f, high.y + 0.05f}));
    append(stone, box({low.x - 0.05f, kSpring - 0.12f, low.y - 0.05f},
                      {high.x + 0.05f, kSpring + 0.015f, high.y + 0.05f}));
}

/// A wall of a gallery from x = 0 to `length`, facing +z: glazed tiles, a band of stone, plaster above.
void add_gallery_wall(Courtyard& to, float length, const glm::mat4& position) {
    constexpr float kDado = 1.3f;
    append(to.building.glazed_tiles, placed(wall_with_openings({0, kStep}, {length, kDado}, {}), position));
    append(to.building.plaster, placed(wall_with_openings({0, kDado}, {length, kCeiling}, {}), position));
    append(to.building.stone, placed(moulding({{0, kDado - 0.05f},
                                               {0.04f, kDado - 0.04f},
                                               {0.04f, kDado - 0.04f},
                                               {0.04f, kDado + 0.03f},
                                               {0.04f, kDado + 0.03f},
                                               {0, kDado + 0.05f}},
                                              straight_way({0, 0, 0}, {length, 0, 0})),
                                     position));
}

/// A double door in a frame of stone, before the wall z = 0.
void add_door(Courtyard& to, float x, const glm::mat4& position) {
    constexpr float kWidth = 1.5f, kTop = 2.6f, kFrame = 0.16f;
    const float left = x - kWidth / 2, right = x + kWidth / 2;
    append(to.building.stone, placed(box({left - kFrame, kStep, 0}, {left, kTop + kFrame, 0.1f}), position));
    append(to.building.stone,
           placed(box({right, kStep, 0}, {right + kFrame, kTop + kFrame, 0.1f}), position));
    append(to.building.stone, placed(box({left, kTop, 0}, {right, kTop + kFrame, 0.1f}), position));
    for (const float half : {left, x + 0.01f}) {
        const float end = half + kWidth / 2 - 0.01f;
        append(to.building.painted_wood, placed(box({half, kStep, 0}, {end, kTop, 0.04f}), position));
        for (int panel = 0; panel < 3; ++panel) {
            const float low = kStep + 0.14f + 0.79f * static_cast<float>(panel);
            append(to.building.painted_wood,
                   placed(box({half + 0.12f, low, 0.04f}, {end - 0.12f, low + 0.6f, 0.065f}), position));
        }
    }
}

/// A ceiling of boards on beams, which lie across.
void add_ceiling(Courtyard& to, float length, float depth, const glm::mat4& position) {
    append(to.building.wood,
           placed(rectangle({0, kCeiling, -depth}, {length, 0, 0}, {0, 0, depth}, kShapeSpacing), position));
    const int beams = static_cast<int>(length / 0.73f);
    for (int i = 0; i <= beams; ++i) {
        const float x = length * static_cast<float>(i) / static_cast<float>(beams);
        append(to.building.wood,
               placed(box({x - 0.07f, kCeiling - 0.2f, -depth}, {x + 0.07f, kCeiling - 0.005f, 0}, 0.3f),
                      position));
    }
}

} // namespace

void add_arcades(Courtyard& to) {
    const float inner = kArcadeWall + kGallery;
    add_arches(to.building.stone, to.building.plaster, left_wing());
    add_arches(to.building.stone, to.building.plaster, back_wing());
    // Galleries: walls begin at the outer corner and overlap nowhere.
    const glm::mat4 left = placement({-kHalf - inner, 0, 0}, 90),
                    back = placement({-kHalf - inner, 0, -kDeep - inner}, 0),
                    right = placement({kHalf, 0, -kDeep - inner}, -90);
    add_gallery_wall(to, kDeep + inner, left);
    add_gallery_wall(to, 2 * kHalf + inner, back);
    add_gallery_wall(to, inner, right);
    add_door(to, 1.5f * kBay, left);
    add_door(to, 3.5f * kBay, left);
    add_door(to, inner + 2.5f * kBay, back);
    add_ceiling(to, kDeep + kArcadeWall, kGallery, placement({-kHalf - kArcadeWall, 0, 0}, 90));
    add_ceiling(to, 2 * kHalf + inner, kGallery, placement({-kHalf - inner, 0, -kDeep - kArcadeWall}, 0));
    // The end of the left gallery is an arch between two pillars.
    const float width = kWing;
    const glm::mat4 end = placement({-kHalf - kWing, 0, 0}, 0);
    append(to.building.plaster, placed(spandrels(width, 1), end));
    append(to.building.plaster, placed(spandrels_behind(width, 1), end));
    append(to.building.stone, placed(arch_ring(width / 2), end));
    const float pier = width / 2 - kArch - 0.06f, outer = -kHalf - kWing;
    add_pillar(to.building.stone, {outer, -kArcadeWall - 0.02f}, {outer + pier, 0.02f});
    add_pillar(to.building.stone, {-kHalf - pier, -kArcadeWall - 0.02f}, {-kHalf + 0.02f, 0.02f});
    // Corners of the court.
    add_pillar(to.building.stone, {-kHalf - kArcadeWall - 0.06f, -kDeep - kArcadeWall - 0.06f},
               {-kHalf + 0.06f, -kDeep + 0.06f});
    add_pillar(to.building.stone, {kHalf - 0.06f, -kDeep - kArcadeWall - 0.06f},
               {kHalf + kOuterWall, -kDeep + 0.06f});
}

} // namespace examples
