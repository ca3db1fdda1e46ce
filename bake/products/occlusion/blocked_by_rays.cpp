// Integrates unoccluded directions times the cosine, band by band.

#include "bake/products/occlusion/blocked_by_rays.h"

#include "prt/bake/volume_bake.h"
#include "prt/core/sh.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {

BakeOptions bake_options(const OccluderOptions& options) {
    BakeOptions bake;
    bake.order = 2;
    bake.rays = options.rays;
    bake.bounces = 0;
    bake.tracer = options.tracer;
    bake.lamps.mode = LampMode::none;
    bake.repairs = options.repairs;
    bake.threads = options.threads;
    bake.seed = options.seed;
    return bake;
}

std::vector<std::optional<float>> blocked_by_rays(const Scene& scene, std::span<const glm::vec3> positions,
                                                  std::span<const glm::vec3> normals,
                                                  const BakeOptions& options, const Progress& progress) {
    // Bands of the cosine over pi (Ramamoorthi and Hanrahan 2001); the next one that is not 0 is 1/64.
    constexpr std::array<double, 5> kCosine = {1, 2.0 / 3, 0.25, 0, -1.0 / 24};
    constexpr int kOrder = static_cast<int>(kCosine.size());
    BakeOptions finer = options;
    finer.order = kOrder;
    const PlacedLight light = bake_positions(scene, positions, 2, finer, progress);
    std::vector<std::optional<float>> blocked(positions.size());
    std::array<float, kCosine.size() * kCosine.size()> basis{};
    for (std::size_t p = 0; p < positions.size(); ++p) {
        if (light.backs[p] > kMaxOccluderBackShare)
            continue;
        evaluate_sh(kOrder, normals[p], basis);
        // The first row, that of Y00, holds Y00 times the bands of the unoccluded directions.
        const std::span<const float> open = light.transfer.vector(4 * p);
        double left = 0;
        for (std::size_t i = 0; i < basis.size(); ++i)
            left += kCosine[static_cast<std::size_t>(std::sqrt(static_cast<double>(i)))] *
                    static_cast<double>(open[i] * basis[i]) / kY00;
        blocked[p] = static_cast<float>(std::clamp(1 - left, 0.0, 1.0));
    }
    return blocked;
}

} // namespace prt
