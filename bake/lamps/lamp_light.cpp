// Casts rays at lamps from every receiver.

#include "lamps/lamp_light.h"

#include "lamps/lamp_rays.h"
#include "prt/support/parallel.h"
#include "trace/sample_sequence.h"

#include <numbers>

namespace prt {
namespace {

/// Lamps are the coefficients of a light of so many bands.
int order_for(std::size_t lamps) {
    int order = 1;
    while (static_cast<std::size_t>(coefficient_count(order)) < lamps)
        ++order;
    return order;
}

} // namespace

Transfer lamp_light(const TraceScene& scene, const Receivers& receivers, std::span<const Lamp> lamps,
                    const LampLightOptions& options, std::size_t& rays, const Progress& progress) {
    Transfer lit = zero_transfer(layout_of_one(order_for(lamps.size()), options.channels, PartKind::direct),
                                 receivers.size());
    const std::size_t stride = lit.dimension() / static_cast<std::size_t>(options.channels);
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
    std::atomic<std::size_t> traced = 0;
    constexpr std::size_t kBatch = 1 << 14; // receivers between two looks at the progress
    for (std::size_t k = 0; k < lamps.size(); ++k) {
        const ShiningTriangles shining(scene, lamps[k]);
        for (std::size_t first = 0; first < indices.size(); first += kBatch) {
            progress.update(
                (static_cast<double>(k) + static_cast<double>(first) / static_cast<double>(indices.size())) /
                static_cast<double>(lamps.size()));
            const std::size_t count = std::min(kBatch, indices.size() - first);
            parallel_for(count, 64, options.threads, [&](std::size_t begin, std::size_t end) {
                std::size_t here = 0;
                for (std::size_t i = begin; i < end; ++i) {
                    const std::uint32_t p = indices[first + i];
                    const LampReceiver receiver{receivers.positions[p], receivers.normals[p],
                                                scene.rays().ray_origin(receivers, p),
                                                receiver_seed(p, options.seed + k)};
                    const LampIrradiance of_lights =
                                             irradiance_of_lights(scene, lamps[k], receiver,
                                                                  options.lamps.radius, options.lamps.rays),
                                         of_surfaces = shining.irradiance(receiver, options.lamps.rays);
                    const glm::dvec3 radiance =
                        (of_lights.irradiance + of_surfaces.irradiance) / std::numbers::pi;
                    for (int c = 0; c < options.channels; ++c)
                        lit.vector(p)[static_cast<std::size_t>(c) * stride + k] =
                            static_cast<float>(radiance[c]);
                    here += of_lights.rays + of_surfaces.rays;
                }
                traced += here;
            });
        }
    }
    rays += traced;
    return lit;
}

} // namespace prt
