// Propagates light between instances: light gathered at samples determines factors, and factors determine the
// light at all vertices.

#include "bake/products/instances/instance_light.h"

#include "bake/products/instances/own_fit.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace prt {
namespace {

constexpr std::size_t kGatheredAtOnce = 1 << 14;
constexpr std::size_t kExpandedAtOnce = 8; ///< instances that are processed together for each vertex of their
                                           ///< mesh
constexpr int kMaxEndlessBounces = 200;    ///< maximum number of endless bounces
constexpr double kMinChange = 1e-4;        ///< relative change of light on surfaces drawn once, below which
                                           ///< endless bounces stop
constexpr float kMinExcess = 1e-6f;        ///< relative excess over incident light that is more than rounding

} // namespace

void rotate_all(const ShRotation& rotation, std::size_t count, std::span<const float> from,
                std::span<float> to) {
    for (std::size_t first = 0; first < from.size(); first += count)
        rotation.apply(from.subspan(first, count), to.subspan(first, count));
}

InstanceLight::InstanceLight(const BakePlan& plan, const InstanceTracers& tracers,
                             const std::vector<SharedMeshBake>& meshes, InstanceReceivers receivers,
                             const InstanceBakeOptions& options)
    : plan_(plan), tracers_(tracers), meshes_(meshes), receivers_(std::move(receivers)), options_(options) {
    const auto count = static_cast<std::size_t>(coefficient_count(plan.options.order)),
               stride = count * static_cast<std::size_t>(plan.channels);
    sizes_ = {count, stride, has_rest(plan) ? count + stride : count};
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
        own_.next.resize(receivers_.own.size() * sizes_.stride);
    }
    if (has_rest(plan)) {
        own_.indirect.resize(receivers_.own.size() * sizes_.stride);
        bounce_.exit.resize(plan.receivers().size() * sizes_.stride);
    }
    for (const DiffusionOperator& body : plan.diffusion)
        if (std::ranges::any_of(body.members(),
                                [&](std::uint32_t r) { return receivers_.own_of[r] != kNoReceiver; }))
            bounce_.media.push_back(&body);
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

/// Converts light that arrives at surfaces drawn once to light that leaves them.
void InstanceLight::leave_own() {
    bounce_.refill.apply(std::span(bounce_.exit), sizes_.stride);
    for (const DiffusionOperator* const body : bounce_.media)
        body->apply(plan_.channels, plan_.options.order, bounce_.exit, plan_.options.threads);
}

/// Computes the light of surfaces drawn once without bounces: the only light is direct light.
void InstanceLight::begin_bounces() {
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        for (std::size_t i = 0; i < sizes_.stride; ++i)
            exit_of(receivers_.own[o])[i] = own_.direct[o * sizes_.count + i % sizes_.count];
    leave_own();
    std::vector<bool> in_medium(plan_.receivers().size());
    for (const DiffusionOperator* const body : bounce_.media)
        for (const std::uint32_t r : body->members())
            in_medium[r] = true;
    if (!bounce_.media.empty())
        own_.scattered.resize(receivers_.own.size() * sizes_.stride);
    for (std::size_t o = 0; o < receivers_.own.size(); ++o) {
        const std::span<const float> exit = exit_of(receivers_.own[o]);
        const std::span<float> direct = std::span(own_.direct).subspan(o * sizes_.count, sizes_.count);
        if (in_medium[receivers_.own[o]]) { // all of its light passes the medium
            std::ranges::copy(exit, &own_.scattered[o * sizes_.stride]);
            std::ranges::fill(direct, 0.0f);
        } else {
            std::ranges::copy(exit.first(sizes_.count), direct.begin());
        }
    }
    own_.indirect = own_.scattered;
    own_.indirect.resize(receivers_.own.size() * sizes_.stride);
}

