#include "prt/clustered_transfer.h"

#include "prt/error.h"
#include "prt/parallel.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <string>

namespace prt {
namespace {

float decoded(float stored) {
    return stored;
}
float decoded(std::int16_t stored) {
    return std::max(static_cast<float>(stored) / 32767.0f, -1.0f);
}
float decoded(std::int8_t stored) {
    return std::max(static_cast<float>(stored) / 127.0f, -1.0f);
}

/// Calls `body` with a value of the type in which weights are stored.
template <class Body>
decltype(auto) with_weight_type(WeightFormat format, Body&& body) {
    switch (format) {
    case WeightFormat::snorm16:
        return body(std::int16_t{});
    case WeightFormat::snorm8:
        return body(std::int8_t{});
    case WeightFormat::float32:
        break;
    }
    return body(float{});
}

template <class Stored>
Stored load(const std::byte* from) {
    Stored value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

} // namespace

int ClusteredBases::max_components() const {
    return components.empty() ? 0 : *std::max_element(components.begin(), components.end());
}

std::vector<std::size_t> ClusteredBases::first_rows() const {
    std::vector<std::size_t> first(clusters() + 1, 0);
    for (std::size_t k = 0; k < clusters(); ++k)
        first[k + 1] = first[k] + 1 + static_cast<std::size_t>(components[k]);
    return first;
}

std::size_t bytes_per_weight(WeightFormat format) {
    return with_weight_type(format, [](auto stored) { return sizeof stored; });
}

float ClusteredReceivers::weight(std::size_t receiver, int component) const {
    return with_weight_type(format, [&](auto type) {
        using Stored = decltype(type);
        const std::size_t index =
            receiver * static_cast<std::size_t>(components) + static_cast<std::size_t>(component);
        return decoded(load<Stored>(&weights[index * sizeof(Stored)]));
    });
}

std::size_t bytes_per_receiver(const ClusteredTransfer& transfer) {
    const std::size_t cluster = transfer.bases.clusters() > 256 ? 2 : 1;
    return cluster + static_cast<std::size_t>(transfer.bases.max_components()) *
                         bytes_per_weight(transfer.receivers.format);
}

std::size_t basis_bytes(const ClusteredBases& bases) {
    return (bases.rows.size() + bases.scales.size()) * sizeof(float);
}

int constants_per_cluster(const ClusteredBases& bases) {
    return 1 + bases.max_components();
}

void form_constants(const ClusteredBases& bases, const Light& light, std::span<glm::vec4> constants) {
    if (light.order > bases.order)
        return form_constants(bases, truncated(light, bases.order), constants);
    if (light.order < bases.order)
        throw Error("the lighting has order " + std::to_string(light.order) + ", the transfer order " +
                    std::to_string(bases.order));
    const auto stride = static_cast<std::size_t>(constants_per_cluster(bases));
    assert(constants.size() >= bases.clusters() * stride);
    const float* row = bases.rows.data();
    const float* scale = bases.scales.data();
    for (std::size_t k = 0; k < bases.clusters(); ++k) {
        const auto used = static_cast<std::size_t>(bases.components[k]);
        for (std::size_t j = 0; j < stride; ++j) {
            glm::vec3 value(0);
            if (j <= used) {
                value = exit_radiance({row, bases.dimension()}, bases.channels, light);
                row += bases.dimension();
                if (j > 0)
                    value *= *scale++;
            }
            constants[k * stride + j] = glm::vec4(value, 0);
        }
    }
}

void evaluate(const ClusteredReceivers& receivers, int constants_per_cluster,
              std::span<const glm::vec4> constants, std::span<glm::vec3> radiance, int threads) {
    const auto stride = static_cast<std::size_t>(constants_per_cluster);
    const auto stored = static_cast<std::size_t>(receivers.components);
    assert(stored + 1 >= stride && radiance.size() >= receivers.size());
    with_weight_type(receivers.format, [&](auto type) {
        using Stored = decltype(type);
        parallel_for(receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                const glm::vec4* row = &constants[receivers.clusters[p] * stride];
                const std::byte* weights = receivers.weights.data() + p * stored * sizeof(Stored);
                glm::vec4 sum = row[0];
                for (std::size_t j = 1; j < stride; ++j)
                    sum += decoded(load<Stored>(weights + (j - 1) * sizeof(Stored))) * row[j];
                radiance[p] = glm::vec3(sum);
            }
        });
    });
}

std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads) {
    const int rows = constants_per_cluster(transfer.bases);
    std::vector<glm::vec4> constants(transfer.bases.clusters() * static_cast<std::size_t>(rows));
    form_constants(transfer.bases, light, constants);
    std::vector<glm::vec3> radiance(transfer.receivers.size());
    evaluate(transfer.receivers, rows, constants, radiance, threads);
    return radiance;
}

Transfer decode(const ClusteredTransfer& transfer) {
    const ClusteredBases& bases = transfer.bases;
    const std::size_t dimension = bases.dimension();
    const std::vector<std::size_t> first = bases.first_rows();
    Transfer result{bases.order, bases.channels, std::vector<float>(transfer.receivers.size() * dimension)};
    parallel_for(transfer.receivers.size(), 4096, 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const std::size_t k = transfer.receivers.clusters[p];
            const float* mean = &bases.rows[first[k] * dimension];
            const std::span<float> out = result.vector(p);
            std::copy_n(mean, dimension, out.begin());
            for (int j = 0; j < bases.components[k]; ++j) {
                const auto ji = static_cast<std::size_t>(j);
                const float weight = bases.scales[first[k] - k + ji] * transfer.receivers.weight(p, j);
                const float* direction = mean + (1 + ji) * dimension;
                for (std::size_t i = 0; i < dimension; ++i)
                    out[i] += weight * direction[i];
            }
        }
    });
    return result;
}

} // namespace prt
