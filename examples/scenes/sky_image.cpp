#include "sky_image.h"

#include "prt/sky.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace examples {
namespace {

constexpr double kPi = 3.14159265358979323846;
const glm::dvec3 kGroundAlbedo(0.24, 0.2, 0.15);

} // namespace

prt::Environment preetham_sky(int height, double turbidity, const glm::dvec3& sun) {
    const prt::PreethamSky sky(turbidity, sun);
    // A disc of 2.5 degrees instead of 0.27, so that the image resolves it, with four times the sky's
    // irradiance.
    constexpr double kSunRadius = 2.5 * kPi / 180;
    const double sun_solid_angle = 2 * kPi * (1 - std::cos(kSunRadius));
    const glm::dvec3 sun_radiance =
        glm::dvec3(1, 0.9, 0.75) * (4 * kPi * 0.5 * sky.zenith_luminance() / sun_solid_angle);

    prt::Environment environment;
    prt::Image& image = environment.image;
    image.width = 2 * height;
    image.height = height;
    glm::dvec3 sky_irradiance(0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 d = prt::lat_long_direction(image.width, height, x + 0.5, y + 0.5);
            glm::dvec3 pixel(0);
            if (d.y > 0) {
                const double gamma = std::acos(std::clamp(glm::dot(d, sun), -1.0, 1.0));
                pixel = sky.radiance(d);
                if (gamma < kSunRadius)
                    pixel += sun_radiance;
                const double solid_angle = 2 * kPi / image.width * kPi / height * std::sqrt(1 - d.y * d.y);
                sky_irradiance += pixel * (d.y * solid_angle);
            } else {
                pixel = sky_irradiance * kGroundAlbedo / kPi; // the upper rows came first
            }
            image.pixels.emplace_back(pixel);
        }
    }
    return environment;
}

} // namespace examples
