// Interpolates keyframes (glTF 2.0, appendix C).
#include "prt/gltf/animation.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace prt {
namespace {

glm::dquat quaternion(const glm::dvec4& v) {
    return {v.w, v.x, v.y, v.z};
}

glm::dvec4 components(const glm::dquat& q) {
    return {q.x, q.y, q.z, q.w};
}

glm::dvec4 unit_where_rotation(const AnimationChannel& channel, const glm::dvec4& value) {
    return channel.part == AnimatedPart::rotation ? components(glm::normalize(quaternion(value))) : value;
}

/// Returns the spline value between `key` and the next one, at fraction `t`.
glm::dvec4 spline(const AnimationChannel& channel, std::size_t key, double t) {
    const double seconds = static_cast<double>(channel.times[key + 1]) - channel.times[key];
    const glm::dvec4 from = channel.values[3 * key + 1],
                     leaves = seconds * glm::dvec4(channel.values[3 * key + 2]),
                     arrives = seconds * glm::dvec4(channel.values[3 * key + 3]),
                     to = channel.values[3 * key + 4];
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * leaves + (3 * t2 - 2 * t3) * to +
           (t3 - t2) * arrives;
}

glm::dvec4 line(const AnimationChannel& channel, std::size_t key, double t) {
    const glm::dvec4 from = channel.values[key], to = channel.values[key + 1];
    if (channel.part != AnimatedPart::rotation)
        return from + t * (to - from);
    return components(glm::slerp(glm::normalize(quaternion(from)), glm::normalize(quaternion(to)), t));
}

} // namespace

glm::dvec4 value_at(const AnimationChannel& channel, double seconds) {
    const bool splines = channel.interpolation == Interpolation::cubic_spline;
    const auto hold = [&](std::size_t key) {
        return unit_where_rotation(channel, channel.values[splines ? 3 * key + 1 : key]);
    };
    const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), seconds);
    if (after == channel.times.begin())
        return hold(0);
    const auto key = static_cast<std::size_t>(after - channel.times.begin()) - 1;
    if (after == channel.times.end() || channel.interpolation == Interpolation::step)
        return hold(key);
    const double from = channel.times[key], t = (seconds - from) / (channel.times[key + 1] - from);
    return splines ? unit_where_rotation(channel, spline(channel, key, t)) : line(channel, key, t);
}

} // namespace prt
