#pragma once

// Transfer of texels.

#include "bake/plan/plan.h"
#include "bake/products/lightmaps/media_light.h"
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
    const BakePlan* plan = nullptr; ///< plan of the scene with the texels; null: direct light at fronts alone
    std::span<const float> sample_areas = {}; ///< [triangles] area_of_sample; needed for sheets
    TexelTransport* transport = nullptr;      ///< set if `plan` is
    const MediaLight* media = nullptr;        ///< null: no media
    bool notes_noise = false;
};

/// Differences between two pairs of samples of a texel, divided by their number, which have the magnitude of
/// the noise of the mean. Zero for texels with fewer than four samples.
struct TexelNoise {
    double rays = 0;                      ///< followed rays of a texel
    std::size_t columns = 0;              ///< order²
    RepresentativeColumns representative; ///< columns of a sky with one channel
    std::vector<float> sky;   ///< [texels][telling], direct and bounced, of the channel in the middle
    std::vector<float> lamps; ///< [texels][lamp_stride()], bounces
};

/// Exit light of the texels of an atlas, zero where nothing was measured.
struct TexelLight {
    std::vector<float> direct; ///< [texels][direct_channels()][order²], zero on media
    std::vector<float> sky;    ///< [texels][sky_stride()], bounced, and all light that leaves media
    std::vector<float> lamps;  ///< [texels][lamp_stride()], without a bounce, and all that leaves media
    std::vector<float> bounced_lamps; ///< [texels][lamp_stride()]
    std::vector<float> visible;       ///< [texels] first coefficient of direct light at the front
    TexelNoise noise;                 ///< set if requested
    std::vector<bool> lit;            ///< [texels]: measured, and not sealed in unless that is kept
    std::vector<bool> traced;         ///< [texels]: lit, without a medium
    std::size_t measured = 0, rays = 0;
};

/// Computes the mean over the samples of each texel, which share its rays: each traces a part of one net.
/// Samples whose front is sealed in are ignored. Samples on sheets also trace rays from their back, and
/// combine both sides as vertices do; samples on media have the light of `task.media`.
TexelLight trace_texels(const TexelTask& task, const Atlas& atlas, std::span<const TexelSample> samples,
                        const Progress& progress);

} // namespace prt
