// Selects points between vertices by area.

#include "bake/reference/surface_points.h"

#include "bake/scene/interpolated.h"
#include "bake/surface_fit/surface_samples.h"
#include "bake/trace/embree_tracer.h"
#include "bake/trace/picked.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <numeric>

namespace prt {
namespace {

void append(const SurfacePoints& from, std::size_t index, SurfacePoints& to) {
    to.receivers.append(from.receivers, index);
    to.triangles.push_back(from.triangles[index]);
    to.uv.push_back(from.uv[index]);
    to.corners.push_back(from.corners[index]);
}

/// Selects samples by area from a dense set that has samples on every triangle.
SurfacePoints points_by_area(const TraceScene& scene, const SurfacePointOptions& options) {
    const TransportReceivers receivers = without_back_sides(vertex_receivers(scene.scene()));
    const SurfaceSamples dense =
        sample_surfaces(scene.surfaces(), receivers, {.count = 4 * options.count, .seed = options.seed});
    const auto area = [&](std::size_t s) { return static_cast<double>(dense.receivers.areas[s]); };
    SurfacePoints points;
    for (const Picked& picked : pick(dense.size(), options.count, area)) {
        const SamplePosition& point = dense.positions[picked.index];
        const glm::uvec3 corners = corner_receivers(scene.surfaces(), receivers, point.triangle, false);
        const float seen = scene.surfaces().coverage({point.triangle, point.uv, 0});
        if (glm::any(glm::equal(corners, glm::uvec3(kNoReceiver))) || !(seen > 0))
            continue;
        points.receivers.append(dense.receivers, picked.index);
        points.receivers.areas.back() = seen * static_cast<float>(picked.weight * area(picked.index));
        points.triangles.push_back(point.triangle);
        points.uv.push_back(point.uv);
        points.corners.push_back(corners);
    }
    return points;
}

} // namespace

SurfacePoints surface_points(const TraceScene& scene, const SurfacePointOptions& options,
                             const Progress& progress) {
    constexpr int kLook = 64; // rays: half of the points that see a hundredth of the sky are found dark
    const SurfacePoints all = points_by_area(scene, options);
    EmbreeTracer tracer(scene);
    Transfer light = zero_transfer(1, 1, all.size());
    std::vector<std::uint32_t> indices(all.size()), dark;
    std::iota(indices.begin(), indices.end(), 0u);
    trace_receivers(tracer, all.receivers, indices, {.order = 1, .rays = kLook, .seed = options.seed}, light,
                    progress);
    for (const std::uint32_t p : indices)
        if (light.vector(p)[0] <= 0)
            dark.push_back(p);
    const Sealed sealed =
        find_sealed(tracer, scene, all.receivers, std::move(dark), options.seed, progress.stop);
    SurfacePoints points;
    for (const std::uint32_t p : indices)
        if (!sealed.receivers[p])
            append(all, p, points);
    return points;
}

SurfacePoints some_of(const SurfacePoints& points, std::size_t count) {
    const auto area = [&](std::size_t p) { return static_cast<double>(points.receivers.areas[p]); };
    SurfacePoints some;
    for (const Picked& picked : pick(points.size(), count, area)) {
        append(points, picked.index, some);
        some.receivers.areas.back() *= static_cast<float>(picked.weight);
    }
    return some;
}

QuarterCorners quarter_corners(const TraceScene& scene, const SurfacePoints& points) {
    const Receivers vertices = vertex_receivers(scene.scene());
    QuarterCorners quarters;
    for (std::size_t p = 0; p < points.size(); ++p) {
        // Quarter at the corner whose share exceeds one half; otherwise the quarter between the midpoints.
        const std::array<float, 3> shares = points.shares(p);
        const auto most =
            static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
        const bool middle = shares[most] <= 0.5f;
        std::array<std::array<float, 3>, 3> nodes;
        std::array<float, 3> inside;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t from = middle ? (i + 1) % 3 : most, to = middle ? (i + 2) % 3 : i;
            nodes[i] = {0, 0, 0};
            nodes[i][from] += 0.5f;
            nodes[i][to] += 0.5f;
            inside[i] = middle ? 1 - 2 * shares[i] : 2 * shares[i] - (i == most ? 1.0f : 0.0f);
        }
        quarters.shares.push_back(inside);
        for (const std::array<float, 3>& node : nodes) {
            append(points, p, quarters.corners);
            quarters.corners.uv.back() = {node[1], node[2]};
            glm::vec3 position(0);
            for (int i = 0; i < 3; ++i)
                position += node[static_cast<std::size_t>(i)] * vertices.positions[points.corners[p][i]];
            quarters.corners.receivers.positions.back() = position;
        }
    }
    return quarters;
}

std::vector<glm::vec3> interpolated(const SurfacePoints& points, std::span<const glm::vec3> at_receivers) {
    std::vector<glm::vec3> values;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const std::array<float, 3> shares = points.shares(p);
        glm::vec3 sum(0);
        for (int i = 0; i < 3; ++i)
            sum += shares[static_cast<std::size_t>(i)] * at_receivers[points.corners[p][i]];
        values.push_back(sum);
    }
    return values;
}

} // namespace prt
