// Finds floor and free room by casting rays into the scene.

#include "core/ground.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace viewer {
namespace {

constexpr glm::vec3 kDown(0, -1, 0);
/// Cosine of the steepest floor, 45 degrees.
constexpr float kSteepestGround = 0.7f;
/// Number of candidate positions along each side of the scene.
constexpr int kCandidates = 12;
constexpr int kDirections = 8;

glm::vec3 direction_round(int i, int count) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(count);
    return {std::sin(angle), 0, std::cos(angle)};
}

} // namespace

std::optional<prt::RayHit> Ground::hit(const glm::vec3& from, const glm::vec3& towards, float reach) const {
    return model_.trace->rays().nearest({from, towards, 0, reach});
}

std::optional<glm::vec3> Ground::below(const glm::vec3& position) const {
    const auto floor = hit(position, kDown, std::numeric_limits<float>::infinity());
    if (!floor)
        return {};
    const prt::RayScene::Triangle at = model_.trace->rays().triangle(floor->triangle);
    const prt::Primitive& primitive = model_.scene.primitives[at.primitive];
    const glm::uvec3& t = primitive.triangles[at.triangle];
    const std::vector<glm::vec3>& p = model_.scene.vertex_arrays[primitive.vertices].positions;
    const glm::vec3 normal = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
    if (normal.y < kSteepestGround * glm::length(normal))
        return {};
    const glm::vec3 stand = position + floor->distance * kDown;
    const float knee = 0.2f * walker_.height; // above objects on the floor
    if (hit(stand - knee * kDown, -kDown, walker_.height - knee))
        return {};
    return stand;
}

/// Returns the free distance at three heights and over the width of the body.
float Ground::free_body_way(const glm::vec3& floor, const glm::vec3& towards, float reach) const {
    const glm::vec3 side = glm::cross(towards, kDown);
    float way = reach;
    for (const float height : {0.25f, 0.55f, 0.9f})
        for (const float aside : {-0.5f, 0.0f, 0.5f}) {
            const glm::vec3 from = floor - height * walker_.height * kDown + aside * walker_.width * side;
            if (const auto wall = hit(from, towards, way))
                way = wall->distance;
        }
    return way;
}

float Ground::free_way(const glm::vec3& floor, const glm::vec3& towards, float reach) const {
    const float way = free_body_way(floor, towards, reach);
    glm::vec3 at = floor;
    const float stride = 0.5f * walker_.width;
    for (float walked = stride; walked <= way; walked += stride) {
        const auto next =
            below(floor + walked * towards + glm::vec3(0, at.y - floor.y + 2 * walker_.step, 0));
        if (!next || std::abs(next->y - at.y) > walker_.step)
            return walked - stride;
        at = *next;
    }
    return way;
}

/// Returns the mean free distance over all directions; each counts at most some metres.
float Ground::room_about(const glm::vec3& floor) const {
    constexpr float kEnough = 4;
    float sum = 0, least = kEnough;
    for (int i = 0; i < kDirections; ++i) {
        const float way = free_way(floor, direction_round(i, kDirections), kEnough);
        sum += way;
        least = std::min(least, way);
    }
    return least < walker_.width ? 0 : sum / static_cast<float>(kDirections);
}

std::optional<glm::vec3> Ground::widest() const {
    const prt::Bounds& box = model_.box;
    const float top = box.high.y + walker_.height;
    std::optional<glm::vec3> best;
    float most = 0;
    // Searches under a roof first, then on hills.
    for (const float height : {0.5f * (box.low.y + box.high.y), top}) {
        for (int i = 0; i < kCandidates * kCandidates; ++i) {
            const auto share = [](int k) { return (static_cast<float>(k) + 0.5f) / kCandidates; };
            const glm::vec3 position(std::lerp(box.low.x, box.high.x, share(i % kCandidates)), height,
                                     std::lerp(box.low.z, box.high.z, share(i / kCandidates)));
            const auto floor = below(position);
            const float room = floor ? room_about(*floor) : 0;
            if (room > most) {
                most = room;
                best = floor;
            }
        }
        if (best)
            return best;
    }
    return best;
}

} // namespace viewer
