// Traces samples of the surface layer by layer, and solves for what receivers must have.

#include "surface/fitted_light.h"

#include "prt/gpu_failure.h"
#include "prt/sh_basis.h"
#include "prt/trace_receivers.h"
#include "scene/sealed.h"
#include "surface/bend_weights.h"
#include "trace/sample_sequence.h"
#include "trace/scrambles.h"
#include "trace/vector_sums.h"
#include "trace_gather.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace prt {
namespace {

/// Sums over samples: b of the equations, and with a random sign for each group of samples that share the net
/// of a receiver.
struct SampleSums {
    std::vector<float> b, signed_b; ///< [unknowns][order²]
    std::vector<std::uint32_t> dark;
};

float sign_of_group(std::size_t group, std::uint64_t seed) {
    return receiver_seed(static_cast<std::uint32_t>(group), seed + 6 * kSecondScramble) & 1 ? 1.0f : -1.0f;
}

class SampleTracer {
public:
    SampleTracer(const BakePlan& plan, Tracer& tracer, const SurfaceSamples& samples,
                 const FitEquations& equations)
        : plan_(plan), tracer_(tracer), samples_(samples), equations_(equations),
          stride_(static_cast<std::size_t>(coefficient_count(plan.options.order))),
          rays_(std::max(1, plan.options.rays / static_cast<int>(samples.layers))) {}

    SampleSums trace(DirectLight& direct, const Progress& progress) {
        SampleSums sums;
        try {
            sums = trace_layers(direct, progress);
        } catch (const GpuFailure&) {
            if (tracer_.backend() == Backend::gpu)
                throw;
            direct.gather.reset(); // what the GPU had summed is gone
            direct.rays = 0;
            sums = trace_layers(direct, progress);
        }
        std::sort(sums.dark.begin(), sums.dark.end());
        if (direct.gather && direct.gather->entries() == 0) {
            direct.gather.reset();
            direct.notices.push_back("no bounces: no ray from a sample meets a surface that scatters");
        }
        return sums;
    }

    /// What groups with random signs leave over at `x`, in the place of b.
    std::vector<float> signed_rest(std::vector<float> signed_b, std::span<const float> x) const {
        std::vector<float> here(stride_);
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            const FitRow& row = equations_.rows[s];
            std::fill(here.begin(), here.end(), 0.0f);
            for (std::size_t i = 0; i < 3; ++i)
                if (row.unknowns[i] != kNoReceiver)
                    for (std::size_t c = 0; c < stride_; ++c)
                        here[c] -= row.shares[i] * x[row.unknowns[i] * stride_ + c];
            add(s, sign_of_group(s / samples_.layers, plan_.options.seed), here, signed_b);
        }
        return signed_b;
    }

private:
    double share(std::size_t layer) const {
        return static_cast<double>(layer) / static_cast<double>(samples_.layers);
    }

    SampleSums trace_layers(DirectLight& direct, const Progress& progress) {
        SampleSums sums;
        sums.b.resize(equations_.unknowns * stride_);
        sums.signed_b.resize(sums.b.size());
        const std::unique_ptr<VectorSums> on_device =
            tracer_.vector_sums(plan_.options.order, unknown_weights(equations_));
        for (std::size_t k = 0; k < samples_.layers; ++k)
            trace_layer(k, direct, sums, on_device.get(), progress.part(share(k), share(k + 1)));
        if (on_device)
            on_device->read(sums.b, sums.signed_b);
        return sums;
    }

    void add(std::size_t sample, float sign, std::span<const float> vector, std::span<float> b) const {
        const FitRow& row = equations_.rows[sample];
        for (std::size_t i = 0; i < 3; ++i)
            if (row.unknowns[i] != kNoReceiver)
                for (std::size_t c = 0; c < stride_; ++c)
                    b[row.unknowns[i] * stride_ + c] += sign * row.area * row.shares[i] * vector[c];
    }

    /// Each layer takes a part of its own of its receivers' nets.
    void trace_layer(std::size_t k, DirectLight& direct, SampleSums& sums, VectorSums* on_device,
                     const Progress& progress) {
        const Receivers layer = samples_.layer(k);
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(layer);
        const auto sample = [&](std::uint32_t g) { return g * samples_.layers + k; };
        TraceOptions options = gather_options(plan_, static_cast<std::uint32_t>(rays_));
        options.first_ray = static_cast<std::uint32_t>(k) * std::bit_ceil(static_cast<std::uint32_t>(rays_));
        ReceiverSink sink;
        if (plan_.bounces != 0) {
            if (!direct.gather) {
                const auto rays = static_cast<std::uint32_t>(rays_);
                direct.rays += check_gather_memory(plan_, tracer_, layer, {{rays, indices}}, samples_.layers,
                                                   progress.stop);
                direct.gather.emplace(plan_.scene.surfaces(), *plan_.transport, samples_.size(),
                                      plan_.channels);
            }
            sink = [&](std::uint32_t g, std::span<const Hit> hits) {
                direct.gather->set_row(sample(g), hits, rays_);
            };
        } else {
            options.hit_stride = 1;
        }
        const auto note_dark = [&](std::uint32_t g, float first) {
            if (first <= 0)
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
                           std::vector<float> first(batch.size());
                           on_device->trace(layer, batch, options, rows, first, sink_of(batch, sink),
                                            of_batch);
                           for (std::size_t i = 0; i < batch.size(); ++i)
                               note_dark(batch[i], first[i]);
                       });
        else
            trace_receivers(
                tracer_, layer, indices, options,
                [&](std::uint32_t g, std::span<const float> vector) {
                    add(sample(g), 1, vector, sums.b);
                    add(sample(g), sign_of_group(g, plan_.options.seed), vector, sums.signed_b);
                    note_dark(g, vector[0]);
                },
                progress, sink);
        direct.rays += indices.size() * static_cast<std::size_t>(rays_);
    }

    const BakePlan& plan_;
    Tracer& tracer_;
    const SurfaceSamples& samples_;
    const FitEquations& equations_;
    std::size_t stride_;
    int rays_; ///< of a sample
};

