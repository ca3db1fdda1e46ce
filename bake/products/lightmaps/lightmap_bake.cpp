// Bakes texels: light bounces between vertices, then every texel gathers it with the rays that computed the
// texel's direct light.

#include "prt/bake/lightmap_bake.h"

#include "bake/pipeline/bounce_sources.h"
#include "bake/pipeline/equal_rays.h"
#include "bake/pipeline/record.h"
#include "bake/pipeline/sampling_error.h"
#include "bake/plan/available_memory.h"
#include "bake/plan/check_options.h"
#include "bake/plan/memory.h"
#include "bake/plan/transfer_terms.h"
#include "bake/products/lightmaps/gutters.h"
#include "bake/products/lightmaps/media_light.h"
#include "bake/products/lightmaps/seams.h"
#include "bake/products/lightmaps/texel_areas.h"
#include "bake/products/lightmaps/texel_filter.h"
#include "bake/products/lightmaps/texel_light.h"
#include "bake/refine/even_refinement.h"
#include "bake/trace/trace_receivers.h"
#include "bake/tracers/make_tracer.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace prt {
namespace {

/// Maximum distance in texels of the vertices that light bounces between; there are then about 64 times fewer
/// vertices than texels. Measured on three.js's collision-world with 256 x 256 texels, 1 024 rays and all
/// bounces, relative L2 of the radiance under three skies without suns, compared with 2 texels: with 4, 8, 16
/// and 32 texels 0.4, 1.1 to 1.3, 1.5 to 1.9 and 1.9 to 2.4 %, from 14 842, 7 452, 5 488 and 4 996 vertices,
/// 41 548 with 2. The demo's room, compared with one texel: 0.1 to 0.4 % with 2, 0.3 to 0.7 % with 4, 0.4 to
/// 0.8 % with 8 and more, because none of its edges is longer.
constexpr double kTexelsBetweenSources = 8;
/// Maximum distance in texels of vertices that receive the light of media.
constexpr double kTexelsBetweenMedia = 2;
/// Approximate maximum number of bytes of the gather rows that exist at a time.
constexpr double kBytesOfRows = 1e9; ///< for the rows of one gather; lamps need additional memory

/// Returns the mean side length of a texel in metres.
double texel_size(const TexelPositions& positions, const std::vector<std::vector<ChartTriangle>>& charts) {
    double surface = 0, texels = 0;
    for (const auto& of_atlas : charts)
        for (const ChartTriangle& t : of_atlas) {
            surface += positions.area(t.triangle);
            texels += area_in_texels(t);
        }
    return texels > 0 ? std::sqrt(surface / texels) : 0;
}

/// Returns the area of a sample on each triangle: [triangles].
std::vector<float> areas_of_samples(const TexelPositions& positions,
                                    const std::vector<std::vector<ChartTriangle>>& charts,
                                    std::size_t triangles) {
    std::vector<float> areas(triangles);
    for (const auto& of_atlas : charts)
        for (const ChartTriangle& t : of_atlas)
            areas[t.triangle] = static_cast<float>(area_of_sample(t, positions));
    return areas;
}

/// Checks the memory of dense values of the largest map and of three times the values of all receivers:
/// separately, in parts, and in the file. Calculated, not measured.
void check_room(const std::vector<Atlas>& atlases, std::size_t numbers, double limit) {
    double largest = 0, all = 0;
    for (const Atlas& atlas : atlases) {
        largest = std::max(largest, static_cast<double>(atlas.texels()));
        all += static_cast<double>(atlas.texels());
    }
    const double value = sizeof(float) * static_cast<double>(numbers),
                 needed = value * (1.1 * largest + 3.2 * all), there = available_memory(limit);
    if (there > 0 && needed > there)
        throw Error(
            fmt::format("maps of {:.3g} texels with {} numbers each need about {:.2g} GB of memory, but "
                        "only {:.2g} GB are available; use fewer texels or a lower order",
                        all, numbers, needed * 1e-9, there * 1e-9));
}

/// Jumps of the first coefficient across seams, squared and summed.
double squared_jumps(const Atlas& atlas, std::span<const SeamPoint> seams, std::span<const float> vectors,
                     std::size_t stride) {
    double sum = 0;
    for (const SeamPoint& point : seams) {
        const double jump = jump_at(atlas, point, vectors, stride);
        sum += jump * jump / (kY00 * kY00);
    }
    return sum;
}

std::uint32_t max_read(const BilinearTexels& filter) {
    return filter.texels[std::max_element(filter.weights, filter.weights + 4) - filter.weights];
}

/// Bakes lightmaps, one map after another.
class LightmapBaker {
public:
    LightmapBaker(const Scene& scene, const std::vector<Atlas>& atlases, const BakeOptions& options,
                  const FinerModel& finer)
        : scene_(scene), atlases_(atlases), options_(options), finer_(finer),
          media_(choose_media(scene, options, finer.scene)) {
        for (const Atlas& atlas : atlases)
            charts_.push_back(chart_triangles(scene, atlas));
    }

