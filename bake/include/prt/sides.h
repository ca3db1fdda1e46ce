#pragma once

// Double-sided surfaces that are lit on both sides. Experimental.

#include "prt/bake.h"

#include <stop_token>
#include <vector>

namespace prt {

/// Returns the triangles of double-sided materials whose backs need their own vertices, because light reaches
/// them: [triangles of the scene], or empty if there are none. Light from below the horizon that hits nothing
/// does not count, because nobody looks from there. Blended surfaces, glass, thin sheets that transmit light
/// and bodies with a medium inside are excluded. `options` are those of the bake that follows;
/// `with_separate_sides` (prt/separate_sides.h) creates the file. Deterministic. Throws `Error`, and
/// `Cancelled` when asked to stop.
std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop = {});

} // namespace prt
