// Finds receivers inside geometry by the surfaces that their rays hit.

#include "bake/trace/sealed.h"

#include "bake/trace/trace_receivers.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

constexpr double kMinBackShare = 0.98; ///< minimum share of all rays; among loose sheets it can reach nine
                                       ///< tenths
constexpr float kNotSealed = -1;
constexpr int kFirstRays = 16; ///< rays per receiver in the first round

/// Decides for groups of neighbours after the first round. The rays of the receivers in a group add up to
/// `probes`. If 98 % of these rays hit backs, all receivers of the group are sealed in and move from
/// `candidates` to `sealed`. `backs`: rays of each receiver that hit backs.
void accept_groups(const std::vector<float>& backs, int probes, std::vector<std::uint32_t>& candidates,
                   std::vector<bool>& sealed) {
    const auto size = static_cast<std::size_t>((probes + kFirstRays - 1) / kFirstRays);
    const double needed = kMinBackShare * kFirstRays * static_cast<double>(size);
    std::vector<std::uint32_t> left;
    for (std::size_t begin = 0; begin < candidates.size(); begin += size) {
        const auto group = std::span(candidates).subspan(begin, std::min(size, candidates.size() - begin));
        double sum = 0;
        for (const std::uint32_t p : group)
            sum += static_cast<double>(backs[p]);
        if (group.size() < size || sum < needed)
            left.insert(left.end(), group.begin(), group.end());
        else
            for (const std::uint32_t p : group)
                sealed[p] = true;
    }
    candidates = std::move(left);
}

} // namespace

double max_dark(const Tracer& tracer) {
    return tracer.method() == BakeMethod::raster ? 0.01 * kY00 : 0;
}

double backs_of(const Surfaces& surfaces, std::span<const Hit> hits) {
    double backs = 0;
    for (const Hit& hit : hits)
        if (hit.back && !surfaces.two_sided(hit.triangle))
            backs += static_cast<double>(hit.weight);
    return backs;
}

bool looks_sealed(const Surfaces& surfaces, std::span<const Hit> hits, int rays, bool maybe) {
    constexpr double kRounding = 1e-3; // rounding of the weights, in rays
    double ended = 0;
    for (const Hit& hit : hits)
        ended += static_cast<double>(hit.weight);
    // With few rays more fronts may be hit by chance.
    const double by_chance = maybe ? 3 * std::sqrt((1 - kMinBackShare) * rays) : 0;
    return ended > rays - kRounding && backs_of(surfaces, hits) >= kMinBackShare * rays - by_chance;
}

Sealed find_sealed(Tracer& tracer, const TraceScene& scene, const Receivers& receivers,
                   std::vector<std::uint32_t> dark, std::uint64_t seed, const std::stop_token& stop,
                   int probes) {
    Sealed result{std::vector<bool>(receivers.size()), 0};
    std::vector<float> backs(receivers.size(), kNotSealed); // for receivers that may be sealed
    // Traces few rays for all receivers, and more for receivers that may be sealed.
    for (const int some : {kFirstRays, 64, 256, probes}) {
        const bool last = some >= probes;
        const int rays = last ? probes : some;
        Transfer unused = zero_transfer(1, 1, receivers.size());
        trace_receivers(tracer.rays(), receivers, dark, {.order = 1, .rays = rays, .seed = seed}, unused,
                        {{}, stop}, [&](std::uint32_t p, std::span<const Hit> hits) {
                            backs[p] = looks_sealed(scene.surfaces(), hits, rays, !last)
                                           ? static_cast<float>(backs_of(scene.surfaces(), hits))
                                           : kNotSealed;
                        });
        result.rays += dark.size() * static_cast<std::size_t>(rays);
        std::erase_if(dark, [&](std::uint32_t p) { return backs[p] == kNotSealed; });
        if (last)
            break;
        // Later rounds decide for each receiver alone: groups there missed small holes.
        if (rays == kFirstRays)
            accept_groups(backs, probes, dark, result.receivers);
    }
    for (const std::uint32_t p : dark)
        result.receivers[p] = true;
    return result;
}

} // namespace prt
