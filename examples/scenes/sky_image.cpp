// Computes sunny and night skies as lat-long images.

#include "sky_image.h"

#include "prt/core/light.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace examples {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSunRadius = 0.265 * kPi / 180; ///< radius of sun and moon
const glm::dvec3 kGroundAlbedo(0.24, 0.2, 0.15);
const glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722); // weights for linear Rec. 709

/// Returns a lat-long image of radiance above the horizon, by direction; below is ground lit by that sky and
/// by `sun_irradiance`, which is added to it. Directions are those of texel centers.
prt::Environment over_ground(int height, const glm::dvec3& sun_irradiance,
                             const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
    prt::Environment environment;
    prt::Image& image = environment.image;
    image.width = 2 * height;
    image.height = height;
    glm::dvec3 irradiance = sun_irradiance;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 d = prt::lat_long_direction(image.width, height, x + 0.5, y + 0.5);
            glm::dvec3 pixel = irradiance * kGroundAlbedo / kPi; // the upper rows came first
            if (d.y > 0) {
                pixel = radiance(d);
                const double solid_angle = 2 * kPi / image.width * kPi / height * std::sqrt(1 - d.y * d.y);
                irradiance += pixel * (d.y * solid_angle);
            }
            image.pixels.emplace_back(pixel);
        }
    return environment;
}

/// Adds a disc of the given irradiance on a surface that faces it. Each texel gets the fraction of the disc
/// inside it, found by sample points, so that the sum is correct at any image size.
void add_disc(prt::Image& image, const glm::dvec3& direction, const glm::dvec3& irradiance) {
    constexpr int kAcross = 256; // points of the square round the disc
    const glm::dvec3 side = glm::normalize(glm::cross(direction, glm::dvec3(0.3, 0.1, 0.95))),
                     other = glm::cross(direction, side);
    std::vector<std::pair<int, int>> texels;
    for (int i = 0; i < kAcross; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const glm::dvec2 p = (glm::dvec2(i, j) + 0.5) * (2.0 / kAcross) - 1.0;
            if (glm::length(p) > 1)
                continue;
            const glm::dvec3 d =
                glm::normalize(direction + std::tan(kSunRadius) * (p.x * side + p.y * other));
            const glm::dvec2 at = prt::lat_long_position(image.width, image.height, d);
            texels.emplace_back(static_cast<int>(at.x), static_cast<int>(at.y));
        }
    for (const auto& [x, y] : texels) {
        const double top = std::cos(kPi * y / image.height), bottom = std::cos(kPi * (y + 1) / image.height);
        const double solid_angle = 2 * kPi / image.width * (top - bottom);
        image.pixels[static_cast<std::size_t>(y * image.width + x)] +=
            glm::vec3(irradiance / (solid_angle * static_cast<double>(texels.size())));
    }
}

/// Returns the transmittance of the air for red, green and blue sunlight, relative to luminance: optical
/// depths at 610, 550 and 465 nm of air, haze and ozone, and air mass, as in Preetham, Shirley and Smits,
/// appendix A.1.
glm::dvec3 sun_color(double turbidity, double height) {
    const glm::dvec3 wavelength(0.61, 0.55, 0.465); // micrometres
    const double zenith_angle = std::acos(height);
    const double air_mass = 1 / (height + 0.15 * std::pow(93.885 - zenith_angle * 180 / kPi, -1.253));
    const glm::dvec3 air = 0.008735 * glm::pow(wavelength, glm::dvec3(-4.08));
    const glm::dvec3 haze = (0.04608 * turbidity - 0.04586) * glm::pow(wavelength, glm::dvec3(-1.3));
    const glm::dvec3 ozone = 0.35 * glm::dvec3(0.12, 0.085, 0.01);
    const glm::dvec3 color = glm::exp(-air_mass * (air + haze + ozone));
    return color / glm::dot(color, kLuminance);
}

/// Irradiance of the ground.
glm::dvec3 sky_irradiance(const prt::PreethamSky& sky) {
    constexpr int kRows = 64, kColumns = 256;
    glm::dvec3 sum(0);
    for (int i = 0; i < kRows; ++i) // cos² of the zenith angle in equal steps
        for (int j = 0; j < kColumns; ++j) {
            const double cosine = std::sqrt((i + 0.5) / kRows), sine = std::sqrt(1 - cosine * cosine),
                         angle = 2 * kPi * (j + 0.5) / kColumns;
            sum += sky.radiance({sine * std::cos(angle), cosine, sine * std::sin(angle)});
        }
    return sum * (kPi / (kRows * kColumns));
}

} // namespace

prt::Environment preetham_sky(int height, double turbidity, const glm::dvec3& sun) {
    const prt::PreethamSky sky(turbidity, sun);
    // A disc of 2.5 degrees instead of 0.27, so that the image resolves it, with four times the sky's
    // irradiance.
    constexpr double kWideRadius = 2.5 * kPi / 180;
    const double solid_angle = 2 * kPi * (1 - std::cos(kWideRadius));
    const glm::dvec3 sun_radiance =
        glm::dvec3(1, 0.9, 0.75) * (4 * kPi * 0.5 * sky.zenith_luminance() / solid_angle);
    return over_ground(height, glm::dvec3(0), [&](const glm::dvec3& d) {
        const double gamma = std::acos(std::clamp(glm::dot(d, sun), -1.0, 1.0));
        return sky.radiance(d) + (gamma < kWideRadius ? sun_radiance : glm::dvec3(0));
    });
}

prt::Environment sunny_sky(int height, const SunnySky& options) {
    const prt::PreethamSky sky(options.turbidity, options.sun);
    const glm::dvec3 by_sky = sky_irradiance(sky);
    const glm::dvec3 by_sun =
        sun_color(options.turbidity, options.sun.y) * (options.sun_to_sky * glm::dot(by_sky, kLuminance));
    const double scale = options.white * kPi / glm::dot(by_sky + by_sun * options.sun.y, kLuminance);
    prt::Environment environment = over_ground(height, scale * options.sun.y * by_sun,
                                               [&](const glm::dvec3& d) { return scale * sky.radiance(d); });
    add_disc(environment.image, options.sun, scale * by_sun);
    return environment;
}

prt::Environment night_sky(int height, const glm::dvec3& moon) {
    const glm::dvec3 zenith(0.004, 0.007, 0.018), horizon(0.012, 0.016, 0.03), moonlight(0.2, 0.23, 0.28);
    prt::Environment environment = over_ground(height, moonlight * moon.y, [&](const glm::dvec3& d) {
        return glm::mix(horizon, zenith, std::sqrt(d.y));
    });
    add_disc(environment.image, moon, moonlight);
    return environment;
}

} // namespace examples
