// Picks few of many samples by the error that interpolation may have at them.

#include "surface/varied_samples.h"

#include "trace/picked.h"

#include <algorithm>
#include <limits>
#include <map>

namespace prt {
namespace {

/// What a sample may contribute where vertices agree, in mean squares.
constexpr double kLeastLikely = 0.02;

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

/// Squared differences between the corners of a sample's triangle, each over the mean square of its column.
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
        sum += static_cast<double>((high - low) * (high - low)) / means[c] + kLeastLikely;
    }
    return sum > 0 ? sum : kLeastLikely;
}

/// Adds to what each sample may contribute so that every node has as much again as its share of all nodes.
void share_among_nodes(const SurfaceSamples& dense, const Surfaces& surfaces, std::vector<double>& likely) {
    std::map<int, double> of_nodes;
    double all = 0;
    const auto node = [&](std::size_t s) {
        return surfaces.scene().primitives[surfaces.primitive(dense.places[s].triangle)].node;
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

SurfaceSamples pick_varied(const SurfaceSamples& dense, const Surfaces& surfaces,
                           const TransportReceivers& receivers, const ChoiceValues& light, std::size_t count,
                           bool by_node) {
    const std::vector<double> means = mean_squares(receivers, light);
    std::vector<double> likely(dense.size());
    for (std::size_t s = 0; s < likely.size(); ++s) {
        const SamplePlace& place = dense.places[s];
        likely[s] =
            static_cast<double>(dense.receivers.areas[s]) *
            variation(corner_receivers(surfaces, receivers, place.triangle, place.back), light, means);
    }
    if (by_node)
        share_among_nodes(dense, surfaces, likely);
    SurfaceSamples some;
    for (const Picked& picked : pick(dense.size(), count, [&](std::size_t s) { return likely[s]; })) {
        some.places.push_back(dense.places[picked.index]);
        some.receivers.append(dense.receivers, picked.index);
        some.receivers.areas.back() *= static_cast<float>(picked.stands_for);
    }
    return some;
}

} // namespace prt
