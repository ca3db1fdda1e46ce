#pragma once

// Which receivers no light can reach, because they lie inside solid geometry.

#include "prt/support/progress.h"
#include "prt/trace_scene.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

struct Sealed {
    std::vector<bool> receivers; ///< [receivers]
    std::size_t rays = 0;        ///< traced to find out
};

struct SealedOptions {
    /// Receivers of at most this visibility are asked: 0 where rays tell, more where depth maps do.
    double most_visibility = 0;
    std::uint64_t seed = 0;
};

/// A receiver is sealed in where none of 1 024 rays escapes and 98 of 100 end at the back of a single-sided
/// surface, which scatters nothing: where fronts are seen, as in a dark room, darkness is the truth. `direct`
/// is the direct transfer of all receivers, of one channel.
Sealed find_sealed(const TraceScene& scene, const Receivers& receivers, const Transfer& direct,
                   const SealedOptions& options, const std::stop_token& stop);

} // namespace prt
