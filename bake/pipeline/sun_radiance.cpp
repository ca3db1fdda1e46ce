// Casts rays to suns from every receiver.

#include "bake/pipeline/sun_radiance.h"

#include "bake/pipeline/light_transport.h"
#include "bake/trace/disc_share.h"
#include "bake/trace/each_receiver.h"
#include "bake/trace/sample_sequence.h"

#include <limits>
#include <numbers>

namespace prt {
std::vector<glm::vec3> sun_radiance(const TraceScene& scene, std::span<const Sun> suns,
                                    const SunRays& options, const Progress& progress) {
    Receivers fronts = vertex_receivers(scene.scene());
    if (suns.empty())
        return std::vector<glm::vec3>(fronts.size(), glm::vec3(0));
    const bool through = scene.surfaces().traits().transmission;
    const TransportReceivers all = through ? with_back_sides(std::move(fronts), scene.surfaces())
                                           : without_back_sides(std::move(fronts));
    // Radiance corresponds to transfer for a light with one coefficient.
    Transfer lit = zero_transfer(layout_of_one(1, 3, TermKind::direct), all.receivers.size());
    std::vector<DiscDirections> directions;
    for (const Sun& sun : suns)
        directions.emplace_back(sun.towards, sun.half_angle, options.rays);
    for_each_receiver(receivers_on_surfaces(all.receivers), options.threads, progress, [&](std::uint32_t p) {
        const glm::vec3 origin = scene.rays().ray_origin(all.receivers, p);
        const double rotation =
            2 * std::numbers::pi * 0x1p-32 * static_cast<double>(receiver_seed(p, options.seed));
        for (std::size_t s = 0; s < suns.size(); ++s) {
            const double share =
                share_of_disc(scene, origin, all.receivers.normals[p], directions[s], rotation,
                              [](int) { return std::numeric_limits<float>::infinity(); });
            for (int c = 0; c < 3; ++c)
                lit.vector(p)[static_cast<std::size_t>(c)] +=
                    static_cast<float>(share * static_cast<double>(suns[s].irradiance[c]) / std::numbers::pi);
        }
    });
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
