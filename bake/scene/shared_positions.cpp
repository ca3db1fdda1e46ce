// Groups front receivers at one position that see each other.

#include "bake/scene/shared_positions.h"

#include "bake/scene/alike_receivers.h"
#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <numeric>

namespace prt {
namespace {

/// [fronts] true for receivers of surfaces that do not transmit light and have no medium inside
std::vector<bool> on_plain_surfaces(const Surfaces& surfaces, std::size_t fronts) {
    std::vector<bool> plain(fronts, true);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        if (surfaces.transmits(t) || surfaces.solid(t))
            for (int corner = 0; corner < 3; ++corner)
                plain[surfaces.corners(t)[corner]] = false;
    return plain;
}

/// Whether a ray connects the ray origins of both receivers. Origins are offset towards the triangles of
/// their receivers, so that a wall on the edge of a floor is between them.
bool see_each_other(const RayScene& rays, const Receivers& receivers, std::uint32_t a, std::uint32_t b) {
    const glm::vec3 from = rays.ray_origin(receivers, a), to = rays.ray_origin(receivers, b);
    return from == to || !rays.occluded({from, to - from, 0, 1});
}

/// Splits receivers at one position into groups that see each other.
void split(const RayScene& rays, const Receivers& receivers, std::span<const std::uint32_t> position,
           std::vector<std::vector<std::uint32_t>>& groups) {
    std::vector<std::vector<std::uint32_t>> here;
    for (const std::uint32_t p : position) {
        const auto seen = std::ranges::find_if(
            here, [&](const auto& group) { return see_each_other(rays, receivers, group.front(), p); });
        if (seen == here.end())
            here.push_back({p});
        else
            seen->push_back(p);
    }
    for (std::vector<std::uint32_t>& group : here)
        if (group.size() > 1)
            groups.push_back(std::move(group));
}

} // namespace

SharedPositions::SharedPositions(const TraceScene& scene, const TransportReceivers& receivers) {
    const std::vector<bool> plain = on_plain_surfaces(scene.surfaces(), receivers.fronts);
    const std::vector<std::uint32_t> alike = alike_receivers(scene.surfaces(), receivers);
    std::vector<std::uint32_t> order;
    for (std::uint32_t p = 0; p < receivers.fronts; ++p)
        if (plain[p] && receivers.receivers.areas[p] > 0 && receivers.receivers.normals[p] != glm::vec3(0))
            order.push_back(p);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t p) { return alike[p]; });
    std::vector<std::span<const std::uint32_t>> positions;
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && alike[order[end]] == alike[order[begin]])
            ++end;
        if (end > begin + 1)
            positions.emplace_back(std::span(order).subspan(begin, end - begin));
    }
    std::vector<std::vector<std::vector<std::uint32_t>>> groups(positions.size());
    parallel_for(positions.size(), 64, scene.threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            split(scene.rays(), receivers.receivers, positions[i], groups[i]);
    });
    for (auto& of_position : groups)
        for (std::vector<std::uint32_t>& group : of_position)
            groups_.push_back(std::move(group));
}

std::vector<float> SharedPositions::left(std::size_t receivers) const {
    std::vector<float> left(receivers, 1.0f);
    for (const std::vector<std::uint32_t>& group : groups_)
        for (const std::uint32_t p : group)
            left[p] = 1 / static_cast<float>(group.size());
    return left;
}

std::vector<std::uint32_t> SharedPositions::first_of_each(std::size_t receivers) const {
    std::vector<std::uint32_t> first(receivers);
    std::iota(first.begin(), first.end(), 0u);
    for (const std::vector<std::uint32_t>& group : groups_)
        for (const std::uint32_t p : group)
            first[p] = group.front();
    return first;
}

void SharedPositions::average(Transfer& transfer) const {
    std::vector<double> sum(transfer.dimension());
    for (const std::vector<std::uint32_t>& group : groups_) {
        std::ranges::fill(sum, 0.0);
        for (const std::uint32_t p : group)
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += static_cast<double>(transfer.vector(p)[i]);
        for (const std::uint32_t p : group)
            for (std::size_t i = 0; i < sum.size(); ++i)
                transfer.vector(p)[i] = static_cast<float>(sum[i] / static_cast<double>(group.size()));
    }
}

} // namespace prt
