#pragma once

// Finds double-sided surfaces whose back sides need separate vertices, because light reaches them.
// Experimental.

#include "prt/bake/bake_options.h"

#include <stop_token>
#include <vector>

namespace prt {

/// Returns for each triangle whether its back side needs separate vertices, because light of the sky or of a
/// lamp reaches the back: [triangles of the scene], in the order of Scene::primitives. Empty if no triangle
/// needs them. If light reaches the backs of more than half of a connected surface, all its triangles are
/// marked. Only triangles of double-sided materials are marked, except blended surfaces and solids with a
/// medium inside. Light of the sky below the horizon does not count, because cameras rarely look from there.
/// Light is followed over up to eight surfaces, and each counts as scattering half of it, a thin sheet to
/// either side. `options` are those of the bake that follows. Pass the result to
/// `with_separate_sides` (bake/gltf/separate_sides.h), which creates the vertices. Uses random paths
/// with the seed of `options`; the result does not depend on the number of threads. Throws `Error` for media
/// and lamp groups that `bake` does not accept; other options are not checked. Also throws the errors of
/// `load_textures` and RayScene::RayScene, and `Cancelled` after a stop request. Does not throw if no
/// material is double-sided.
std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop = {});

} // namespace prt