/// Fills surfaces drawn once that are inside geometry, if no light bounces.
void InstanceLight::refill_direct() {
    if (bounce_.refill.empty())
        return;
    std::vector<float> all(plan_.receivers().size() * sizes_.count);
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        std::copy_n(&own_.direct[o * sizes_.count], sizes_.count, &all[receivers_.own[o] * sizes_.count]);
    bounce_.refill.apply(std::span(all), sizes_.count);
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        std::copy_n(&all[receivers_.own[o] * sizes_.count], sizes_.count, &own_.direct[o * sizes_.count]);
}

void InstanceLight::bounce(const Progress& progress) {
    if (has_rest(plan_))
        begin_bounces();
    else
        refill_direct();
    if (!bounce_.gather) {
        fit(0, false);
        return;
    }
    fit(0, true);
    const bool endless = plan_.bounces == kEndlessBounces;
    const int most = endless ? kMaxEndlessBounces : plan_.bounces;
    while (result_.bounces < most) {
        if (plan_.options.fit == FitMode::surface)
            bounce_.last = bounce_.exit;
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

void InstanceLight::fit_own(const Progress& progress) {
    if (receivers_.own.empty())
        return;
    const OwnFit fit(plan_, tracers_.own, receivers_, progress);
    const FittedTransfer light = fit.light(std::move(bounce_.last), bounce_.media, {{}, progress.stop});
    result_.rays += fit.rays();
    result_.sampling_error = fit.sampling_error();
    for (std::size_t o = 0; o < receivers_.own.size(); ++o) {
        const std::span<const float> direct = light.direct.vector(receivers_.own[o]),
                                     all = light.all.vector(receivers_.own[o]);
        std::ranges::copy(direct, &own_.direct[o * sizes_.count]);
        for (std::size_t i = 0; i < own_.indirect.size() / receivers_.own.size(); ++i)
            own_.indirect[o * sizes_.stride + i] = all[i] - direct[i % sizes_.count];
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
    leave_own();
    double changed = 0, all = 1e-30;
    for (std::size_t o = 0; o < receivers_.own.size(); ++o)
        for (std::size_t i = 0; i < sizes_.stride; ++i) {
            float& now = exit_of(receivers_.own[o])[i];
            float& before = own_.indirect[o * sizes_.stride + i];
            if (!own_.scattered.empty())
                now += own_.scattered[o * sizes_.stride + i];
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
        const SharedMeshBake& mesh = meshes_[group.mesh];
        const Transfer &exit = gives ? mesh.after[step] : mesh.stored(), &arrives = mesh.at_samples(step);
        const SharedTransfer shared(exit, group.up, plan_.options.threads);
        std::optional<SharedTransfer> arriving;
        if (&arrives != &exit)
            arriving.emplace(arrives, group.up, plan_.options.threads);
        const SharedTransfer& at_samples = arriving ? *arriving : shared;
        const InstanceFit fit(at_samples, receivers_.samples[group.mesh], group.up);
        std::vector<glm::vec3> positions;
        for (std::size_t r = 0; r < shared.receivers(); ++r)
            positions.push_back(mesh.position_of(r));
        UniformBound& bound = bounds.emplace_back(shared, positions);
        parallel_for(group.instances.size(), kExpandedAtOnce, plan_.options.threads,
                     [&](std::size_t begin, std::size_t end) {
                         const std::span some = std::span(group.instances).subspan(begin, end - begin);
                         for (const std::size_t i : some)
                             if (samples_.met[i]) {
                                 fit_one(fit, bound, i);
                                 if (!gives)
                                     result_.errors[i] = error_of(fit, at_samples, i);
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
    const bool rest = has_rest(plan_);
    if (rest)
        layout.terms.push_back({TermKind::indirect, plan_.channels});
    const bool transmits = plan_.scene.surfaces().traits().transmission;
    Transfer own = zero_transfer(layout, transmits ? all : receivers_.own.size());
    for (std::size_t o = 0; o < receivers_.own.size(); ++o) {
        const std::span<float> to = own.vector(transmits ? receivers_.own[o] : o);
        std::copy_n(&own_.direct[o * sizes_.count], sizes_.count, to.begin());
        if (rest)
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
