// Traces samples of the surface layer by layer, and solves for the values of receivers.

#include "bake/pipeline/fitted_light.h"

#include "bake/device/gpu_failure.h"
#include "bake/pipeline/equal_rays.h"
#include "bake/pipeline/lamps_of_plan.h"
#include "bake/pipeline/trace_gather.h"
#include "bake/surface_fit/fit_noise.h"
#include "bake/surface_fit/separated_receivers.h"
#include "bake/surface_fit/smoothness_weights.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"
#include "bake/trace/vector_sums.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Light at samples, summed for the equations without and with a random sign for each group of samples that
/// share the rays of one receiver; and the test values of the samples.
struct SampleSums {
    std::vector<float> b, signed_b; ///< [unknowns][order²]
    std::vector<float> values;      ///< [samples][tests]
    std::vector<std::uint32_t> dark;
};

class SampleTracer {
public:
    SampleTracer(const BakePlan& plan, Tracer& tracer, const SurfaceSamples& samples,
                 const FitEquations& equations, const LampConnections* lamps, int rays)
        : plan_(plan), tracer_(tracer), samples_(samples), equations_(equations), lamps_(lamps),
          tests_(TestValues::of_sky(plan.options.order, 1)),
          stride_(static_cast<std::size_t>(coefficient_count(plan.options.order))), rays_(rays) {}

    int rays_of_sample() const { return rays_; }

    SampleSums trace(DirectLight& direct, const Progress& progress) {
        SampleSums sums;
        try {
            sums = trace_layers(direct, progress);
        } catch (const GpuFailure&) {
            if (tracer_.backend() == Backend::gpu)
                throw;
            direct.gather.reset(); // sums on the GPU are lost
            direct.lamps.reset();
            direct.rays = 0;
            sums = trace_layers(direct, progress);
        }
        std::sort(sums.dark.begin(), sums.dark.end());
        if (direct.gather && direct.gather->entries() == 0) {
            direct.gather.reset();
            direct.notices.push_back(
                "bounces are skipped: no ray from a sample hits a surface that reflects light diffusely");
        }
        return sums;
    }

private:
    double share(std::size_t layer) const {
        return static_cast<double>(layer) / static_cast<double>(samples_.layers);
    }

    SampleSums trace_layers(DirectLight& direct, const Progress& progress) {
        SampleSums sums;
        sums.b.resize(equations_.unknowns * stride_);
        sums.signed_b.resize(sums.b.size());
        sums.values.resize(samples_.size() * tests_.count());
        const std::unique_ptr<VectorSums> on_device =
            tracer_.vector_sums(plan_.options.order, unknown_weights(equations_));
        for (std::size_t k = 0; k < samples_.layers; ++k)
            trace_layer(k, direct, sums, on_device.get(), progress.range(share(k), share(k + 1)));
        if (on_device)
            on_device->read(sums.b, sums.signed_b);
        return sums;
    }

    void make_rows(const Receivers& layer, const std::vector<std::uint32_t>& indices, DirectLight& direct,
                   const Progress& progress) {
        const double copies = static_cast<double>(samples_.layers) * (lamps_ ? 1 + LampRows::kCopies : 1);
        direct.rays += check_gather_memory(
            plan_, tracer_, layer, {{static_cast<std::uint32_t>(rays_), indices}}, copies, progress.stop);
        direct.gather.emplace(plan_.gather_rows(samples_.size()));
        if (lamps_)
            direct.lamps.emplace(plan_, samples_.size(), false);
    }

