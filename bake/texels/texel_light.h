#pragma once

// Transfer of texels.

#include "prt/tracer.h"
#include "texels/texel_places.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

struct TexelLight {
    std::vector<float> vectors; ///< [texels][order²], zero where nothing was measured
    std::vector<bool> lit;      ///< [texels]: measured, and not sealed in
    std::size_t measured = 0, rays = 0;
};

/// `scene` is what is traced. The mean over the samples of each texel, which share its rays: each takes a
/// part of one net. Samples that are sealed in tell nothing.
TexelLight trace_texels(Tracer& tracer, const TraceScene& scene, const TexelPlaces& places,
                        const Atlas& atlas, std::span<const TexelSample> samples, const TraceOptions& options,
                        const Progress& progress);

} // namespace prt
