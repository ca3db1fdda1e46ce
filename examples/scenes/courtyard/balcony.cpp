// A balcony in front of the three doors of the back wing, with an iron railing and a cloth over it.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace examples {
namespace {

using namespace plan;

constexpr float kOut = 0.95f, kFloor = kStorey + 0.1f, kRail = kFloor + 0.98f;

/// A baluster that bellies outwards.
Mesh baluster(const glm::vec3& foot, const glm::vec3& out) {
    const float height = kRail - kFloor;
    std::array<glm::vec3, 6> points;
    std::array<float, 6> radii;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float t = static_cast<float>(i) / 5;
        const float belly = 0.09f * std::exp(-std::pow((t - 0.27f) / 0.18f, 2.0f));
        points[i] = foot + glm::vec3(0, t * height, 0) + belly * out;
        radii[i] = 0.011f;
    }
    return bar(points, radii, 5);
}

/// A corbel under the floor, like a rolled leaf.
Mesh corbel(float x) {
    Mesh mesh;
    constexpr int kSteps = 10;
    std::vector<std::vector<glm::vec3>> under(2), side_a(2), side_b(2);
    for (int i = 0; i <= kSteps; ++i) {
        const float t = static_cast<float>(i) / kSteps;
        const float z = kOut * 0.85f * (1 - t), y = kFloor - 0.1f - 0.5f * t * t;
        under[0].emplace_back(x - 0.1f, y, z);
        under[1].emplace_back(x + 0.1f, y, z);
        side_a[0].emplace_back(x + 0.1f, y, z);
        side_a[1].emplace_back(x + 0.1f, kFloor - 0.06f, z);
        side_b[0].emplace_back(x - 0.1f, kFloor - 0.06f, z);
        side_b[1].emplace_back(x - 0.1f, y, z);
    }
    append(mesh, lofted(under));
    append(mesh, lofted(side_a));
    append(mesh, lofted(side_b));
    return mesh;
}

} // namespace

void add_balcony(Courtyard& to) {
    const glm::mat4 wing = back_wing();
    const float left = kBay - 0.25f, right = 4 * kBay + 0.25f;
    append(to.building.stone, placed(box({left, kFloor - 0.1f, 0}, {right, kFloor, kOut}), wing));
    for (int i = 1; i <= 4; ++i)
        append(to.building.stone, placed(corbel(static_cast<float>(i) * kBay), wing));
    const auto add_row = [&](const glm::vec3& from, const glm::vec3& to_point, const glm::vec3& out) {
        const int count = static_cast<int>(glm::distance(from, to_point) / 0.13f);
        for (int i = 0; i <= count; ++i)
            append(
                to.building.iron,
                placed(baluster(glm::mix(from, to_point, static_cast<float>(i) / static_cast<float>(count)),
                                out),
                       wing));
        const glm::vec3 up(0, kRail - kFloor, 0);
        append(to.building.iron, placed(bar(from + up, to_point + up, 0.024f, 8), wing));
        append(to.building.iron, placed(bar(from + 0.07f * up, to_point + 0.07f * up, 0.014f), wing));
    };
    const float front = kOut - 0.08f;
    const glm::vec3 a(left + 0.06f, kFloor, front), b(right - 0.06f, kFloor, front);
    add_row(a, b, {0, 0, 1});
    add_row({a.x, a.y, 0.02f}, a, {-1, 0, 0});
    add_row({b.x, b.y, 0.02f}, b, {1, 0, 0});
}

} // namespace examples
