#include "prt/bake.h"

#include "prt/embree_tracer.h"
#include "prt/error.h"
#include "prt/sh.h"
#include "prt/stopwatch.h"

#include <algorithm>

namespace prt {
namespace {

std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < receivers.size(); ++i)
        if (receivers.areas[i] > 0 && receivers.normals[i] != glm::vec3(0))
            indices.push_back(i);
    return indices;
}

} // namespace

Receivers vertex_receivers(const Scene& scene) {
    Receivers receivers;
    for (const VertexArray& vertices : scene.vertex_arrays) {
        receivers.positions.insert(receivers.positions.end(), vertices.positions.begin(),
                                   vertices.positions.end());
        receivers.normals.insert(receivers.normals.end(), vertices.normals.begin(), vertices.normals.end());
    }
    receivers.areas = receiver_areas(scene);
    return receivers;
}

Transfer direct_transfer(Tracer& tracer, const Receivers& receivers, const DirectOptions& options,
                         const Progress& progress) {
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
    Transfer transfer{options.order, 1, {}};
    transfer.vectors.resize(receivers.size() * transfer.dimension());
    const std::size_t batch = tracer.batch_size(options);
    std::vector<float> vectors(batch * transfer.dimension());
    for (std::size_t begin = 0; begin < indices.size(); begin += batch) {
        progress.update(static_cast<double>(begin) / static_cast<double>(indices.size()));
        const auto part = std::span(indices).subspan(begin, std::min(batch, indices.size() - begin));
        tracer.direct_transfer(receivers, part, options, vectors);
        for (std::size_t i = 0; i < part.size(); ++i)
            std::copy_n(&vectors[i * transfer.dimension()], transfer.dimension(),
                        transfer.vector(part[i]).begin());
    }
    progress.update(1);
    return transfer;
}

double mean_visibility(const Transfer& transfer, std::span<const float> areas) {
    double sum = 0, area = 0;
    const auto stride = static_cast<std::size_t>(coefficient_count(transfer.order));
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        for (int c = 0; c < transfer.channels; ++c)
            sum += static_cast<double>(areas[p]) *
                   static_cast<double>(transfer.vector(p)[static_cast<std::size_t>(c) * stride]) /
                   transfer.channels;
        area += static_cast<double>(areas[p]);
    }
    const double y00 = detail::kLegendre.sectoral[0];
    return area > 0 ? sum / (area * y00) : 0;
}

BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress) {
    check_order(options.order);
    if (options.rays < 1 || options.rays > (1 << 24))
        throw Error("rays per receiver must lie in 1..16777216, not " + std::to_string(options.rays));
    BakeResult result;
    BakeStatistics& statistics = result.statistics;

    const Stopwatch build;
    const RayScene ray_scene(scene, options.threads);
    statistics.seconds_build = build.seconds();

    const Stopwatch trace;
    const Receivers receivers = vertex_receivers(scene);
    EmbreeTracer tracer(ray_scene, options.threads);
    result.baked.transfer =
        direct_transfer(tracer, receivers, {options.order, options.rays, options.seed}, progress);
    statistics.seconds_trace = trace.seconds();

    statistics.receivers = receivers.size();
    statistics.traced = receivers_on_surfaces(receivers).size();
    statistics.triangles = scene.triangles();
    statistics.rays_per_second = static_cast<double>(statistics.traced) * options.rays /
                                 (statistics.seconds_build + statistics.seconds_trace);
    statistics.mean_visibility = mean_visibility(result.baked.transfer, receivers.areas);
    result.baked.record = {0, options.rays, options.seed, "trace", tracer.backend(), receivers_id(scene)};
    return result;
}

} // namespace prt
