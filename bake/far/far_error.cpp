// Traces some receivers with voxels and without.

#include "far/far_error.h"

#include "far/far_blockers.h"
#include "prt/sh.h"
#include "trace/embree_tracer.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

constexpr std::size_t kReceivers = 256;
constexpr int kRays = 4096; ///< relative L2 of their noise: some tenths of a percent

std::vector<float> trace_all(Tracer& tracer, const Receivers& receivers,
                             std::span<const std::uint32_t> indices, const TraceOptions& options) {
    std::vector<float> vectors(indices.size() * static_cast<std::size_t>(coefficient_count(options.order)));
    tracer.trace(receivers, indices, options, vectors);
    return vectors;
}

} // namespace

std::optional<FarBlockerFigures> far_figures(Tracer& tracer, const TraceScene& scene,
                                             const Receivers& receivers,
                                             std::span<const std::uint32_t> indices, int order) {
    if (!tracer.far_blockers())
        return std::nullopt;
    FarBlockerFigures figures = tracer.far_blockers()->figures();
    std::vector<std::uint32_t> some;
    const std::size_t count = std::min(kReceivers, indices.size());
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(indices[i * indices.size() / count]);
    const TraceOptions options{.order = order, .rays = kRays};
    EmbreeTracer by_triangles(scene);
    const std::vector<float> exact = trace_all(by_triangles, receivers, some, options),
                             with_voxels = trace_all(tracer, receivers, some, options);
    const std::size_t dimension = exact.size() / std::max<std::size_t>(1, some.size());
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const auto area = static_cast<double>(receivers.areas[some[i / dimension]]);
        error += area * std::pow(static_cast<double>(with_voxels[i] - exact[i]), 2);
        norm += area * std::pow(static_cast<double>(exact[i]), 2);
    }
    figures.error = norm > 0 ? std::sqrt(error / norm) : 0;
    return figures;
}

} // namespace prt
