// Solves two least-squares problems with 512 unknowns each: for the blocked share, and for its direction.

#include "bake/products/occlusion/occluder_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace prt {
namespace {

constexpr int kTexels = static_cast<int>(kOccluderTexels);

/// Corners of the cell that contains a position, with trilinear weights.
struct CellCorners {
    std::array<int, 8> texels;
    std::array<double, 8> weights;
};

int texel_of(const glm::ivec3& corner) {
    return (corner.z * kOccluderSide + corner.y) * kOccluderSide + corner.x;
}

CellCorners corners_of(const glm::vec3& at) {
    const glm::vec3 along = at * static_cast<float>(kOccluderSide - 1);
    const glm::ivec3 low = glm::clamp(glm::ivec3(along), glm::ivec3(0), glm::ivec3(kOccluderSide - 2));
    const glm::dvec3 over(along - glm::vec3(low));
    CellCorners corners{};
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
        const glm::dvec3 weight = glm::mix(1.0 - over, over, glm::dvec3(corner));
        corners.texels[i] = texel_of(low + corner);
        corners.weights[i] = weight.x * weight.y * weight.z;
    }
    return corners;
}

/// min sum weight |sum w x - value|² + least |second differences|²
class Equations {
public:
    Equations() : a_(Eigen::MatrixXd::Zero(kTexels, kTexels)), b_(Eigen::MatrixX3d::Zero(kTexels, 3)) {}

    void add(const CellCorners& corners, double weight, const glm::dvec3& value) {
        for (std::size_t i = 0; i < 8; ++i) {
            const double w = weight * corners.weights[i];
            for (std::size_t j = 0; j < 8; ++j)
                a_(corners.texels[i], corners.texels[j]) += w * corners.weights[j];
            for (int c = 0; c < 3; ++c)
                b_(corners.texels[i], c) += w * value[c];
        }
    }

    /// Adds second differences along each axis.
    void smooth(double weight) {
        for (int t = 0; t < kTexels; ++t) {
            const glm::ivec3 at(t % kOccluderSide, t / kOccluderSide % kOccluderSide,
                                t / (kOccluderSide * kOccluderSide));
            for (int axis = 0; axis < 3; ++axis) {
                if (at[axis] == 0 || at[axis] == kOccluderSide - 1)
                    continue;
                glm::ivec3 step(0);
                step[axis] = 1;
                const std::array<int, 3> row = {texel_of(at - step), t, texel_of(at + step)};
                constexpr std::array<double, 3> kSecond = {1, -2, 1};
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t j = 0; j < 3; ++j)
                        a_(row[i], row[j]) += weight * kSecond[i] * kSecond[j];
            }
        }
        // Values that are linear along all axes are not constrained by second differences alone.
        a_.diagonal().array() += 1e-6 * weight;
    }

    Eigen::MatrixX3d solution() const { return a_.ldlt().solve(b_); }

private:
    Eigen::MatrixXd a_;
    Eigen::MatrixX3d b_;
};

} // namespace

void fit_texels(std::span<const BlockedPoint> points, OcclusionVolume& volume) {
    // A fiftieth of the weight of one point at a texel: smoothness decides only where there are no points.
    constexpr double kSmooth = 0.02;
    Equations much, where;
    double all = 0;
    for (const BlockedPoint& point : points) {
        const CellCorners corners = corners_of(point.at);
        const auto root = std::sqrt(static_cast<double>(point.blocked));
        much.add(corners, 1, {root, 0, 0});
        where.add(corners, root, glm::dvec3(point.blocked_direction));
        all += root;
    }
    much.smooth(kSmooth);
    where.smooth(kSmooth * std::max(all / static_cast<double>(points.size()), 1e-3));
    const Eigen::MatrixX3d roots = much.solution(), leans = where.solution();
    for (int t = 0; t < kTexels; ++t) {
        const auto root = static_cast<float>(std::clamp(roots(t, 0), 0.0, 1.0));
        glm::vec3 blocked_direction(leans(t, 0), leans(t, 1), leans(t, 2));
        blocked_direction /= std::max(glm::length(blocked_direction), 1.0f);
        volume.texels[static_cast<std::size_t>(t)] = occluder_texel(root * root, blocked_direction);
    }
}

} // namespace prt