    LightmapBake run(const Progress& progress) {
        const Stopwatch watch;
        const TexelPositions plain(scene_, nullptr);
        const std::vector<float> sample_areas = areas_of_samples(plain, charts_, scene_.triangles());
        const double texel = texel_size(plain, charts_);
        const Scene even = with_short_edges(finer_.scene ? *finer_.scene : scene_,
                                            options_.bounces != 0 ? kTexelsBetweenSources * texel : HUGE_VAL);
        DetailedPlan traced(scene_, {&even, finer_.scene ? finer_.reach : 0}, options_);
        const TraceScene own = trace_scene(scene_, media_, options_, finer_.scene ? nullptr : &traced.traced);
        const BakePlan plan = plan_bake(own, media_, options_, &traced);
        check_memory(traced.plan);
        check_room(atlases_, plan.numbers(), options_.memory.limit);
        const std::unique_ptr<Tracer> tracer = make_tracer(traced.traced, options_.tracer);
        statistics().notices = plan.notices;
        const TexelPositions positions(scene_, traced.surface ? &*traced.surface : nullptr);
        choose_rays(*tracer, positions);
        const double share = plan.bounces != 0 || !plan.lamps.empty() ? 0.2 : 0,
                     scattered = share + (plan.diffusion.empty() ? 0 : 0.2);
        BounceSources sources = bounce_sources(traced.plan, *tracer, progress.range(0, share));
        bounces_done_ = sources.bounces;
        statistics().rays += sources.rays;
        statistics().sources = plan.bounces != 0 ? traced.plan.receivers().size() : 0;
        std::optional<MediaLight> media;
        if (!plan.diffusion.empty()) {
            media.emplace(plan, traced, sources, media_, kTexelsBetweenMedia * texel, *tracer,
                          progress.range(share, scattered));
            statistics().rays += media->rays();
        }
        statistics().seconds.sources = watch.seconds();
        TexelTransport transport(plan, std::move(sources), rows_at_once());
        trace({.tracer = *tracer,
               .scene = traced.traced,
               .positions = positions,
               .options = {.order = options_.order, .rays = rays_},
               .inside = options_.repairs.inside,
               .plan = &plan,
               .sample_areas = sample_areas,
               .transport = &transport,
               .media = media ? &*media : nullptr,
               .notes_noise = denoises(*tracer)},
              progress.range(scattered, 1));
        finish(plan, *tracer, positions, watch);
        progress.update(1);
        return std::move(result_);
    }

private:
    LightmapStatistics& statistics() { return result_.statistics; }

    /// The noise of depth maps is alike in neighbouring texels, so that the filter does not recognise it.
    bool denoises(const Tracer& tracer) const {
        return options_.repairs.denoise && tracer.method() == BakeMethod::trace;
    }

    /// Sets the number of rays of a texel; with a target error, by the noise at some texels.
    void choose_rays(Tracer& tracer, const TexelPositions& positions) {
        if (!options_.target_error)
            return;
        const EqualRays equal = equal_rays(*options_.target_error, [&](int rays) {
            rays_ = rays;
            return estimated_error(tracer, positions);
        });
        if (!equal.reached)
            statistics().notices.push_back(missed_target());
    }

    std::size_t rows_at_once() const {
        const double rays = std::max(1.0, static_cast<double>(rays_) / kSamplesOfTexel);
        return static_cast<std::size_t>(
            std::clamp(kBytesOfRows / (rays * GatherOperator::kMaxBytesPerRay), 256.0, 65536.0));
    }

