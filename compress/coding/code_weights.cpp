// Stores weights as consecutive bit fields, point by point.

#include "compress/coding/code_weights.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace prt {
namespace {

constexpr std::size_t kFloatBits = 32;

std::size_t bits_of(const WeightGrid& grid) {
    return grid.is_any() ? kFloatBits : static_cast<std::size_t>(grid.bits());
}

std::uint32_t stored(float weight, const WeightGrid& grid) {
    return grid.is_any() ? std::bit_cast<std::uint32_t>(weight)
                         : static_cast<std::uint32_t>(grid.index_of(weight));
}

} // namespace

CodeWeights::CodeWeights(std::size_t points, const QuantisedClusters& clusters) {
    std::size_t most = 0;
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        std::size_t bits = 0;
        for (std::size_t j = 0; j < clusters.components_of(k); ++j)
            bits += bits_of(clusters.grid(k, j));
        most = std::max(most, bits);
    }
    stride_ = (most + 7) / 8;
    bytes_.resize(points * stride_);
}

/// Buffers bits in 64: at most 7 remain, and at most 32 are needed at once.
void CodeWeights::read(const QuantisedClusters& clusters, std::size_t k, std::size_t point,
                       float* weights) const {
    const std::byte* from = bytes_.data() + point * stride_;
    std::uint64_t waiting = 0;
    std::size_t count = 0;
    for (std::size_t j = 0; j < clusters.components_of(k); ++j) {
        const WeightGrid& grid = clusters.grid(k, j);
        const std::size_t bits = bits_of(grid);
        for (; count < bits; count += 8)
            waiting |= std::to_integer<std::uint64_t>(*from++) << count;
        const auto value = static_cast<std::uint32_t>(waiting & ((std::uint64_t{1} << bits) - 1));
        weights[j] = grid.is_any() ? std::bit_cast<float>(value) : grid.at(value);
        waiting >>= bits;
        count -= bits;
    }
}

void CodeWeights::write(const QuantisedClusters& clusters, std::size_t k, std::size_t point,
                        const float* weights) {
    std::byte* to = bytes_.data() + point * stride_;
    std::uint64_t waiting = 0;
    std::size_t count = 0;
    for (std::size_t j = 0; j < clusters.components_of(k); ++j) {
        const WeightGrid& grid = clusters.grid(k, j);
        waiting |= std::uint64_t{stored(weights[j], grid)} << count;
        for (count += bits_of(grid); count >= 8; count -= 8, waiting >>= 8)
            *to++ = static_cast<std::byte>(waiting & 0xFF);
    }
    if (count > 0)
        *to = static_cast<std::byte>(waiting & 0xFF);
}

void CodeWeights::copy(const CodeWeights& other, std::size_t point) {
    if (stride_ > 0)
        std::memcpy(&bytes_[point * stride_], &other.bytes_[point * stride_], stride_);
}

} // namespace prt
