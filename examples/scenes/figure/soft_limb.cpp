// Builds soft limbs and their skin weights.

#include "figure/soft_limb.h"

#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace examples::anatomy {
namespace {

constexpr int kCapRings = 3;

Section operator*(float factor, const Section& s) {
    return {factor * s.along, factor * s.half_width, factor * s.half_depth, factor * s.ahead};
}

Section operator+(const Section& a, const Section& b) {
    return {a.along + b.along, a.half_width + b.half_width, a.half_depth + b.half_depth, a.ahead + b.ahead};
}

/// Returns the section between `sections[i]` and the next by Catmull-Rom interpolation.
Section between(std::span<const Section> sections, std::size_t i, float t) {
    const Section& a = sections[i];
    const Section& b = sections[i + 1];
    const float length = b.along - a.along;
    const auto tangent = [&](std::size_t at) {
        const Section& before = sections[at == 0 ? 0 : at - 1];
        const Section& after = sections[std::min(at + 1, sections.size() - 1)];
        return (length / (after.along - before.along)) * (after + -1.0f * before);
    };
    const float t2 = t * t, t3 = t2 * t;
    Section section = (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * tangent(i) + (3 * t2 - 2 * t3) * b +
                      (t3 - t2) * tangent(i + 1);
    section.along = a.along + t * length;
    return section;
}

/// A ring of the round end at `end`, `share` of the way to its pole.
Section cap_ring(const Section& end, float reach, float share) {
    const float angle = share * kTurn / 4;
    const float shrunk = share == 1 ? 0 : std::cos(angle);
    return {end.along + reach * std::sin(angle), end.half_width * shrunk, end.half_depth * shrunk, end.ahead};
}

std::vector<Section> rings_of(std::span<const Section> sections, const LimbShape& shape) {
    std::vector<Section> rings;
    for (int ring = kCapRings; ring > 0; --ring)
        rings.push_back(cap_ring(sections.front(), -shape.first_cap,
                                 static_cast<float>(ring) / static_cast<float>(kCapRings)));
    for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
        const float length = sections[i + 1].along - sections[i].along;
        const int steps = std::max(1, static_cast<int>(std::lround(length / shape.spacing)));
        for (int step = 0; step < steps; ++step)
            rings.push_back(between(sections, i, static_cast<float>(step) / static_cast<float>(steps)));
    }
    for (int ring = 0; ring <= kCapRings; ++ring)
        rings.push_back(cap_ring(sections.back(), shape.last_cap,
                                 static_cast<float>(ring) / static_cast<float>(kCapRings)));
    return rings;
}

std::vector<glm::vec3> ring_points(const LimbFrame& frame, const Section& section, const LimbShape& shape) {
    const glm::vec3 side = glm::cross(frame.axis, frame.front);
    const auto rounded = [&](float x) {
        return std::copysign(std::pow(std::abs(x), 2 / shape.squareness), x);
    };
    std::vector<glm::vec3> points;
    for (int i = 0; i <= shape.segments; ++i) {
        const float angle =
            kTurn * static_cast<float>(i % shape.segments) / static_cast<float>(shape.segments);
        glm::vec3 point = frame.origin + section.along * frame.axis +
                          section.half_width * rounded(std::sin(angle)) * side +
                          (section.ahead + section.half_depth * rounded(std::cos(angle))) * frame.front;
        point.y = std::max(point.y, shape.floor);
        points.push_back(point);
    }
    return points;
}

/// The two joints that hold a vertex at `along`, and how much each does.
void hang(SkinWeights& skin, std::span<const HeldBy> joints, float along) {
    std::size_t last = 0;
    while (last + 1 < joints.size() && along > joints[last + 1].from - joints[last + 1].blend)
        ++last;
    const HeldBy& held = joints[last];
    const HeldBy& before = joints[last == 0 ? 0 : last - 1];
    const float share =
        last == 0 ? 1 : glm::smoothstep(held.from - held.blend, held.from + held.blend, along);
    // glTF wants joint 0 where a weight is 0.
    skin.joints.emplace_back(held.joint, share < 1 ? before.joint : 0, 0, 0);
    skin.weights.emplace_back(share, 1 - share, 0, 0);
}

} // namespace

void append(SoftMesh& mesh, const SoftMesh& other) {
    append(mesh.mesh, other.mesh);
    mesh.skin.joints.insert(mesh.skin.joints.end(), other.skin.joints.begin(), other.skin.joints.end());
    mesh.skin.weights.insert(mesh.skin.weights.end(), other.skin.weights.begin(), other.skin.weights.end());
}

SoftMesh soft_limb(const LimbFrame& frame, std::span<const Section> sections, std::span<const HeldBy> joints,
                   const LimbShape& shape) {
    std::vector<std::vector<glm::vec3>> rows;
    for (const Section& ring : rings_of(sections, shape))
        rows.push_back(ring_points(frame, ring, shape));
    SoftMesh limb{lofted(rows), {}};
    for (const glm::vec3& position : limb.mesh.positions)
        hang(limb.skin, joints, glm::dot(position - frame.origin, frame.axis));
    return limb;
}

} // namespace examples::anatomy
