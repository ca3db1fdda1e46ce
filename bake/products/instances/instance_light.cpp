// Propagates light between instances: light gathered at samples determines factors, and factors determine the
// light at all vertices.

#include "bake/products/instances/instance_light.h"

#include "bake/pipeline/trace_gather.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"
#include "runtime/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr std::size_t kGatheredAtOnce = 1 << 14;
constexpr std::size_t kExpandedAtOnce = 8; ///< instances that are processed together for each vertex of their
                                           ///< mesh
constexpr int kMaxEndlessBounces = 200;    ///< maximum number of endless bounces
constexpr double kMinChange = 1e-4;        ///< relative change of light on surfaces drawn once, below which
                                           ///< endless bounces stop
/// The purpose of kHitStride, for samples: there are many of them per factor.
constexpr int kSampleHitStride = 8;
constexpr int kMinSampleRays = 16;
/// Minimum share of a sample's rays that end at backs for it to be a candidate. The rays are few; at sealed
/// samples 98 of 100 end at backs.
constexpr double kMinSealedBackShare = 0.5;
constexpr float kMinExcess = 1e-6f;   ///< relative excess over incident light that is more than rounding
constexpr int kProbesOfSamples = 128; ///< rays per sample; if a sample is sealed in, the other samples of its
                                      ///< instance determine the factors

/// Rotates a vector of one or several channels.
void rotate_all(const ShRotation& rotation, std::size_t count, std::span<const float> from,
                std::span<float> to) {
    for (std::size_t first = 0; first < from.size(); first += count)
        rotation.apply(from.subspan(first, count), to.subspan(first, count));
}

} // namespace

InstanceLight::InstanceLight(const BakePlan& plan, Tracer& tracer, const std::vector<SharedMeshBake>& meshes,
                             InstanceReceivers receivers, const InstanceBakeOptions& options)
    : plan_(plan), tracer_(tracer), meshes_(meshes), receivers_(std::move(receivers)), options_(options) {
    const auto count = static_cast<std::size_t>(coefficient_count(plan.options.order)),
               stride = count * static_cast<std::size_t>(plan.channels);
    sizes_ = {count, stride, plan.bounces != 0 ? count + stride : count};
    own_.direct.resize(receivers_.own.size() * sizes_.count);
    const std::size_t samples = receivers_.sampled.size(),
                      noisy = (samples + kSamplesToOfNoise - 1) / kSamplesToOfNoise;
    samples_.left_out.resize(samples);
    samples_.may_be_sealed.resize(samples);
    samples_.met.resize(receivers_.instances.size());
    result_.factors.assign(receivers_.instances.size(), open_factors());
    result_.errors.resize(receivers_.instances.size());
    samples_.light.resize(samples * sizes_.dimension);
    samples_.differences.resize(noisy * sizes_.dimension);
    for (const InstanceReceivers::Instance& instance : receivers_.instances)
        samples_.into_mesh.emplace_back(plan.options.order, glm::transpose(instance.rotation));
    if (plan.bounces != 0) {
        bounce_.gather.emplace(plan.scene.surfaces(), *plan.transport,
                               receivers_.own.size() + samples + noisy, plan.channels);
        own_.indirect.resize(receivers_.own.size() * sizes_.stride);
        own_.next.resize(own_.indirect.size());
        bounce_.exit.resize(plan.receivers().size() * sizes_.stride);
    }
    make_groups();
}

void InstanceLight::make_groups() {
    constexpr double kSame = 1e-5;
    for (std::size_t i = 0; i < receivers_.instances.size(); ++i) {
        const InstanceReceivers::Instance& instance = receivers_.instances[i];
        const glm::dvec3 up = glm::normalize(glm::transpose(instance.rotation) * glm::dvec3(0, 1, 0));
        const auto same = std::ranges::find_if(groups_, [&](const Group& group) {
            return group.mesh == instance.mesh && glm::distance(group.up, up) < kSame;
        });
        if (same != groups_.end())
            same->instances.push_back(i);
        else
            groups_.push_back({instance.mesh, up, {i}});
    }
}

std::size_t InstanceLight::alone() const {
    return static_cast<std::size_t>(std::ranges::count(samples_.met, 0));
}

void InstanceLight::trace(const Progress& progress) {
    const auto own = static_cast<double>(receivers_.own.size()),
               samples = static_cast<double>(receivers_.sampled.size()) * options_.rays;
    const double share = own / std::max(1.0, own + samples);
    trace_own(progress.range(0, share));
    trace_samples(progress.range(share, 1));
    find_sealed_in(progress);
}

