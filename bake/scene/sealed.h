#pragma once

// Which receivers no light can reach, because they lie inside solid geometry.

#include "prt/support/progress.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

inline constexpr int kMostProbes = 1024;

/// Of rays, how many ended at the back of a single-sided surface, inside a solid.
double backs_of(const Surfaces& surfaces, std::span<const Hit> hits);

/// Whether the hits of so many rays are all of them, and nearly all backs of single-sided surfaces. `maybe`:
/// so far as few rays can tell.
bool looks_sealed(const Surfaces& surfaces, std::span<const Hit> hits, int rays, bool maybe);

struct Sealed {
    std::vector<bool> receivers; ///< [receivers]
    std::size_t rays = 0;        ///< traced to find out
};

/// Which of the `dark` receivers are sealed in: none of `probes` rays escapes and 98 of 100 end at the back
/// of a single-sided surface, which scatters nothing. Groups of neighbours share these rays. Where fronts are
/// seen, as in a dark room, darkness is the truth. Rays go to `tracer`, or where that notes no hits to the
/// CPU.
Sealed find_sealed(Tracer& tracer, const TraceScene& scene, const Receivers& receivers,
                   std::vector<std::uint32_t> dark, std::uint64_t seed, const std::stop_token& stop,
                   int probes = kMostProbes);

} // namespace prt
