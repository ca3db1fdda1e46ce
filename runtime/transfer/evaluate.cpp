// Exit radiance of every receiver from formed constants, in vectors (docs/math.md, eq. 29).
#include "prt/clustered_transfer.h"
#include "prt/support/parallel.h"
#include "prt/support/vector_lanes.h"
#include "transfer/evaluate_range.h"
#include "transfer/packed_weights.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace prt {
namespace {

using Color [[gnu::vector_size(16)]] = float;
using ColorInMemory [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;

[[gnu::always_inline]] inline Color color_at(const glm::vec4* row) {
    return *reinterpret_cast<const ColorInMemory*>(row);
}

constexpr std::size_t kMostOutputs = 16;

using FourColors [[gnu::vector_size(64)]] = float;
using FourColorsInMemory [[gnu::vector_size(64), gnu::aligned(4), gnu::may_alias]] = float;

/// sum_j stored_j row_j for normalised integers, eight at a time; `Limit` is what stands for 1.
template <class Stored, int Limit>
[[gnu::always_inline]] inline Color sum_of_integers(const std::byte* from, std::size_t count,
                                                    const glm::vec4* rows) {
    using Eight [[gnu::vector_size(8 * sizeof(Stored))]] = Stored;
    using EightInts [[gnu::vector_size(32)]] = std::int32_t;
    using EightFloats [[gnu::vector_size(32)]] = float;
    FourColors four = {};
    std::size_t j = 0;
    for (; j + 8 <= count; j += 8) {
        Eight stored;
        std::memcpy(&stored, from + j * sizeof(Stored), sizeof stored);
        EightInts wide = __builtin_convertvector(stored, EightInts);
        wide = wide < -Limit ? EightInts{} - Limit : wide;
        const EightFloats w = __builtin_convertvector(wide, EightFloats);
        const auto* row = reinterpret_cast<const FourColorsInMemory*>(rows + j);
        four += __builtin_shufflevector(w, w, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3) * row[0];
        four += __builtin_shufflevector(w, w, 4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7) * row[1];
    }
    const EightFloats two = __builtin_shufflevector(four, four, 0, 1, 2, 3, 4, 5, 6, 7) +
                            __builtin_shufflevector(four, four, 8, 9, 10, 11, 12, 13, 14, 15);
    Color sum = __builtin_shufflevector(two, two, 0, 1, 2, 3) + __builtin_shufflevector(two, two, 4, 5, 6, 7);
    for (; j < count; ++j)
        sum += static_cast<float>(std::max<int>(load<Stored>(from + j * sizeof(Stored)), -Limit)) *
               color_at(rows + j);
    return sum * (1.0f / static_cast<float>(Limit));
}

template <WeightFormat Format>
[[gnu::always_inline]] inline Color sum_of_weights(const ClusteredReceivers& receivers,
                                                   const ClusterLayout& layout, const std::byte* from,
                                                   const glm::vec4* rows) {
    if constexpr (Format == WeightFormat::snorm8)
        return sum_of_integers<std::int8_t, 127>(from, layout.components, rows);
    if constexpr (Format == WeightFormat::snorm16)
        return sum_of_integers<std::int16_t, 32767>(from, layout.components, rows);
    Color sum = {};
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
        sum += stored * color_at(rows + j);
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
                                                  const Lanes (&known)[3], glm::vec3* radiance) {
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
                sums[c] += w * row[j][c];
        }
    }
    for (int c = 0; c < 3; ++c)
        sums[c] = sums[c] * (1.0f / 127) + known[c];
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

/// The mean of a cluster, and what the guides of a receiver add to it.
[[gnu::always_inline]] inline Color known_color(const glm::vec4* row, const float* guides,
                                                std::size_t count) {
    Color sum = color_at(row);
    for (std::size_t g = 0; g < count; ++g)
        sum += guides[g] * color_at(row + 1 + g);
    return sum;
}

/// The same for kLaneCount receivers of one cluster.
[[gnu::always_inline]] inline void known_lanes(const glm::vec4* row, const float* guides, std::size_t count,
                                               Lanes (&known)[3]) {
    for (int c = 0; c < 3; ++c)
        known[c] = Lanes{} + row[0][c];
    for (std::size_t g = 0; g < count; ++g) {
        Lanes x;
        for (std::size_t lane = 0; lane < kLaneCount; ++lane)
            x[lane] = guides[lane * count + g];
        for (int c = 0; c < 3; ++c)
            known[c] += x * row[1 + g][c];
    }
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
    const std::size_t guides = receivers.guides.size() / receivers.size();
    for (std::size_t p = begin; p < end; ++p) {
        const ClusterLayout& layout = layouts[clusters[p]];
        const glm::vec4* row = constants + layout.first_row;
        if constexpr (Format == WeightFormat::snorm8)
            if (p + kLaneCount <= end && all_alike(clusters + p)) {
                Lanes known[3];
                known_lanes(row, receivers.guides.data() + p * guides, guides, known);
                evaluate_lanes(weights + p * stride, stride, layout.components, row + 1 + guides, known,
                               radiance + (p - begin));
                p += kLaneCount - 1;
                continue;
            }
        const Color sum = known_color(row, receivers.guides.data() + p * guides, guides) +
                          sum_of_weights<Format>(receivers, layout, weights + p * stride, row + 1 + guides);
        radiance[p - begin] = {sum[0], sum[1], sum[2]};
    }
}

PRT_TARGET_CLONES
void evaluate_in_lanes(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
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

/// Every output of receivers [begin, end), whose weights are packed.
PRT_TARGET_CLONES
void evaluate_outputs(const ClusteredReceivers& receivers, const ClusterLayout* layouts, std::size_t outputs,
                      const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance) {
    const std::size_t stride = receivers.stride();
    for (std::size_t p = begin; p < end; ++p) {
        const ClusterLayout& layout = layouts[receivers.clusters[p]];
        const std::byte* const words = receivers.weights.data() + p * stride;
        const glm::vec4* row = constants + layout.first_row * outputs;
        Color sums[kMostOutputs];
        for (std::size_t o = 0; o < outputs; ++o)
            sums[o] = color_at(row + o);
        auto position = static_cast<std::size_t>(receivers.cluster_bits);
        for (std::size_t j = 0; j < layout.components; ++j) {
            const int width = width_of(layout, j);
            const auto weight = static_cast<float>(bits_at(words, position, width));
            position += static_cast<std::size_t>(width);
            row += outputs;
            for (std::size_t o = 0; o < outputs; ++o)
                sums[o] += weight * color_at(row + o);
        }
        for (std::size_t o = 0; o < outputs; ++o)
            radiance[(p - begin) * outputs + o] = {sums[o][0], sums[o][1], sums[o][2]};
    }
}

} // namespace

void evaluate_range(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
                    const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance) {
    evaluate_in_lanes(receivers, layouts, constants, begin, end, radiance);
}

void evaluate(const ClusteredTransfer& transfer, std::span<const glm::vec4> constants,
              std::span<glm::vec3> radiance, int threads) {
    const std::vector<ClusterLayout> layouts = cluster_layouts(transfer.bases);
    const ClusteredReceivers& receivers = transfer.receivers;
    const std::size_t outputs = transfer.bases.layout.outputs;
    assert(radiance.size() >= receivers.size() * outputs);
    if (outputs > 1) {
        assert(receivers.format == WeightFormat::packed);
        parallel_for(receivers.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
            evaluate_outputs(receivers, layouts.data(), outputs, constants.data(), begin, end,
                             radiance.data() + begin * outputs);
        });
        return;
    }
    parallel_for(receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        evaluate_range(receivers, layouts.data(), constants.data(), begin, end, radiance.data() + begin);
    });
}

} // namespace prt
