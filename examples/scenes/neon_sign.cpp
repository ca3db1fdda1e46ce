// Paints the neon sign from strokes.

#include "neon_sign.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace examples {
namespace {

using Stroke = std::vector<glm::vec2>;

float distance_to(const Stroke& stroke, const glm::vec2& p) {
    float nearest = 1e9f;
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
        const glm::vec2 a = stroke[i], along = stroke[i + 1] - a;
        const float t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0f, 1.0f);
        nearest = std::min(nearest, glm::distance(p, a + t * along));
    }
    return nearest;
}

/// Half an ellipse to the right of x, from `high` to `low`.
Stroke bow(float x, float high, float low, float reach) {
    Stroke stroke;
    for (int i = 0; i <= 16; ++i) {
        const float angle = 3.14159265f * static_cast<float>(i) / 16;
        stroke.emplace_back(x + reach * std::sin(angle),
                            (high + low) / 2 - (high - low) / 2 * -std::cos(angle));
    }
    return stroke;
}

/// Strokes in a field of 2 x 1, y downwards.
std::vector<Stroke> letters() {
    Stroke wave;
    for (int i = 0; i <= 60; ++i) {
        const float t = static_cast<float>(i) / 60;
        wave.emplace_back(0.25f + 1.5f * t, 0.84f + 0.05f * std::sin(6.2831853f * 3 * t));
    }
    return {{{0.32f, 0.68f}, {0.32f, 0.14f}, {0.45f, 0.14f}},
            bow(0.45f, 0.14f, 0.42f, 0.19f),
            {{0.45f, 0.42f}, {0.32f, 0.42f}},
            {{0.84f, 0.68f}, {0.84f, 0.14f}, {0.97f, 0.14f}},
            bow(0.97f, 0.14f, 0.42f, 0.19f),
            {{0.97f, 0.42f}, {0.84f, 0.42f}},
            {{0.97f, 0.42f}, {1.18f, 0.68f}},
            {{1.3f, 0.14f}, {1.74f, 0.14f}},
            {{1.52f, 0.14f}, {1.52f, 0.68f}},
            wave};
}

} // namespace

SharedPicture neon_sign_picture() {
    return painted("neon sign", 256, 128, [strokes = letters()](float u, float v) {
        float nearest = 1e9f;
        for (const Stroke& stroke : strokes)
            nearest = std::min(nearest, distance_to(stroke, {2 * u, v}));
        const float tube = 1 - glm::smoothstep(0.018f, 0.032f, nearest),
                    halo = 0.12f * std::exp(-nearest / 0.06f);
        return glm::vec3(std::min(1.0f, tube + halo));
    });
}

} // namespace examples
