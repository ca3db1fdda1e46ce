#include "sky.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace examples {
namespace {

constexpr double kPi = 3.14159265358979323846;
const glm::dvec3 kGroundAlbedo(0.24, 0.2, 0.15);

/// The five parameters of the distribution of Perez et al. (1993), as the paper's appendix A.2 fits them.
using Perez = std::array<double, 5>;

double perez(const Perez& p, double cos_zenith, double gamma) {
    const double cos_gamma = std::cos(gamma);
    return (1 + p[0] * std::exp(p[1] / cos_zenith)) *
           (1 + p[2] * std::exp(p[3] * gamma) + p[4] * cos_gamma * cos_gamma);
}

struct Sky {
    Perez luminance, x, y;
    double zenith_luminance, zenith_x, zenith_y; ///< kcd/m² and CIE chromaticity
    double theta_sun;

    Sky(double t, double theta) : theta_sun(theta) {
        luminance = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                     -0.0670 * t + 0.3703};
        x = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
             -0.0033 * t + 0.0452};
        y = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
             -0.0109 * t + 0.0529};
        const double chi = (4.0 / 9 - t / 120) * (kPi - 2 * theta);
        zenith_luminance = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
        const double s = theta, s2 = s * s, s3 = s2 * s;
        zenith_x = t * t * (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) +
                   t * (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) +
                   (0.11693 * s3 - 0.21196 * s2 + 0.06052 * s + 0.25886);
        zenith_y = t * t * (0.00275 * s3 - 0.00610 * s2 + 0.00317 * s) +
                   t * (-0.04214 * s3 + 0.08970 * s2 - 0.04153 * s + 0.00516) +
                   (0.15346 * s3 - 0.26756 * s2 + 0.06670 * s + 0.26688);
    }

    /// Linear Rec. 709 radiance in a direction above the horizon.
    glm::dvec3 radiance(double cos_zenith, double gamma) const {
        const double c = std::max(cos_zenith, 0.01);
        const auto relative = [&](const Perez& p) { return perez(p, c, gamma) / perez(p, 1, theta_sun); };
        const double big_y = zenith_luminance * relative(luminance);
        const double cx = zenith_x * relative(x), cy = zenith_y * relative(y);
        const double big_x = big_y * cx / cy, big_z = big_y * (1 - cx - cy) / cy;
        return glm::max(glm::dvec3(3.2406 * big_x - 1.5372 * big_y - 0.4986 * big_z,
                                   -0.9689 * big_x + 1.8758 * big_y + 0.0415 * big_z,
                                   0.0557 * big_x - 0.2040 * big_y + 1.0570 * big_z),
                        glm::dvec3(0));
    }
};

} // namespace

prt::Environment preetham_sky(int height, double turbidity, const glm::dvec3& sun) {
    const Sky sky(turbidity, std::acos(std::clamp(sun.y, 0.0, 1.0)));
    // A disc of 2.5 degrees instead of 0.27, so that the image resolves it, with four times the sky's
    // irradiance.
    constexpr double kSunRadius = 2.5 * kPi / 180;
    const double sun_solid_angle = 2 * kPi * (1 - std::cos(kSunRadius));
    const glm::dvec3 sun_radiance =
        glm::dvec3(1, 0.9, 0.75) * (4 * kPi * 0.5 * sky.zenith_luminance / sun_solid_angle);

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
                pixel = sky.radiance(d.y, gamma);
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
