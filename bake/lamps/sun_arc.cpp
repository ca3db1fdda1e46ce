// Where the sun stands, by its declination and the hour.

#include "prt/sun_arc.h"

#include "prt/support/error.h"

#include <glm/geometric.hpp>

#include <fmt/core.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHoursPerRadian = 12 / kPi;

/// Hours from noon to sunset; 12 where the sun does not set, 0 where it does not rise.
double half_a_day(const SunArc& arc) {
    const double cosine = -std::tan(arc.latitude) * std::tan(declination(arc.day));
    return kHoursPerRadian * std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// To the minute, or to the thousandth of a second where keys stand closer than that.
std::string clock(double hour, bool close) {
    const auto milliseconds =
        static_cast<long>(std::lround((close ? 3.6e6 : 60.0) * hour)) * (close ? 1 : 60000);
    const long minutes = milliseconds / 60000;
    const std::string time = fmt::format("sun {:02}:{:02}", minutes / 60, minutes % 60);
    return close ? fmt::format("{}:{:06.3f}", time, static_cast<double>(milliseconds % 60000) / 1000) : time;
}

} // namespace

double declination(int day) {
    return 23.45 / 180 * kPi * std::sin(2 * kPi * (284 + day) / 365);
}

glm::dvec3 towards_sun(const SunArc& arc, double hour) {
    const double angle = (hour - 12) / kHoursPerRadian, d = declination(arc.day);
    const double east = -std::cos(d) * std::sin(angle),
                 north = std::cos(arc.latitude) * std::sin(d) -
                         std::sin(arc.latitude) * std::cos(d) * std::cos(angle),
                 up = std::sin(arc.latitude) * std::sin(d) +
                      std::cos(arc.latitude) * std::cos(d) * std::cos(angle);
    const glm::dvec3 above(0, 1, 0);
    return glm::normalize(east * glm::cross(arc.north, above) + north * arc.north + up * above);
}

std::vector<PunctualLight> keys_of(const SunArc& arc) {
    const double half = half_a_day(arc);
    if (half <= 0)
        throw Error("the sun does not rise on that day at that latitude");
    const bool close = 2 * half * 60 < 1.01 * (arc.keys - 1);
    std::vector<PunctualLight> keys;
    for (int k = 0; k < arc.keys; ++k) {
        const double share = arc.keys > 1 ? 2.0 * k / (arc.keys - 1) - 1 : 0, hour = 12 + half * share;
        PunctualLight key{.name = clock(hour, close), .kind = PunctualKind::directional, .key = true};
        key.direction = -glm::vec3(towards_sun(arc, hour));
        key.half_angle = static_cast<float>(arc.half_angle);
        keys.push_back(key);
    }
    return keys;
}

} // namespace prt
