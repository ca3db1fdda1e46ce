#pragma once

// Finds receivers that no light can reach, because they are inside solid geometry.

#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"
#include "prt/core/progress.h"
#include "prt/core/transfer.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Maximum number of rays per receiver.
inline constexpr int kMaxProbes = 1024;

/// Maximum first coefficient of a receiver without light: 0, or a hundredth of an open receiver for depth
/// maps, which do not resolve less.
double max_dark(const Tracer& tracer);

/// Number of rays that hit back faces of single-sided surfaces.
double backs_of(const Surfaces& surfaces, std::span<const Hit> hits);

/// Whether all `rays` rays hit a surface, and almost all of them back faces of single-sided surfaces.
/// `maybe`: with a tolerance for few rays.
bool looks_sealed(const Surfaces& surfaces, std::span<const Hit> hits, int rays, bool maybe);

struct Sealed {
    std::vector<bool> receivers; ///< [receivers]
    std::size_t rays = 0;        ///< rays that found them
};

/// Finds the `dark` receivers that are sealed in: none of `probes` rays escapes, and 98 of 100 hit the back
/// of a single-sided surface, which scatters nothing. Groups of neighbours share these rays. Receivers that
/// see fronts, for example in a dark room, are truly dark. The rays are traced by `tracer.rays()`.
Sealed find_sealed(Tracer& tracer, const TraceScene& scene, const Receivers& receivers,
                   std::vector<std::uint32_t> dark, std::uint64_t seed, const std::stop_token& stop,
                   int probes = kMaxProbes);

} // namespace prt
