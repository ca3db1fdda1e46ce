// Tone mapping by the rational fit of Narkowicz (2016) to the ACES curve, and averaging of samples.
#include "prt/render/tone_map.h"

#include "prt/core/light.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

float filmic(float x) {
    return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}

/// Calls `sum(x, y, pixel)` for every sample of every pixel of the smaller image.
template <class Sum>
void for_each_sample(const Image& image, int samples, Sum&& sum) {
    for (int y = 0; y < image.height / samples * samples; ++y)
        for (int x = 0; x < image.width / samples * samples; ++x)
            sum(x / samples, y / samples, image.at(x, y));
}

Image empty_smaller(const Image& image, int samples) {
    Image small{image.width / samples, image.height / samples, {}};
    small.pixels.resize(static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
    return small;
}

} // namespace

float automatic_exposure(const Light& light) {
    // The mean radiance over the sphere is L_0 Y_00.
    const float mean = luminance(light.coefficients[0] * static_cast<float>(kY00));
    return mean > 0 ? 0.25f / mean : 1.0f;
}

Image downsampled(const Image& image, int samples) {
    Image small = empty_smaller(image, samples);
    const float share = 1.0f / static_cast<float>(samples * samples);
    for_each_sample(image, samples,
                    [&](int x, int y, const glm::vec3& pixel) { small.at(x, y) += pixel * share; });
    return small;
}

std::vector<glm::u8vec3> tone_mapped(const Image& image, int samples, float exposure, ToneMap tone_map) {
    Image small = empty_smaller(image, samples);
    const float share = 1.0f / static_cast<float>(samples * samples);
    for_each_sample(image, samples, [&](int x, int y, const glm::vec3& pixel) {
        for (int c = 0; c < 3; ++c) {
            float value = std::max(0.0f, pixel[c] * exposure);
            if (tone_map == ToneMap::filmic)
                value = filmic(std::min(value, 1e4f));
            small.at(x, y)[c] += share * std::min(value, 1.0f);
        }
    });
    std::vector<glm::u8vec3> result;
    result.reserve(small.pixels.size());
    for (const glm::vec3& pixel : small.pixels) {
        glm::u8vec3 encoded;
        for (int c = 0; c < 3; ++c)
            encoded[c] = static_cast<std::uint8_t>(std::lround(255 * srgb_encode(pixel[c])));
        result.push_back(encoded);
    }
    return result;
}

} // namespace prt
