// Samples the texels of an environment in proportion to their power.

#include "bake/reference/distant_light.h"

#include "prt/core/light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {

DistantLight::DistantLight(Image environment, std::vector<Sun> suns)
    : environment_(std::move(environment)), suns_(std::move(suns)) {
    cumulative_.reserve(environment_.pixels.size() + 1);
    cumulative_.push_back(0);
    for (int y = 0; y < environment_.height; ++y)
        for (int x = 0; x < environment_.width; ++x) {
            const glm::dvec3 radiance(environment_.at(x, y));
            cumulative_.push_back(cumulative_.back() + std::max(luminance(radiance), 0.0) * solid_angle(y));
        }
}

double DistantLight::solid_angle(int row) const {
    const double step = std::numbers::pi / environment_.height;
    return 2 * std::numbers::pi / environment_.width * (std::cos(row * step) - std::cos((row + 1) * step));
}

std::size_t DistantLight::texel(const glm::vec3& direction) const {
    const glm::dvec2 at = lat_long_position(environment_.width, environment_.height, glm::dvec3(direction));
    const int x = std::clamp(static_cast<int>(at.x), 0, environment_.width - 1),
              y = std::clamp(static_cast<int>(at.y), 0, environment_.height - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(environment_.width) +
           static_cast<std::size_t>(x);
}

DistantLight::Sample DistantLight::sample(const glm::vec2& u) const {
    const double total = cumulative_.back();
    if (!(total > 0))
        return {{0, 1, 0}, glm::vec3(0), 0};
    const double wanted = std::min(static_cast<double>(u.x), 1 - 1e-9) * total;
    const auto after = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, wanted);
    const auto index = static_cast<std::size_t>(after - cumulative_.begin()) - 1;
    const double power = cumulative_[index + 1] - cumulative_[index];
    const int width = environment_.width, row = static_cast<int>(index) / width;
    // Uniform over the texel: the remainder of u.x selects the position in the row, u.y the cosine to +Y.
    const double along = power > 0 ? (wanted - cumulative_[index]) / power : 0.5;
    const double step = std::numbers::pi / environment_.height;
    const double top = std::cos(row * step), bottom = std::cos((row + 1) * step);
    const double polar = std::acos(std::clamp(top + static_cast<double>(u.y) * (bottom - top), -1.0, 1.0));
    const double x = static_cast<double>(static_cast<int>(index) % width) + along;
    const glm::dvec3 direction = lat_long_direction(width, environment_.height, x, polar / step);
    return {glm::vec3(direction), environment_.pixels[index],
            static_cast<float>(power / (total * solid_angle(row)))};
}

glm::vec3 DistantLight::radiance(const glm::vec3& direction) const {
    return environment_.pixels.empty() ? glm::vec3(0) : environment_.pixels[texel(direction)];
}

float DistantLight::density(const glm::vec3& direction) const {
    if (!(cumulative_.back() > 0))
        return 0;
    const std::size_t i = texel(direction);
    const int row = static_cast<int>(i) / environment_.width;
    return static_cast<float>((cumulative_[i + 1] - cumulative_[i]) /
                              (cumulative_.back() * solid_angle(row)));
}

} // namespace prt
