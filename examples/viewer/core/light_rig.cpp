// Sums the lights of the rig as SH light, as suns and as an environment for path tracing.

#include "core/light_rig.h"

#include "prt/core/light.h"
#include "prt/core/sh_basis.h"
#include "prt/fit/suns.h"
#include "prt/image/image_file.h"
#include "prt/render/tone_map.h"
#include "runtime/render/gl/sun_shadows.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

namespace viewer {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSunHalfAngle = 0.265 * kPi / 180; ///< radians, as seen from Earth
const glm::vec3 kGround(0.24f, 0.2f, 0.15f);

glm::dvec3 sun_at(double hour) {
    const double angle = (hour - 12) / 12 * kPi, latitude = kPi / 4;
    return {-std::sin(angle), std::cos(angle) * std::cos(latitude), std::cos(angle) * std::sin(latitude)};
}

LoadedEnvironment ready(std::string name, const prt::Environment& environment) {
    LoadedEnvironment result;
    result.name = std::move(name);
    result.light = prt::project(environment, prt::kMaxOrder);
    result.lat_long = prt::resampled_lat_long(environment);
    result.mean = 0.25f / prt::automatic_exposure(result.light);
    result.sky = result.light;
    return result;
}

/// Rotates `d` about +Y, as prt::rotated_about_y does.
glm::vec3 rotated(const glm::vec3& d, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

void add(prt::Light& sum, const prt::Light& light) {
    sum = prt::sum(sum, light);
}

/// Returns the fraction of daylight in the sky, 0..1; the rest is night. Dusk ends when the sun is 8.6
/// degrees below the horizon, between the ends of civil and nautical twilight.
double daylight(const glm::dvec3& sun) {
    const double share = std::clamp(1 + sun.y / 0.15, 0.0, 1.0);
    return share * share;
}

/// Returns the sky radiance of a moonless night, slightly brighter towards the horizon: a thousandth of the
/// sky at noon, as in the night of the example scenes, so that lanterns and sky fit into one picture. Real
/// nights are far darker.
glm::dvec3 night_radiance(const glm::dvec3& direction) {
    const glm::dvec3 zenith(0.004, 0.007, 0.018), horizon(0.012, 0.016, 0.03);
    return glm::mix(horizon, zenith, std::sqrt(direction.y));
}

/// Returns the model sky above a ground that reflects it; dusk fades into night.
prt::Image day_image(const Day& day, const glm::dvec3& sun) {
    constexpr int kWidth = 128, kHeight = 64;
    const glm::dvec3 above = glm::normalize(glm::dvec3(sun.x, std::max(sun.y, 0.02), sun.z));
    const prt::PreethamSky sky(day.turbidity, above);
    const double share = daylight(sun);
    prt::Image image{kWidth, kHeight, {}};
    image.pixels.reserve(std::size_t{kWidth} * kHeight);
    glm::dvec3 irradiance(0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const glm::dvec3 d = prt::lat_long_direction(kWidth, kHeight, x + 0.5, y + 0.5);
            glm::dvec3 pixel = irradiance * glm::dvec3(kGround) / kPi; // the upper rows, computed first,
                                                                       // light the ground
            if (d.y > 0) {
                pixel = glm::mix(night_radiance(d), glm::max(sky.radiance(d), 0.0), share);
                irradiance += pixel * (d.y * 2 * kPi / kWidth * kPi / kHeight * std::sqrt(1 - d.y * d.y));
            }
            image.pixels.emplace_back(pixel);
        }
    return image;
}

/// Adds a cone of constant radiance about `axis`, scaled so that the covered pixels have its exact solid
/// angle.
void add_cone(prt::Image& image, const glm::vec3& axis, double half_angle, const glm::vec3& radiance) {
    const double wanted = 2 * kPi * (1 - std::cos(half_angle));
    std::vector<std::size_t> inside;
    double covered = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 d = prt::lat_long_direction(image.width, image.height, x + 0.5, y + 0.5);
            if (glm::dot(d, glm::dvec3(axis)) < std::cos(half_angle))
                continue;
            inside.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(x));
            covered += 2 * kPi / image.width *
                       (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
        }
    for (const std::size_t i : inside)
        image.pixels[i] += radiance * static_cast<float>(wanted / covered);
}

double half_angle(const RigLight& light) {
    return light.kind == LightKind::sphere
               ? std::asin(std::clamp(static_cast<double>(light.size / light.distance), 0.0, 0.99))
               : static_cast<double>(light.size);
}

} // namespace

