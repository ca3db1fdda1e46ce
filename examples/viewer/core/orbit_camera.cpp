// Rotates, moves and zooms the orbit camera.

#include "core/orbit_camera.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

constexpr float kHalfTurn = std::numbers::pi_v<float>;
constexpr float kSteepest = 0.49f * kHalfTurn; ///< `up` must not be parallel to the view direction

} // namespace

OrbitCamera::OrbitCamera(const prt::Camera& camera)
    : target_(camera.target), distance_(glm::distance(camera.position, camera.target)),
      field_of_view_(camera.vertical_field_of_view) {
    const glm::vec3 from = (camera.position - camera.target) / std::max(distance_, 1e-30f);
    yaw_ = std::atan2(from.x, from.z);
    pitch_ = std::clamp(std::asin(std::clamp(from.y, -1.0f, 1.0f)), -kSteepest, kSteepest);
}

void OrbitCamera::orbit(const glm::vec2& rotations) {
    yaw_ = std::remainder(yaw_ - kHalfTurn * rotations.x, 2 * kHalfTurn);
    pitch_ = std::clamp(pitch_ + kHalfTurn * rotations.y, -kSteepest, kSteepest);
}

void OrbitCamera::pan(const glm::vec2& way) {
    const prt::CameraFrame frame = prt::camera_frame(camera());
    const float height = 2 * distance_ * static_cast<float>(frame.half_height);
    target_ += height * (way.y * glm::vec3(frame.up) - way.x * glm::vec3(frame.right));
}

void OrbitCamera::zoom(float notches) {
    distance_ *= std::exp2(-0.2f * notches);
}

prt::Camera OrbitCamera::camera() const {
    const glm::vec3 from(std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_),
                         std::cos(pitch_) * std::cos(yaw_));
    return {target_ + distance_ * from, target_, {0, 1, 0}, field_of_view_};
}

} // namespace viewer
