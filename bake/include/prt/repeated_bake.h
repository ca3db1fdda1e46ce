#pragma once

// A bake done again with another seed: what differs is the noise of rays. Experimental.

#include "prt/baked_transfer.h"
#include "prt/lightmap.h"
#include "prt/scene.h"
#include "prt/support/progress.h"

namespace prt {

/// The transfer of `scene` by rays of their own, without lamps, as `baked` was made by its `record`. Throws
/// `Error` where it comes out otherwise than noise explains: what the record does not tell was another.
Transfer repeated_bake(const Scene& scene, const Transfer& baked, const BakeRecord& record, int threads,
                       const Progress& progress = {});

/// The same of a lightmap without a finer model: of its receivers, in their order.
Transfer repeated_lightmap(const Scene& scene, const BakedLightmap& lightmap, int threads,
                           const Progress& progress = {});

} // namespace prt