    /// Traces a layer, which uses a separate part of its receivers' nets.
    void trace_layer(std::size_t k, DirectLight& direct, SampleSums& sums, VectorSums* on_device,
                     const Progress& progress) {
        const Receivers layer = samples_.layer(k);
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(layer);
        const auto sample = [&](std::uint32_t g) { return g * samples_.layers + k; };
        TraceOptions options = gather_options(plan_, static_cast<std::uint32_t>(rays_));
        options.first_ray = static_cast<std::uint32_t>(k) * std::bit_ceil(static_cast<std::uint32_t>(rays_));
        ReceiverSink sink;
        if (plan_.bounces != 0) {
            if (!direct.gather)
                make_rows(layer, indices, direct, progress);
            sink = [&, options](std::uint32_t g, std::span<const Hit> hits) {
                direct.gather->set_row(sample(g), hits, rays_);
                if (lamps_)
                    direct.lamps->set(sample(g), lamps_->join(layer, g, hits, options), rays_);
            };
        } else {
            options.hit_stride = 1;
        }
        const auto note = [&](std::uint32_t g, std::span<const float> vector) {
            tests_.evaluate(vector,
                            std::span(sums.values).subspan(sample(g) * tests_.count(), tests_.count()));
            if (static_cast<double>(vector[0]) <= max_dark(tracer_))
                sums.dark.push_back(static_cast<std::uint32_t>(sample(g)));
        };
        if (on_device)
            in_batches(tracer_, indices, options, progress,
                       [&](std::span<const std::uint32_t> batch, const Progress& of_batch) {
                           std::vector<SumRow> rows;
                           for (const std::uint32_t g : batch) {
                               rows.push_back(sum_row(equations_.rows[sample(g)]));
                               rows.back().sign = sign_of_group(g, plan_.options.seed);
                           }
                           const std::size_t tested = first_coefficients(options.order);
                           std::vector<float> first(batch.size() * tested);
                           on_device->trace(layer, batch, options, rows, first, sink_of(batch, sink),
                                            of_batch);
                           for (std::size_t i = 0; i < batch.size(); ++i)
                               note(batch[i], std::span<const float>(&first[i * tested], tested));
                       });
        else
            trace_receivers(
                tracer_, layer, indices, options,
                [&](std::uint32_t g, std::span<const float> vector) {
                    add_samples(equations_, sample(g), vector, stride_, std::span(sums.b));
                    add_samples(equations_, sample(g), vector, stride_, std::span(sums.signed_b),
                                sign_of_group(g, plan_.options.seed));
                    note(g, vector);
                },
                progress, sink);
        direct.rays += indices.size() * static_cast<std::size_t>(rays_);
    }

    const BakePlan& plan_;
    Tracer& tracer_;
    const SurfaceSamples& samples_;
    const FitEquations& equations_;
    const LampConnections* lamps_; ///< may be null
    TestValues tests_;
    std::size_t stride_;
    int rays_; ///< rays per sample
};

/// Returns receivers whose samples are all sealed in, and their repair.
SealedIn sealed_receivers(const BakePlan& plan, const FitEquations& equations, const Sealed& sealed) {
    SealedIn result;
    result.rays = sealed.rays;
    std::vector<bool> open(equations.unknowns), asked(equations.unknowns);
    for (std::size_t s = 0; s < equations.rows.size(); ++s)
        for (const std::uint32_t u : equations.rows[s].unknowns)
            if (u != kNoReceiver) {
                asked[u] = true;
                open[u] = open[u] || !sealed.receivers[s];
            }
    std::vector<bool> inside(plan.receivers().size());
    for (std::uint32_t p = 0; p < inside.size(); ++p) {
        const std::uint32_t u = equations.unknown_of[p];
        inside[p] = u != kNoReceiver && asked[u] && !open[u];
        if (p < plan.transport->fronts && inside[p])
            result.receivers.push_back(p);
    }
    if (!result.receivers.empty() && plan.options.repairs.inside == Inside::refill)
        result.refill = Refill(
            MeshNeighbours(plan.scene.surfaces(), plan.receivers(), plan.transport->fronts, inside), inside);
    return result;
}

/// Excludes samples that are sealed in.
void leave_out(const Sealed& sealed, FitEquations& equations) {
    for (std::size_t s = 0; s < equations.rows.size(); ++s)
        if (sealed.receivers[s])
            equations.rows[s].unknowns.fill(kNoReceiver);
}

/// Converts sums of `from`, in which every receiver is an unknown, to those of `to`, in which some receivers
/// share one.
std::vector<float> joined_sums(const FitEquations& from, const FitEquations& to, std::size_t stride,
                               std::span<const float> sums) {
    std::vector<float> joined(to.unknowns * stride);
    for (std::size_t p = 0; p < from.unknown_of.size(); ++p)
        for (std::size_t c = 0; from.unknown_of[p] != kNoReceiver && c < stride; ++c)
            joined[to.unknown_of[p] * stride + c] += sums[from.unknown_of[p] * stride + c];
    return joined;
}

