// Bakes direct light with an increasing number of rays on every backend, and measures its time and its error
// against a bake with many more rays from another seed.

#include "bake/studies/bench.h"

#include "bake/reference/surface_reference.h"
#include "bake/trace/trace_receivers.h"
#include "bake/tracers/make_tracer.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>

namespace prt {
namespace {

/// Rays of a reference relative to the measured bakes.
constexpr int kReferenceFactor = 64;
/// Total rays of the reference; they determine its number of receivers.
constexpr double kReferenceRays = 3e8;
constexpr std::uint64_t kReferenceSeed = 0x51ed270b7a5d1f3c;

struct Setup {
    Backend backend;
    BakeMethod method;
    bool fitted = false;
    Traversal traversal = Traversal::automatic;
};
constexpr Setup kSetups[] = {{Backend::cpu, BakeMethod::trace},
                             {Backend::cpu, BakeMethod::trace, true},
                             {Backend::gpu, BakeMethod::trace, false, Traversal::device},
                             {Backend::gpu, BakeMethod::trace, false, Traversal::compute},
                             {Backend::gpu, BakeMethod::raster}};
constexpr double kShare = 1.0 / (1 + std::size(kSetups)); ///< share of the progress for each series and for
                                                          ///< the references

class Bench {
public:
    Bench(const Scene& scene, const BenchOptions& options)
        : scene_(scene), options_(options), textures_(load_textures(scene, options.bad_textures)),
          receivers_(vertex_receivers(scene)), indices_(receivers_on_surfaces(receivers_)) {}

    BenchResult run(const std::string& name, const Progress& progress) {
        BenchResult result;
        result.scene = name;
        result.receivers = receivers_.size();
        result.triangles = scene_.triangles();
        result.order = options_.order;
        double begin = kShare;
        make_reference(result, progress.range(0, begin));
        for (const Setup& setup : kSetups) {
            result.series.push_back(measure(setup, progress.range(begin, begin + kShare)));
            begin += kShare;
        }
        progress.update(1);
        return result;
    }

private:
    void make_reference(BenchResult& result, const Progress& progress) {
        const int rays = std::min(kMaxRays, kReferenceFactor * options_.max_rays);
        const auto wanted = static_cast<std::size_t>(std::max(64.0, kReferenceRays / rays));
        const std::size_t step = std::max<std::size_t>(1, indices_.size() / wanted);
        std::vector<std::uint32_t> sample;
        for (std::size_t i = step / 2; i < indices_.size(); i += step)
            sample.push_back(indices_[i]);
        const TraceScene scene(scene_, textures_, {.threads = options_.threads});
        const std::unique_ptr<Tracer> tracer = make_tracer(scene, {.backend = Backend::cpu});
        surface_.emplace(scene, SurfaceReferenceOptions{.order = options_.order}, progress.range(0, 0.3));
        result.surface_points = surface_->points();
        reference_ = empty_transfer();
        trace_receivers(*tracer, receivers_, sample,
                        {.order = options_.order, .rays = rays, .seed = kReferenceSeed}, reference_,
                        progress.range(0.3, 1));
        areas_.assign(receivers_.size(), 0);
        for (const std::uint32_t p : sample)
            areas_[p] = receivers_.areas[p];
        result.reference_rays = rays;
        result.reference_receivers = sample.size();
    }

    BenchSeries measure(const Setup& setup, const Progress& progress) const {
        BenchSeries series{.backend = setup.backend,
                           .method = setup.method,
                           .fitted = setup.fitted,
                           .traversal = setup.traversal};
        double per_ray = 0;
        for (int rays = std::max(1, options_.fewest_rays); rays <= options_.max_rays; rays *= 2) {
            const double expected = per_ray * rays;
            if (expected > options_.max_seconds) {
                series.left_out =
                    fmt::format("runs of {} {} or more are skipped: they would take at least {:.0f} s", rays,
                                setup.method == BakeMethod::raster ? "directions" : "rays", expected);
                break;
            }
            const double share = static_cast<double>(rays) / options_.max_rays;
            try {
                const Progress term = progress.range(share / 2, share);
                series.runs.push_back(setup.fitted ? measure_fit(rays, series.device, term)
                                                   : measure_run(setup, rays, series.device, term));
            } catch (const Cancelled&) {
                throw;
            } catch (const Error& error) {
                series.left_out = error.what();
                break;
            }
            per_ray = series.runs.back().seconds / rays;
        }
        return series;
    }

