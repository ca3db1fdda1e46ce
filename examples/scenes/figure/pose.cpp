// Solves the angles of legs and arms.

#include "figure/pose.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <stdexcept>

namespace examples::anatomy {
namespace {

constexpr glm::vec3 kSideways(1, 0, 0);

/// Returns the rotation of a bone that points along -Y at rest to `along`, and of its X axis to `sideways`,
/// which is normal to `along`.
glm::quat bone_rotation(const glm::vec3& along, const glm::vec3& sideways) {
    return glm::quat_cast(glm::mat3(sideways, -along, glm::cross(sideways, -along)));
}

/// The knee between hip and ankle, in front of the line through both.
glm::vec3 knee_between(const glm::vec3& hip, const glm::vec3& ankle, const glm::vec3& sideways) {
    const float distance = glm::distance(hip, ankle);
    if (distance >= kThigh + kShin)
        throw std::logic_error("a leg of the figure is too short for the step");
    const glm::vec3 down = (ankle - hip) / distance;
    const float along = (kThigh * kThigh - kShin * kShin + distance * distance) / (2 * distance);
    return hip + along * down + std::sqrt(kThigh * kThigh - along * along) * glm::cross(sideways, -down);
}

} // namespace

std::array<glm::quat, bone_count> Pose::rotated() {
    std::array<glm::quat, bone_count> rotations;
    rotations.fill(glm::quat(1, 0, 0, 0));
    return rotations;
}

glm::quat rotation(float angle, const glm::vec3& axis) {
    return glm::angleAxis(angle, axis);
}

void place_foot(Pose& pose, Side side, const FootPosition& point, float aside) {
    const std::vector<Joint> rest = joints();
    const auto first = static_cast<std::size_t>(thigh(side));
    const glm::quat& pelvis = pose.rotations[hips];
    const glm::vec3 hip = pose.hips_position + pelvis * (rest[first].position - rest[hips].position);
    const glm::vec3 ankle(sign_of(side) * aside, point.height, point.ahead);
    const glm::vec3 down = glm::normalize(ankle - hip);
    const glm::vec3 sideways = glm::normalize(kSideways - glm::dot(kSideways, down) * down);
    const glm::vec3 knee = knee_between(hip, ankle, sideways);
    const glm::quat upper = bone_rotation(glm::normalize(knee - hip), sideways);
    const glm::quat lower = bone_rotation(glm::normalize(ankle - knee), sideways);
    pose.rotations[first] = glm::conjugate(pelvis) * upper;
    pose.rotations[first + 1] = glm::conjugate(upper) * lower;
    pose.rotations[first + 2] = glm::conjugate(lower) * rotation(-point.pitch, kSideways);
    pose.rotations[first + 3] = rotation(-point.toe_bend, kSideways);
}

} // namespace examples::anatomy
