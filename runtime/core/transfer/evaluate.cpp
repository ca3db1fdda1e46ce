// Computes exit radiance of every receiver from the constants, in SIMD registers (docs/math.md, eq. 29).
#include "prt/core/clustered_transfer.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/vector_lanes.h"
#include "runtime/core/transfer/evaluate_range.h"

#include <cassert>

namespace prt {
namespace {

template <WeightFormat Format>
[[gnu::always_inline]] inline Color sum_of_weights(const ClusteredReceivers& receivers,
                                                   const ClusterLayout& layout, const std::byte* from,
                                                   const glm::vec4* rows) {
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

/// Returns the mean of a cluster plus the predictor term of a receiver.
[[gnu::always_inline]] inline Color known_color(const glm::vec4* row, const float* predictors,
                                                std::size_t count) {
    Color sum = color_at(row);
    for (std::size_t g = 0; g < count; ++g)
        sum += predictors[g] * color_at(row + 1 + g);
    return sum;
}

template <WeightFormat Format>
[[gnu::always_inline]] inline std::size_t cluster_of(const ClusteredReceivers& receivers,
                                                     const std::byte* weights, std::size_t receiver) {
    if constexpr (Format == WeightFormat::packed)
        return cluster_in(weights, receivers.cluster_bits);
    else
        return receivers.clusters[receiver];
}

template <WeightFormat Format>
[[gnu::always_inline]] inline void evaluate_format(const ClusteredReceivers& receivers,
                                                   const ClusterLayout* layouts, const glm::vec4* constants,
                                                   std::size_t begin, std::size_t end, glm::vec3* radiance) {
    const std::size_t stride = receivers.stride();
    const std::byte* weights = receivers.weights.data();
    const std::size_t predictors = receivers.predictors.size() / receivers.size();
    for (std::size_t p = begin; p < end; ++p) {
        const ClusterLayout& layout = layouts[cluster_of<Format>(receivers, weights + p * stride, p)];
        const glm::vec4* row = constants + layout.first_row;
        const Color sum =
            known_color(row, receivers.predictors.data() + p * predictors, predictors) +
            sum_of_weights<Format>(receivers, layout, weights + p * stride, row + 1 + predictors);
        radiance[p - begin] = {sum[0], sum[1], sum[2]};
    }
}

PRT_TARGET_CLONES
void evaluate_in_lanes(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
                       const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance) {
    switch (receivers.format) {
    case WeightFormat::float32:
        return evaluate_format<WeightFormat::float32>(receivers, layouts, constants, begin, end, radiance);
    case WeightFormat::packed:
        return evaluate_format<WeightFormat::packed>(receivers, layouts, constants, begin, end, radiance);
    }
}

template <std::size_t Outputs>
[[gnu::always_inline]] inline void evaluate_each(const ClusteredReceivers& receivers,
                                                 const ClusterLayout* layouts, const glm::vec4* constants,
                                                 std::size_t begin, std::size_t end, glm::vec3* radiance) {
    for (std::size_t p = begin; p < end; ++p) {
        Color sums[Outputs];
        sum_outputs(receivers, layouts, constants, p, sums);
        for (const Color& sum : sums)
            *radiance++ = {sum[0], sum[1], sum[2]};
    }
}

/// Evaluates every output of receivers [begin, end), whose weights are packed.
PRT_TARGET_CLONES
void evaluate_outputs(const ClusteredReceivers& receivers, const ClusterLayout* layouts, std::size_t outputs,
                      const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance) {
    switch (outputs) {
    case 4:
        return evaluate_each<4>(receivers, layouts, constants, begin, end, radiance);
    case 9:
        return evaluate_each<9>(receivers, layouts, constants, begin, end, radiance);
    default:
        return evaluate_each<16>(receivers, layouts, constants, begin, end, radiance);
    }
}

} // namespace

void check_coordinates(const ClusteredTransfer& transfer) {
    if (transfer.receivers.predictors.size() != transfer.receivers.size() * transfer.bases.predictor_rows())
        throw Error("the transfer has no coordinates for its predictors; call add_coordinates after "
                    "load_model");
}

void check_rows(const ClusteredBases& bases) {
    if (bases.rows.size() != bases.first_rows().back() * bases.dimension())
        throw Error("the transfer has no rows of clusters; free_rows has freed them");
}

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
    check_coordinates(transfer);
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
