// Traces some receivers with voxels and without.

#include "far/far_error.h"

#include "far/far_blockers.h"
#include "prt/sh.h"
#include "trace/embree_tracer.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

constexpr int kReceivers = 256;
constexpr int kRays = 4096; ///< relative L2 of their noise: some tenths of a percent

std::vector<float> trace_all(Tracer& tracer, const Receivers& receivers,
                             std::span<const std::uint32_t> indices, const TraceOptions& options) {
    std::vector<float> vectors(indices.size() * static_cast<std::size_t>(coefficient_count(options.order)));
    tracer.trace(receivers, indices, options, vectors);
    return vectors;
}

/// So many of `indices` that each stands for as much area.
std::vector<std::uint32_t> even_shares(const Receivers& receivers, std::span<const std::uint32_t> indices) {
    double area = 0;
    for (const std::uint32_t r : indices)
        area += static_cast<double>(receivers.areas[r]);
    std::vector<std::uint32_t> some;
    double passed = 0;
    for (const std::uint32_t r : indices) {
        passed += static_cast<double>(receivers.areas[r]);
        while (area > 0 && static_cast<double>(some.size()) + 0.5 < passed / area * kReceivers)
            some.push_back(r); // large ones several times
    }
    return some;
}

} // namespace

std::optional<FarBlockerFigures> far_figures(Tracer& tracer, const TraceScene& scene,
                                             const Receivers& receivers,
                                             std::span<const std::uint32_t> indices, int order) {
    if (!tracer.far_blockers())
        return std::nullopt;
    FarBlockerFigures figures = tracer.far_blockers()->figures();
    const std::vector<std::uint32_t> some = even_shares(receivers, indices);
    const TraceOptions options{.order = order, .rays = kRays};
    EmbreeTracer by_triangles(scene);
    const std::vector<float> exact = trace_all(by_triangles, receivers, some, options),
                             with_voxels = trace_all(tracer, receivers, some, options);
    // Where no light arrives, what voxels let through is over a hundredth of the light of the open.
    std::vector<double> open(static_cast<std::size_t>(coefficient_count(order)));
    clamped_cosine_lobe(order, glm::dvec3(0, 0, 1), open);
    double error = 0, norm = 0, least = 0;
    for (const double value : open)
        least += 1e-4 * value * value * static_cast<double>(some.size());
    for (std::size_t i = 0; i < exact.size(); ++i) {
        error += std::pow(static_cast<double>(with_voxels[i] - exact[i]), 2);
        norm += std::pow(static_cast<double>(exact[i]), 2);
    }
    figures.error = some.empty() ? 0 : std::sqrt(error / std::max(norm, least));
    return figures;
}

} // namespace prt
