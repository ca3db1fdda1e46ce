// Light between instances: what is gathered at samples becomes factors, and factors the light of all
// vertices.

#include "instances/instance_light.h"

#include "instances/uniform_bound.h"

#include "prt/sh_rotation.h"
#include "prt/support/error.h"
#include "prt/support/parallel.h"
#include "prt/trace_receivers.h"
#include "scene/sealed.h"
#include "trace_gather.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

constexpr std::size_t kGatheredAtOnce = 1 << 14;
constexpr int kMostEndless = 200;     ///< bounces, where they are endless
constexpr double kLeastChange = 1e-4; ///< of the light of what is drawn once, where they end
constexpr int kSampleHitStride = 8;   ///< as kHitStride; samples are many for each factor

/// A vector of several channels, turned.
void turn_all(const ShRotation& turn, std::size_t count, std::span<const float> from, std::span<float> to) {
    for (std::size_t first = 0; first < from.size(); first += count)
        turn.apply(from.subspan(first, count), to.subspan(first, count));
}

} // namespace

InstanceLight::InstanceLight(const BakePlan& plan, Tracer& tracer, const std::vector<SharedMeshBake>& meshes,
                             InstanceReceivers receivers, const InstanceBakeOptions& options)
    : plan_(plan), tracer_(tracer), meshes_(meshes), receivers_(std::move(receivers)), options_(options) {
    const auto count = static_cast<std::size_t>(coefficient_count(plan.options.order)),
               stride = count * static_cast<std::size_t>(plan.channels);
    sizes_ = {count, stride, plan.bounces != 0 ? count + stride : count};
    own_.direct.resize(receivers_.own.size() * sizes_.count);
    samples_.left_out.resize(receivers_.sampled.size());
    samples_.met.resize(receivers_.instances.size());
    result_.factors.assign(receivers_.instances.size(), open_factors());
    result_.errors.resize(receivers_.instances.size());
    for (std::vector<float>& targets : samples_.targets)
        targets.resize(receivers_.sampled.size() * sizes_.dimension);
    if (plan.bounces != 0) {
        bounce_.gather.emplace(plan.scene.surfaces(), *plan.transport,
                               receivers_.own.size() + 2 * receivers_.sampled.size(), plan.channels);
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
    trace_own(progress.part(0, share));
    trace_samples(0, progress.part(share, 0.5 * (1 + share)));
    trace_samples(1, progress.part(0.5 * (1 + share), 1));
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

void InstanceLight::trace_samples(int half, const Progress& progress) {
    const int rays = std::max(1, static_cast<int>(std::lround(0.5 * options_.rays * plan_.options.rays)));
    // Whoever stands alone is seen by every ray; light that comes from surfaces needs fewer.
    const TraceOptions options{.order = plan_.options.order,
                               .rays = rays,
                               .seed = plan_.options.seed + 1 + static_cast<std::uint64_t>(half),
                               .hit_stride = bounce_.gather ? kSampleHitStride : 1};
    const Surfaces& surfaces = plan_.scene.surfaces();
    const auto take = [&](std::uint32_t r, std::span<const float> vector) {
        const std::size_t sample = receivers_.sample_of[r];
        const auto& instance = receivers_.instances[receivers_.instance_of_sample(sample)];
        const ShRotation back(options.order, glm::transpose(instance.rotation));
        back.apply(vector,
                   std::span(samples_.targets[half]).subspan(sample * sizes_.dimension, sizes_.count));
    };
    const auto sink = [&](std::uint32_t r, std::span<const Hit> hits) {
        const std::size_t sample = receivers_.sample_of[r], i = receivers_.instance_of_sample(sample);
        if (bounce_.gather)
            bounce_.gather->set_row(receivers_.own.size() + 2 * sample + static_cast<std::size_t>(half), hits,
                                    rays);
        const bool met = std::ranges::any_of(hits, [&](const Hit& hit) {
            return surfaces.scene().primitives[surfaces.primitive(hit.triangle)].node !=
                   receivers_.instances[i].node;
        });
        if (met)
            std::atomic_ref(samples_.met[i]).store(1, std::memory_order_relaxed);
    };
    trace_receivers(tracer_, plan_.receivers(), receivers_.sampled, options, take, progress, sink);
    result_.rays += receivers_.sampled.size() * static_cast<std::size_t>(rays);
}

void InstanceLight::find_sealed_in(const Progress& progress) {
    std::vector<std::uint32_t> dark;
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        if (own_.direct[o * sizes_.count] <= 0)
            dark.push_back(receivers_.own[o]);
    for (std::size_t s = 0; s < receivers_.sampled.size(); ++s)
        if (samples_.targets[0][s * sizes_.dimension] + samples_.targets[1][s * sizes_.dimension] <= 0)
            dark.push_back(receivers_.sampled[s]);
    if (dark.empty())
        return;
    Sealed sealed = find_sealed(tracer_, plan_.scene, plan_.receivers(), std::move(dark), plan_.options.seed,
                                progress.stop);
    result_.rays += sealed.rays;
    bool own = false;
    for (std::size_t s = 0; s < receivers_.sampled.size(); ++s) {
        samples_.left_out[s] = sealed.receivers[receivers_.sampled[s]];
        sealed.receivers[receivers_.sampled[s]] = false;
    }
    for (const std::uint32_t r : receivers_.own)
        own = own || sealed.receivers[r];
    if (own && plan_.options.repairs.inside == Inside::refill)
        bounce_.refill =
            Refill(MeshNeighbours(plan_.scene.surfaces(), plan_.receivers(), plan_.transport->fronts),
                   sealed.receivers);
}

void InstanceLight::bounce(const Progress& progress) {
    if (!bounce_.gather) {
        if (bounce_.refill.size() > 0) {
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
    for (std::size_t o = 0; o < receivers_.own.size(); ++o) // with no light but direct light
        for (std::size_t i = 0; i < sizes_.stride; ++i)
            exit_of(receivers_.own[o])[i] = own_.direct[o * sizes_.count + i % sizes_.count];
    bounce_.refill.apply(std::span(bounce_.exit), sizes_.stride);
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        std::copy_n(exit_of(receivers_.own[o]).begin(), sizes_.count, &own_.direct[o * sizes_.count]);
    fit(0, true);
    const bool endless = plan_.bounces == kEndlessBounces;
    const int most = endless ? kMostEndless : plan_.bounces;
    while (result_.bounces < most) {
        gather_light();
        ++result_.bounces;
        const double change = take_own();
        const bool last =
            result_.bounces == most || (endless && result_.bounces > 2 && change < kLeastChange);
        fit(endless ? 1 : static_cast<std::size_t>(result_.bounces), !last);
        if (last)
            break;
        progress.update(static_cast<double>(result_.bounces) / most);
    }
}

/// One bounce of all light: into the targets, and `own_.indirect`.
void InstanceLight::gather_light() {
    const int order = plan_.options.order, threads = plan_.options.threads;
    const std::size_t own = receivers_.own.size(), rows = bounce_.gather->rows();
    bounce_.gather->reflect(order, bounce_.exit, threads);
    std::vector<float> block(std::min(kGatheredAtOnce, rows) * sizes_.stride);
    for (std::size_t first = 0; first < rows; first += kGatheredAtOnce) {
        const std::span<float> some(block.data(), std::min(kGatheredAtOnce, rows - first) * sizes_.stride);
        bounce_.gather->apply(order, bounce_.exit, first, some, threads);
        parallel_for(some.size() / sizes_.stride, 256, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                const std::span<const float> light = some.subspan(row * sizes_.stride, sizes_.stride);
                if (const std::size_t r = first + row; r >= own)
                    take_row((r - own) / 2, static_cast<int>((r - own) % 2), light);
            }
        });
        // Later blocks still read what receivers gave before.
        for (std::size_t row = 0; row < some.size() / sizes_.stride && first + row < own; ++row)
            std::copy_n(&some[row * sizes_.stride], sizes_.stride, &own_.next[(first + row) * sizes_.stride]);
    }
}

void InstanceLight::take_row(std::size_t sample, int half, std::span<const float> row) {
    const auto& instance = receivers_.instances[receivers_.instance_of_sample(sample)];
    const ShRotation back(plan_.options.order, glm::transpose(instance.rotation));
    turn_all(
        back, sizes_.count, row,
        std::span(samples_.targets[half]).subspan(sample * sizes_.dimension + sizes_.count, sizes_.stride));
}

/// Takes what was gathered for what is drawn once; returns how much of its light changed.
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

/// Fits all instances to what their samples get, their meshes after so many steps of bounces. `gives`: their
/// light is wanted for another bounce.
void InstanceLight::fit(std::size_t step, bool gives) {
    for (const Group& group : groups_) {
        const SharedTransfer shared(meshes_[group.mesh].after[step], group.up, plan_.options.threads);
        const InstanceFit fit(shared, receivers_.samples[group.mesh], group.up);
        std::vector<glm::vec3> places;
        for (std::size_t r = 0; r < shared.receivers(); ++r)
            places.push_back(meshes_[group.mesh].place_of(r));
        const UniformBound bound(shared, places);
        parallel_for(
            group.instances.size(), 1, plan_.options.threads, [&](std::size_t begin, std::size_t end) {
                for (std::size_t g = begin; g < end; ++g) {
                    const std::size_t i = group.instances[g];
                    const auto& instance = receivers_.instances[i];
                    if (samples_.met[i]) {
                        const std::size_t first = instance.first_sample, samples = receivers_.samples_of(i);
                        const std::vector<bool> left_out(
                            samples_.left_out.begin() + static_cast<std::ptrdiff_t>(first),
                            samples_.left_out.begin() + static_cast<std::ptrdiff_t>(first + samples));
                        const InstanceFit::Fitted fitted =
                            fit.fit({std::span(samples_.targets[0])
                                         .subspan(first * sizes_.dimension, samples * sizes_.dimension),
                                     std::span(samples_.targets[1])
                                         .subspan(first * sizes_.dimension, samples * sizes_.dimension),
                                     left_out});
                        result_.factors[i] =
                            in_axes_of_world(bound.bounded(fitted.factors), instance.rotation);
                        result_.errors[i] = fitted.error;
                    }
                    if (gives)
                        expand(shared, i);
                }
            });
    }
}

/// Writes the light that an instance gives to all its receivers.
void InstanceLight::expand(const SharedTransfer& shared, std::size_t instance) {
    const auto& placed = receivers_.instances[instance];
    const InstanceFactors factors = in_axes_of_mesh(result_.factors[instance], placed.rotation);
    const ShRotation turn(plan_.options.order, placed.rotation);
    std::vector<float> vector(sizes_.dimension);
    for (std::size_t p = 0; p < placed.receivers.size(); ++p) {
        if (placed.receivers[p] == kNoReceiver)
            continue;
        shared.sum(p, mode_factors(factors, meshes_[placed.mesh].place_of(p)), vector);
        for (std::size_t i = sizes_.count; i < sizes_.dimension; ++i)
            vector[i] += vector[(i - sizes_.count) % sizes_.count];
        turn_all(turn, sizes_.count, std::span<const float>(vector).subspan(sizes_.count),
                 exit_of(placed.receivers[p]));
    }
}

Transfer InstanceLight::own_fronts(int direct_channels) const {
    const std::size_t all = plan_.receivers().size();
    TransferLayout layout = layout_of_one(plan_.options.order, 1, PartKind::direct);
    if (bounce_.gather)
        layout.parts.push_back({PartKind::indirect, plan_.channels});
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
    const Transfer fronts = of_fronts(plan_, own, direct_channels); // by both sides of thin sheets
    Transfer result = zero_transfer(fronts.layout, receivers_.own.size());
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        if (receivers_.own[o] < plan_.transport->fronts)
            std::ranges::copy(fronts.vector(receivers_.own[o]), result.vector(o).begin());
    return result;
}

} // namespace prt
