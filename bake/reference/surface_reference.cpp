// Traces points between vertices, independent of the samples of a bake.

#include "bake/reference/surface_reference.h"

#include "bake/trace/embree_tracer.h"
#include "bake/trace/trace_receivers.h"

#include <cmath>
#include <numeric>

namespace prt {

SurfaceReference::SurfaceReference(const TraceScene& scene, const SurfaceReferenceOptions& options,
                                   const Progress& progress)
    : points_(surface_points(scene, {.count = options.points, .seed = options.seed}, {{}, progress.stop})) {
    EmbreeTracer tracer(scene);
    light_ = zero_transfer(options.order, 1, points_.size());
    std::vector<std::uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0u);
    trace_receivers(tracer, points_.receivers, all,
                    {.order = options.order, .rays = options.rays, .seed = options.seed}, light_, progress);
}

double SurfaceReference::relative_l2(const Transfer& direct) const {
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
        const std::array<float, 3> shares = points_.shares(p);
        double squared = 0, here = 0;
        for (std::size_t k = 0; k < light_.dimension(); ++k) {
            float value = -light_.vector(p)[k];
            for (int i = 0; i < 3; ++i)
                value += shares[static_cast<std::size_t>(i)] * direct.vector(points_.corners[p][i])[k];
            squared += static_cast<double>(value * value);
            here += static_cast<double>(light_.vector(p)[k] * light_.vector(p)[k]);
        }
        error += static_cast<double>(points_.receivers.areas[p]) * squared;
        norm += static_cast<double>(points_.receivers.areas[p]) * here;
    }
    return error > 0 ? std::sqrt(error / norm) : 0;
}

} // namespace prt
