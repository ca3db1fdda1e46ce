#pragma once

// Double-sided surfaces that are lit on both sides. Experimental.

#include "prt/bake.h"

#include <stop_token>
#include <vector>

namespace prt {

/// Marks the triangles of double-sided materials whose backs need separate vertices, because light reaches
/// them: [triangles of the scene], or empty if no triangle does. Light that arrives from below the horizon
/// without hitting a surface does not count, because cameras rarely look from there. Blended surfaces, glass,
/// thin sheets that transmit light, and solids with a medium inside are excluded. `options` are those of the
/// bake that follows; `with_separate_sides` (prt/separate_sides.h) creates the file. Deterministic. Throws
/// `Error` for invalid options, and `Cancelled` after a stop request.
std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop = {});

} // namespace prt
