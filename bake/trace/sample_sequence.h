#pragma once

// Samples of a receiver: cosine-distributed directions from Owen-scrambled Sobol points.

#include "runtime/core/support/vector_lanes.h"
#include "shared_bake.h"
#include "shared_samples.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Number of rays of a chunk; each chunk is an aligned range of the Sobol sequence.
inline constexpr int kChunk = PRT_CHUNK;
/// Number of rays that are traced together.
inline constexpr int kPacket = kLaneCount;

/// First two dimensions of the Sobol sequence, bits reversed, for one chunk of `rays` points. The points are
/// ordered by the cells of a grid with about kPacket points each: a net has equally many points in each cell,
/// and nested scrambling maps cells to cells, so that packets of consecutive points stay narrow beams for
/// every scramble.
struct SobolChunk {
    std::vector<std::uint32_t> x, y; ///< padded to a multiple of kPacket by repeating the last
    int rays = 0;
    int followed = 0; ///< number of leading points that are an even sample of all: every `stride`-th

    explicit SobolChunk(int rays, int stride = 1);
};

/// Offset of a range of Sobol points. The points are linear over GF(2): point (first + j) is point j XOR
/// this, if `first` is a multiple of a power of two above j.
struct SobolOffset {
    std::uint32_t x, y;
};
SobolOffset sobol_offset(std::uint32_t first);

using glsl::laine_karras, glsl::pcg_hash;

[[gnu::always_inline]] inline std::uint32_t reverse_bits(std::uint32_t v) {
    v = (v >> 16) | (v << 16);
    v = ((v & 0x00ff00ffu) << 8) | ((v >> 8) & 0x00ff00ffu);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v >> 4) & 0x0f0f0f0fu);
    v = ((v & 0x33333333u) << 2) | ((v >> 2) & 0x33333333u);
    return ((v & 0x55555555u) << 1) | ((v >> 1) & 0x55555555u);
}

/// Seed of a receiver's samples: the hash of its index XOR the scramble that all receivers share.
constexpr std::uint32_t seed_scramble(std::uint64_t seed) {
    const auto low = static_cast<std::uint32_t>(seed), high = static_cast<std::uint32_t>(seed >> 32);
    return pcg_hash(low ^ pcg_hash(high));
}
constexpr std::uint32_t receiver_seed(std::uint32_t receiver, std::uint64_t seed) {
    return pcg_hash(receiver ^ seed_scramble(seed));
}

} // namespace prt