    void trace(TexelTask task, const Progress& progress) {
        light_.direct.layout = layout_of_one(options_.order, task.plan->direct_channels(), TermKind::direct);
        light_.rest.layout = layout_of_one(options_.order, task.plan->channels, TermKind::indirect);
        light_.lamps.layout = task.transport->lamp_layout();
        light_.visible.layout = layout_of_one(1, 1, TermKind::direct);
        std::size_t first = 0;
        for (std::size_t a = 0; a < atlases_.size(); ++a) {
            const Progress term =
                progress.range(static_cast<double>(a) / static_cast<double>(atlases_.size()),
                               static_cast<double>(a + 1) / static_cast<double>(atlases_.size()));
            const TexelSamples samples = sample_texels(charts_[a], atlases_[a]);
            task.options.seed = options_.seed + a;
            TexelLight light = trace_texels(task, atlases_[a], samples.samples, term);
            statistics().rays += light.rays;
            if (task.notes_noise)
                filter(a, task.positions, samples.samples, light);
            for (std::size_t i = 0; i < light.lamps.size(); ++i)
                light.lamps[i] += light.bounced_lamps[i];
            take(a, first, task.positions, samples.samples, std::move(light), *task.transport);
            first += atlases_[a].texels();
        }
    }

    void filter(std::size_t a, const TexelPositions& positions, std::span<const TexelSample> samples,
                TexelLight& light) {
        const TexelNet net(scene_, atlases_[a], charts_[a], samples, positions, light.traced);
        const double noise = filter_texels(net, options_.threads, light);
        const auto measured = static_cast<double>(light.measured);
        noise_.squares += measured * noise * noise;
        noise_.texels += measured;
    }

    /// Fills the gutters of a map, closes its seams, and keeps the texels that filters read.
    void take(std::size_t a, std::size_t first, const TexelPositions& positions,
              std::span<const TexelSample> samples, TexelLight light, const TexelTransport& transport) {
        const Atlas& atlas = atlases_[a];
        statistics().texels.measured += light.measured;
        statistics().texels.sealed +=
            light.measured - static_cast<std::size_t>(std::ranges::count(light.lit, true));
        const std::vector<SeamPoint> seams = seam_points(scene_, atlas);
        const auto stride = light_.direct.dimension();
        const auto close = [&](std::vector<float>& values, std::size_t numbers) {
            if (numbers == 0)
                return;
            fill_gutters(atlas, light.lit, values, numbers);
            stitch_seams(atlas, seams, light.lit, values, numbers);
        };
        fill_gutters(atlas, light.lit, light.direct, stride);
        jumps_.before += squared_jumps(atlas, seams, light.direct, stride);
        stitch_seams(atlas, seams, light.lit, light.direct, stride);
        jumps_.after += squared_jumps(atlas, seams, light.direct, stride);
        jumps_.points += seams.size();
        close(light.sky, transport.sky_stride());
        close(light.lamps, transport.lamp_stride());
        close(light.visible, 1);

        const TexelAreas areas = texel_areas(atlas, charts_[a], positions, samples);
        BakedLightmap& map = result_.lightmap;
        const std::size_t begin = map.texels.size();
        for (const std::uint32_t texel : areas.texels) {
            map.texels.push_back(static_cast<std::uint32_t>(first + texel));
            const auto append = [&](const std::vector<float>& from, std::size_t numbers, Transfer& to) {
                to.vectors.insert(to.vectors.end(),
                                  from.begin() + static_cast<std::ptrdiff_t>(texel * numbers),
                                  from.begin() + static_cast<std::ptrdiff_t>((texel + 1) * numbers));
            };
            append(light.direct, stride, light_.direct);
            append(light.visible, 1, light_.visible);
            append(light.sky, transport.sky_stride(), light_.rest);
            append(light.lamps, transport.lamp_stride(), light_.lamps);
        }
        map.areas.insert(map.areas.end(), areas.areas.begin(), areas.areas.end());
        for (const SeamPoint& point : seams) {
            const auto receiver_at = [&](const glm::dvec2& position) {
                const auto found =
                    std::ranges::lower_bound(areas.texels, max_read(bilinear_at(atlas, position)));
                return static_cast<std::uint32_t>(begin +
                                                  static_cast<std::size_t>(found - areas.texels.begin()));
            };
            map.seams.push_back({receiver_at(point.here), receiver_at(point.there)});
        }
    }

