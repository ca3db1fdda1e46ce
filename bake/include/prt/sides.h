#pragma once

// Finds double-sided surfaces whose back sides need separate vertices, because light reaches them.
// Experimental.

#include "prt/bake_options.h"

#include <stop_token>
#include <vector>

namespace prt {

/// Returns for each triangle whether its back side needs separate vertices, because light of the sky or of a
/// lamp reaches the back: [triangles of the scene], in the order of Scene::primitives. Empty if no triangle
/// needs them. Only triangles of double-sided materials are marked, except blended surfaces, glass, thin
/// sheets that transmit light, and solids with a medium inside. Sky light from below the horizon counts only
/// after a reflection, because cameras rarely look from there. `options` are those of the bake that follows.
/// Pass the result to `with_separate_sides` (prt/separate_sides.h), which creates the vertices. Uses random
/// paths with the seed of `options`; the result does not depend on the number of threads. Throws `Error` for
/// invalid options and unreadable textures, and `Cancelled` after a stop request.
std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop = {});

} // namespace prt