/// Extracts some columns of `all` [unknowns][stride], multiplied by their factors.
std::vector<float> columns_of(std::span<const float> all, std::size_t stride,
                              const RepresentativeColumns& some) {
    std::vector<float> result;
    result.reserve(all.size() / stride * some.columns.size());
    for (std::size_t row = 0; row < all.size(); row += stride)
        for (std::size_t i = 0; i < some.columns.size(); ++i)
            result.push_back(some.factors[i] * all[row + some.columns[i]]);
    return result;
}

/// Converts values of unknowns to transfer of all receivers.
Transfer of_receivers(const BakePlan& plan, const FitEquations& equations, std::span<const float> x) {
    Transfer transfer = zero_transfer(plan.options.order, 1, plan.receivers().size());
    spread_unknowns(equations, x, transfer.dimension(), std::span(transfer.vectors));
    return transfer;
}

/// Sum of squares over receivers, weighted by area, of values [unknowns][columns].
double weighted_square(const BakePlan& plan, const FitEquations& equations, std::span<const float> x,
                       std::size_t columns) {
    double sum = 0;
    for (std::uint32_t p = 0; p < plan.receivers().size(); ++p)
        if (const std::uint32_t u = equations.unknown_of[p]; u != kNoReceiver)
            sum += static_cast<double>(plan.receivers().areas[p]) *
                   squared_norm(x.subspan(u * columns, columns));
    return sum;
}

/// Distant light at the samples, and its solver.
struct FittedSky {
    FitSolver solver;
    SampledLight light;
    double noise; ///< relative L2 noise in the sharp values
};

/// Solves for distant light with smoothness weights for its noise.
FittedSky fit_sky(const BakePlan& plan, const SurfaceSamples& samples, const FitEquations& equations,
                  SampleSums sums) {
    const int threads = plan.options.threads;
    const auto stride = static_cast<std::size_t>(coefficient_count(plan.options.order));
    const RepresentativeColumns some = columns_of_sky(stride);
    auto [solver, residuals] =
        noise_solver(samples, equations,
                     {some.size(), columns_of(sums.b, stride, some), columns_of(sums.signed_b, stride, some)},
                     plan.options.seed, threads);
    std::vector<float> sharp = sums.b;
    solver.solve(sharp, stride, threads);
    solver.solve(residuals, some.size(), threads, FitSolver::kEstimate);
    const double norm = weighted_square(plan, equations, sharp, stride),
                 error = weighted_square(plan, equations, residuals, some.size());
    const std::size_t tests = sums.values.size() / std::max<std::size_t>(samples.size(), 1);
    return {std::move(solver),
            {stride, tests, std::move(sums.b), std::move(sharp), std::move(sums.values)},
            norm > 0 ? std::sqrt(error / norm) : 0};
}

/// Computes smooth light of lamps at the vertices from light at the samples.
LampLight smooth_lamps(const BakePlan& plan, const FitEquations& equations, const LampLight& at_samples) {
    const std::size_t stride = at_samples.transfer.dimension();
    LampLight light{zero_transfer(at_samples.transfer.layout, plan.receivers().size()), at_samples.rays};
    std::vector<float> sums(equations.unknowns * stride);
    add_samples(equations, 0, std::span<const float>(at_samples.transfer.vectors), stride, std::span(sums));
    smooth(unknown_weights(equations), std::span(sums), stride);
    spread_unknowns(equations, std::span<const float>(sums), stride, std::span(light.transfer.vectors));
    return light;
}

MeasuredLamps measured_lamps(const BakePlan& plan, const FitEquations& equations,
                             const LampLight& at_samples) {
    const std::size_t stride = at_samples.transfer.dimension(),
                      channels = static_cast<std::size_t>(at_samples.transfer.layout.channels());
    const TestValues tests =
        TestValues::of_lamps(plan.lamps.size(), static_cast<int>(channels), stride / channels);
    MeasuredLamps lamps{smooth_lamps(plan, equations, at_samples),
                        {.stride = stride,
                         .tests = tests.count(),
                         .sums = std::vector<float>(equations.unknowns * stride),
                         .sharp = {},
                         .values = std::vector<float>(equations.rows.size() * tests.count())}};
    add_samples(equations, 0, std::span<const float>(at_samples.transfer.vectors), stride,
                std::span(lamps.sampled.sums));
    for (std::size_t s = 0; s < equations.rows.size(); ++s)
        tests.evaluate(at_samples.transfer.vector(s),
                       std::span(lamps.sampled.values).subspan(s * tests.count(), tests.count()));
    return lamps;
}