void InstanceLight::trace_own(const Progress& progress) {
    TraceOptions options = gather_options(plan_, static_cast<std::uint32_t>(plan_.options.rays));
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
    trace_receivers(tracer_, plan_.receivers(), receivers_.own, options, take, progress, sink);
    result_.rays += receivers_.own.size() * static_cast<std::size_t>(options.rays);
}

/// Traces all samples, and some of them twice to estimate the noise. Two halves of the same rays do not
/// suffice: a half is less evenly distributed, and its noise is more than 50 % larger.
void InstanceLight::trace_samples(const Progress& progress) {
    std::vector<std::uint32_t> noisy;
    for (std::size_t s = 0; s < receivers_.sampled.size(); s += kSamplesToOfNoise)
        noisy.push_back(receivers_.sampled[s]);
    const int rays =
        std::max(kMinSampleRays, static_cast<int>(std::lround(options_.rays * plan_.options.rays)));
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
    trace_receivers(tracer_, plan_.receivers(), receivers, options, take, progress, sink);
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
        Sealed sealed = find_sealed(tracer_, plan_.scene, plan_.receivers(), std::move(dark),
                                    plan_.options.seed, progress.stop, probes);
        result_.rays += sealed.rays;
        return std::move(sealed.receivers);
    };
    std::vector<std::uint32_t> dark;
    for (std::size_t s = 0; s < receivers_.sampled.size(); ++s)
        if (samples_.light[s * sizes_.dimension] <= 0 && samples_.may_be_sealed[s])
            dark.push_back(receivers_.sampled[s]);
    if (const std::vector<bool> sealed = sealed_of(std::move(dark), kProbesOfSamples); !sealed.empty())
        for (std::size_t s = 0; s < receivers_.sampled.size(); ++s)
            samples_.left_out[s] = sealed[receivers_.sampled[s]];
    dark.clear();
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        if (own_.direct[o * sizes_.count] <= 0)
            dark.push_back(receivers_.own[o]);
    const std::vector<bool> sealed = sealed_of(std::move(dark), kMaxProbes);
    if (std::ranges::find(sealed, true) != sealed.end() && plan_.options.repairs.inside == Inside::refill)
        bounce_.refill =
            Refill(MeshNeighbours(plan_.scene.surfaces(), plan_.receivers(), plan_.transport->fronts, sealed),
                   sealed);
}

void InstanceLight::bounce(const Progress& progress) {
    if (!bounce_.gather) {
        if (!bounce_.refill.empty()) {
            std::vector<float> all(plan_.receivers().size() * sizes_.count);
            for (std::size_t o = 0; o < receivers_.own.size(); ++o)
                std::copy_n(&own_.direct[o * sizes_.count], sizes_.count,
                            &all[receivers_.own[o] * sizes_.count]);
            bounce_.refill.apply(std::span(all), sizes_.count);
            for (std::size_t o = 0; o < receivers_.own.size(); ++o)
                std::copy_n(&all[receivers_.own[o] * sizes_.count], sizes_.count,
                            &own_.direct[o * sizes_.count]);
        }
        fit(0, false);
        return;
    }
    for (std::size_t o = 0; o < receivers_.own.size(); ++o) // the only light is direct light
        for (std::size_t i = 0; i < sizes_.stride; ++i)
            exit_of(receivers_.own[o])[i] = own_.direct[o * sizes_.count + i % sizes_.count];
    bounce_.refill.apply(std::span(bounce_.exit), sizes_.stride);
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        std::copy_n(exit_of(receivers_.own[o]).begin(), sizes_.count, &own_.direct[o * sizes_.count]);
    fit(0, true);
    const bool endless = plan_.bounces == kEndlessBounces;
    const int most = endless ? kMaxEndlessBounces : plan_.bounces;
    while (result_.bounces < most) {
        gather_light();
        ++result_.bounces;
        const double change = take_own();
        const bool last = result_.bounces == most || (endless && result_.bounces > 2 && change < kMinChange);
        fit(endless ? 1 : static_cast<std::size_t>(result_.bounces), !last);
        if (last)
            break;
        progress.update(static_cast<double>(result_.bounces) / most);
    }
}

/// Computes one bounce of all light: to the samples, and to `own_.next`.
void InstanceLight::gather_light() {
    bounce_.gather->reflect(plan_.options.order, bounce_.exit, plan_.options.threads);
    const std::size_t own = receivers_.own.size(), samples = receivers_.sampled.size();
    gather_rows(0, own, [&](std::size_t o, std::span<const float> light) {
        std::ranges::copy(light, &own_.next[o * sizes_.stride]);
    });
    gather_rows(own, samples, [&](std::size_t sample, std::span<const float> light) {
        take_light(sample, false, light, sizes_.count);
    });
    gather_rows(own + samples, bounce_.gather->rows() - own - samples,
                [&](std::size_t noisy, std::span<const float> light) {
                    take_light(noisy * kSamplesToOfNoise, true, light, sizes_.count);
                });
}

