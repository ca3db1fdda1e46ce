#pragma once

// Repeats a bake with another seed. The difference of both is the noise of rays. Experimental.

#include "prt/baked_transfer.h"
#include "prt/lightmap.h"
#include "prt/scene.h"
#include "prt/support/progress.h"

namespace prt {

/// Bakes `scene` again with the options of `record`, but with other rays and without lamps. Throws `Error` if
/// the result differs from `baked` by more than noise, because an option that the record does not contain was
/// then different.
Transfer repeated_bake(const Scene& scene, const Transfer& baked, const BakeRecord& record, int threads,
                       const Progress& progress = {});

/// Bakes `lightmap` again with other rays, without a finer model. Returns the transfer of its receivers in
/// their order. Throws `Error` if the result differs by more than noise.
Transfer repeated_lightmap(const Scene& scene, const BakedLightmap& lightmap, int threads,
                           const Progress& progress = {});

} // namespace prt
