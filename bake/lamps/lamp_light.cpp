// Casts rays at lamps from every receiver.

#include "lamps/lamp_light.h"

#include "lamps/lamp_rays.h"
#include "trace/each_receiver.h"
#include "trace/sample_sequence.h"

#include <numbers>
#include <vector>

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
    if (lamps.empty())
        return lit;
    const std::size_t stride = lit.dimension() / static_cast<std::size_t>(options.channels);
    std::vector<ShiningTriangles> shining;
    for (const Lamp& lamp : lamps)
        shining.emplace_back(scene, lamp);
    std::atomic<std::size_t> traced = 0;
    for_each_receiver(receivers_on_surfaces(receivers), options.threads, progress, [&](std::uint32_t p) {
        LampReceiver receiver{receivers.positions[p], receivers.normals[p],
                              scene.rays().ray_origin(receivers, p)};
        for (std::size_t k = 0; k < lamps.size(); ++k) {
            receiver.seed = receiver_seed(p, options.seed + k);
            const LampIrradiance of_lights = irradiance_of_lights(scene, lamps[k], receiver,
                                                                  options.lamps.radius, options.lamps.rays),
                                 of_surfaces = shining[k].irradiance(receiver, options.lamps.rays);
            const glm::dvec3 radiance = (of_lights.irradiance + of_surfaces.irradiance) / std::numbers::pi;
            for (int c = 0; c < options.channels; ++c)
                lit.vector(p)[static_cast<std::size_t>(c) * stride + k] = static_cast<float>(radiance[c]);
            traced += of_lights.rays + of_surfaces.rays;
        }
    });
    rays += traced;
    return lit;
}

} // namespace prt
