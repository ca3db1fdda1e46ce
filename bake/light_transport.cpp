#include "light_transport.h"

#include "prt/bake.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Largest norm of a receiver's vector of one channel.
double largest_norm(std::span<const float> vectors, std::size_t coefficients) {
    double largest = 0;
    for (std::size_t begin = 0; begin < vectors.size(); begin += coefficients) {
        float sum = 0;
        for (std::size_t k = 0; k < coefficients; ++k)
            sum += vectors[begin + k] * vectors[begin + k];
        largest = std::max(largest, static_cast<double>(sum));
    }
    return std::sqrt(largest);
}

void exit_from_incident(const TransportOperators& operators, int order, int channels,
                        std::span<float> vectors, int threads) {
    const int coefficients = coefficient_count(order);
    operators.refill.apply(vectors, static_cast<std::size_t>(channels * coefficients));
    for (const DiffusionOperator& diffusion : operators.diffusion)
        diffusion.apply(channels, order, vectors, threads);
}

} // namespace

BounceResult propagate(Transfer& transfer, const TransportOperators& operators, int bounces, int threads,
                       const Progress& progress) {
    const int order = transfer.order, channels = transfer.channels;
    const auto coefficients = static_cast<std::size_t>(coefficient_count(order));
    BounceResult result;
    exit_from_incident(operators, order, channels, transfer.vectors, threads);
    if (!operators.gather || bounces == 0)
        return result;

    // Enclosures of albedo 1 that hardly any light leaves converge slowly; this many bounces take seconds.
    constexpr int kMostBounces = 10000;
    const bool endless = bounces == kEndlessBounces;
    std::vector<float> now = transfer.vectors, next(now.size());
    double before = largest_norm(now, coefficients);
    const double first = before;
    while (result.bounces < (endless ? kMostBounces : bounces)) {
        operators.gather->apply(order, now, next, threads);
        exit_from_incident(operators, order, channels, next, threads);
        for (std::size_t i = 0; i < next.size(); ++i)
            transfer.vectors[i] += next[i];
        std::swap(now, next);
        ++result.bounces;
        const double energy = largest_norm(now, coefficients);
        const double ratio = before > 0 ? energy / before : 0;
        const double total = largest_norm(transfer.vectors, coefficients);
        result.remaining = energy == 0 || total == 0 ? 0
                           : ratio < 1               ? energy * ratio / (1 - ratio) / total
                                                     : 1;
        before = energy;
        if (endless && result.remaining < kRemainingEnergy) {
            result.converged = true;
            break;
        }
        // The energy falls geometrically, so that its logarithm says how far it is.
        const double share = endless ? std::log(std::max(energy / first, 1e-30)) / std::log(kRemainingEnergy)
                                     : static_cast<double>(result.bounces) / bounces;
        progress.update(std::clamp(share, 0.0, 1.0));
    }
    return result;
}

void add_transmission(Transfer& transfer, const Surfaces& surfaces, const TransportReceivers& receivers) {
    // Where the base colour is nearly black, no finite transfer can say what passes: it is taken as 1/255.
    constexpr float kLeastBase = 1.0f / 255;
    const auto coefficients = static_cast<std::size_t>(coefficient_count(transfer.order));
    std::vector<bool> done(receivers.fronts);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        if (!surfaces.transmits(t))
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            if (done[front])
                continue;
            done[front] = true;
            const glm::vec2 uv(corner == 1 ? 1 : 0, corner == 2 ? 1 : 0);
            const SurfacePoint point{t, uv, receivers.receivers.areas[front]};
            const Scattering s = surfaces.scattering(point);
            const glm::vec3 base = surfaces.base_color(point);
            const std::span<float> to = transfer.vector(front);
            const std::span<const float> from = transfer.vector(receivers.back_of(front));
            for (int c = 0; c < transfer.channels; ++c) {
                const float scale = 1 / std::max(base[c], kLeastBase);
                for (std::size_t i = static_cast<std::size_t>(c) * coefficients;
                     i < static_cast<std::size_t>(c + 1) * coefficients; ++i)
                    to[i] = scale * (s.reflected[c] * to[i] + s.transmitted[c] * from[i]);
            }
        }
    }
}

} // namespace prt
