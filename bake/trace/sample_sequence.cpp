// Generates Sobol points in an order that keeps packets of rays narrow.

#include "bake/trace/sample_sequence.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

namespace prt {
namespace {

/// Second Sobol dimension with reversed bits: the generator matrix is Pascal's triangle modulo 2, so column k
/// is the XOR-shift of column k - 1.
std::uint32_t sobol_y_reversed(std::uint32_t index) {
    std::uint32_t column = 1, result = 0;
    for (; index != 0; index >>= 1) {
        if (index & 1)
            result ^= column;
        column ^= column << 1;
    }
    return result;
}

/// Returns the first `bits` bits of the unreversed value.
std::uint32_t leading_bits(std::uint32_t reversed, int bits) {
    std::uint32_t leading = 0;
    for (int b = 0; b < bits; ++b)
        leading = leading << 1 | (reversed >> b & 1);
    return leading;
}

} // namespace

SobolChunk::SobolChunk(int count, int stride) : rays(count), followed((count + stride - 1) / stride) {
    const auto points = static_cast<std::uint32_t>(count);
    const int cells_log2 = std::max(0, static_cast<int>(std::bit_width(points / kPacket)) - 1);
    const int x_bits = (cells_log2 + 1) / 2, y_bits = cells_log2 / 2;
    std::vector<std::uint32_t> order(points);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto cell = [&](std::uint32_t i) {
            return leading_bits(i, x_bits) << y_bits | leading_bits(sobol_y_reversed(i), y_bits);
        };
        return cell(a) < cell(b);
    });
    std::vector<std::uint32_t> first, rest; // both are sorted by cell
    for (std::size_t i = 0; i < order.size(); ++i)
        (i % static_cast<std::size_t>(stride) == 0 ? first : rest).push_back(order[i]);
    order = std::move(first);
    order.insert(order.end(), rest.begin(), rest.end());
    order.resize((points + kPacket - 1) / kPacket * kPacket, order.back());
    for (const std::uint32_t i : order) {
        x.push_back(i); // the first dimension is the radical inverse: reversed, the index itself
        y.push_back(sobol_y_reversed(i));
    }
}

SobolOffset sobol_offset(std::uint32_t first) {
    return {first, sobol_y_reversed(first)};
}

} // namespace prt
