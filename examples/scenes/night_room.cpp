// The room at night: a ceiling lamp, a table lamp, a coloured floor lamp, and a neon sign on the back wall.

#include "example_scenes.h"
#include "neon_sign.h"
#include "shapes.h"

#include <cmath>

namespace examples {
namespace {

/// Meshes of the lamps by material.
struct Fixtures {
    Mesh brass, shades, bulbs, cool_bulbs, table;
    std::vector<GltfLight> lamps;
};

constexpr glm::vec3 kWarm(1, 0.72f, 0.42f);
/// Bulbs and shades are visible by their emission. If they reflected the lamp, which is centimetres away,
/// they would be many times brighter than the room, and bounces would be noisy, because few rays hit them.
constexpr glm::vec3 kBulb(0);

/// A bell of sheet metal under a cord, open below; the bulb looks out of it.
void add_ceiling_lamp(Fixtures& to, const glm::vec3& position) {
    append(to.brass, bar(position + glm::vec3(0, 0.3f, 0), position + glm::vec3(0, 1.3f, 0), 0.012f));
    append(to.brass, lathe(position, {{0.36f, 0}, {0.3f, 0.12f}, {0.14f, 0.24f}, {0.03f, 0.3f}}, 32));
    append(to.brass,
           lathe(position, {{0.02f, 0.29f}, {0.13f, 0.225f}, {0.29f, 0.11f}, {0.355f, 0}}, 32)); // its inside
    append(to.bulbs, sphere(position + glm::vec3(0, 0.1f, 0), 0.07f, 20));
    to.lamps.push_back(
        {"LampCeiling", position + glm::vec3(0, 0.02f, 0), kWarm, 16, 12, {0, -1, 0}, 0.6f, 1.15f});
}

/// Adds an emissive cloth shade on a lathed foot, on a round table.
void add_table_lamp(Fixtures& to, const glm::vec3& floor) {
    constexpr float kTable = 0.72f;
    append(to.table, lathe(floor,
                           {{0.26f, 0},
                            {0.26f, 0.03f},
                            {0.26f, 0.03f},
                            {0.06f, 0.08f},
                            {0.045f, 0.3f},
                            {0.05f, kTable - 0.06f},
                            {0.12f, kTable - 0.035f},
                            {0.12f, kTable - 0.035f},
                            {0.46f, kTable - 0.035f},
                            {0.46f, kTable - 0.035f},
                            {0.48f, kTable - 0.02f},
                            {0.47f, kTable},
                            {0.47f, kTable},
                            {0, kTable}},
                           40));
    const glm::vec3 foot = floor + glm::vec3(0, kTable, 0);
    append(to.brass, lathe(foot,
                           {{0.11f, 0},
                            {0.11f, 0.02f},
                            {0.11f, 0.02f},
                            {0.04f, 0.05f},
                            {0.07f, 0.14f},
                            {0.08f, 0.18f},
                            {0.03f, 0.26f},
                            {0.015f, 0.3f},
                            {0.015f, 0.36f}},
                           24));
    append(to.bulbs, sphere(foot + glm::vec3(0, 0.39f, 0), 0.035f, 16));
    // Outside and inside.
    append(to.shades, lathe(foot + glm::vec3(0, 0.3f, 0), {{0.24f, 0}, {0.15f, 0.28f}}, 32));
    append(to.shades, lathe(foot + glm::vec3(0, 0.3f, 0), {{0.145f, 0.28f}, {0.235f, 0}}, 32));
    to.lamps.push_back({"LampTable", foot + glm::vec3(0, 0.45f, 0), kWarm, 4, 10});
}

/// A bowl on a stem that throws blue light at the ceiling.
void add_floor_lamp(Fixtures& to, const glm::vec3& floor) {
    constexpr float kTop = 1.75f;
    append(to.brass, lathe(floor,
                           {{0.17f, 0},
                            {0.17f, 0.03f},
                            {0.17f, 0.03f},
                            {0.02f, 0.06f},
                            {0.015f, 0.2f},
                            {0.015f, kTop - 0.1f},
                            {0.09f, kTop - 0.06f},
                            {0.19f, kTop + 0.03f},
                            {0.19f, kTop + 0.03f},
                            {0.18f, kTop + 0.035f},
                            {0.08f, kTop - 0.045f},
                            {0, kTop - 0.05f}},
                           28));
    append(to.cool_bulbs, sphere(floor + glm::vec3(0, kTop, 0), 0.045f, 16));
    to.lamps.push_back({"LampBlue",
                        floor + glm::vec3(0, kTop + 0.06f, 0),
                        {0.18f, 0.42f, 1},
                        14,
                        10,
                        {0, 1, 0},
                        0.5f,
                        1.35f});
}

} // namespace

ExampleScene night_room() {
    ExampleScene scene = room_with_columns();
    Fixtures fixtures;
    add_ceiling_lamp(fixtures, {0, 2.7f, -1.6f});
    add_table_lamp(fixtures, {-1.5f, 0, -6.2f});
    add_floor_lamp(fixtures, {1.75f, 0, -9.1f});
    // The sign is in a case, slightly in front of the back wall.
    constexpr float kWide = 2.6f, kHigh = 1.3f, kWall = -10, kProud = 0.12f;
    const glm::vec3 corner(-0.3f - kWide / 2, 1.55f, kWall + kProud);
    const Mesh face = parametric_surface(
        52, 26, [&](float u, float v) { return corner + glm::vec3(u * kWide, v * kHigh, 0); });
    Part sign = shining({"Sign", {0.02f, 0.02f, 0.025f}, face}, {1, 0.16f, 0.3f}, 6);
    sign.emission.picture = neon_sign_picture();
    Mesh frame;
    const glm::vec3 low(corner.x - 0.06f, corner.y - 0.06f, kWall),
        high(corner.x + kWide + 0.06f, corner.y + kHigh + 0.06f, kWall + kProud + 0.03f);
    append(frame, box(low, {high.x, corner.y, high.z}));
    append(frame, box({low.x, corner.y + kHigh, low.z}, high));
    append(frame, box({low.x, corner.y, low.z}, {corner.x, corner.y + kHigh, high.z}));
    append(frame, box({corner.x + kWide, corner.y, low.z}, {high.x, corner.y + kHigh, high.z}));
    append(fixtures.table, frame);
    const std::vector<Part> things = {
        {"brass", {0.5f, 0.36f, 0.16f}, fixtures.brass},
        {"wood", {0.24f, 0.13f, 0.07f}, fixtures.table},
        shining({"LampTable shade", kBulb, fixtures.shades}, kWarm, 1.6f),
        shining({"Bulbs", kBulb, fixtures.bulbs}, kWarm, 12),
        shining({"Blue bulb", kBulb, fixtures.cool_bulbs}, {0.18f, 0.42f, 1}, 12),
        sign};
    scene.parts.insert(scene.parts.end(), things.begin(), things.end());
    scene.lamps = fixtures.lamps;
    return scene;
}

} // namespace examples
