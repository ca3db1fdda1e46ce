// Traces points between vertices, independent of where a bake had its samples.

#include "prt/surface_reference.h"

#include "prt/sh_basis.h"
#include "prt/trace_receivers.h"
#include "scene/sealed.h"
#include "surface/surface_samples.h"
#include "trace/embree_tracer.h"
#include "trace/picked.h"

#include <cmath>
#include <numeric>

namespace prt {

SurfaceReference::SurfaceReference(const TraceScene& scene, const SurfaceReferenceOptions& options,
                                   const Progress& progress) {
    const TransportReceivers receivers = without_back_sides(vertex_receivers(scene.scene()));
    const SurfaceSamples dense =
        sample_surfaces(scene.surfaces(), receivers, {.count = 4 * options.points, .seed = options.seed});
    // Of the samples, of which every triangle has one, so many by area.
    const auto area = [&](std::size_t s) { return static_cast<double>(dense.receivers.areas[s]); };
    Receivers chosen;
    for (const Picked& picked : pick(dense.size(), options.points, area)) {
        const SamplePlace& place = dense.places[picked.index];
        const glm::uvec3 corners = corner_receivers(scene.surfaces(), receivers, place.triangle, false);
        if (glm::any(glm::equal(corners, glm::uvec3(kNoReceiver))))
            continue;
        points_.push_back({{corners.x, corners.y, corners.z},
                           place.shares(),
                           static_cast<float>(picked.stands_for * area(picked.index))});
        chosen.append(dense.receivers, picked.index);
    }
    EmbreeTracer tracer(scene);
    light_ = zero_transfer(options.order, 1, chosen.size());
    std::vector<std::uint32_t> all(chosen.size()), dark;
    std::iota(all.begin(), all.end(), 0u);
    trace_receivers(tracer, chosen, all, {.order = options.order, .rays = options.rays, .seed = options.seed},
                    light_, progress);
    for (const std::uint32_t p : all)
        if (light_.vector(p)[0] <= 0)
            dark.push_back(p);
    const Sealed sealed = find_sealed(scene, chosen, std::move(dark), options.seed, progress.stop);
    for (const std::uint32_t p : all)
        if (sealed.receivers[p])
            points_[p].area = 0;
}

double SurfaceReference::relative_l2(const Transfer& direct) const {
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
        const Point& point = points_[p];
        double squared = 0, here = 0;
        for (std::size_t k = 0; k < light_.dimension(); ++k) {
            float value = -light_.vector(p)[k];
            for (std::size_t i = 0; i < 3; ++i)
                value += point.shares[i] * direct.vector(point.receivers[i])[k];
            squared += static_cast<double>(value * value);
            here += static_cast<double>(light_.vector(p)[k] * light_.vector(p)[k]);
        }
        error += static_cast<double>(point.area) * squared;
        norm += static_cast<double>(point.area) * here;
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

} // namespace prt
