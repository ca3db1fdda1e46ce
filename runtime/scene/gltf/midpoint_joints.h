#pragma once

#include "gltf/contents.h"
#include "prt/refinement.h"

#include <span>

namespace prt {

/// Replaces JOINTS_n and WEIGHTS_n of `attributes`, which are those of a primitive, by accessors with those
/// of `midpoints` behind them: of the joints of both ends the heaviest, as many as a vertex has, whose
/// weights sum to one.
void add_midpoint_joints(GltfContents& contents, Json& attributes, std::span<const Midpoint> midpoints);

} // namespace prt
