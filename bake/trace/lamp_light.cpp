// Casts rays to lamps from every receiver, on the CPU.

#include "bake/trace/lamp_light.h"

#include "bake/trace/each_receiver.h"
#include "bake/trace/lamp_rays.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace/tracer.h"

#include <atomic>
#include <numbers>
#include <vector>

namespace prt {
namespace {

/// Smallest order with enough coefficients: lamps are stored as coefficients of a light.
int order_for(std::size_t lamps) {
    int order = 1;
    while (static_cast<std::size_t>(coefficient_count(order)) < lamps)
        ++order;
    return order;
}

} // namespace

LampLight no_lamp_light(const LampTask& task) {
    return {zero_transfer(layout_of_one(order_for(task.lamps.size()), task.channels, TermKind::direct),
                          task.receivers.size())};
}

void put_irradiance(const LampTask& task, std::uint32_t p, std::size_t lamp, const glm::dvec3& irradiance,
                    LampLight& light) {
    const std::size_t stride = light.transfer.dimension() / static_cast<std::size_t>(task.channels);
    for (int c = 0; c < task.channels; ++c)
        light.transfer.vector(p)[static_cast<std::size_t>(c) * stride + lamp] =
            static_cast<float>(irradiance[c] / std::numbers::pi);
}

LampLight lamp_light_on_cpu(const LampTask& task, const Progress& progress) {
    LampLight light = no_lamp_light(task);
    std::vector<ShiningTriangles> shining;
    for (const Lamp& lamp : task.lamps)
        shining.emplace_back(task.scene, lamp);
    std::atomic<std::size_t> traced = 0;
    const auto work = [&](std::uint32_t p) {
        LampReceiver receiver{task.receivers.positions[p], task.receivers.normals[p],
                              task.scene.rays().ray_origin(task.receivers, p)};
        for (std::size_t k = 0; k < task.lamps.size(); ++k) {
            receiver.seed = receiver_seed(p, task.seed + k);
            const LampIrradiance of_lights = irradiance_of_lights(task.scene, task.lamps[k], receiver,
                                                                  task.options.radius, task.options.rays),
                                 of_surfaces = shining[k].irradiance(receiver, task.options.rays);
            put_irradiance(task, p, k, of_lights.irradiance + of_surfaces.irradiance, light);
            traced += of_lights.rays + of_surfaces.rays;
        }
    };
    if (!task.lamps.empty())
        for_each_receiver(receivers_on_surfaces(task.receivers), task.threads, progress, work);
    light.rays = traced;
    return light;
}

} // namespace prt
