// Measures all occluders of a scene together on the floor below it.

#include "bake/products/occlusion/blocked_by_rays.h"
#include "prt/bake/ambient_occlusion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace prt {

FloorOcclusion floor_occlusion(const Scene& scene, std::span<const OcclusionVolume> volumes,
                               std::span<const glm::dmat4> frames, const OccluderOptions& options,
                               const Progress& progress) {
    constexpr std::size_t kPositions = 2048;
    const Bounds box = bounds(scene);
    const glm::vec3 size = box.high - box.low, around(size.y, 0, size.y);
    std::mt19937_64 random(options.seed + 1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec3> positions, normals(kPositions, glm::vec3(0, 1, 0));
    for (std::size_t i = 0; i < kPositions; ++i) {
        const float x = unit(random), z = unit(random);
        positions.push_back(box.low - around + (size + 2.0f * around) * glm::vec3(x, 0, z));
        positions.back().y = box.low.y - 1e-3f * size.y; // to include geometry in the plane itself
    }
    std::vector<PlacedOccluder> where;
    for (std::size_t i = 0; i < volumes.size(); ++i)
        where.push_back(placed(volumes[i], glm::mat4(frames[i]), i));
    const auto truth = blocked_by_rays(scene, positions, normals, bake_options(options), progress);
    FloorOcclusion floor;
    double count = 0;
    for (std::size_t p = 0; p < kPositions; ++p) {
        if (!truth[p])
            continue;
        float left = 1;
        for (std::size_t i = 0; i < volumes.size(); ++i)
            left *= 1 - blocked_cosine(blocked_at(volumes[i], where[i], positions[p]), normals[p]);
        const double error = std::abs(static_cast<double>(1 - left - *truth[p]));
        floor.mean_blocked += static_cast<double>(*truth[p]);
        floor.mean_error += error;
        floor.largest_error = std::max(floor.largest_error, error);
        count += 1;
    }
    floor.mean_blocked /= std::max(count, 1.0);
    floor.mean_error /= std::max(count, 1.0);
    return floor;
}

} // namespace prt
