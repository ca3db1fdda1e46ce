// Adds light that passes distant surfaces to visibility.

#include "bake/tracers/falloff_tracer.h"

#include "bake/trace/lamp_light.h"
#include "bake/trace/sealed.h"
#include "prt/core/sh.h"
#include "prt/core/sh_basis.h"

#include <glm/geometric.hpp>

#include <array>

namespace prt {

FalloffTracer::FalloffTracer(std::unique_ptr<Tracer> tracer, const TraceScene& scene, Falloff falloff)
    : tracer_(std::move(tracer)), scene_(scene), falloff_(std::move(falloff)) {
    for (const VertexArray& vertices : scene.scene().vertex_arrays)
        positions_.insert(positions_.end(), vertices.positions.begin(), vertices.positions.end());
}

void FalloffTracer::passing(const glm::vec3& position, std::span<const Hit> hits, const TraceOptions& options,
                            std::span<double> vector) const {
    std::ranges::fill(vector, 0.0);
    std::array<double, kMaxOrder * kMaxOrder> basis{};
    for (const Hit& hit : hits) {
        const glm::uvec3& c = scene_.surfaces().corners(hit.triangle);
        const glm::dvec3 way = glm::dvec3(positions_[c.x]) * static_cast<double>(1 - hit.u - hit.v) +
                               glm::dvec3(positions_[c.y]) * static_cast<double>(hit.u) +
                               glm::dvec3(positions_[c.z]) * static_cast<double>(hit.v) -
                               glm::dvec3(position);
        const double distance = glm::length(way);
        const double share = static_cast<double>(hit.weight) / options.rays * falloff_.passes(distance);
        if (!(distance > 0) || share == 0)
            continue;
        evaluate_sh(options.order, way / distance, basis);
        for (std::size_t k = 0; k < vector.size(); ++k)
            vector[k] += share * basis[k];
    }
}

void FalloffTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                          const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                          const Progress& progress) {
    const auto stride = static_cast<std::size_t>(coefficient_count(options.order));
    std::vector<double> passing_all(vectors.size());
    TraceOptions every_hit = options;
    every_hit.hit_stride = 1;
    tracer_->trace(
        receivers, indices, every_hit, vectors,
        [&](std::size_t i, std::span<const Hit> hits) {
            const std::span<double> here = std::span(passing_all).subspan(i * stride, stride);
            if (looks_sealed(scene_.surfaces(), hits, options.rays, options.rays < kMaxProbes))
                std::ranges::fill(here, 0.0);
            else
                passing(receivers.positions[indices[i]], hits, options, here);
            if (sink)
                sink(i, hits);
        },
        progress);
    seconds_ = tracer_->seconds();
    for (std::size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = static_cast<float>(static_cast<double>(vectors[i]) + passing_all[i]);
}

LampLight FalloffTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return tracer_->lamp_light(task, progress);
}

} // namespace prt
