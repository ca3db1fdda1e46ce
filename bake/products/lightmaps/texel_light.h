#pragma once

// Transfer of texels.

#include "bake/products/lightmaps/texel_positions.h"
#include "bake/products/lightmaps/texel_transport.h"
#include "bake/surface_fit/fit_noise.h"
#include "bake/trace/tracer.h"
#include "prt/bake/bake.h"

#include <span>
#include <vector>

namespace prt {

struct TexelTask {
    Tracer& tracer;
    const TraceScene& scene; ///< scene that is traced
    const TexelPositions& positions;
    TraceOptions options;
    Inside inside = Inside::refill;
    TexelTransport* transport = nullptr; ///< null: direct light alone
    bool notes_noise = false;
};

/// Differences between two pairs of samples of a texel, divided by their number, which have the magnitude of
/// the noise of the mean. Zero for texels with fewer than four samples.
struct TexelNoise {
    double rays = 0;                      ///< followed rays of a texel
    RepresentativeColumns representative; ///< columns of a sky with one channel
    std::vector<float> sky;   ///< [texels][telling], direct and bounced, of the channel in the middle
    std::vector<float> lamps; ///< [texels][lamp_stride()], bounces
};

/// Light of the texels of an atlas, zero where nothing was measured.
struct TexelLight {
    std::vector<float> direct;        ///< [texels][order²]
    std::vector<float> sky;           ///< [texels][sky_stride()], bounced
    std::vector<float> lamps;         ///< [texels][lamp_stride()], without a bounce
    std::vector<float> bounced_lamps; ///< [texels][lamp_stride()]
    TexelNoise noise;                 ///< set if requested
    std::vector<bool> lit;            ///< [texels]: measured, and not sealed in unless that is kept
    std::size_t measured = 0, rays = 0;
};

/// Computes the mean over the samples of each texel, which share its rays: each traces a part of one net.
/// Samples that are sealed in are ignored.
TexelLight trace_texels(const TexelTask& task, const Atlas& atlas, std::span<const TexelSample> samples,
                        const Progress& progress);

} // namespace prt
