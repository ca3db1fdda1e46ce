#include "prt/clustered_transfer.h"

#include "prt/constant_former.h"
#include "prt/support/parallel.h"
#include "prt/support/vector_lanes.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace prt {
namespace {

template <class Stored>
[[gnu::always_inline]] inline Stored load(const std::byte* from) {
    Stored value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

[[gnu::always_inline]] inline int width_of(const ClusterLayout& layout, std::size_t component) {
    return 1 + static_cast<int>(layout.widths[component / 8] >> (4 * (component % 8)) & 15u);
}

/// `width` bits of `words` from bit `position` on, width <= 16.
[[gnu::always_inline]] inline std::uint32_t bits_at(const std::byte* words, std::size_t position, int width) {
    const std::size_t word = position / 32, shift = position % 32;
    std::uint64_t bits = load<std::uint32_t>(words + word * 4);
    if (shift + static_cast<std::size_t>(width) > 32)
        bits |= static_cast<std::uint64_t>(load<std::uint32_t>(words + word * 4 + 4)) << 32;
    return static_cast<std::uint32_t>(bits >> shift) & ((1u << width) - 1);
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
    const ClusteredReceivers& receivers = transfer.receivers;
    const ClusterLayout& layout = layouts[receivers.clusters[receiver]];
    const std::byte* from = receivers.weights.data() + receiver * receivers.stride();
    auto position = static_cast<std::size_t>(receivers.cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j) {
        switch (receivers.format) {
        case WeightFormat::float32:
            weights[j] = load<float>(from + 4 * j);
            break;
        case WeightFormat::snorm16:
            weights[j] = std::max(static_cast<float>(load<std::int16_t>(from + 2 * j)) / 32767.0f, -1.0f);
            break;
        case WeightFormat::snorm8:
            weights[j] = std::max(static_cast<float>(load<std::int8_t>(from + j)) / 127.0f, -1.0f);
            break;
        case WeightFormat::packed: {
            const int width = width_of(layout, j);
            const auto largest = static_cast<float>((1u << width) - 1);
            weights[j] = (2 * static_cast<float>(bits_at(from, position, width)) - largest) / largest;
            position += static_cast<std::size_t>(width);
            break;
        }
        }
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
    if (receivers.format == WeightFormat::packed)
        return receivers.stride();
    return 4 + receivers.stride();
}

std::size_t bits_per_receiver(const ClusteredTransfer& transfer) {
    const ClusteredReceivers& receivers = transfer.receivers;
    const ClusteredBases& bases = transfer.bases;
    if (receivers.format != WeightFormat::packed)
        return 8 * ((bases.clusters() > 256 ? 2 : 1) +
                    static_cast<std::size_t>(bases.max_components()) * bytes_per_weight(receivers.format));
    std::size_t most = 0;
    for (const ClusterLayout& layout : cluster_layouts(bases)) {
        auto bits = static_cast<std::size_t>(receivers.cluster_bits);
        for (std::size_t j = 0; j < layout.components; ++j)
            bits += static_cast<std::size_t>(width_of(layout, j));
        most = std::max(most, bits);
    }
    return most;
}

std::size_t constant_rows(const ClusteredBases& bases) {
    return bases.first_rows().back();
}

void form_constants(const ClusteredTransfer& transfer, const Light& light, std::span<glm::vec4> constants) {
    ConstantFormer(transfer).form(light.coefficients, constants);
}

namespace {

using Colour [[gnu::vector_size(16)]] = float;
using ColourInMemory [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;

[[gnu::always_inline]] inline Colour colour_at(const glm::vec4* row) {
    return *reinterpret_cast<const ColourInMemory*>(row);
}

using FourColours [[gnu::vector_size(64)]] = float;
using FourColoursInMemory [[gnu::vector_size(64), gnu::aligned(4), gnu::may_alias]] = float;

/// sum_j stored_j row_j for normalised integers, eight at a time; `Limit` is what stands for 1.
template <class Stored, int Limit>
[[gnu::always_inline]] inline Colour sum_of_integers(const std::byte* from, std::size_t count,
                                                     const glm::vec4* rows) {
    using Eight [[gnu::vector_size(8 * sizeof(Stored))]] = Stored;
    using EightInts [[gnu::vector_size(32)]] = std::int32_t;
    using EightFloats [[gnu::vector_size(32)]] = float;
    FourColours four = {};
    std::size_t j = 0;
    for (; j + 8 <= count; j += 8) {
        Eight stored;
        std::memcpy(&stored, from + j * sizeof(Stored), sizeof stored);
        EightInts wide = __builtin_convertvector(stored, EightInts);
        wide = wide < -Limit ? EightInts{} - Limit : wide;
        const EightFloats w = __builtin_convertvector(wide, EightFloats);
        const auto* row = reinterpret_cast<const FourColoursInMemory*>(rows + j);
        four += __builtin_shufflevector(w, w, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3) * row[0];
        four += __builtin_shufflevector(w, w, 4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7) * row[1];
    }
    const EightFloats two = __builtin_shufflevector(four, four, 0, 1, 2, 3, 4, 5, 6, 7) +
                            __builtin_shufflevector(four, four, 8, 9, 10, 11, 12, 13, 14, 15);
    Colour sum =
        __builtin_shufflevector(two, two, 0, 1, 2, 3) + __builtin_shufflevector(two, two, 4, 5, 6, 7);
    for (; j < count; ++j)
        sum += static_cast<float>(std::max<int>(load<Stored>(from + j * sizeof(Stored)), -Limit)) *
               colour_at(rows + j);
    return sum * (1.0f / static_cast<float>(Limit));
}

template <WeightFormat Format>
[[gnu::always_inline]] inline Colour sum_of_weights(const ClusteredReceivers& receivers,
                                                    const ClusterLayout& layout, const std::byte* from,
                                                    const glm::vec4* rows) {
    if constexpr (Format == WeightFormat::snorm8)
        return sum_of_integers<std::int8_t, 127>(from, layout.components, rows);
    if constexpr (Format == WeightFormat::snorm16)
        return sum_of_integers<std::int16_t, 32767>(from, layout.components, rows);
    Colour sum = {};
    auto position = static_cast<std::size_t>(receivers.cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j) {
        float stored;
        if constexpr (Format == WeightFormat::packed) {
            const int width = width_of(layout, j);
            stored = static_cast<float>(bits_at(from, position, width));
            position += static_cast<std::size_t>(width);
        } else {
            stored = load<float>(from + 4 * j);
        }
        sum += stored * colour_at(rows + j);
    }
    return sum;
}

using Words [[gnu::vector_size(4 * kLaneCount)]] = std::int32_t;

/// A word of each of kLaneCount receivers, `stride` bytes apart.
[[gnu::always_inline]] inline Words word_of_each(const std::byte* from, std::size_t stride) {
    Words words[2];
    if (stride == 8) { // eight components: every second word
        std::memcpy(words, from, sizeof words - 4);
        return __builtin_shufflevector(words[0], words[1], 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26,
                                       28, 30);
    }
    std::int32_t one_by_one[kLaneCount];
    for (std::size_t lane = 0; lane < kLaneCount; ++lane)
        one_by_one[lane] = load<std::int32_t>(from + lane * stride);
    std::memcpy(words, one_by_one, sizeof one_by_one);
    return words[0];
}

/// Radiance of kLaneCount receivers of one cluster whose weights are bytes, a receiver per lane: where
/// clusters are contiguous (prt compress --reorder) memory is what limits.
[[gnu::always_inline]] inline void evaluate_lanes(const std::byte* weights, std::size_t stride,
                                                  std::size_t components, const glm::vec4* row,
                                                  glm::vec3* radiance) {
    Lanes sums[3] = {};
    for (std::size_t first = 0; first < components; first += 4) {
        Words four = word_of_each(weights + first, stride);
        for (std::size_t j = first; j < std::min(first + 4, components); ++j) {
            // The lowest byte with its sign; the next one moves down.
            Words q = four << 24 >> 24;
            four >>= 8;
            q = q < -127 ? Words{} - 127 : q;
            const Lanes w = __builtin_convertvector(q, Lanes);
            for (int c = 0; c < 3; ++c)
                sums[c] += w * row[1 + j][c];
        }
    }
    for (int c = 0; c < 3; ++c)
        sums[c] = sums[c] * (1.0f / 127) + row[0][c];
    // r0 g0 r1 g1 .. and then b in between.
    const auto interleave = [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
        const auto part = [&]<int Part>() __attribute__((always_inline)) {
            // Element 16 Part + i of the output is channel (16 Part + i) % 3 of receiver (16 Part + i) / 3.
            const Lanes rg = __builtin_shufflevector(
                sums[0], sums[1], ((16 * Part + I) / 3 + ((16 * Part + I) % 3 == 1 ? kLaneCount : 0))...);
            const Lanes rgb = __builtin_shufflevector(
                rg, sums[2], ((16 * Part + I) % 3 == 2 ? kLaneCount + (16 * Part + I) / 3 : I)...);
            *reinterpret_cast<LanesInMemory*>(&radiance[0][0] + 16 * Part) = rgb;
        };
        part.template operator()<0>();
        part.template operator()<1>();
        part.template operator()<2>();
    };
    interleave(std::make_integer_sequence<int, kLaneCount>());
}

/// Whether kLaneCount receivers are of one cluster.
[[gnu::always_inline]] inline bool all_alike(const std::uint16_t* clusters) {
    const std::uint64_t first = clusters[0] * 0x0001000100010001u;
    std::uint64_t four[kLaneCount / 4], differ = 0;
    std::memcpy(four, clusters, sizeof four);
    for (const std::uint64_t each : four)
        differ |= each ^ first;
    return differ == 0;
}

template <WeightFormat Format>
[[gnu::always_inline]] inline void evaluate_format(const ClusteredReceivers& receivers,
                                                   const ClusterLayout* layouts, const glm::vec4* constants,
                                                   std::size_t begin, std::size_t end, glm::vec3* radiance) {
    const std::size_t stride = receivers.stride();
    const std::uint16_t* clusters = receivers.clusters.data();
    const std::byte* weights = receivers.weights.data();
    for (std::size_t p = begin; p < end; ++p) {
        const ClusterLayout& layout = layouts[clusters[p]];
        const glm::vec4* row = constants + layout.first_row;
        if constexpr (Format == WeightFormat::snorm8)
            if (p + kLaneCount <= end && all_alike(clusters + p)) {
                evaluate_lanes(weights + p * stride, stride, layout.components, row, radiance + p);
                p += kLaneCount - 1;
                continue;
            }
        const Colour sum =
            colour_at(row) + sum_of_weights<Format>(receivers, layout, weights + p * stride, row + 1);
        radiance[p] = {sum[0], sum[1], sum[2]};
    }
}

PRT_TARGET_CLONES
void evaluate_range(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
                    const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance) {
    switch (receivers.format) {
    case WeightFormat::snorm8:
        return evaluate_format<WeightFormat::snorm8>(receivers, layouts, constants, begin, end, radiance);
    case WeightFormat::snorm16:
        return evaluate_format<WeightFormat::snorm16>(receivers, layouts, constants, begin, end, radiance);
    case WeightFormat::float32:
        return evaluate_format<WeightFormat::float32>(receivers, layouts, constants, begin, end, radiance);
    case WeightFormat::packed:
        return evaluate_format<WeightFormat::packed>(receivers, layouts, constants, begin, end, radiance);
    }
}

} // namespace

void evaluate(const ClusteredTransfer& transfer, std::span<const glm::vec4> constants,
              std::span<glm::vec3> radiance, int threads) {
    const std::vector<ClusterLayout> layouts = cluster_layouts(transfer.bases);
    const ClusteredReceivers& receivers = transfer.receivers;
    assert(radiance.size() >= receivers.size());
    parallel_for(receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        evaluate_range(receivers, layouts.data(), constants.data(), begin, end, radiance.data());
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
