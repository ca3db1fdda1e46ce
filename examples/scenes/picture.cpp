// Paints pictures in sRGB.

#include "picture.h"

#include <glm/common.hpp>

#include <cmath>

namespace examples {
namespace {

float srgb_encoded(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

} // namespace

SharedPicture painted(const std::string& name, int width, int height,
                      const std::function<glm::vec3(float u, float v)>& color) {
    auto picture = std::make_shared<Picture>(Picture{name, width, height, {}});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec3 linear =
                glm::clamp(color((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                 (static_cast<float>(y) + 0.5f) / static_cast<float>(height)),
                           0.0f, 1.0f);
            picture->pixels.emplace_back(glm::round(
                255.0f * glm::vec3(srgb_encoded(linear.r), srgb_encoded(linear.g), srgb_encoded(linear.b))));
        }
    return picture;
}

} // namespace examples
