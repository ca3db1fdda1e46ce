// A room, open to the front and through a skylight, with two rows of columns and colored side walls.

#include "example_scenes.h"

#include <cmath>

namespace examples {
namespace {

constexpr float kWidth = 8, kHeight = 4, kDepth = 10, kSpacing = 0.16f;

Mesh column(float x, float z) {
    constexpr float kRadius = 0.3f;
    return parametric_surface(24, 24, [&](float u, float v) {
        return glm::vec3(x + kRadius * std::sin(kTurn * u), v * kHeight, z + kRadius * std::cos(kTurn * u));
    });
}

/// The ceiling round a skylight in its middle.
Mesh ceiling() {
    const float hole = 1.2f;
    Mesh mesh;
    const auto strip = [&](float x0, float x1, float z0, float z1) {
        append(mesh, rectangle({x0, kHeight, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0}, kSpacing));
    };
    strip(-kWidth / 2, -hole, -kDepth, 0);
    strip(hole, kWidth / 2, -kDepth, 0);
    strip(-hole, hole, -kDepth, -kDepth / 2 - 2 * hole);
    strip(-hole, hole, -kDepth / 2 + 2 * hole, 0);
    return mesh;
}

} // namespace

ExampleScene room_with_columns() {
    const float w = kWidth / 2;
    Mesh columns;
    for (const float x : {-w + 1.4f, w - 1.4f})
        for (int i = 0; i < 4; ++i)
            append(columns, column(x, -1.4f - 2.4f * static_cast<float>(i)));
    return {
        .parts = {
            {"floor", {0.7f, 0.7f, 0.68f}, rectangle({-w, 0, 0}, {kWidth, 0, 0}, {0, 0, -kDepth}, kSpacing)},
            {"ceiling", {0.8f, 0.8f, 0.8f}, ceiling()},
            {"back wall",
             {0.8f, 0.8f, 0.8f},
             rectangle({-w, 0, -kDepth}, {kWidth, 0, 0}, {0, kHeight, 0}, kSpacing)},
            {"left wall",
             {0.75f, 0.12f, 0.08f},
             rectangle({-w, 0, 0}, {0, 0, -kDepth}, {0, kHeight, 0}, kSpacing)},
            {"right wall",
             {0.1f, 0.45f, 0.12f},
             rectangle({w, 0, -kDepth}, {0, 0, kDepth}, {0, kHeight, 0}, kSpacing)},
            {"columns", {0.85f, 0.83f, 0.78f}, columns}}};
}

} // namespace examples
