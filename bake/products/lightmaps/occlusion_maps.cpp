// Measures the texels of atlases, fills the texels between charts, and closes seams.

#include "prt/bake/ambient_occlusion.h"

#include "bake/plan/available_memory.h"
#include "bake/products/lightmaps/gutters.h"
#include "bake/products/lightmaps/seams.h"
#include "bake/products/lightmaps/texel_light.h"
#include "bake/products/occlusion/occlusion_scene.h"
#include "prt/core/error.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace prt {
namespace {

constexpr std::size_t kStride = 4; ///< number of coefficients of order 2

/// Jumps of the first coefficient across seams, root mean square.
double rms_jump(const Atlas& atlas, std::span<const SeamPoint> seams, std::span<const float> vectors) {
    double sum = 0;
    for (const SeamPoint& point : seams) {
        const double jump = jump_at(atlas, point, vectors, kStride);
        sum += jump * jump;
    }
    return seams.empty() ? 0 : std::sqrt(sum / static_cast<double>(seams.size())) / kY00;
}

/// Throws `Error` for a texture that does not fit into memory, before the work starts. Measured: 70 bytes per
/// texel.
void check_room(const std::vector<Atlas>& atlases, double limit) {
    constexpr double kBytesOfTexel = 80;
    const double there = available_memory(limit);
    for (const Atlas& atlas : atlases)
        if (const double needed = kBytesOfTexel * static_cast<double>(atlas.texels());
            there > 0 && needed > there)
            throw Error(fmt::format("a texture of {} x {} texels needs about {:.2g} GB of memory, but only "
                                    "{:.2g} GB are available",
                                    atlas.width, atlas.height, needed * 1e-9, there * 1e-9));
}

OcclusionMap map_of(const Atlas& atlas, TexelLight light, const Scene& scene) {
    OcclusionMap map{.atlas = atlas, .ambient_visibility = {}, .measured = light.measured};
    const auto lit = static_cast<std::size_t>(std::ranges::count(light.lit, true));
    map.sealed = light.measured - lit;
    fill_gutters(atlas, light.lit, light.direct, kStride);
    const std::vector<SeamPoint> seams = seam_points(scene, atlas);
    map.seam_before = rms_jump(atlas, seams, light.direct);
    stitch_seams(atlas, seams, light.lit, light.direct, kStride);
    map.seam = rms_jump(atlas, seams, light.direct);
    Transfer transfer = zero_transfer(2, 1, 0);
    transfer.vectors = std::move(light.direct);
    map.ambient_visibility = ambient_visibility_of(transfer);
    return map;
}

} // namespace

OcclusionMapsStatistics occlusion_maps(const Scene& scene, const std::vector<Atlas>& atlases,
                                       const OcclusionOptions& options,
                                       const std::function<void(OcclusionMap)>& take, const FinerModel& finer,
                                       const Progress& progress) {
    check_finer(finer);
    check_room(atlases, options.memory.limit);
    const Stopwatch watch;
    const OcclusionScene traced(finer.scene ? *finer.scene : scene, options);
    std::optional<DetailedSurface> detail;
    if (finer.scene)
        detail.emplace(traced.scene(), finer.reach, scene.origin);
    const TexelPositions positions(scene, detail ? &*detail : nullptr);
    OcclusionMapsStatistics result;
    result.notices = traced.notices();
    for (std::size_t i = 0; i < atlases.size(); ++i) {
        const Progress part =
            progress.range(static_cast<double>(i) / static_cast<double>(atlases.size()),
                           static_cast<double>(i + 1) / static_cast<double>(atlases.size()));
        const TexelSamples samples = sample_texels(chart_triangles(scene, atlases[i]), atlases[i]);
        const TexelTask task{.tracer = traced.tracer(),
                             .scene = traced.scene(),
                             .positions = positions,
                             .options = {.order = 2, .rays = options.rays, .seed = options.seed + i},
                             .inside = options.repairs.inside};
        TexelLight light = trace_texels(task, atlases[i], samples.samples, part);
        result.rays += light.rays;
        take(map_of(atlases[i], std::move(light), scene));
    }
    if (std::optional<std::string> notice = detail ? detail->check() : std::nullopt)
        result.notices.push_back(std::move(*notice));
    result.device = traced.tracer().device();
    result.seconds = watch.seconds();
    progress.update(1);
    return result;
}

} // namespace prt
