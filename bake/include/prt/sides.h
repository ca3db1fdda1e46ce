#pragma once

// Double-sided surfaces that are lit on both sides. Experimental.

#include "prt/bake.h"

#include <stop_token>
#include <vector>

namespace prt {

/// The triangles of double-sided materials whose backs need vertices of their own, since light reaches them.
/// Light that comes from below the horizon and meets nothing does not count: nobody looks from there. Blended
/// surfaces, glass, sheets that light passes and bodies with a medium inside are left out. `options` are
/// those of the bake that follows; `with_separate_sides` (prt/separate_sides.h) makes the file. [triangles of
/// the scene], or empty where there are none. Deterministic. Throws `Error`, and `Cancelled` when asked to
/// stop.
std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop = {});

} // namespace prt
