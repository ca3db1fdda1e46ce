#include "prt/bake.h"

#include "prt/sh.h"
#include "scene/ray_starts.h"

#include <algorithm>
#include <array>

namespace prt {

std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < receivers.size(); ++i)
        if (receivers.areas[i] > 0 && receivers.normals[i] != glm::vec3(0))
            indices.push_back(i);
    return indices;
}

Transfer unshadowed_transfer(const Scene& scene, int order) {
    Transfer transfer{order, 1, {}};
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& normal : vertices.normals) {
            clamped_cosine_lobe(order, glm::dvec3(normal), lobe);
            for (std::size_t i = 0; i < transfer.dimension(); ++i)
                transfer.vectors.push_back(normal == glm::vec3(0) ? 0.0f : static_cast<float>(lobe[i]));
        }
    return transfer;
}

Receivers vertex_receivers(const Scene& scene) {
    Receivers receivers;
    for (const VertexArray& vertices : scene.vertex_arrays) {
        receivers.positions.insert(receivers.positions.end(), vertices.positions.begin(),
                                   vertices.positions.end());
        receivers.normals.insert(receivers.normals.end(), vertices.normals.begin(), vertices.normals.end());
    }
    receivers.areas = receiver_areas(scene);
    receivers.starts = ray_starts(scene, Side::front);
    return receivers;
}

void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& trace_options, Transfer& transfer, const Progress& progress,
                     const ReceiverSink& sink) {
    TraceOptions options = trace_options;
    options.progress = &progress;
    std::vector<float> vectors;
    for (std::size_t begin = 0; begin < indices.size();) {
        progress.update(static_cast<double>(begin) / static_cast<double>(indices.size()));
        const auto part =
            indices.subspan(begin, std::min(tracer.batch_size(options), indices.size() - begin));
        vectors.resize(part.size() * transfer.dimension());
        HitSink batch_sink;
        if (sink)
            batch_sink = [&](std::size_t i, std::span<const Hit> hits) { sink(part[i], hits); };
        tracer.trace(receivers, part, options, vectors, batch_sink);
        for (std::size_t i = 0; i < part.size(); ++i)
            std::copy_n(&vectors[i * transfer.dimension()], transfer.dimension(),
                        transfer.vector(part[i]).begin());
        begin += part.size();
    }
    progress.update(1);
}

Transfer direct_transfer(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                         const Progress& progress, const ReceiverSink& sink) {
    Transfer transfer = zero_transfer(options.order, 1, receivers.size());
    trace_receivers(tracer, receivers, receivers_on_surfaces(receivers), options, transfer, progress, sink);
    return transfer;
}

} // namespace prt
