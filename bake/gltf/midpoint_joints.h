#pragma once

// Joints of edge midpoints.

#include "bake/gltf/contents.h"
#include "prt/gltf/refinement.h"

#include <span>

namespace prt {

/// Replaces JOINTS_n and WEIGHTS_n of a primitive's `attributes` by accessors that also contain `midpoints`.
/// A midpoint gets the joints of both ends with the largest weights, limited to the number per vertex; their
/// weights sum to one.
void add_midpoint_joints(GltfContents& contents, Json& attributes, std::span<const Midpoint> midpoints);

} // namespace prt