RigLight make_light(LightKind kind) {
    RigLight light;
    light.kind = kind;
    light.direction = glm::normalize(glm::vec3(0.6f, 0.7f, 0.5f));
    if (kind == LightKind::hemisphere)
        light = {kind, true, {0, 1, 0}, 2, 0.4f, {0.6f, 0.75f, 1}, 1};
    return light;
}

LoadedEnvironment load_environment(const std::string& path) {
    const prt::Environment environment = prt::load_environment(path).environment;
    LoadedEnvironment result = ready(std::filesystem::path(path).filename().string(), environment);
    prt::SunSplit split = prt::find_suns(environment);
    if (!split.suns.empty()) {
        result.sky = prt::project(split.remainder, prt::kMaxOrder);
        result.sky_lat_long = prt::resampled_lat_long(split.remainder);
    }
    result.suns = std::move(split.suns);
    return result;
}

LightRig::LightRig() {
    LightSettings settings = settings_;
    settings.time.hour = 9.5;
    set(settings);
}

void LightRig::set(const LightSettings& settings) {
    if (settings == settings_ && !day_.lat_long.pixels.empty())
        return;
    const bool another_day = settings.time != settings_.time || day_.lat_long.pixels.empty();
    if (another_day || settings.day != settings_.day || settings.environment_on != settings_.environment_on)
        ++background_version_;
    settings_ = settings;
    ++version_;
    if (!another_day)
        return;
    const glm::dvec3 sun = sun_at(settings.time.hour);
    day_ = ready("day", {day_image(settings.time, sun), prt::EnvironmentLayout::lat_long});
    day_sun_ = glm::vec3(sun);
    // The sun has four times the sky's irradiance at noon; it becomes yellow, then red, towards the horizon.
    const auto height = static_cast<float>(std::clamp(sun.y, 0.0, 1.0));
    day_sun_irradiance_ = height <= 0
                              ? glm::vec3(0)
                              : glm::vec3(14, 14 * std::pow(height, 0.15f), 12 * std::pow(height, 0.4f)) *
                                    std::min(1.0f, 8 * height);
}

void LightRig::set_environment(std::shared_ptr<const LoadedEnvironment> environment) {
    environment_ = std::move(environment);
    settings_.day = false;
    settings_.environment_on = true;
    ++version_;
    ++background_version_;
}

float LightRig::darkness() const {
    return settings_.day ? static_cast<float>(1 - daylight(day_sun_)) : 0.0f;
}

const LoadedEnvironment* LightRig::base() const {
    if (settings_.day)
        return &day_;
    return settings_.environment_on ? environment_.get() : nullptr;
}

float LightRig::unit() const {
    const LoadedEnvironment* environment = base();
    return environment ? environment->mean : 1;
}

/// Returns the suns that are not part of the environment image: the day's and the added ones.
std::vector<prt::Sun> LightRig::own_suns() const {
    std::vector<prt::Sun> suns;
    if (settings_.day && day_sun_irradiance_ != glm::vec3(0))
        suns.push_back({rotated(day_sun_, settings_.rotation), day_sun_irradiance_, kSunHalfAngle});
    for (const RigLight& light : settings_.lights)
        if (light.on && light.kind == LightKind::sun)
            suns.push_back(
                {light.direction, light.color * (light.strength * unit() * static_cast<float>(kPi))});
    return suns;
}

/// Returns the suns of the environment image, rotated with it.
std::vector<prt::Sun> LightRig::rotated_suns() const {
    const LoadedEnvironment* environment = base();
    std::vector<prt::Sun> suns;
    if (environment)
        suns = environment->suns;
    for (prt::Sun& sun : suns)
        sun.towards = rotated(sun.towards, settings_.rotation);
    return suns;
}

/// Adds the lights that are not suns.
void LightRig::add_shapes(prt::Light& sum) const {
    for (const RigLight& light : settings_.lights) {
        if (!light.on)
            continue;
        const glm::vec3 radiance = light.color * (light.strength * unit());
        if (light.kind == LightKind::cone || light.kind == LightKind::sphere)
            add(sum, prt::cone_light(sum.order, light.direction, half_angle(light), radiance));
        else if (light.kind == LightKind::hemisphere)
            add(sum, prt::hemisphere_light(sum.order, light.direction, radiance, glm::vec3(0)));
    }
}

prt::Light LightRig::light(int order) const {
    prt::Light sum = prt::constant_light(order, glm::vec3(0));
    if (const LoadedEnvironment* environment = base())
        add(sum, prt::rotated_about_y(prt::truncated(environment->light, order),
                                      static_cast<double>(settings_.rotation)));
    for (const prt::Sun& sun : own_suns())
        add(sum, prt::as_light(sun, order));
    add_shapes(sum);
    return prt::windowed(sum, settings_.window);
}