/// Division of the rays of each receiver.
struct FitRays {
    int samples; ///< samples that share them
    int rays;    ///< rays of a receiver
};

FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, LastOfLamps last, const FitRays& each,
                         const Progress& progress, const LampConnections* known) {
    const Surfaces& surfaces = plan.scene.surfaces();
    const std::size_t on_surfaces = receivers_on_surfaces(plan.receivers()).size();
    const auto layers = static_cast<std::size_t>(each.samples);
    SurfaceSamples samples =
        sample_surfaces(surfaces, *plan.transport,
                        {.count = on_surfaces * layers, .layers = layers, .seed = plan.options.seed});
    std::vector<std::uint32_t> alike(plan.receivers().size());
    std::iota(alike.begin(), alike.end(), 0u);
    FitEquations alone = fit_equations(surfaces, *plan.transport, samples, alike);
    const double lit = plan.lamps.empty() ? 0 : 0.2;
    const LampLight lamps =
        light_of_lamps(plan, tracer, samples.receivers, {.divisor = layers, .seed = plan.options.seed},
                       progress.range(0, lit));
    const std::optional<LampConnections> connections =
        connections_to(plan, last, smooth_lamps(plan, alone, lamps).transfer);
    SampleTracer traced(plan, tracer, samples, alone, connections ? &*connections : known,
                        std::max(1, each.rays / each.samples));
    DirectLight direct;
    SampleSums sums = traced.trace(direct, progress.range(lit, 0.95));

    const Sealed sealed = find_sealed(tracer, plan.traced().scene, samples.receivers, std::move(sums.dark),
                                      plan.options.seed, progress.stop);
    const bool refilled = plan.options.repairs.inside == Inside::refill;
    if (refilled)
        leave_out(sealed, alone);
    alike = separated(alike_receivers(surfaces, *plan.transport), alone,
                      TestValues::of_sky(plan.options.order, 1), sums.values, traced.rays_of_sample());
    FitEquations equations = fit_equations(surfaces, *plan.transport, samples, alike);
    SealedIn inside = sealed_receivers(plan, equations, sealed);
    if (refilled)
        leave_out(sealed, equations);
    const auto stride = static_cast<std::size_t>(coefficient_count(plan.options.order));
    sums.b = joined_sums(alone, equations, stride, sums.b);
    sums.signed_b = joined_sums(alone, equations, stride, sums.signed_b);

    FittedSky sky = fit_sky(plan, samples, equations, std::move(sums));
    std::optional<FitSolver> of_lamps;
    if (!plan.lamps.empty()) // the edges of their shadows are elsewhere
        of_lamps.emplace(equations,
                         std::vector<float>(equations.second_differences.size(), kPlainSmoothnessWeight));
    MeasuredLamps lit_by_lamps = measured_lamps(plan, equations, lamps);
    std::vector<float> weights = unknown_weights(equations);
    SurfaceFit fit{std::move(samples), std::move(equations), std::move(weights), std::move(sky.solver),
                   std::move(of_lamps)};
    std::vector<float> smooth = sky.light.sums;
    fit.smooth(std::span(smooth), stride);
    direct.transfer = of_receivers(plan, fit.equations, smooth);
    direct.mean_rays = each.rays;
    direct.mean_visibility = mean_visibility(direct.transfer, plan.areas());
    direct.sampling_error = sky.noise;
    progress.update(1);
    return {.direct = std::move(direct),
            .sky = std::move(sky.light),
            .lamps = std::move(lit_by_lamps),
            .fit = std::move(fit),
            .sealed = std::move(inside)};
}

} // namespace

FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, LastOfLamps last, int samples,
                         const Progress& progress, const LampConnections* known) {
    if (!plan.options.target_error)
        return trace_fitted(plan, tracer, last, FitRays{samples, plan.options.rays}, progress, known);
    std::optional<FittedLight> light;
    std::size_t traced = 0;
    const EqualRays equal = equal_rays(*plan.options.target_error, [&](int rays) {
        light.reset(); // only one fits into memory
        light.emplace(trace_fitted(plan, tracer, last, FitRays{samples, rays}, {{}, progress.stop}, known));
        traced += light->direct.rays;
        return light->direct.sampling_error;
    });
    light->direct.rays = traced;
    if (!equal.reached)
        light->direct.notices.push_back(missed_target());
    progress.update(1);
    return std::move(*light);
}

} // namespace prt
