// Finds receivers inside geometry by what their rays end on.

#include "scene/sealed.h"

#include "prt/trace_receivers.h"
#include "trace/embree_tracer.h"

#include <cmath>
#include <optional>

namespace prt {
namespace {

constexpr double kLeastBacks = 0.98; ///< of all rays; among loose sheets nine of ten may be

} // namespace

double backs_of(const Surfaces& surfaces, std::span<const Hit> hits) {
    double backs = 0;
    for (const Hit& hit : hits)
        if (hit.back && !surfaces.two_sided(hit.triangle))
            backs += static_cast<double>(hit.weight);
    return backs;
}

bool looks_sealed(const Surfaces& surfaces, std::span<const Hit> hits, int rays, bool maybe) {
    constexpr double kRounding = 1e-3; // of the weights, in rays
    double ended = 0;
    for (const Hit& hit : hits)
        ended += static_cast<double>(hit.weight);
    // Of few rays more may meet a front by chance.
    const double by_chance = maybe ? 3 * std::sqrt((1 - kLeastBacks) * rays) : 0;
    return ended > rays - kRounding && backs_of(surfaces, hits) >= kLeastBacks * rays - by_chance;
}

Sealed find_sealed(Tracer& tracer, const TraceScene& scene, const Receivers& receivers,
                   std::vector<std::uint32_t> dark, std::uint64_t seed, const std::stop_token& stop,
                   int probes) {
    Sealed result{std::vector<bool>(receivers.size()), 0};
    std::optional<EmbreeTracer> on_cpu;
    Tracer& prober = tracer.notes_hits() ? tracer : on_cpu.emplace(scene);
    // Few rays for all of them, more for those that may be.
    std::vector<std::uint8_t> sealed(receivers.size(), 0); // bytes, as several threads write
    for (const int some : {16, 128, probes}) {
        const bool last = some >= probes;
        const int rays = last ? probes : some;
        Transfer unused = zero_transfer(1, 1, receivers.size());
        trace_receivers(prober, receivers, dark, {.order = 1, .rays = rays, .seed = seed}, unused, {{}, stop},
                        [&](std::uint32_t p, std::span<const Hit> hits) {
                            sealed[p] = looks_sealed(scene.surfaces(), hits, rays, !last);
                        });
        result.rays += dark.size() * static_cast<std::size_t>(rays);
        std::erase_if(dark, [&](std::uint32_t p) { return sealed[p] == 0; });
        if (last)
            break;
    }
    for (const std::uint32_t p : dark)
        result.receivers[p] = true;
    return result;
}

} // namespace prt
