// Hills by fractal value noise.

#include "example_scenes.h"

#include <cmath>

namespace examples {
namespace {

float lattice(int x, int y) {
    auto h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24f;
}

/// Value noise with quintic interpolation, in [0, 1].
float noise(float x, float y) {
    const float fx = std::floor(x), fy = std::floor(y);
    const int i = static_cast<int>(fx), j = static_cast<int>(fy);
    const auto fade = [](float t) { return t * t * t * (t * (6 * t - 15) + 10); };
    const float u = fade(x - fx), v = fade(y - fy);
    return std::lerp(std::lerp(lattice(i, j), lattice(i + 1, j), u),
                     std::lerp(lattice(i, j + 1), lattice(i + 1, j + 1), u), v);
}

float height(float x, float z) {
    float sum = 0, amplitude = 1.9f, frequency = 0.22f;
    for (int octave = 0; octave < 5; ++octave) {
        const float valley = std::abs(2 * noise(x * frequency + 31, z * frequency + 17) - 1);
        sum += amplitude * (1 - valley * valley);
        amplitude *= 0.38f;
        frequency *= 2.03f;
    }
    return sum;
}

} // namespace

ExampleScene terrain() {
    constexpr float kSize = 12;
    const auto surface = [](float u, float v) {
        const float x = kSize * (u - 0.5f), z = kSize * (0.5f - v);
        return glm::vec3(x, height(x, z), z);
    };
    return {{"hills", {0.3f, 0.26f, 0.16f}, parametric_surface(150, 150, surface)}};
}

} // namespace examples