/// Calls `take(row - first, light)` for each row from several threads.
template <class Take>
void InstanceLight::gather_rows(std::size_t first, std::size_t rows, const Take& take) {
    std::vector<float> block(std::min(kGatheredAtOnce, rows) * sizes_.stride);
    for (std::size_t done = 0; done < rows; done += kGatheredAtOnce) {
        const std::span<float> some(block.data(), std::min(kGatheredAtOnce, rows - done) * sizes_.stride);
        bounce_.gather->apply(plan_.options.order, bounce_.exit, first + done, some, plan_.options.threads);
        parallel_for(some.size() / sizes_.stride, 256, plan_.options.threads,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t row = begin; row < end; ++row)
                             take(done + row,
                                  std::span<const float>(some).subspan(row * sizes_.stride, sizes_.stride));
                     });
    }
}

/// Takes the light gathered on surfaces that are drawn once; returns its relative change.
double InstanceLight::take_own() {
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        std::copy_n(&own_.next[o * sizes_.stride], sizes_.stride, exit_of(receivers_.own[o]).begin());
    bounce_.refill.apply(std::span(bounce_.exit), sizes_.stride);
    double changed = 0, all = 1e-30;
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        for (std::size_t i = 0; i < sizes_.stride; ++i) {
            float& now = exit_of(receivers_.own[o])[i];
            float& before = own_.indirect[o * sizes_.stride + i];
            changed += std::pow(static_cast<double>(now - before), 2);
            before = now;
            now += own_.direct[o * sizes_.count + i % sizes_.count];
            all += std::pow(static_cast<double>(now), 2);
        }
    return std::sqrt(changed / all);
}

/// Fits all instances to the light of their samples; their meshes have `step` steps of bounces. `gives`:
/// compute the light of the instances for another bounce; otherwise compute their errors.
void InstanceLight::fit(std::size_t step, bool gives) {
    std::vector<UniformBound> bounds; // [groups]
    bounds.reserve(groups_.size());
    for (const Group& group : groups_) {
        const SharedTransfer shared(meshes_[group.mesh].after[step], group.up, plan_.options.threads);
        const InstanceFit fit(shared, receivers_.samples[group.mesh], group.up);
        std::vector<glm::vec3> positions;
        for (std::size_t r = 0; r < shared.receivers(); ++r)
            positions.push_back(meshes_[group.mesh].position_of(r));
        UniformBound& bound = bounds.emplace_back(shared, positions);
        parallel_for(group.instances.size(), kExpandedAtOnce, plan_.options.threads,
                     [&](std::size_t begin, std::size_t end) {
                         const std::span some = std::span(group.instances).subspan(begin, end - begin);
                         for (const std::size_t i : some)
                             if (samples_.met[i]) {
                                 fit_one(fit, bound, i);
                                 if (!gives)
                                     result_.errors[i] = error_of(fit, shared, i);
                             }
                         for (std::size_t first = 0; gives && first < some.size(); first += kExpandedAtOnce)
                             expand(shared, positions,
                                    some.subspan(first, std::min(kExpandedAtOnce, some.size() - first)));
                     });
        if (gives) {
            bounds.clear();
            continue;
        }
        std::vector<InstanceFactors> found;
        for (const std::size_t i : group.instances)
            if (samples_.met[i])
                found.push_back(in_axes_of_mesh(result_.factors[i], receivers_.instances[i].rotation));
        bound.keep_near(found); // there are many groups if every instance has a different orientation
    }
    if (!gives)
        bound_as_stored(bounds);
}

/// Scales factors down until they add no energy after quantisation to bytes.
void InstanceLight::bound_as_stored(const std::vector<UniformBound>& bounds) {
    constexpr int kMaxRounds = 16; // all instances share the scales of bytes, which change if one of them
                                   // changes
    for (int round = 0; round < kMaxRounds; ++round) {
        const std::vector<InstanceFactors> stored = decoded(coded(result_.factors));
        std::atomic<bool> changed = false;
        for (std::size_t g = 0; g < groups_.size(); ++g)
            parallel_for(groups_[g].instances.size(), kExpandedAtOnce, plan_.options.threads,
                         [&](std::size_t begin, std::size_t end) {
                             for (std::size_t j = begin; j < end; ++j) {
                                 const std::size_t i = groups_[g].instances[j];
                                 if (!samples_.met[i])
                                     continue;
                                 const float share = bounds[g].share(
                                     in_axes_of_mesh(stored[i], receivers_.instances[i].rotation));
                                 if (share > 1 - kMinExcess)
                                     continue;
                                 result_.factors[i] = scaled(result_.factors[i], share);
                                 changed = true;
                             }
                         });
        if (!changed)
            return;
    }
}

