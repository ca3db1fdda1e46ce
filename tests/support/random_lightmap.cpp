// Creates random lightmaps.

#include "support/random_lightmap.h"

#include <array>
#include <cstring>

namespace prt::test {

CompressedLightmap random_lightmap(const std::vector<LightmapSize>& maps, int words, bool alike,
                                   std::mt19937& random) {
    constexpr int kClusters = 11, kClusterBits = 4;
    std::normal_distribution<float> normal;
    CompressedLightmap lightmap{{maps, {}}, {}};
    ClusteredTransfer& t = lightmap.compressed.transfer;
    t.bases.layout = layout_of_one(3, 3);
    for (int k = 0; k < kClusters; ++k) {
        const int components = alike ? 3 : k % 4;
        t.bases.components.push_back(components);
        const int bits = (32 * words - kClusterBits) / 3; // across words where there are two
        for (int j = 0; j < components; ++j)
            t.bases.bits.push_back(static_cast<std::uint8_t>(std::min(16, alike ? bits : bits - j)));
    }
    t.bases.rows.resize(t.bases.first_rows().back() * t.bases.dimension());
    for (float& v : t.bases.rows)
        v = normal(random);
    t.receivers.format = WeightFormat::packed;
    t.receivers.cluster_bits = kClusterBits;
    t.receivers.words = words;
    const std::vector<ClusterLayout> layouts = cluster_layouts(t.bases);
    const std::vector<std::size_t> rows = t.bases.first_rows();
    for (std::size_t p = 0; p < lightmap.layout.texels(); ++p) {
        const auto k = static_cast<std::uint32_t>(random() % kClusters);
        std::vector<std::uint32_t> values, packed(static_cast<std::size_t>(words));
        for (int j = 0; j < t.bases.components[k]; ++j)
            values.push_back(static_cast<std::uint32_t>(random()) &
                             ((1u << t.bases.bits[rows[k] - k + static_cast<std::size_t>(j)]) - 1));
        pack_words(k, kClusterBits, layouts[k], values, packed);
        const auto* bytes = reinterpret_cast<const std::byte*>(packed.data());
        t.receivers.weights.insert(t.receivers.weights.end(), bytes, bytes + 4 * packed.size());
    }
    return lightmap;
}

} // namespace prt::test
