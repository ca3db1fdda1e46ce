// Finds bright spots: the brightest texels of the cells, each grown to the region above half of its
// brightness. The extent of a spot's light is found as in aperture photometry (Stetson 1987, "DAOPHOT") by
// medians over rings, which are robust against a second sun in the ring.
#include "runtime/fit/spot.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

/// Number of candidates by brightest texel, and the same number by total light: a lamp may be dim and large.
constexpr std::size_t kCandidates = 16;

/// Maximum spread of a sun relative to its radius. A disc has 0.71, ellipses and windows with aspect ratio
/// 2:1 0.8, strips of 3:1 0.92.
constexpr double kRound = 0.87;

struct Weighted {
    double value, weight;
};

/// Returns the value below which half of the weight is. `list` is not empty.
double weighted_median(std::vector<Weighted>& list) {
    std::sort(list.begin(), list.end(),
              [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    double all = 0, below = 0;
    for (const Weighted& entry : list)
        all += entry.weight;
    for (const Weighted& entry : list)
        if ((below += entry.weight) >= 0.5 * all)
            return entry.value;
    return list.back().value;
}

/// Returns the median of `value(color)`, weighted by solid angle, over texels from `begin` to `end` radians;
/// empty if there are no texels.
template <class Value>
std::optional<double> ring_median(const std::vector<NearTexel>& texels, double begin, double end,
                                  const Value& value) {
    std::vector<Weighted> ring;
    for (const NearTexel& near : texels)
        if (near.angle > begin && near.angle <= end)
            ring.push_back({value(near.color), near.solid_angle});
    if (ring.empty())
        return {};
    return weighted_median(ring);
}

/// Moves `spot` to the centroid of the texels brighter than `level` within `window`.
void measure_above(const std::vector<NearTexel>& texels, double level, double window, Spot& spot) {
    glm::dvec3 sum(0);
    double area = 0, weights = 0;
    spot.excess = 0;
    for (const NearTexel& near : texels) {
        const double value = brightness(near.color);
        if (near.angle > window || value <= level)
            continue;
        area += near.solid_angle;
        spot.excess += near.solid_angle * (value - spot.sky);
        const double weight = near.solid_angle * (value - spot.sky) / (spot.peak - spot.sky);
        weights += weight;
        sum += weight * near.direction;
    }
    spot.radius = std::sqrt(area / pi);
    const double length = glm::length(sum);
    spot.towards = sum / length;
    // The sum of unit vectors is shorter than their number by half of their mean squared distance.
    spot.spread = std::sqrt(std::max(0.0, 2 * (1 - length / weights)));
}

/// Moves `spot` to the brightest texel within `window`. Returns whether the texel changed.
bool climb(const std::vector<NearTexel>& texels, double window, Spot& spot) {
    const double before = spot.peak;
    for (const NearTexel& near : texels)
        if (near.angle <= window && brightness(near.color) > spot.peak) {
            spot.peak = brightness(near.color);
            spot.towards = near.direction;
        }
    return spot.peak > before;
}

/// Returns the brightest texels of well separated cells, in two orders: by brightest texel and by total
/// light.
std::vector<std::size_t> candidates(const SkyMap& map) {
    const std::vector<SkyCell> cells = map.cells();
    std::vector<std::size_t> sorted;
    for (std::size_t c = 0; c < cells.size(); ++c)
        if (cells[c].most > 0)
            sorted.push_back(c);
    const double separate = std::max(0.05, 2 * map.texels().spacing()); // a cell and its neighbors
    std::vector<std::size_t> found;
    const auto take = [&](auto key) {
        std::stable_sort(sorted.begin(), sorted.end(),
                         [&](std::size_t a, std::size_t b) { return key(cells[a]) > key(cells[b]); });
        std::vector<glm::dvec3> taken;
        for (std::size_t i = 0; i < sorted.size() && taken.size() < kCandidates; ++i) {
            const SkyCell& cell = cells[sorted[i]];
            if (std::ranges::any_of(taken, [&](const glm::dvec3& other) {
                    return glm::distance(other, cell.direction) < separate;
                }))
                continue;
            taken.push_back(cell.direction);
            found.push_back(cell.brightest);
        }
    };
    take([](const SkyCell& cell) { return cell.most; });
    take([](const SkyCell& cell) { return brightness(cell.flux); });
    return found;
}

} // namespace

std::optional<Spot> spot_at(const SkyMap& map, std::size_t texel, double widest) {
    const double step = map.texels().spacing();
    Spot spot;
    spot.towards = map.texels().direction(texel);
    spot.peak = brightness(glm::dvec3(map.environment().image.pixels[texel]));
    for (double window = 1.5 * step; window <= 2 * widest + step;) {
        const std::vector<NearTexel> texels = map.near(spot.towards, 2 * window + step);
        const auto sky = ring_median(texels, window, 2 * window + step, brightness);
        if (!sky || !(spot.peak > *sky))
            return {};
        spot.sky = *sky;
        if (climb(texels, window, spot))
            continue;
        measure_above(texels, 0.5 * (spot.peak + spot.sky), window, spot);
        // The window contains the whole spot if it is twice as wide.
        const double wanted = 2 * spot.radius + step;
        if (window >= 0.9 * wanted)
            return spot.radius <= widest && spot.spread <= kRound * std::max(spot.radius, step)
                       ? std::optional(spot)
                       : std::nullopt;
        window = std::max(1.5 * window, wanted);
    }
    return {};
}

std::optional<Spot> strongest_spot(const SkyMap& map, double widest, std::span<const Taken> taken) {
    std::optional<Spot> strongest;
    double most = 0;
    for (const std::size_t texel : candidates(map)) {
        const std::optional<Spot> spot = spot_at(map, texel, widest);
        if (spot && std::ranges::any_of(taken, [&](const Taken& part) {
                return glm::distance(part.towards, spot->towards) < part.radius + spot->radius;
            }))
            continue;
        // Wider spots are better represented by the SH order.
        const double weight = spot ? spot->excess * (1 - spot->radius / widest) : 0;
        if (weight > most) {
            most = weight;
            strongest = spot;
        }
    }
    return strongest;
}

Aperture aperture_of(const SkyMap& map, const Spot& spot, double widest) {
    constexpr double kHalo = 0.05; // minimum light of a ring that is included, relative to the light inside
    const double step = map.texels().spacing();
    Aperture aperture{spot.radius + 1.5 * step, glm::dvec3(spot.sky)};
    for (;;) {
        const double radius = aperture.radius, outer = 2 * radius + 2 * step;
        const std::vector<NearTexel> texels = map.near(spot.towards, outer);
        const double middle = 1.5 * radius + step;
        const auto ring = ring_median(texels, radius, middle, brightness),
                   far = ring_median(texels, middle, outer, brightness);
        double inside = 0, area = 0;
        for (const NearTexel& near : texels)
            if (near.angle <= radius)
                inside += near.solid_angle * std::max(0.0, brightness(near.color) - far.value_or(spot.sky));
            else if (near.angle <= middle)
                area += near.solid_angle;
        if (!ring || !far || (*ring - *far) * area <= kHalo * inside || 1.3 * radius > widest) {
            for (int c = 0; c < 3; ++c)
                aperture.sky[c] = ring_median(texels, radius, middle, [c](const glm::dvec3& color) {
                                      return color[c];
                                  }).value_or(spot.sky);
            return aperture;
        }
        aperture.radius *= 1.3;
    }
}

} // namespace prt