/// [samples of the instance] samples that are ignored
std::vector<bool> InstanceLight::left_out_of(std::size_t instance) const {
    const auto first =
        samples_.left_out.begin() + static_cast<std::ptrdiff_t>(receivers_.instances[instance].first_sample);
    return {first, first + static_cast<std::ptrdiff_t>(receivers_.samples_of(instance))};
}

InstanceFit::Targets InstanceLight::targets_of(std::size_t instance,
                                               const std::vector<bool>& left_out) const {
    const std::size_t first = receivers_.instances[instance].first_sample;
    return {std::span(samples_.light)
                .subspan(first * sizes_.dimension, receivers_.samples_of(instance) * sizes_.dimension),
            left_out};
}

void InstanceLight::fit_one(const InstanceFit& fit, const UniformBound& bound, std::size_t instance) {
    const std::vector<bool> left_out = left_out_of(instance);
    result_.factors[instance] = in_axes_of_world(fit.fit(targets_of(instance, left_out), &bound),
                                                 receivers_.instances[instance].rotation);
}

double InstanceLight::error_of(const InstanceFit& fit, const SharedTransfer& shared,
                               std::size_t instance) const {
    const auto& placed = receivers_.instances[instance];
    const std::vector<bool> left_out = left_out_of(instance);
    const std::size_t first = placed.first_sample,
                      noisy = (first + kSamplesToOfNoise - 1) / kSamplesToOfNoise;
    std::vector<Lighting> lights = options_.lights;
    for (Lighting& light : lights) {
        const auto rotation = [&](Light& term) {
            term = truncated(term, plan_.options.order);
            samples_.into_mesh[instance].apply(std::span(term.coefficients));
        };
        rotation(light.sky);
        if (light.suns)
            rotation(*light.suns);
    }
    return fit.error(shared, targets_of(instance, left_out),
                     {std::span<const float>(samples_.differences).subspan(noisy * sizes_.dimension),
                      noisy * kSamplesToOfNoise - first},
                     in_axes_of_mesh(result_.factors[instance], placed.rotation), lights);
}

/// Writes the exit light of some instances of a mesh for all their receivers.
void InstanceLight::expand(const SharedTransfer& shared, std::span<const glm::vec3> positions,
                           std::span<const std::size_t> instances) {
    std::vector<InstanceFactors> factors;
    std::vector<ShRotation> rotations;
    for (const std::size_t i : instances) {
        const glm::dmat3& rotation = receivers_.instances[i].rotation;
        factors.push_back(in_axes_of_mesh(result_.factors[i], rotation));
        rotations.emplace_back(plan_.options.order, rotation);
    }
    std::vector<float> vector(sizes_.dimension);
    for (std::size_t p = 0; p < positions.size(); ++p)
        for (std::size_t i = 0; i < instances.size(); ++i) {
            const std::uint32_t receiver = receivers_.instances[instances[i]].receivers[p];
            if (receiver == kNoReceiver)
                continue;
            shared.sum(p, mode_factors(factors[i], positions[p]), vector);
            for (std::size_t first = sizes_.count; first < sizes_.dimension; first += sizes_.count)
                for (std::size_t k = 0; k < sizes_.count; ++k)
                    vector[first + k] += vector[k];
            rotate_all(rotations[i], sizes_.count, std::span<const float>(vector).subspan(sizes_.count),
                       exit_of(receiver));
        }
}

Transfer InstanceLight::own_fronts(int direct_channels) const {
    const std::size_t all = plan_.receivers().size();
    TransferLayout layout = layout_of_one(plan_.options.order, 1, TermKind::direct);
    if (bounce_.gather)
        layout.terms.push_back({TermKind::indirect, plan_.channels});
    const bool transmits = plan_.scene.surfaces().traits().transmission;
    Transfer own = zero_transfer(layout, transmits ? all : receivers_.own.size());
    for (std::size_t o = 0; o < receivers_.own.size(); ++o) {
        const std::span<float> to = own.vector(transmits ? receivers_.own[o] : o);
        std::copy_n(&own_.direct[o * sizes_.count], sizes_.count, to.begin());
        if (bounce_.gather)
            std::copy_n(&own_.indirect[o * sizes_.stride], sizes_.stride,
                        to.begin() + static_cast<std::ptrdiff_t>(sizes_.count));
    }
    if (!transmits)
        return own;
    const Transfer fronts = of_fronts(plan_, own, direct_channels); // from both sides of thin sheets
    Transfer result = zero_transfer(fronts.layout, receivers_.own.size());
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        if (receivers_.own[o] < plan_.transport->fronts)
            std::ranges::copy(fronts.vector(receivers_.own[o]), result.vector(o).begin());
    return result;
}

} // namespace prt
