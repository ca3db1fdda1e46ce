// Computes value noise from a hash of lattice points.

#include "noise.h"

#include <cmath>

namespace examples {

float lattice(int x, int y) {
    auto h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24f;
}

float noise(float x, float y, int period) {
    const float fx = std::floor(x), fy = std::floor(y);
    const auto wrapped = [&](int i) { return period > 0 ? (i % period + period) % period : i; };
    const int i = wrapped(static_cast<int>(fx)), j = wrapped(static_cast<int>(fy));
    const int next_i = wrapped(i + 1), next_j = wrapped(j + 1);
    const auto fade = [](float t) { return t * t * t * (t * (6 * t - 15) + 10); };
    const float u = fade(x - fx), v = fade(y - fy);
    return std::lerp(std::lerp(lattice(i, j), lattice(next_i, j), u),
                     std::lerp(lattice(i, next_j), lattice(next_i, next_j), u), v);
}

float tiling_noise(float u, float v, int frequency, int octaves) {
    float sum = 0, total = 0, amplitude = 1;
    for (int octave = 0; octave < octaves; ++octave, frequency *= 2, amplitude *= 0.5f) {
        const auto f = static_cast<float>(frequency);
        sum += amplitude * noise(u * f, v * f, frequency);
        total += amplitude;
    }
    return sum / total;
}

} // namespace examples
