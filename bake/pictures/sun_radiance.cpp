// Casts rays at suns from every receiver.

#include "prt/sun_radiance.h"

#include "pictures/disc_directions.h"
#include "prt/sh_basis.h"
#include "prt/support/parallel.h"
#include "scene/transmittance.h"
#include "trace/sample_sequence.h"
#include "transport/light_transport.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// Share of a sun's irradiance that arrives.
double share_of(const TraceScene& scene, const Receivers& receivers, std::uint32_t p,
                const DiscDirections& directions, std::uint64_t seed) {
    const glm::vec3 origin = scene.rays().ray_origin(receivers, p), normal = receivers.normals[p];
    const double turn = 2 * std::numbers::pi * 0x1p-32 * static_cast<double>(receiver_seed(p, seed));
    double sum = 0;
    for (int i = 0; i < directions.count(); ++i) {
        const glm::vec3 towards = directions.direction(i, turn);
        const auto cosine = static_cast<double>(glm::dot(normal, towards));
        if (cosine > 0)
            sum +=
                cosine * static_cast<double>(transmittance(scene.rays(), scene.surfaces(), origin, towards));
    }
    return sum / (directions.count() * directions.mean_cosine());
}

} // namespace

std::vector<glm::vec3> sun_radiance(const TraceScene& scene, std::span<const SunDisc> suns,
                                    const SunRays& options, const Progress& progress) {
    Receivers fronts = vertex_receivers(scene.scene());
    const bool through = scene.surfaces().traits().transmission;
    const TransportReceivers all = through ? with_back_sides(std::move(fronts), scene.surfaces())
                                           : without_back_sides(std::move(fronts));
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(all.receivers);
    // Radiance is what transfer is for a light of one coefficient.
    Transfer lit = zero_transfer(layout_of_one(1, 3, PartKind::direct), all.receivers.size());
    constexpr std::size_t kBatch = 1 << 14; // receivers between two looks at the progress
    for (std::size_t s = 0; s < suns.size(); ++s) {
        const DiscDirections directions(suns[s], options.rays);
        for (std::size_t first = 0; first < indices.size(); first += kBatch) {
            progress.update(
                (static_cast<double>(s) + static_cast<double>(first) / static_cast<double>(indices.size())) /
                static_cast<double>(suns.size()));
            const std::size_t count = std::min(kBatch, indices.size() - first);
            parallel_for(count, 64, options.threads, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    const std::uint32_t p = indices[first + i];
                    const double share = share_of(scene, all.receivers, p, directions, options.seed);
                    for (int c = 0; c < 3; ++c)
                        lit.vector(p)[static_cast<std::size_t>(c)] += static_cast<float>(
                            share * static_cast<double>(suns[s].irradiance[c]) / std::numbers::pi);
                }
            });
        }
    }
    if (through)
        add_transmission(lit, scene.surfaces(), all);
    std::vector<glm::vec3> radiance;
    for (std::size_t p = 0; p < all.fronts; ++p)
        radiance.emplace_back(lit.vector(p)[0], lit.vector(p)[1], lit.vector(p)[2]);
    for (std::uint32_t t = 0; t < scene.surfaces().triangles(); ++t)
        if (scene.surfaces().solid(t))
            for (int corner = 0; corner < 3; ++corner)
                radiance[scene.surfaces().corners(t)[corner]] = glm::vec3(0);
    return radiance;
}

} // namespace prt
