// Loads lights for an error budget and splits off their suns.

#include "budget/budget_lights.h"

#include "evaluation_lights.h"
#include "prt/light_file.h"
#include "prt/support/tangent_frame.h"

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt::cli {
namespace {

/// The sky that coefficients describe, dark where they are negative.
Image drawn(const Light& light) {
    constexpr int kWidth = 256; // a texel is a tenth of the resolution of ten bands
    const Light sky = deringed(light);
    Image image{kWidth, kWidth / 2, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.pixels.push_back(glm::max(
                radiance(sky, glm::vec3(lat_long_direction(image.width, image.height, x + 0.5, y + 0.5))),
                glm::vec3(0)));
    return image;
}

/// Returns suns for path tracing: a wide sun becomes several ones, evenly distributed over its disc.
std::vector<Sun> as_seen_by_rays(std::span<const Sun> discs) {
    constexpr int kParts = 16;
    std::vector<Sun> suns;
    for (const Sun& disc : discs) {
        const int terms = disc.half_angle > 0 ? kParts : 1;
        for (int i = 0; i < terms; ++i) { // on a spiral (docs/math.md, eq. 41)
            const double radius = disc.half_angle * std::sqrt((i + 0.5) / terms),
                         angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
            const TangentFrame frame = tangent_frame(disc.towards);
            const glm::dvec3 to(disc.towards), off = glm::dvec3(frame.tangent) * std::cos(angle) +
                                                     glm::dvec3(frame.bitangent) * std::sin(angle);
            suns.push_back({glm::vec3(terms == 1 ? to : to * std::cos(radius) + off * std::sin(radius)),
                            disc.irradiance / static_cast<float>(terms)});
        }
    }
    return suns;
}

/// Returns the image rotated about +Y by `texels` columns; content moves to the left, as in
/// `rotated_about_y`.
Image rotated(Image image, int texels) {
    for (int y = 0; y < image.height; ++y) {
        const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
        std::rotate(row, row + texels, row + image.width);
    }
    return image;
}

/// Returns the light of an environment map with the suns in `split`.
ReferenceLight of_image(const SplitLight& light, const BudgetLightOptions& options) {
    const Image whole = resampled_lat_long(*light.sky.environment);
    const double degrees = std::remainder(options.reading.rotation_degrees, 360.0);
    const int texels =
        (static_cast<int>(std::lround(degrees / 360 * whole.width)) + whole.width) % whole.width;
    const double angle = 2 * std::numbers::pi * texels / whole.width;
    const auto bands = [&](const Environment& environment) {
        return rotated_about_y(project(environment, kMaxOrder, options.threads), angle);
    };
    ReferenceLight measured{.all = DistantLight(rotated(whole, texels)),
                            .sky = {},
                            .suns = {},
                            .sky_bands = {},
                            .sun_bands = constant_light(kMaxOrder, glm::vec3(0))};
    if (light.split.suns.empty()) {
        measured.sky_bands = bands(*light.sky.environment);
        return measured;
    }
    measured.sky.emplace(rotated(resampled_lat_long(light.split.remainder), texels));
    measured.sky_bands = bands(light.split.remainder);
    SplitLight suns_alone;
    suns_alone.split.suns = light.split.suns;
    suns_alone.sky.light = suns_alone.whole = constant_light(kMaxOrder, glm::vec3(0));
    measured.suns = cli::rotated(suns_alone, angle).split.suns;
    measured.sun_bands = as_light(measured.suns, kMaxOrder);
    return measured;
}

/// From coefficients of kMaxOrder and suns.
ReferenceLight of_coefficients(const SplitLight& light, bool separate) {
    const std::vector<Sun> suns = as_seen_by_rays(light.split.suns);
    const Image sky = drawn(light.sky.light);
    ReferenceLight measured{.all = DistantLight(sky, suns),
                            .sky = {},
                            .suns = {},
                            .sky_bands = separate ? light.sky.light : light.whole,
                            .sun_bands = constant_light(kMaxOrder, glm::vec3(0))};
    if (separate && !suns.empty()) {
        measured.sky.emplace(sky);
        measured.suns = light.split.suns;
        measured.sun_bands = as_light(light.split.suns, kMaxOrder);
    }
    return measured;
}

/// A light file with zeros for the bands that it does not have: there is no more light in it.
SplitLight all_bands(const Path& path, const BudgetLightOptions& options) {
    const int order = std::min(read_light_file(path).sky.order, kMaxOrder);
    SplitLight light = load_split_light(path, order, {std::nullopt}, options.reading, options.threads);
    for (Light* bands : {&light.sky.light, &light.whole}) {
        bands->order = kMaxOrder;
        bands->coefficients.resize(static_cast<std::size_t>(coefficient_count(kMaxOrder)), glm::vec3(0));
    }
    light.whole = sum(light.sky.light, as_light(light.split.suns, kMaxOrder));
    return light;
}

} // namespace

BandFactors BudgetLight::factors(int order) const {
    return dering_factors(truncated(measured.sky_bands, order));
}

Lighting BudgetLight::lighting(int order) const {
    Lighting lighting{with_band_factors(truncated(measured.sky_bands, order), factors(order))};
    if (!measured.suns.empty())
        lighting.suns = truncated(measured.sun_bands, order);
    return lighting;
}

std::vector<BudgetLight> budget_lights(const BudgetLightOptions& options) {
    std::vector<BudgetLight> lights;
    const SunCount suns = options.separate ? options.suns : SunCount{0};
    for (const Path& path : options.files) {
        LightOptions unturned = options.reading;
        unturned.rotation_degrees = 0;
        const SplitLight light = load_split_light(path, options.order, suns, unturned, options.threads);
        if (light.sky.environment) {
            lights.push_back({light.sky.name, of_image(light, options)});
            continue;
        }
        lights.push_back(
            {light.sky.name, of_coefficients(all_bands(path, options), options.separate && suns.count != 0)});
    }
    if (lights.empty())
        for (const SplitLight& light : default_lights(kMaxOrder))
            lights.push_back({light.sky.name, of_coefficients(light, options.separate)});
    return lights;
}

} // namespace prt::cli
