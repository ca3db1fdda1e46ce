// Fits a disc to texels by least squares (Ceres): seven parameters, including its center (two) and its
// radius.
#include "runtime/fit/disc_fit.h"

#include "runtime/fit/across.h"

#include <ceres/ceres.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace prt {
namespace {

/// A texel in the plane about the spot, in units of the spot's radius. Brightness is in units of the peak's
/// height above the sky. All values are therefore of magnitude 1 for any image.
struct PlaneTexel {
    double x, y;
    double brightness;
    double weight;
};

/// In the order of the parameters; `slope_x` and `slope_y` belong to the sky.
enum Parameter { middle_x, middle_y, radius, height, sky, slope_x, slope_y, kParameters };

/// Returns the fraction of a texel that the disc covers if the texel is `inside` texels inside the edge: a
/// smooth ramp of one and a half texels, which approximates a square of any orientation.
template <class T>
T coverage(const T& inside) {
    const T share = inside / 1.5 + 0.5;
    if (share <= 0.0)
        return T(0);
    if (share >= 1.0)
        return T(1);
    return share * share * (3.0 - 2.0 * share);
}

struct DiscResidual {
    const std::vector<PlaneTexel>& texels;
    double step; ///< distance of texels, in units of the spot's radius

    template <class T>
    bool operator()(const T* p, T* residuals) const {
        for (std::size_t i = 0; i < texels.size(); ++i) {
            const PlaneTexel& texel = texels[i];
            const T x = texel.x - p[middle_x], y = texel.y - p[middle_y];
            const T distance = ceres::sqrt(x * x + y * y + 1e-12); // differentiable at the center
            const T model = p[sky] + p[slope_x] * texel.x + p[slope_y] * texel.y +
                            p[height] * coverage(T((p[radius] - distance) / step));
            residuals[i] = texel.weight * (model - texel.brightness);
        }
        return true;
    }
};

std::vector<PlaneTexel> in_plane(const std::vector<NearTexel>& near, const Spot& spot, const Across& across) {
    std::vector<PlaneTexel> texels;
    for (const NearTexel& texel : near) {
        // Distances from the center are angles.
        const glm::dvec2 at(glm::dot(texel.direction, across.x), glm::dot(texel.direction, across.y));
        const double sine = glm::length(at), scale = (sine > 0 ? texel.angle / sine : 1) / spot.radius;
        texels.push_back({at.x * scale, at.y * scale,
                          (brightness(texel.color) - spot.sky) / (spot.peak - spot.sky),
                          std::sqrt(texel.solid_angle) / spot.radius});
    }
    return texels;
}

/// Returns a disc with the brightness of the peak and the total light of `spot`: for a spot of one texel, a
/// disc of the same solid angle.
Disc narrow_disc(const SkyMap& map, const Spot& spot) {
    glm::dvec3 sum(0);
    double area = 0;
    for (const NearTexel& texel : map.near(spot.towards, spot.radius + 1.5 * map.texels().spacing())) {
        const double share = (brightness(texel.color) - spot.sky) / (spot.peak - spot.sky);
        if (share > 0) {
            sum += share * texel.solid_angle * texel.direction;
            area += share * texel.solid_angle;
        }
    }
    return {glm::normalize(sum), std::sqrt(area / std::numbers::pi)};
}

} // namespace

Disc fitted_disc(const SkyMap& map, const Spot& spot) {
    const Disc unfitted = narrow_disc(map, spot);
    const double step = map.texels().spacing();
    if (spot.radius < 1.2 * step)
        return unfitted;
    const Across across(spot.towards);
    const std::vector<PlaneTexel> texels =
        in_plane(map.near(spot.towards, std::max(1.5 * spot.radius, spot.radius + 3 * step)), spot, across);
    double p[kParameters] = {0, 0, 1, 1, 0, 0, 0};
    ceres::Problem problem;
    problem.AddResidualBlock(
        std::make_unique<ceres::AutoDiffCostFunction<DiscResidual, ceres::DYNAMIC, kParameters>>(
            new DiscResidual{texels, step / spot.radius}, static_cast<int>(texels.size()))
            .release(),
        nullptr, p);
    // Start values at half of the peak are closer than these bounds for every real disc.
    for (const Parameter middle : {middle_x, middle_y}) {
        problem.SetParameterLowerBound(p, middle, -0.5);
        problem.SetParameterUpperBound(p, middle, 0.5);
    }
    problem.SetParameterLowerBound(p, radius, 0.5);
    problem.SetParameterUpperBound(p, radius, 1.5);
    problem.SetParameterLowerBound(p, height, 0);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.function_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
        return unfitted;
    const double distance = spot.radius * std::hypot(p[middle_x], p[middle_y]);
    const glm::dvec3 aside = p[middle_x] * across.x + p[middle_y] * across.y;
    const glm::dvec3 towards =
        distance > 0 ? std::cos(distance) * spot.towards + std::sin(distance) * glm::normalize(aside)
                     : spot.towards;
    return {glm::normalize(towards), p[radius] * spot.radius};
}

} // namespace prt
