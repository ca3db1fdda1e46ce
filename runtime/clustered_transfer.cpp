#include "prt/clustered_transfer.h"

#include "prt/error.h"
#include "prt/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <string>

namespace prt {
namespace {

template <class Stored>
Stored load(const std::byte* from) {
    Stored value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

int width_of(const ClusterLayout& layout, std::size_t component) {
    return 1 + static_cast<int>(layout.widths[component / 8] >> (4 * (component % 8)) & 15u);
}

/// `width` bits of `words` from bit `position` on, width <= 16.
std::uint32_t bits_at(const std::byte* words, std::size_t position, int width) {
    const std::size_t word = position / 32, shift = position % 32;
    std::uint64_t bits = load<std::uint32_t>(words + word * 4);
    if (shift + static_cast<std::size_t>(width) > 32)
        bits |= static_cast<std::uint64_t>(load<std::uint32_t>(words + word * 4 + 4)) << 32;
    return static_cast<std::uint32_t>(bits >> shift) & ((1u << width) - 1);
}

/// Calls `weight(j, stored)` for the components of a receiver: as the shader reads them, q where packed.
template <class Weight>
void for_each_stored(const ClusteredReceivers& receivers, const ClusterLayout& layout, std::size_t receiver,
                     Weight&& weight) {
    const std::byte* from = receivers.weights.data() + receiver * receivers.stride();
    const std::size_t count = layout.components;
    switch (receivers.format) {
    case WeightFormat::float32:
        for (std::size_t j = 0; j < count; ++j)
            weight(j, load<float>(from + 4 * j));
        break;
    case WeightFormat::snorm16:
        for (std::size_t j = 0; j < count; ++j)
            weight(j, std::max(static_cast<float>(load<std::int16_t>(from + 2 * j)) / 32767.0f, -1.0f));
        break;
    case WeightFormat::snorm8:
        for (std::size_t j = 0; j < count; ++j)
            weight(j, std::max(static_cast<float>(load<std::int8_t>(from + j)) / 127.0f, -1.0f));
        break;
    case WeightFormat::packed:
        auto position = static_cast<std::size_t>(receivers.cluster_bits);
        for (std::size_t j = 0; j < count; ++j) {
            const int width = width_of(layout, j);
            weight(j, static_cast<float>(bits_at(from, position, width)));
            position += static_cast<std::size_t>(width);
        }
        break;
    }
}

} // namespace

std::size_t bytes_per_weight(WeightFormat format) {
    switch (format) {
    case WeightFormat::snorm16:
        return 2;
    case WeightFormat::snorm8:
        return 1;
    case WeightFormat::float32:
    case WeightFormat::packed:
        break;
    }
    assert(format == WeightFormat::float32);
    return 4;
}

std::size_t ClusteredReceivers::stride() const {
    return format == WeightFormat::packed ? static_cast<std::size_t>(words) * 4
                                          : static_cast<std::size_t>(components) * bytes_per_weight(format);
}

void decode_weights(const ClusteredTransfer& transfer, std::span<const ClusterLayout> layouts,
                    std::size_t receiver, std::span<float> weights) {
    const ClusterLayout& layout = layouts[transfer.receivers.clusters[receiver]];
    for_each_stored(transfer.receivers, layout, receiver,
                    [&](std::size_t j, float stored) { weights[j] = stored; });
    if (transfer.receivers.format == WeightFormat::packed)
        for (std::size_t j = 0; j < layout.components; ++j) {
            const auto largest = static_cast<float>((1u << width_of(layout, j)) - 1);
            weights[j] = (2 * weights[j] - largest) / largest;
        }
}

void pack_words(std::uint32_t cluster, int cluster_bits, const ClusterLayout& layout,
                std::span<const std::uint32_t> values, std::span<std::uint32_t> words) {
    std::fill(words.begin(), words.end(), 0u);
    std::size_t position = 0;
    const auto put = [&](std::uint32_t value, int width) {
        const std::size_t word = position / 32, shift = position % 32;
        words[word] |= value << shift;
        if (shift + static_cast<std::size_t>(width) > 32)
            words[word + 1] |= value >> (32 - shift);
        position += static_cast<std::size_t>(width);
    };
    put(cluster, cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j)
        put(values[j], width_of(layout, j));
}

std::size_t bytes_per_receiver(const ClusteredTransfer& transfer) {
    const ClusteredReceivers& receivers = transfer.receivers;
    const ClusteredBases& bases = transfer.bases;
    if (receivers.format != WeightFormat::packed)
        return (bases.clusters() > 256 ? 2 : 1) +
               static_cast<std::size_t>(bases.max_components()) * bytes_per_weight(receivers.format);
    std::size_t most = 0;
    for (const ClusterLayout& layout : cluster_layouts(bases)) {
        auto bits = static_cast<std::size_t>(receivers.cluster_bits);
        for (std::size_t j = 0; j < layout.components; ++j)
            bits += static_cast<std::size_t>(width_of(layout, j));
        most = std::max(most, bits);
    }
    return (most + 7) / 8;
}

std::size_t constant_rows(const ClusteredBases& bases) {
    return bases.first_rows().back();
}

void form_constants(const ClusteredTransfer& transfer, const Light& light, std::span<glm::vec4> constants) {
    const ClusteredBases& bases = transfer.bases;
    if (light.order > bases.order)
        return form_constants(transfer, truncated(light, bases.order), constants);
    if (light.order < bases.order)
        throw Error("the lighting has order " + std::to_string(light.order) + ", the transfer order " +
                    std::to_string(bases.order));
    const bool packed = transfer.receivers.format == WeightFormat::packed;
    const float* row = bases.rows.data();
    const std::uint8_t* bits = bases.bits.data();
    glm::vec4* to = constants.data();
    const auto next = [&] {
        const glm::vec4 value(exit_radiance({row, bases.dimension()}, bases.channels, light), 0);
        row += bases.dimension();
        return value;
    };
    for (const int components : bases.components) {
        glm::vec4& mean = *to++ = next();
        for (int j = 0; j < components; ++j) {
            glm::vec4 value = next();
            if (packed) { // w = 2 q / largest - 1
                mean -= value;
                value *= 2 / static_cast<float>((1u << *bits++) - 1);
            }
            *to++ = value;
        }
    }
    assert(to <= constants.data() + constants.size());
}

void evaluate(const ClusteredTransfer& transfer, std::span<const glm::vec4> constants,
              std::span<glm::vec3> radiance, int threads) {
    const std::vector<ClusterLayout> layouts = cluster_layouts(transfer.bases);
    const ClusteredReceivers& receivers = transfer.receivers;
    assert(radiance.size() >= receivers.size());
    parallel_for(receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const ClusterLayout& layout = layouts[receivers.clusters[p]];
            const glm::vec4* row = &constants[layout.first_row];
            glm::vec4 sum = row[0];
            for_each_stored(receivers, layout, p,
                            [&](std::size_t j, float stored) { sum += stored * row[1 + j]; });
            radiance[p] = glm::vec3(sum);
        }
    });
}

