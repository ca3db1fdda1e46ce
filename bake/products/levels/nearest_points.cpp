// Searches a hierarchy of triangles for the nearest points, and selects among them by normals.

#include "bake/products/levels/nearest_points.h"

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>

namespace prt {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Largest diagonal of the bounding boxes of the nodes: instances of one mesh may be spread all over a scene.
double largest_diagonal(const Scene& scene) {
    std::map<int, Bounds> boxes;
    for (const Primitive& primitive : scene.primitives)
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner) {
                const glm::vec3& p = scene.vertex_arrays[primitive.vertices].positions[t[corner]];
                Bounds& box = boxes.try_emplace(primitive.node, Bounds{p, p}).first->second;
                box = {glm::min(box.low, p), glm::max(box.high, p)};
            }
    double largest = 0;
    for (const auto& [node, box] : boxes)
        largest = std::max(largest, glm::distance(glm::dvec3(box.low), glm::dvec3(box.high)));
    return largest;
}

/// Visits triangles, starting with the whole scene; `visit` returns the distance within which other triangles
/// matter.
template <class Visit>
void visit_nearest(RTCScene scene, const glm::vec3& position, Visit&& visit) {
    RTCPointQuery query{position.x, position.y, position.z, 0, std::numeric_limits<float>::infinity()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        scene, &query, &context,
        [](RTCPointQueryFunctionArguments* arguments) {
            const float radius =
                (*static_cast<std::remove_reference_t<Visit>*>(arguments->userPtr))(arguments->primID);
            if (!(radius < arguments->query->radius))
                return false;
            arguments->query->radius = radius;
            return true;
        },
        &visit);
}

} // namespace

std::array<double, 3> nearest_on_triangle(const std::array<glm::dvec3, 3>& corners,
                                          const glm::dvec3& position) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 ab = b - a, ac = c - a, ap = position - a, bp = position - b, cp = position - c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp),
                 d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d1 <= 0 && d2 <= 0)
        return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3)
        return {0, 1, 0};
    if (d6 >= 0 && d5 <= d6)
        return {0, 0, 1};
    const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
    if (of_c <= 0 && d1 >= 0 && d3 <= 0)
        return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    if (of_b <= 0 && d2 >= 0 && d6 <= 0)
        return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    if (of_a <= 0 && d4 >= d3 && d5 >= d6) {
        const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - share, share};
    }
    const double all = of_a + of_b + of_c;
    return {of_a / all, of_b / all, of_c / all};
}

void NearestRule::begin(const glm::vec3& position, const glm::vec3& normal) {
    position_ = glm::dvec3(position);
    normal_ = glm::dvec3(normal);
    any_ = agreeing_ = {kInfinite, {kNoTriangle, {}, kInfinite}};
}

void NearestRule::add(std::uint32_t triangle, const std::array<glm::dvec3, 3>& corners,
                      const std::array<glm::dvec3, 3>& normals) {
    const std::array<double, 3> shares = nearest_on_triangle(corners, position_);
    glm::dvec3 at(0), normal(0);
    for (std::size_t i = 0; i < 3; ++i) {
        at += shares[i] * corners[i];
        normal += shares[i] * normals[i];
    }
    const double length = glm::length(normal), cosine = length > 0 ? glm::dot(normal, normal_) / length : -1,
                 lean = tie_ * (1 - std::min(cosine, 1.0)), distance = glm::distance(at, position_),
                 score = distance * distance + lean * lean;
    const NearestPoint point{triangle, shares, distance};
    if (any_.worse_than(score, triangle))
        any_ = {score, point};
    if (cosine >= kMinCosine && agreeing_.worse_than(score, triangle))
        agreeing_ = {score, point};
}

double NearestRule::radius() const {
    return std::min(std::sqrt(agreeing_.score), std::sqrt(any_.score) + reach_);
}

NearestPoint NearestRule::result() const {
    return std::sqrt(agreeing_.score) <= std::sqrt(any_.score) + reach_ ? agreeing_.position : any_.position;
}

NearestPoints::NearestPoints(const TraceScene& scene, const Receivers& receivers)
    : scene_(scene), receivers_(receivers) {
    diagonal_ = largest_diagonal(scene.scene());
    lit_.resize(scene.surfaces().triangles());
    for (std::uint32_t t = 0; t < lit_.size(); ++t) {
        const glm::uvec3& corners = scene.surfaces().corners(t);
        lit_[t] = true;
        for (int i = 0; i < 3; ++i)
            lit_[t] =
                lit_[t] && receivers.areas[corners[i]] > 0 && receivers.normals[corners[i]] != glm::vec3(0);
    }
}

std::array<glm::dvec3, 3> NearestPoints::at_corners(const std::vector<glm::vec3>& values,
                                                    std::uint32_t triangle) const {
    const glm::uvec3& corners = scene_.surfaces().corners(triangle);
    return {glm::dvec3(values[corners.x]), glm::dvec3(values[corners.y]), glm::dvec3(values[corners.z])};
}

NearestPoint NearestPoints::find(const glm::vec3& position, const glm::vec3& normal) const {
    NearestRule rule(diagonal_);
    rule.begin(position, normal);
    // Boxes are floats, and so is the radius: also visit triangles that are equally near up to rounding.
    constexpr double kRounding = 1 + 1e-6;
    visit_nearest(scene_.rays().handle(), position, [&](unsigned triangle) {
        if (lit_[triangle])
            rule.add(triangle, at_corners(receivers_.positions, triangle),
                     at_corners(receivers_.normals, triangle));
        return static_cast<float>(kRounding * rule.radius());
    });
    return rule.result();
}

} // namespace prt
