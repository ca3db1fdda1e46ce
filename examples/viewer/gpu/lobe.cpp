// Builds the mesh of a spherical function.

#include "gpu/lobe.h"

#include "prt/core/sh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

constexpr int kRings = 32, kSegments = 64;

glm::vec3 direction(int ring, int segment) {
    const float polar = std::numbers::pi_v<float> * static_cast<float>(ring) / kRings,
                azimuth = 2 * std::numbers::pi_v<float> * static_cast<float>(segment) / kSegments;
    return {std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
}

} // namespace

ColoredMesh make_lobe(int order, std::span<const float> function, const glm::vec3& center, float radius,
                      const glm::vec3& towards_eye) {
    ColoredMesh mesh;
    std::vector<float> values;
    for (int ring = 0; ring <= kRings; ++ring)
        for (int segment = 0; segment <= kSegments; ++segment)
            values.push_back(prt::sh_value(order, function, direction(ring, segment)));
    float largest = 0;
    for (const float value : values)
        largest = std::max(largest, std::abs(value));
    const float scale = largest > 0 ? radius / largest : 0;
    constexpr auto kRow = static_cast<std::uint32_t>(kSegments + 1);
    for (int ring = 0; ring <= kRings; ++ring)
        for (int segment = 0; segment <= kSegments; ++segment) {
            const glm::vec3 d = direction(ring, segment);
            const float value =
                values[static_cast<std::size_t>(ring) * kRow + static_cast<std::size_t>(segment)];
            mesh.positions.push_back(center + d * (scale * std::abs(value)));
            // Shaded like a sphere, so that it looks round.
            const float shade = 0.35f + 0.65f * std::max(0.0f, glm::dot(d, towards_eye));
            mesh.colors.emplace_back(
                shade * (value >= 0 ? glm::vec3(0.95f, 0.3f, 0.1f) : glm::vec3(0.1f, 0.35f, 0.95f)), 1);
        }
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
        for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
            const std::uint32_t a = ring * kRow + segment, b = a + kRow;
            mesh.triangles.emplace_back(a, b, b + 1);
            mesh.triangles.emplace_back(a, b + 1, a + 1);
        }
    return mesh;
}

} // namespace viewer