    /// Estimates the sampling error of direct light at single positions, with the rays of a texel.
    double estimated_error(Tracer& tracer, const TexelPositions& positions) {
        constexpr std::size_t kPositions = 2048;
        Receivers receivers;
        for (std::size_t a = 0; a < atlases_.size(); ++a) {
            const std::vector<TexelSample> samples = sample_texels(charts_[a], atlases_[a]).samples;
            const std::size_t step = std::max<std::size_t>(1, samples.size() * atlases_.size() / kPositions);
            for (std::size_t s = 0; s < samples.size(); s += step)
                positions.append(samples[s], 1, receivers);
        }
        // The samples of a texel have parts of one sequence of rays, but separate directions of depth maps.
        const double parts = tracer.method() == BakeMethod::raster ? kSamplesOfTexel : 1;
        const TraceOptions options{.order = options_.order,
                                   .rays = std::max(1, static_cast<int>(rays_ / parts)),
                                   .seed = options_.seed};
        Transfer traced = zero_transfer(options.order, 1, receivers.size());
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
        trace_receivers(tracer, receivers, indices, options, traced);
        const SamplingError error = sampling_error(tracer, receivers, options, traced, {});
        statistics().rays += error.rays + indices.size() * static_cast<std::size_t>(options.rays);
        return error.error / std::sqrt(parts);
    }

    void finish(const BakePlan& plan, Tracer& tracer, const TexelPositions& positions,
                const Stopwatch& watch) {
        LightmapStatistics& s = statistics();
        BakedLightmap& map = result_.lightmap;
        map.seams = unique_edges(std::move(map.seams));
        map.layout.placements.resize(scene_.primitives.size(), {.map = kNoMap});
        for (std::size_t a = 0; a < atlases_.size(); ++a) {
            map.layout.maps.push_back(size_of(atlases_[a]));
            for (const std::size_t p : atlases_[a].primitives)
                map.layout.placements[p] = {a, atlases_[a].uv_set};
        }
        if (std::optional<std::string> notice =
                positions.detail() ? positions.detail()->check() : std::nullopt)
            s.notices.push_back(std::move(*notice));
        s.mean_visibility = mean_visibility(light_.visible, map.areas);
        s.denoised = denoises(tracer);
        s.sampling_error = noise_.texels > 0 ? std::sqrt(noise_.squares / noise_.texels)
                                             : estimated_error(tracer, positions);
        BakedTransfer& baked = map.baked;
        baked.transfer = narrowed(std::move(light_.direct));
        if (!light_.rest.vectors.empty())
            baked.transfer = joined(baked.transfer, narrowed(std::move(light_.rest)));
        if (!plan.lamps.empty())
            baked.transfer = with_lamps(baked.transfer, light_.lamps, plan.lamps);
        baked.record = {.bounces = bounces_done_,
                        .endless = plan.bounces == kEndlessBounces,
                        .rays = rays_,
                        .seed = options_.seed,
                        .method = tracer.method(),
                        .backend = tracer.backend(),
                        .receivers = receivers_id(scene_),
                        .sampling_error = s.sampling_error,
                        .media = added_media(scene_, media_)};
        s.rounding_error = float16_rounding_error(baked.transfer, map.areas);
        baked.storage = storage_for(options_.memory.storage,
                                    {.rounding = s.rounding_error, .sampling = s.sampling_error}, s.notices);
        s.texels.all = map.layout.texels();
        s.texels.receivers = map.texels.size();
        s.device = tracer.device();
        const auto rms = [&](double sum) {
            return jumps_.points > 0 ? std::sqrt(sum / static_cast<double>(jumps_.points)) : 0;
        };
        s.seam_before = rms(jumps_.before);
        s.seam = rms(jumps_.after);
        if (s.texels.sealed > 0)
            s.notices.push_back(fmt::format("{} inside solid geometry and filled from neighbours",
                                            counted(s.texels.sealed, "texel is", "texels are")));
        s.seconds.all = watch.seconds();
        s.seconds.texels = s.seconds.all - s.seconds.sources;
    }

    const Scene& scene_;
    const std::vector<Atlas>& atlases_;
    const BakeOptions& options_;
    const FinerModel& finer_;
    Media media_;
    std::vector<std::vector<ChartTriangle>> charts_; ///< [atlases]
    struct Parts {
        Transfer direct, rest, lamps, visible;
    } light_; ///< light of the receivers that are complete
    struct Jumps {
        double before = 0, after = 0; ///< squared
        std::size_t points = 0;
    } jumps_;
    struct Noise {
        double squares = 0, texels = 0; ///< relative, weighted by texels
    } noise_;                           ///< noise of filtered maps
    int bounces_done_ = 0;
    int rays_ = options_.rays; ///< rays of a texel
    LightmapBake result_;
};

} // namespace

LightmapBake bake_lightmap(const Scene& scene, const std::vector<Atlas>& atlases, const BakeOptions& options,
                           const FinerModel& finer, const Progress& progress) {
    check_options(options);
    check_finer(finer);
    return LightmapBaker(scene, atlases, options, finer).run(progress);
}

} // namespace prt
