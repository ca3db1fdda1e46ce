// Spreads samples by their possible interpolation error.

#include "bake/surface_fit/varied_samples.h"

#include "bake/trace/picked.h"

#include <algorithm>
#include <limits>
#include <map>

namespace prt {
namespace {

/// Weight of a sample if the vertices agree, in mean squares.
constexpr double kMinLikely = 0.02;

/// Mean square of each column over the surface.
std::vector<double> mean_squares(const TransportReceivers& receivers, const ChoiceValues& light) {
    std::vector<double> means(light.columns);
    double areas = 0;
    for (std::size_t p = 0; p < receivers.receivers.size(); ++p) {
        const auto area = static_cast<double>(receivers.receivers.areas[p]);
        areas += area;
        for (std::size_t c = 0; c < light.columns; ++c) {
            const float v = light.values[p * light.columns + c];
            means[c] += area * static_cast<double>(v * v);
        }
    }
    for (double& mean : means)
        mean = areas > 0 ? mean / areas : 0;
    return means;
}

/// Squared differences between the corners of a sample's triangle, each relative to the mean square of its
/// column.
double variation(const glm::uvec3& corners, const ChoiceValues& light, std::span<const double> means) {
    double sum = 0;
    for (std::size_t c = 0; c < light.columns; ++c) {
        if (!(means[c] > 0))
            continue;
        float low = std::numeric_limits<float>::infinity(), high = 0;
        for (int i = 0; i < 3; ++i) {
            const float here = corners[i] == kNoReceiver ? 0 : light.values[corners[i] * light.columns + c];
            low = std::min(low, here);
            high = std::max(high, here);
        }
        sum += static_cast<double>((high - low) * (high - low)) / means[c] + kMinLikely;
    }
    return sum > 0 ? sum : kMinLikely;
}

/// Increases the weights of the sides so that half of the total weight is shared equally among nodes.
void share_among_nodes(const Surfaces& surfaces, std::span<const TriangleSide> sides,
                       std::vector<double>& likely) {
    std::map<int, double> of_nodes;
    double all = 0;
    const auto node = [&](std::size_t s) {
        return surfaces.scene().primitives[surfaces.primitive(sides[s].triangle)].node;
    };
    for (std::size_t s = 0; s < likely.size(); ++s) {
        of_nodes[node(s)] += likely[s];
        all += likely[s];
    }
    for (std::size_t s = 0; s < likely.size(); ++s)
        if (const double here = of_nodes[node(s)]; here > 0)
            likely[s] *= 1 + all / (here * static_cast<double>(of_nodes.size()));
}

} // namespace

SurfaceSamples sample_varied(const Surfaces& surfaces, const TransportReceivers& receivers,
                             const ChoiceValues& light, const VariedSpread& spread) {
    const std::vector<double> means = mean_squares(receivers, light);
    const std::vector<TriangleSide> sides = triangle_sides(surfaces, receivers, spread.backs);
    std::vector<double> likely;
    for (const TriangleSide& side : sides)
        likely.push_back(
            side.area *
            variation(corner_receivers(surfaces, receivers, side.triangle, side.back), light, means));
    if (spread.by_node)
        share_among_nodes(surfaces, sides, likely);
    SurfaceSamples samples;
    for (const Picked& picked : pick(sides.size(), spread.count, [&](std::size_t s) { return likely[s]; })) {
        const TriangleSide& side = sides[picked.index];
        const std::uint32_t hash = side_hash(side, spread.seed);
        const auto area = static_cast<float>(side.area * picked.weight / static_cast<double>(picked.times));
        for (std::size_t i = 0; i < picked.times; ++i)
            append_sample(samples, surfaces, receivers, {side.triangle, side.back, even_point(hash, i)},
                          area);
    }
    return samples;
}

SurfaceSamples pick_samples(const SurfaceSamples& many, std::span<const double> likely, std::size_t count) {
    SurfaceSamples some;
    for (const Picked& picked : pick(many.size(), count, [&](std::size_t s) { return likely[s]; })) {
        some.positions.push_back(many.positions[picked.index]);
        some.receivers.append(many.receivers, picked.index);
        some.receivers.areas.back() *= static_cast<float>(picked.weight);
    }
    return some;
}

} // namespace prt