/// Samples that are sealed in tell nothing; receivers that none tells of take the light of their neighbours.
SealedIn leave_out_sealed(const BakePlan& plan, Tracer& tracer, const SurfaceSamples& samples,
                          std::vector<std::uint32_t> dark, FitEquations& equations,
                          const std::stop_token& stop) {
    const Sealed sealed =
        find_sealed(tracer, plan.scene, samples.receivers, std::move(dark), plan.options.seed, stop);
    SealedIn result;
    result.rays = sealed.rays;
    std::vector<bool> told(equations.unknowns), asked(equations.unknowns);
    for (std::size_t s = 0; s < samples.size(); ++s) {
        for (const std::uint32_t u : equations.rows[s].unknowns)
            if (u != kNoReceiver) {
                asked[u] = true;
                told[u] = told[u] || !sealed.receivers[s];
            }
        if (sealed.receivers[s] && plan.options.repairs.inside == Inside::refill)
            equations.rows[s].unknowns.fill(kNoReceiver);
    }
    std::vector<bool> inside(plan.receivers().size());
    for (std::uint32_t p = 0; p < inside.size(); ++p) {
        const std::uint32_t u = equations.unknown_of[p];
        inside[p] = u != kNoReceiver && asked[u] && !told[u];
        if (p < plan.transport->fronts && inside[p])
            result.receivers.push_back(p);
    }
    if (!result.receivers.empty() && plan.options.repairs.inside == Inside::refill)
        result.refill = Refill(
            MeshNeighbours(plan.scene.surfaces(), plan.receivers(), plan.transport->fronts, inside), inside);
    return result;
}

/// Relative L2 of `noise` in `light`, both of receivers.
double relative_noise(const Receivers& receivers, const Transfer& light, const Transfer& noise) {
    double error = 0, norm = 0;
    for (std::uint32_t p = 0; p < receivers.size(); ++p) {
        error += static_cast<double>(receivers.areas[p]) * squared_norm(noise.vector(p));
        norm += static_cast<double>(receivers.areas[p]) * squared_norm(light.vector(p));
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

} // namespace

FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, int samples_each, const Progress& progress) {
    const std::size_t on_surfaces = receivers_on_surfaces(plan.receivers()).size();
    const auto layers = static_cast<std::size_t>(samples_each);
    SurfaceSamples samples =
        sample_surfaces(plan.scene.surfaces(), *plan.transport,
                        {.count = on_surfaces * layers, .layers = layers, .seed = plan.options.seed});
    FitEquations equations = fit_equations(plan.scene.surfaces(), *plan.transport, samples);
    SampleTracer traced(plan, tracer, samples, equations);
    DirectLight direct;
    SampleSums sums = traced.trace(direct, progress.part(0, 0.95));
    SealedIn sealed = leave_out_sealed(plan, tracer, samples, std::move(sums.dark), equations, progress.stop);

    const int threads = plan.options.threads;
    const auto stride = static_cast<std::size_t>(coefficient_count(plan.options.order));
    const auto even = [&](float weight) { return std::vector<float>(equations.bends.size(), weight); };
    FitSolver solver(equations, even(kFirstBendWeight));
    std::vector<float> first = sums.b;
    solver.solve(first, stride, threads);
    std::vector<float> rest = traced.signed_rest(std::move(sums.signed_b), first), noise = rest;
    solver.solve(noise, stride, threads);
    solver.factor(equations, bend_weights(equations, first, noise, stride));
    const auto of_receivers = [&](std::vector<float>& b) {
        solver.solve(b, stride, threads);
        Transfer transfer = zero_transfer(plan.options.order, 1, plan.receivers().size());
        spread_unknowns(equations, std::span<const float>(b), stride, std::span(transfer.vectors));
        return transfer;
    };
    direct.transfer = of_receivers(sums.b);
    direct.mean_rays = plan.options.rays;
    direct.mean_visibility = mean_visibility(direct.transfer, plan.areas());
    direct.sampling_error = relative_noise(plan.receivers(), direct.transfer, of_receivers(rest));
    progress.update(1);
    if (plan.bounces != 0 || !plan.lamps.empty()) // their light bends elsewhere
        solver.factor(equations, even(kPlainBendWeight));
    return {
        std::move(direct), {std::move(samples), std::move(equations), std::move(solver)}, std::move(sealed)};
}

} // namespace prt
