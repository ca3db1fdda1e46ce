// Finds where on the arcs between keys a sun stands.

#include "prt/light_set.h"

#include "prt/support/error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace prt {
namespace {

struct Key {
    std::size_t lamp; ///< of the layout's
    glm::dvec3 towards;
};

/// A place on the arc between two keys, as the sum of both.
struct Place {
    std::size_t first = 0, second = 0; ///< of the layout's lamps
    double of_first = 1, of_second = 0;
    double cosine = -2; ///< to the sun
};

Place at_key(const Key& key, const glm::dvec3& sun) {
    return {key.lamp, key.lamp, 1, 0, glm::dot(key.towards, sun)};
}

/// The place nearest to the sun within the arc from `a` to `b`; none where that is one of the keys, where
/// these are one, and where they stand more than a right angle apart: what only one of them lights would be
/// far too bright.
Place within_arc(const Key& a, const Key& b, const glm::dvec3& sun) {
    constexpr double kSame = 1e-9;
    const double between = glm::dot(a.towards, b.towards), to_a = glm::dot(a.towards, sun),
                 to_b = glm::dot(b.towards, sun);
    const double of_a = to_a - between * to_b, of_b = to_b - between * to_a;
    if (between < 0 || 1 - between < kSame || of_a <= 0 || of_b <= 0)
        return {};
    const double length = glm::length(of_a * a.towards + of_b * b.towards); // of the sun on the arc's plane
    return {a.lamp, b.lamp, of_a / length, of_b / length, (of_a * to_a + of_b * to_b) / length};
}

/// The place of the light set nearest to unit `sun`.
Place nearest(std::span<const TransferPart> lamps, const glm::dvec3& sun) {
    Place best;
    const auto consider = [&](const Place& place) {
        if (place.cosine > best.cosine)
            best = place;
    };
    std::optional<Key> before;
    for (std::size_t k = 0; k < lamps.size(); ++k)
        if (lamps[k].towards) {
            const Key key{k, glm::normalize(glm::dvec3(*lamps[k].towards))};
            consider(at_key(key, sun));
            if (before)
                consider(within_arc(*before, key, sun));
            before = key;
        }
    return best;
}

} // namespace

bool has_light_set(const TransferLayout& layout) {
    return std::ranges::any_of(layout.lamp_parts(),
                               [](const TransferPart& lamp) { return lamp.towards.has_value(); });
}

double add_sun(const TransferLayout& layout, const SunDisc& sun, std::span<glm::vec3> strengths) {
    if (!has_light_set(layout))
        throw Error("the transfer has no light set, so that suns cannot shine by its keys");
    assert(strengths.size() == layout.lamps());
    const Place place = nearest(layout.lamp_parts(), glm::normalize(glm::dvec3(sun.towards)));
    strengths[place.first] += static_cast<float>(place.of_first) * sun.irradiance;
    strengths[place.second] += static_cast<float>(place.of_second) * sun.irradiance;
    return std::acos(std::clamp(place.cosine, -1.0, 1.0));
}

} // namespace prt
