// Divides a scene into what voxels stand in for, and the rest.

#include "far/far_blockers.h"

#include "levels/scene_part.h"
#include "prt/support/stopwatch.h"

namespace prt {
namespace {

/// Where rays first meet a voxel it is seen 3.6 degrees wide: a tenth of what order 5 tells apart.
constexpr double kVoxelsInDistance = 16;

} // namespace

FarBlockers::FarBlockers(const TraceScene& scene, double distance) : distance_(static_cast<float>(distance)) {
    const Stopwatch watch;
    const DenseParts dense = find_dense_parts(scene.scene(), distance_);
    const double size = distance / kVoxelsInDistance;
    volume_ = std::make_unique<const BlockerVolume>(scene, dense, static_cast<float>(size));
    std::vector<std::size_t> others;
    std::uint32_t first = 0;
    for (std::size_t p = 0; p < dense.primitives.size(); ++p) {
        const auto count = static_cast<std::uint32_t>(scene.scene().primitives[p].triangles.size());
        if (!dense.primitives[p]) {
            others.push_back(p);
            for (std::uint32_t t = 0; t < count; ++t)
                triangles_.push_back(first + t);
        }
        first += count;
    }
    const ScenePart part = scene_part(scene.scene(), others);
    others_ = std::make_unique<const RayScene>(part.scene, scene.threads());
    figures_ = {.distance = distance,
                .voxel_size = size,
                .nodes = dense.nodes.size(),
                .triangles = dense.triangles,
                .voxels = volume_->voxels(),
                .bytes = volume_->bytes(),
                .seconds = watch.seconds()};
}

} // namespace prt
