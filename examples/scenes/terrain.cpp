// Hills by fractal value noise.

#include "example_scenes.h"
#include "noise.h"

#include <cmath>

namespace examples {
namespace {

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
    return {.parts = {{"hills", {0.3f, 0.26f, 0.16f}, parametric_surface(150, 150, surface)}}};
}

} // namespace examples
