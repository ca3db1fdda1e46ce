// Loads lights for an error budget and splits off their suns.

#include "cli/pipeline/budget_lights.h"

#include "cli/pipeline/evaluation_lights.h"
#include "prt/load/light_file.h"
#include "runtime/core/support/tangent_frame.h"

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt::pipeline {
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
ReferenceLight of_image(const LoadedLight& light, const BudgetLightOptions& options) {
    const Image whole = resampled_lat_long(*light.environment);
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
                            .sun_bands = constant_light(kMaxOrder, glm::vec3(0)),
                            .name = light.name};
    if (light.split.suns.empty()) {
        measured.sky_bands = bands(*light.environment);
        return measured;
    }
    measured.sky.emplace(rotated(resampled_lat_long(light.split.remainder), texels));
    measured.sky_bands = bands(light.split.remainder);
    measured.suns = pipeline::rotated(light.split.suns, angle);
    measured.sun_bands = as_light(measured.suns, kMaxOrder);
    return measured;
}

/// From coefficients of kMaxOrder and suns.
ReferenceLight of_coefficients(const LoadedLight& light, bool separate) {
    const std::vector<Sun> suns = as_seen_by_rays(light.split.suns);
    const Image sky = drawn(light.sky);
    ReferenceLight measured{.all = DistantLight(sky, suns),
                            .sky = {},
                            .suns = {},
                            .sky_bands = separate ? light.sky : light.combined,
                            .sun_bands = constant_light(kMaxOrder, glm::vec3(0)),
                            .name = light.name};
    if (separate && !suns.empty()) {
        measured.sky.emplace(sky);
        measured.suns = light.split.suns;
        measured.sun_bands = as_light(light.split.suns, kMaxOrder);
    }
    return measured;
}

/// A light file with zeros for the bands that it does not have: there is no more light in it.
LoadedLight all_bands(const Path& path, const BudgetLightOptions& options) {
    const int order = std::min(read_light_file(path).sky.order, kMaxOrder);
    LoadedLight light = load_light(path, order, {std::nullopt}, options.reading, options.threads);
    for (Light* bands : {&light.sky, &light.combined}) {
        bands->order = kMaxOrder;
        bands->coefficients.resize(static_cast<std::size_t>(coefficient_count(kMaxOrder)), glm::vec3(0));
    }
    light.combined = sum(light.sky, as_light(light.split.suns, kMaxOrder));
    return light;
}

} // namespace

std::vector<ReferenceLight> budget_lights(const BudgetLightOptions& options) {
    std::vector<ReferenceLight> lights;
    const SunCount suns = options.separate ? options.suns : SunCount{0};
    for (const Path& path : options.files) {
        LightOptions unturned = options.reading;
        unturned.rotation_degrees = 0;
        const LoadedLight light = load_light(path, options.order, suns, unturned, options.threads);
        lights.push_back(light.environment ? of_image(light, options)
                                           : of_coefficients(all_bands(path, options),
                                                             options.separate && suns.count != 0));
    }
    if (lights.empty())
        for (const LoadedLight& light : default_lights(kMaxOrder))
            lights.push_back(of_coefficients(light, options.separate));
    return lights;
}

} // namespace prt::pipeline
