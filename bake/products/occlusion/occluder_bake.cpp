// Samples an object alone from points in its box, and fits a volume to the occlusion there.

#include "prt/bake/ambient_occlusion.h"

#include "bake/products/occlusion/blocked_by_rays.h"
#include "bake/products/occlusion/occluder_fit.h"
#include "bake/trace/scrambles.h"
#include "prt/bake/volume_bake.h"
#include "prt/core/error.h"
#include "prt/core/sh_basis.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace prt {
namespace {

/// Number of points of the fit: with 343 cells, eight for each texel. Number of points of the test.
constexpr std::size_t kFitPoints = 4096, kJudgePoints = 1024;

/// The object's frame without its scale.
class Frame {
public:
    explicit Frame(const glm::dmat4& to_scene)
        : to_scene_(to_scene), scale_(std::cbrt(std::abs(glm::determinant(glm::dmat3(to_scene))))) {
        if (!(scale_ > 0) || !std::isfinite(scale_))
            throw Error("the scale of the object is 0 or not finite");
        inverse_ = glm::inverse(to_scene);
    }
    double scale() const { return scale_; }
    glm::vec3 to_scene(const glm::vec3& p) const { return glm::vec3(to_scene_ * glm::dvec4(p, 1)); }
    glm::vec3 from_scene(const glm::vec3& p) const { return glm::vec3(inverse_ * glm::dvec4(p, 1)); }
    /// Converts a mean blocked direction from the scene's frame to the object's, the inverse of the
    /// conversion in `blocked_at`: by the inverse of the transposed scene-to-box matrix.
    glm::vec3 direction_from_scene(const glm::vec3& blocked_direction) const {
        const glm::dmat3 rows = glm::transpose(scale_ * glm::dmat3(inverse_));
        return glm::vec3(glm::inverse(rows) * glm::dvec3(blocked_direction));
    }

private:
    glm::dmat4 to_scene_, inverse_{1};
    double scale_;
};

/// Sets the bounding box of the object in its frame, extended on every side.
void place_box(const Scene& part, const Frame& frame, double margin, OcclusionVolume& volume) {
    glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
    for (const VertexArray& vertices : part.vertex_arrays)
        for (const glm::vec3& v : vertices.positions) {
            const glm::vec3 at = frame.from_scene(v);
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
    const glm::vec3 sides = high - low;
    const float grown = static_cast<float>(margin) * (sides.x + sides.y + sides.z) / 3;
    if (!(grown > 0))
        throw Error("the object has a size of 0");
    volume.low = low - grown;
    volume.high = high + grown;
}

struct Points {
    std::vector<glm::vec3> at, in_scene; ///< coordinates in the box, 0..1, and positions in the scene
};

Points points_in(const OcclusionVolume& volume, const Frame& frame, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = unit(random), y = unit(random), z = unit(random);
        points.at.emplace_back(x, y, z);
        points.in_scene.push_back(frame.to_scene(glm::mix(volume.low, volume.high, points.at.back())));
    }
    return points;
}

/// Blocked directions and their mean, seen from points outside the object. Points inside are omitted.
struct Seen {
    std::vector<BlockedPoint> points; ///< leans in the frame of the scene
    std::vector<glm::vec3> in_scene;
};

Seen look(const Scene& part, const Points& points, const BakeOptions& options, const Progress& progress) {
    const PlacedLight light = bake_positions(part, points.in_scene, 2, options, progress);
    // The first row is that of Y00: its columns are Y00 times the integrals of the basis over unoccluded
    // directions.
    const auto linear = static_cast<float>(kY00 * 4 * std::numbers::pi * 0.48860251190291992);
    Seen seen;
    for (std::size_t p = 0; p < points.at.size(); ++p) {
        if (light.backs[p] > kMaxOccluderBackShare)
            continue;
        const std::span<const float> open = light.transfer.vector(4 * p);
        BlockedPoint& point = seen.points.emplace_back();
        point.at = points.at[p];
        point.blocked = std::clamp(1 - open[0], 0.0f, 1.0f);
        // Directions have mean 0 over the whole sphere, so that the means of unoccluded and blocked
        // directions are opposite.
        const glm::vec3 mean = -glm::vec3(-open[3], -open[1], open[2]) / linear;
        const float most = point.blocked * (1 - point.blocked);
        point.blocked_direction = most > 1e-6f ? mean / most : glm::vec3(0);
        point.blocked_direction /= std::max(glm::length(point.blocked_direction), 1.0f);
        seen.in_scene.push_back(points.in_scene[p]);
    }
    return seen;
}

/// Distance at which a sphere that blocks the same amount of light as the object would block `least` of it.
float reach_of(const OcclusionVolume& volume, const Seen& seen, const Frame& frame, double least) {
    const glm::vec3 center = frame.to_scene(0.5f * (volume.low + volume.high));
    float most = 0; // maximum of blocked · distance², outside of a ball about half the size of the box
    const float radius = 0.5f * glm::distance(frame.to_scene(volume.high), frame.to_scene(volume.low));
    for (std::size_t i = 0; i < seen.points.size(); ++i) {
        const float distance = glm::distance(seen.in_scene[i], center);
        if (distance > 0.6f * radius)
            most = std::max(most, seen.points[i].blocked * distance * distance);
    }
    // A cap with share b blocks 4 b of the light of a receiver that faces it.
    const float reach = std::sqrt(4 * most / static_cast<float>(least));
    return std::max(reach, radius) / static_cast<float>(frame.scale());
}

glm::vec3 any_direction(std::mt19937_64& random) {
    std::normal_distribution<float> normal;
    for (;;) {
        const float x = normal(random), y = normal(random), z = normal(random);
        const glm::vec3 d(x, y, z);
        if (glm::dot(d, d) > 1e-6f)
            return glm::normalize(d);
    }
}

/// Compares light blocked by the volume with rays, at receivers in the box.
void judge(const Scene& part, const Points& points, const BakeOptions& options, const PlacedOccluder& where,
           const Progress& progress, OccluderBake& baked) {
    std::mt19937_64 random(options.seed);
    std::vector<glm::vec3> normals;
    for (std::size_t p = 0; p < points.at.size(); ++p)
        normals.push_back(any_direction(random));
    const std::vector<std::optional<float>> truth =
        blocked_by_rays(part, points.in_scene, normals, options, progress);
    double count = 0;
    for (std::size_t p = 0; p < truth.size(); ++p) {
        if (!truth[p])
            continue;
        const float found = blocked_cosine(blocked_at(baked.volume, where, points.in_scene[p]), normals[p]);
        baked.mean_error += std::abs(static_cast<double>(found - *truth[p]));
        baked.mean_blocked += static_cast<double>(*truth[p]);
        count += 1;
    }
    baked.mean_error /= std::max(count, 1.0);
    baked.mean_blocked /= std::max(count, 1.0);
}

} // namespace

OccluderBake bake_occluder(const Scene& part, const glm::dmat4& to_scene, const OccluderOptions& options,
                           const Progress& progress) {
    const Frame frame(to_scene);
    OccluderBake baked;
    place_box(part, frame, options.margin, baked.volume);
    BakeOptions bake = bake_options(options);
    Seen seen =
        look(part, points_in(baked.volume, frame, kFitPoints, options.seed), bake, progress.range(0, 0.8));
    if (seen.points.empty())
        throw Error("all points around the object are inside solid geometry");
    baked.volume.reach = reach_of(baked.volume, seen, frame, options.least);
    check_occlusion_volume(baked.volume);
    for (BlockedPoint& point : seen.points)
        point.blocked_direction = frame.direction_from_scene(point.blocked_direction);
    fit_texels(seen.points, baked.volume);
    bake.seed += kSecondScramble;
    judge(part, points_in(baked.volume, frame, kJudgePoints, bake.seed), bake,
          placed(baked.volume, glm::mat4(to_scene), 0), progress.range(0.8, 1), baked);
    baked.rays = (kFitPoints + kJudgePoints) * static_cast<std::size_t>(options.rays);
    return baked;
}

} // namespace prt