std::vector<prt::Sun> LightRig::strongest_first() const {
    std::vector<prt::Sun> suns = rotated_suns();
    std::ranges::copy(own_suns(), std::back_inserter(suns));
    std::ranges::stable_sort(suns, std::greater(),
                             [](const prt::Sun& sun) { return prt::luminance(sun.irradiance); });
    return suns;
}

SeparateLight LightRig::separate_light(int order) const {
    std::vector<prt::Sun> suns = strongest_first();
    const auto most = std::min<std::size_t>(suns.size(), prt::kMaxShadowedSuns);
    prt::Light sky = prt::constant_light(order, glm::vec3(0)), of_suns = sky;
    if (const LoadedEnvironment* environment = base())
        add(sky, prt::rotated_about_y(prt::truncated(environment->sky, order),
                                      static_cast<double>(settings_.rotation)));
    add_shapes(sky);
    for (std::size_t i = 0; i < suns.size(); ++i)
        add(i < most ? of_suns : sky, prt::as_light(suns[i], order));
    suns.resize(most);
    return {{prt::windowed(sky, settings_.window), std::move(of_suns)}, std::move(suns)};
}

/// Returns a distant light from an image of the environment (may be null) and these suns.
prt::DistantLight LightRig::distant_light(const prt::Image* lat_long,
                                          const std::vector<prt::Sun>& suns) const {
    const bool plain = lat_long && settings_.rotation == 0 &&
                       std::none_of(settings_.lights.begin(), settings_.lights.end(),
                                    [](const RigLight& l) { return l.on && l.kind != LightKind::sun; });
    if (plain)
        return prt::DistantLight(*lat_long, suns);
    // All lights are drawn into one image, in world axes.
    prt::Image image{1024, 512, std::vector<glm::vec3>(std::size_t{1024} * 512, glm::vec3(0))};
    if (lat_long) {
        const float c = std::cos(settings_.rotation), s = std::sin(settings_.rotation);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const glm::vec3 d(prt::lat_long_direction(image.width, image.height, x + 0.5, y + 0.5));
                image.at(x, y) = prt::sample_lat_long(*lat_long, {c * d.x - s * d.z, d.y, s * d.x + c * d.z});
            }
    }
    for (const RigLight& light : settings_.lights) {
        if (!light.on)
            continue;
        const glm::vec3 radiance = light.color * (light.strength * unit());
        if (light.kind == LightKind::cone || light.kind == LightKind::sphere)
            add_cone(image, light.direction, half_angle(light), radiance);
        else if (light.kind == LightKind::hemisphere)
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    const glm::vec3 d(prt::lat_long_direction(image.width, image.height, x + 0.5, y + 0.5));
                    image.at(x, y) += radiance * (0.5f + 0.5f * glm::dot(d, light.direction));
                }
    }
    return prt::DistantLight(std::move(image), suns);
}

prt::DistantLight LightRig::distant_light() const {
    const LoadedEnvironment* environment = base();
    return distant_light(environment ? &environment->lat_long : nullptr, own_suns());
}

prt::ReferenceLight LightRig::reference_light() const {
    LightRig rig = *this;
    rig.settings_.window = prt::Window::none;
    return {.all = distant_light(),
            .sky = {},
            .suns = {},
            .sky_bands = rig.light(prt::kMaxOrder),
            .sun_bands = prt::constant_light(prt::kMaxOrder, glm::vec3(0))};
}

prt::ReferenceLight LightRig::separate_reference_light() const {
    LightRig rig = *this;
    rig.settings_.window = prt::Window::none;
    SeparateLight separate = rig.separate_light(prt::kMaxOrder);
    if (separate.suns.empty())
        return reference_light();
    const LoadedEnvironment* environment = base();
    const bool has_suns = environment && !environment->sky_lat_long.pixels.empty();
    std::vector<prt::Sun> others = strongest_first();
    others.erase(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(separate.suns.size()));
    return {.all = distant_light(),
            .sky = distant_light(has_suns      ? &environment->sky_lat_long
                                 : environment ? &environment->lat_long
                                               : nullptr,
                                 others),
            .suns = std::move(separate.suns),
            .sky_bands = std::move(separate.lighting.sky),
            .sun_bands = std::move(*separate.lighting.suns)};
}

const prt::Image* LightRig::background() const {
    const LoadedEnvironment* environment = base();
    return environment ? &environment->lat_long : nullptr;
}

} // namespace viewer
