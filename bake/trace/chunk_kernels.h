#pragma once

// The two vectorised loops of the CPU baker, compiled for several vector widths.

#include "bake/trace/sample_sequence.h"
#include "runtime/core/support/tangent_frame.h"

#include <array>
#include <span>

namespace prt {

/// World directions of one chunk of rays.
struct alignas(64) ChunkDirections {
    std::array<float, kChunk> x, y, z;
};

/// Generates directions of `chunk` shifted by `offset` and scrambled by `seed`, cosine-distributed about the
/// normal of `frame`. Scrambling: Owen's, by the hash of Laine and Karras (2011) in the form of Vegdahl
/// (2021); the disk by the concentric map of Shirley and Chiu (1997).
void generate_directions(const SobolChunk& chunk, SobolOffset offset, std::uint32_t seed,
                         const TangentFrame& frame, ChunkDirections& directions);

/// Adds the basis in directions[0..count), multiplied by the weights (null: 1), to `sums` [order²]. `count`
/// is at most kChunk; entries up to the next multiple of kPacket are read and ignored.
void add_basis(int order, const ChunkDirections& directions, int count, const float* weights,
               std::span<double> sums);

} // namespace prt