    BenchRun measure_run(const Setup& setup, int rays, std::string& device, const Progress& progress) const {
        const TraceScene scene(scene_, textures_, {.threads = options_.threads});
        const Stopwatch all;
        const std::unique_ptr<Tracer> tracer =
            make_tracer(scene, {.backend = setup.backend,
                                .method = setup.method,
                                .raster_resolution = options_.raster_resolution,
                                .gpu = options_.gpu,
                                .traversal = setup.traversal});
        device = tracer->device();
        // Shaders are compiled on first use; a bake of a game's scene does not notice it.
        Transfer transfer = empty_transfer();
        trace_receivers(*tracer, receivers_, std::span(indices_).first(1),
                        {.order = options_.order, .rays = 1}, transfer);
        const TraceSeconds before = tracer->seconds();
        BenchRun run;
        run.rays = rays;
        run.seconds_build = all.seconds();
        trace_receivers(*tracer, receivers_, indices_,
                        {.order = options_.order, .rays = rays, .seed = options_.seed}, transfer, progress);
        run.seconds = all.seconds();
        run.stages = tracer->seconds();
        run.stages.trace -= before.trace;
        run.stages.accumulate -= before.accumulate;
        run.stages.transfer -= before.transfer;
        run.rays_per_second = static_cast<double>(indices_.size()) * rays / run.seconds;
        run.relative_l2 = relative_l2(reference_, transfer, areas_);
        run.contrast = transfer_contrast(reference_, transfer, areas_);
        run.surface_l2 = surface_->relative_l2(transfer);
        return run;
    }

    /// Measures a complete bake, without the time for reading textures, as for the others.
    BenchRun measure_fit(int rays, std::string& device, const Progress& progress) const {
        BakeOptions options;
        options.order = options_.order;
        options.rays = rays;
        options.fit = FitMode::surface;
        options.tracer.backend = Backend::cpu;
        options.lamps.mode = LampMode::none;
        options.repairs.bad_textures = options_.bad_textures;
        options.threads = options_.threads;
        options.seed = options_.seed;
        const BakeResult result = bake(scene_, options, progress);
        const BakeStatistics& s = result.statistics;
        device = s.device;
        BenchRun run;
        run.rays = rays;
        run.seconds = s.seconds.all;
        run.seconds_build = s.seconds.build;
        run.stages = s.seconds.tracing;
        run.rays_per_second = s.rays_per_second();
        if (result.baked.transfer.layout.channels() != 1)
            throw Error("the benchmark does not support transmission through colored surfaces");
        run.relative_l2 = relative_l2(reference_, result.baked.transfer, areas_);
        run.contrast = transfer_contrast(reference_, result.baked.transfer, areas_);
        run.surface_l2 = surface_->relative_l2(result.baked.transfer);
        return run;
    }

    Transfer empty_transfer() const { return zero_transfer(options_.order, 1, receivers_.size()); }

    const Scene& scene_;
    const BenchOptions& options_;
    std::vector<Texture> textures_;
    Receivers receivers_;
    std::vector<std::uint32_t> indices_;
    std::vector<float> areas_; ///< areas of the receivers of the reference, zero for other receivers
    Transfer reference_;
    std::optional<SurfaceReference> surface_;
};

} // namespace

BenchResult run_bench(const std::string& name, const Scene& scene, const BenchOptions& options,
                      const Progress& progress) {
    return Bench(scene, options).run(name, progress);
}

} // namespace prt
