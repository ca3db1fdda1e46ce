// A room, open to the front and through a skylight, with two rows of columns and colored side walls.

#include "example_scenes.h"

#include <cmath>

namespace examples {
namespace {

constexpr float kWidth = 8, kHeight = 4, kDepth = 10;

/// How large its triangles are.
struct Fineness {
    float spacing; ///< metres, on flat surfaces
    int rows;      ///< per column
};

Mesh column(float x, float z, int rows) {
    constexpr float kRadius = 0.3f;
    return parametric_surface(24, rows, [&](float u, float v) {
        return glm::vec3(x + kRadius * std::sin(kTurn * u), v * kHeight, z + kRadius * std::cos(kTurn * u));
    });
}

/// The ceiling round a skylight in its middle.
Mesh ceiling(float spacing) {
    const float hole = 1.2f;
    Mesh mesh;
    const auto strip = [&](float x0, float x1, float z0, float z1) {
        append(mesh, rectangle({x0, kHeight, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0}, spacing));
    };
    strip(-kWidth / 2, -hole, -kDepth, 0);
    strip(hole, kWidth / 2, -kDepth, 0);
    strip(-hole, hole, -kDepth, -kDepth / 2 - 2 * hole);
    strip(-hole, hole, -kDepth / 2 + 2 * hole, 0);
    return mesh;
}

ExampleScene room(const Fineness& fineness) {
    const float w = kWidth / 2;
    Mesh columns;
    for (const float x : {-w + 1.4f, w - 1.4f})
        for (int i = 0; i < 4; ++i)
            append(columns, column(x, -1.4f - 2.4f * static_cast<float>(i), fineness.rows));
    return {.parts = {{"floor",
                       {0.7f, 0.7f, 0.68f},
                       rectangle({-w, 0, 0}, {kWidth, 0, 0}, {0, 0, -kDepth}, fineness.spacing)},
                      {"ceiling", {0.8f, 0.8f, 0.8f}, ceiling(fineness.spacing)},
                      {"back wall",
                       {0.8f, 0.8f, 0.8f},
                       rectangle({-w, 0, -kDepth}, {kWidth, 0, 0}, {0, kHeight, 0}, fineness.spacing)},
                      {"left wall",
                       {0.75f, 0.12f, 0.08f},
                       rectangle({-w, 0, 0}, {0, 0, -kDepth}, {0, kHeight, 0}, fineness.spacing)},
                      {"right wall",
                       {0.1f, 0.45f, 0.12f},
                       rectangle({w, 0, -kDepth}, {0, 0, kDepth}, {0, kHeight, 0}, fineness.spacing)},
                      {"columns", {0.85f, 0.83f, 0.78f}, columns}}};
}

} // namespace

ExampleScene room_with_columns() {
    return room({0.16f, 24});
}

ExampleScene plain_room() {
    return room({100, 1});
}

} // namespace examples
