#pragma once

// Scales of instances whose mesh contains a medium: transfer has no unit of length, but media have.

#include "prt/bake/instance_bake.h"

#include <span>

namespace prt {

/// Returns the scale to bake a mesh with: 1 without a medium, otherwise the mean of its placements. Throws
/// `Error` if the scales of instances with a medium differ by more than kMaxScaleRatio.
double scale_to_bake(const Scene& scene, std::span<const MeshPlacement> placements,
                     const BakeOptions& options);

} // namespace prt
