// Traces surfaces that are drawn once, and samples of instances in their surroundings.

#include "bake/pipeline/adaptive.h"
#include "bake/pipeline/trace_gather.h"
#include "bake/products/instances/instance_light.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>

namespace prt {
namespace {

/// The purpose of kHitStride, for samples: there are many of them per factor.
constexpr int kSampleHitStride = 8;
constexpr int kMinSampleRays = 16;
/// Minimum share of a sample's rays that end at backs for it to be a candidate. The rays are few; at sealed
/// samples 98 of 100 end at backs.
constexpr double kMinSealedBackShare = 0.5;
constexpr int kProbesOfSamples = 128; ///< rays per sample; if a sample is sealed in, the other samples of its
                                      ///< instance determine the factors

/// Indices of receivers grouped by their number of rays.
ByRays by_rays(std::span<const std::uint32_t> receivers, std::span<const std::uint32_t> rays) {
    ByRays result;
    for (const std::uint32_t r : receivers)
        result[rays[r]].push_back(r);
    return result;
}

} // namespace

void InstanceLight::trace(const Progress& progress) {
    const auto own = static_cast<double>(receivers_.own.size()),
               samples = static_cast<double>(receivers_.sampled.size()) * options_.rays;
    const double share = own / std::max(1.0, own + samples);
    trace_own(progress.range(0, share));
    trace_samples(progress.range(share, 1));
    find_sealed_in(progress);
}

void InstanceLight::trace_own(const Progress& progress) {
    if (plan_.options.target_error && !receivers_.own.empty())
        trace_own_adaptively(progress);
    else
        trace_own(receivers_.own, static_cast<std::uint32_t>(plan_.options.rays), progress);
}

void InstanceLight::trace_own(std::span<const std::uint32_t> receivers, std::uint32_t rays,
                              const Progress& progress) {
    TraceOptions options = gather_options(plan_, rays);
    if (!bounce_.gather)
        options.hit_stride = 1;
    const auto take = [&](std::uint32_t r, std::span<const float> vector) {
        std::ranges::copy(vector, &own_.direct[receivers_.own_of[r] * sizes_.count]);
    };
    ReceiverSink sink;
    if (bounce_.gather)
        sink = [&](std::uint32_t r, std::span<const Hit> hits) {
            bounce_.gather->set_row(receivers_.own_of[r], hits, options.rays);
        };
    trace_receivers(tracers_.own, plan_.receivers(), receivers, options, take, progress, sink);
    result_.rays += receivers.size() * static_cast<std::size_t>(options.rays);
}

/// Traces until the noise over all surfaces that are drawn once is at most the target.
void InstanceLight::trace_own_adaptively(const Progress& progress) {
    const double last = bounce_.gather ? 0.5 : 1; // then rows of bounces with the same numbers of rays
    Receivers own = plan_.receivers();
    for (std::size_t r = 0; r < own.size(); ++r)
        if (receivers_.own_of[r] == kNoReceiver)
            own.normals[r] = glm::vec3(0); // not traced
    const std::vector<float> left(own.size(), 1.0f);
    const AdaptiveResult adaptive = adaptive_transfer(
        tracers_.own, own, MeshNeighbours(plan_.scene.surfaces(), plan_.receivers(), plan_.transport->fronts),
        left, {.order = plan_.options.order, .rays = plan_.options.rays, .seed = plan_.options.seed},
        *plan_.options.target_error, progress.range(0, last));
    result_.rays += std::accumulate(adaptive.rays.begin(), adaptive.rays.end(), adaptive.rays_checked);
    result_.sampling_error = adaptive.error;
    for (const std::uint32_t r : receivers_.own)
        std::ranges::copy(adaptive.transfer.vector(r), &own_.direct[receivers_.own_of[r] * sizes_.count]);
    if (bounce_.gather)
        for (const auto& [rays, members] : by_rays(receivers_.own, adaptive.rays))
            trace_own(members, rays, {{}, progress.stop});
}

int InstanceLight::rays_per_receiver() const {
    if (!plan_.options.target_error)
        return plan_.options.rays;
    double rays = 0, receivers = 0;
    for (const SharedMeshBake& mesh : meshes_) {
        const auto count = static_cast<double>(mesh.receivers().size());
        rays += count * mesh.mean_rays;
        receivers += count;
    }
    return static_cast<int>(std::lround(rays / std::max(receivers, 1.0)));
}

/// Traces all samples, and some of them twice to estimate the noise. Two halves of the same rays do not
/// suffice: a half is less evenly distributed, and its noise is more than 50 % larger.
void InstanceLight::trace_samples(const Progress& progress) {
    std::vector<std::uint32_t> noisy;
    for (std::size_t s = 0; s < receivers_.sampled.size(); s += kSamplesToOfNoise)
        noisy.push_back(receivers_.sampled[s]);
    const int rays =
        std::max(kMinSampleRays, static_cast<int>(std::lround(options_.rays * rays_per_receiver())));
    constexpr double kOnce = static_cast<double>(kSamplesToOfNoise) / (kSamplesToOfNoise + 1);
    trace_samples(receivers_.sampled, rays, false, progress.range(0, kOnce));
    trace_samples(noisy, rays, true, progress.range(kOnce, 1));
}

void InstanceLight::trace_samples(std::span<const std::uint32_t> receivers, int rays, bool again,
                                  const Progress& progress) {
    // Instances without neighbours need every ray; light from surfaces needs fewer.
    const TraceOptions options{.order = plan_.options.order,
                               .rays = rays,
                               .seed = plan_.options.seed + (again ? 2 : 1),
                               .hit_stride = bounce_.gather ? kSampleHitStride : 1};
    const Surfaces& surfaces = plan_.scene.surfaces();
    const auto take = [&](std::uint32_t r, std::span<const float> vector) {
        take_light(receivers_.sample_of[r], again, vector, 0);
    };
    const auto sink = [&](std::uint32_t r, std::span<const Hit> hits) {
        const std::size_t sample = receivers_.sample_of[r], i = receivers_.instance_of_sample(sample);
        if (bounce_.gather)
            bounce_.gather->set_row(
                receivers_.own.size() +
                    (again ? receivers_.sampled.size() + sample / kSamplesToOfNoise : sample),
                hits, rays);
        const bool met = std::ranges::any_of(hits, [&](const Hit& hit) {
            return surfaces.scene().primitives[surfaces.primitive(hit.triangle)].node !=
                   receivers_.instances[i].node;
        });
        if (!again)
            samples_.may_be_sealed[sample] = backs_of(surfaces, hits) >= kMinSealedBackShare * rays;
        if (met)
            std::atomic_ref(samples_.met[i]).store(1, std::memory_order_relaxed);
    };
    trace_receivers(tracers_.samples, plan_.receivers(), receivers, options, take, progress, sink);
    result_.rays += receivers.size() * static_cast<std::size_t>(rays);
}

/// Takes light of a sample, rotated into the frame of its mesh, from coefficient `first` of its vector on.
void InstanceLight::take_light(std::size_t sample, bool again, std::span<const float> light,
                               std::size_t first) {
    std::array<float, 3 * kMaxOrder * kMaxOrder> space;
    const std::span<float> rotated(space.data(), light.size());
    rotate_all(samples_.into_mesh[receivers_.instance_of_sample(sample)], sizes_.count, light, rotated);
    float* const before = &samples_.light[sample * sizes_.dimension + first];
    if (!again) {
        std::ranges::copy(rotated, before);
        return;
    }
    float* const differences = &samples_.differences[sample / kSamplesToOfNoise * sizes_.dimension + first];
    for (std::size_t i = 0; i < rotated.size(); ++i)
        differences[i] = std::numbers::sqrt2_v<float> / 2 * (before[i] - rotated[i]);
}

void InstanceLight::find_sealed_in(const Progress& progress) {
    const auto sealed_of = [&](std::vector<std::uint32_t> dark, int probes) {
        if (dark.empty())
            return std::vector<bool>();
        Sealed sealed = find_sealed(tracers_.samples, plan_.scene, plan_.receivers(), std::move(dark),
                                    plan_.options.seed, progress.stop, probes);
        result_.rays += sealed.rays;
        return std::move(sealed.receivers);
    };
    // Depth maps do not resolve the last hundredth of visibility.
    const float darkest =
        tracers_.own.method() == BakeMethod::trace ? 0.0f : 0.01f * static_cast<float>(kY00);
    std::vector<std::uint32_t> dark;
    for (std::size_t s = 0; s < receivers_.sampled.size(); ++s)
        if (samples_.light[s * sizes_.dimension] <= 0 && samples_.may_be_sealed[s])
            dark.push_back(receivers_.sampled[s]);
    if (const std::vector<bool> sealed = sealed_of(std::move(dark), kProbesOfSamples); !sealed.empty())
        for (std::size_t s = 0; s < receivers_.sampled.size(); ++s)
            samples_.left_out[s] = sealed[receivers_.sampled[s]];
    dark.clear();
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        if (own_.direct[o * sizes_.count] <= darkest)
            dark.push_back(receivers_.own[o]);
    const std::vector<bool> sealed = sealed_of(std::move(dark), kMaxProbes);
    if (std::ranges::find(sealed, true) != sealed.end() && plan_.options.repairs.inside == Inside::refill)
        bounce_.refill =
            Refill(MeshNeighbours(plan_.scene.surfaces(), plan_.receivers(), plan_.transport->fronts, sealed),
                   sealed);
}

} // namespace prt