std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads) {
    std::vector<glm::vec4> constants(constant_rows(transfer.bases));
    form_constants(transfer, light, constants);
    std::vector<glm::vec3> radiance(transfer.receivers.size());
    evaluate(transfer, constants, radiance, threads);
    return radiance;
}

Transfer decode(const ClusteredTransfer& transfer, int threads) {
    const ClusteredBases& bases = transfer.bases;
    const std::size_t dimension = bases.dimension();
    const std::vector<ClusterLayout> layouts = cluster_layouts(bases);
    Transfer result = zero_transfer(bases.order, bases.channels, transfer.receivers.size());
    parallel_for(transfer.receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> weights(static_cast<std::size_t>(bases.max_components()));
        for (std::size_t p = begin; p < end; ++p) {
            const ClusterLayout& layout = layouts[transfer.receivers.clusters[p]];
            decode_weights(transfer, layouts, p, weights);
            const float* row = &bases.rows[layout.first_row * dimension];
            const std::span<float> out = result.vector(p);
            std::copy_n(row, dimension, out.begin());
            for (std::size_t j = 0; j < layout.components; ++j) {
                row += dimension;
                for (std::size_t i = 0; i < dimension; ++i)
                    out[i] += weights[j] * row[i];
            }
        }
    });
    return result;
}

} // namespace prt
