// Creates random volumes.

#include "support/random_volume.h"

#include <algorithm>
#include <cstring>

namespace prt::test {
namespace {

constexpr int kClusters = 11, kClusterBits = 4, kWords = 2, kComponents = 4;

ClusteredBases random_bases(const TransferLayout& layout, bool alike, std::mt19937& random) {
    std::normal_distribution<float> normal;
    ClusteredBases bases;
    bases.layout = layout;
    for (int k = 0; k < kClusters; ++k) {
        const int components = alike ? kComponents : k % (kComponents + 1);
        bases.components.push_back(components);
        for (int j = 0; j < components; ++j) // 60 bits: the third lies across words
            bases.bits.push_back(static_cast<std::uint8_t>(alike ? 15 : 14 - j));
    }
    bases.rows.resize(bases.first_rows().back() * bases.dimension());
    for (float& v : bases.rows)
        v = 0.3f * normal(random);
    return bases;
}

ClusteredReceivers random_receivers(const ClusteredBases& bases, std::size_t count, std::mt19937& random) {
    ClusteredReceivers receivers;
    receivers.format = WeightFormat::packed;
    receivers.cluster_bits = kClusterBits;
    receivers.words = kWords;
    const std::vector<ClusterLayout> layouts = cluster_layouts(bases);
    const std::vector<std::size_t> rows = bases.first_rows();
    for (std::size_t p = 0; p < count; ++p) {
        const auto k = static_cast<std::uint32_t>(random() % kClusters);
        std::vector<std::uint32_t> values, packed(kWords);
        for (int j = 0; j < bases.components[k]; ++j)
            values.push_back(static_cast<std::uint32_t>(random()) &
                             ((1u << bases.bits[rows[k] - k + static_cast<std::size_t>(j)]) - 1));
        pack_words(k, kClusterBits, layouts[k], values, packed);
        const auto bytes = std::as_bytes(std::span(packed));
        receivers.weights.insert(receivers.weights.end(), bytes.begin(), bytes.end());
    }
    return receivers;
}

} // namespace

TransferLayout terms_of_volume(int order) {
    return {order, {{TermKind::direct, 1}, {TermKind::indirect, 3}, {TermKind::lamp, 3, "lantern"}}};
}

Lighting lighting_of_probes() {
    Lighting lighting{cone_light(3, {0, 1, 0}, 0.7, {1, 2, 3}), cone_light(3, {1, 0, 0}, 0.2, {3, 2, 1})};
    lighting.lamps = {{0.5f, 1, 2}};
    return lighting;
}

CompressedVolume random_volume(const VolumeGrid& grid, int order, bool alike, std::mt19937& random,
                               std::size_t invalid) {
    CompressedVolume volume{{grid, order, {}}, {}};
    const std::size_t probes = probes_of(grid).size();
    TransferLayout layout = terms_of_volume(3);
    layout.outputs = static_cast<std::size_t>(coefficient_count(order));
    volume.compressed.transfer.bases = random_bases(layout, alike, random);
    volume.compressed.transfer.receivers = random_receivers(volume.compressed.transfer.bases, probes, random);
    // Surfaces nearer than a fifth of a cell would amplify the rounding of positions.
    std::uniform_int_distribution<int> visibility(60, 400);
    for (std::size_t p = 0; p < probes; ++p) {
        ProbeVisibility& s = volume.visibility.emplace_back();
        for (std::uint8_t& each : s)
            each = p % invalid == 0 ? 0 : static_cast<std::uint8_t>(std::min(255, visibility(random)));
    }
    return volume;
}

CompressedVolume random_volume(int order, bool alike, std::mt19937& random, std::size_t invalid) {
    const VolumeGrid grid{.origin = {-1.5f, 0.25f, 2},
                          .spacing = 0.5f,
                          .size = {5, 3, 2},
                          .bricks = {{{0, 0, 0}, 1},
                                     {{2, 0, 0}, 0},
                                     {{3, 0, 0}, 0},
                                     {{2, 1, 0}, 0},
                                     {{2, 0, 1}, 0},
                                     {{3, 1, 1}, 0},
                                     {{0, 2, 0}, 1},
                                     {{2, 2, 0}, 0}}}; // {0, 2, 0} reaches out of the box
    return random_volume(grid, order, alike, random, invalid);
}

} // namespace prt::test
