#pragma once

// Repeats a bake with another seed. The difference between the two results is the noise of their rays.
// Experimental.

#include "prt/core/baked_transfer.h"
#include "prt/core/lightmap.h"
#include "prt/core/progress.h"
#include "prt/load/scene.h"

namespace prt {

/// Bakes `scene` again with the options in `record` and another seed, on the CPU unless the method is
/// BakeMethod::raster. Returns the terms of distant light: [vertices], without terms of lamps. `baked` and
/// `record` are the results of the first bake. `threads`: number of threads; 0: all. Throws `Error` if
/// `baked` has no term of distant light, or if the relative L2 difference between its first term and that of
/// the result exceeds 6 times BakeRecord::sampling_error plus 0.05: the scene, or an option that the record
/// does not contain, was then different. Other terms or another number of receivers count as a difference of
/// 1. Also throws the errors of `bake`, and `Cancelled` after a stop request.
Transfer repeated_bake(const Scene& scene, const Transfer& baked, const BakeRecord& record, int threads,
                       const Progress& progress = {});

/// Bakes the texels of `lightmap` again with the options in its record and another seed, and returns the
/// terms of distant light: [receivers of `lightmap`], without terms of lamps. `scene` must have the
/// primitives of LightmapLayout::placements. Texels take their light from `scene` itself, not from a
/// high-poly model. `threads`: number of threads; 0: all. Throws `Error` if the lightmap has no term of
/// distant light, or if the result differs too much from it, by the same rule as for `repeated_bake`. Also
/// throws the errors of `bake_lightmap`, and `Cancelled` after a stop request.
Transfer repeated_lightmap(const Scene& scene, const BakedLightmap& lightmap, int threads,
                           const Progress& progress = {});

} // namespace prt
