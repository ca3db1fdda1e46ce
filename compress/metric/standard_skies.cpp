// Built-in skies: daylight by Preetham, Shirley and Smits (1999), the CIE overcast sky, both over grey
// ground, and rooms.

#include "compress/metric/standard_skies.h"

#include "compress/tuning/tuning.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"

#include <glm/trigonometric.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace prt {
namespace {

using std::numbers::pi;

const glm::vec3 kUp(0, 1, 0);

/// Returns the luminance of a light in all three channels.
Light grey(Light light) {
    for (glm::vec3& c : light.coefficients)
        c = glm::vec3(0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z);
    return light;
}

/// Returns the irradiance of horizontal ground, from all available bands.
double irradiance_from_above(const Light& light) {
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    clamped_cosine_lobe(light.order, glm::dvec3(kUp), std::span<double>(lobe));
    double sum = 0;
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        sum += lobe[i] * static_cast<double>(light.coefficients[i].x);
    return pi * sum;
}

/// Returns radiance integrated over all directions.
double all_light(const Light& light) {
    return static_cast<double>(light.coefficients[0].x) * std::sqrt(4 * pi);
}

Light scaled(Light light, double factor) {
    for (glm::vec3& c : light.coefficients)
        c *= static_cast<float>(factor);
    return light;
}

/// Adds ground that reflects the light of `sky` and of a sun in direction `towards`. `sun_over_sky`: the
/// sun's irradiance relative to all light of sky and ground. With f this ratio, a the albedo and s the sine
/// of the sun's elevation, E = f (sky + 2 a (E_sky + E s)).
Lighting over_ground(const Light& sky, const glm::vec3& towards, double sun_over_sky, int order) {
    const double albedo = tuning::kGroundAlbedo, sine = static_cast<double>(towards.y);
    const double of_sky = irradiance_from_above(sky);
    const double sun =
        sun_over_sky * (all_light(sky) + 2 * albedo * of_sky) / (1 - 2 * albedo * sun_over_sky * sine);
    const double ground = albedo * (of_sky + sun * sine) / pi;
    const Light below = cone_light(order, -kUp, pi / 2, glm::vec3(static_cast<float>(ground)));
    const double scale = 4 * pi / (all_light(sky) + 2 * pi * ground);
    Lighting result{scaled(sum(truncated(sky, order), below), scale)};
    if (sun_over_sky > 0)
        result.suns = directional_light(order, towards, glm::vec3(static_cast<float>(scale * sun)));
    return result;
}

} // namespace

Lighting daylight(int order, const DaylightOptions& day) {
    const double sine = std::sin(day.sun_elevation);
    const glm::dvec3 towards(std::cos(day.sun_elevation), sine, 0);
    // Bouguer's law for the path length through the air, 1 / sine.
    const double sun_over_sky =
        tuning::kSunOverSky / day.turbidity * std::exp(-tuning::kAirExtinction / sine);
    // Uses all bands, so that the ground's light does not depend on `order`.
    return over_ground(grey(sky_light(kMaxOrder, PreethamSky(day.turbidity, towards))), glm::vec3(towards),
                       sun_over_sky, order);
}

Lighting overcast_day(int order) {
    return over_ground(overcast_sky(kMaxOrder, glm::vec3(1)), kUp, 0, order);
}

Lighting room_light(int order, double lamp_elevation) {
    // For a + b y the mean is a, and band 1 along +Y is b / sqrt(3) of band 0.
    const auto b = static_cast<float>(std::sqrt(3.0) * tuning::kRoomFromAbove);
    const glm::vec3 towards(glm::dvec3(std::cos(lamp_elevation), std::sin(lamp_elevation), 0));
    const double half_angle = glm::radians(8.0), solid_angle = 2 * pi * (1 - std::cos(half_angle));
    const auto lamp = static_cast<float>(tuning::kLampOverRoom * 4 * pi / solid_angle);
    return {hemisphere_light(order, kUp, glm::vec3(1 + b), glm::vec3(1 - b)),
            cone_light(order, towards, half_angle, glm::vec3(lamp))};
}

std::vector<Lighting> standard_skies(int order) {
    const auto degrees = [](double d) { return glm::radians(d); };
    // A window of 2 m by 2 m at about 3 m distance, and a lamp of 40 cm 2 m above: half of all light, and a
    // quarter.
    Light room = sum(constant_light(order, glm::vec3(1)),
                     cone_light(order, glm::vec3(1, 0, 0), degrees(20), glm::vec3(66)));
    room = sum(room, cone_light(order, kUp, degrees(6), glm::vec3(365)));
    const auto named = [](std::string name, Lighting lighting) {
        lighting.name = std::move(name);
        return lighting;
    };
    return {named("clear noon", daylight(order, {.sun_elevation = degrees(55), .turbidity = 3})),
            named("low sun", daylight(order, {.sun_elevation = degrees(10), .turbidity = 4})),
            named("overcast", overcast_day(order)), named("window and lamp", {room})};
}

} // namespace prt
