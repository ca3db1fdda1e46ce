#pragma once

// Repeats a bake with another seed: the difference is the noise of rays. Experimental.

#include "prt/baked_transfer.h"
#include "prt/lightmap.h"
#include "prt/scene.h"
#include "prt/support/progress.h"

namespace prt {

/// Bakes `scene` again with the options of `record`, with other rays and without lamps. Throws `Error` if the
/// result differs from `baked` by more than noise: then an option that the record does not contain was
/// different.
Transfer repeated_bake(const Scene& scene, const Transfer& baked, const BakeRecord& record, int threads,
                       const Progress& progress = {});

/// Bakes a lightmap without a finer model again with other rays. Returns the transfer of its receivers in
/// their order. Throws `Error` if the result differs by more than noise.
Transfer repeated_lightmap(const Scene& scene, const BakedLightmap& lightmap, int threads,
                           const Progress& progress = {});

} // namespace prt
