// Selects instances of one scale for meshes that contain a medium.

#include "bake/products/instances/instance_scales.h"

#include "bake/plan/plan.h"
#include "prt/core/error.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

bool contains_medium(const Scene& scene, int node, const Media& media) {
    return std::ranges::any_of(scene.primitives, [&](const Primitive& primitive) {
        return primitive.node == node && media[primitive.material].has_value();
    });
}

bool same_scale(double smaller, double larger) {
    constexpr double kRounding = 1 + 1e-9;
    return larger <= smaller * kMaxScaleRatio * kRounding;
}

/// Returns the smallest scale of the largest group of placements that have the same scale.
double most_frequent(const std::vector<MeshPlacement>& placements) {
    std::vector<double> scales;
    for (const MeshPlacement& placement : placements)
        scales.push_back(placement.scale);
    std::ranges::sort(scales);
    std::size_t first = 0, most = 0;
    for (std::size_t begin = 0, end = 0; begin < scales.size(); ++begin) {
        while (end < scales.size() && same_scale(scales[begin], scales[end]))
            ++end;
        if (end - begin > most) {
            most = end - begin;
            first = begin;
        }
    }
    return scales[first];
}

} // namespace

std::size_t keep_one_scale(SharedMeshes& meshes, const Scene& scene, const BakeOptions& options) {
    const Media media = choose_media(scene, options);
    const std::size_t before = meshes.placements();
    for (SharedMesh& mesh : meshes.meshes) {
        if (!contains_medium(scene, mesh.placements.front().node, media))
            continue;
        const double scale = most_frequent(mesh.placements);
        std::erase_if(mesh.placements, [&](const MeshPlacement& placement) {
            return placement.scale < scale || !same_scale(scale, placement.scale);
        });
    }
    std::erase_if(meshes.meshes, [](const SharedMesh& mesh) { return mesh.placements.size() < 2; });
    return before - meshes.placements();
}

double scale_to_bake(const Scene& scene, std::span<const MeshPlacement> placements,
                     const BakeOptions& options) {
    if (!contains_medium(scene, placements.front().node, choose_media(scene, options)))
        return 1;
    const auto [least, most] = std::ranges::minmax_element(placements, {}, &MeshPlacement::scale);
    if (!same_scale(least->scale, most->scale))
        throw Error("node " + std::to_string(most->node) +
                    ": its mesh contains a medium, and its scale differs from that of node " +
                    std::to_string(least->node) + "; use --instances own");
    return std::sqrt(least->scale * most->scale);
}

} // namespace prt
