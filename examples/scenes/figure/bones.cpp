// Joints of the figure at rest.

#include "figure/bones.h"

#include <cmath>

namespace examples::anatomy {
namespace {

constexpr float kArmAngle = 0.31f; ///< radians, of arms at rest from the vertical

void add_arm(std::vector<Joint>& joints, Side side, const std::string& name) {
    const glm::vec3 shoulder(0.195f * sign_of(side), 1.43f, -0.005f), along = arm_direction(side);
    const auto first = static_cast<int>(joints.size());
    joints.push_back({name + "_upper_arm", chest, shoulder});
    joints.push_back({name + "_forearm", first, shoulder + kUpperArm * along});
    joints.push_back({name + "_hand", first + 1, shoulder + (kUpperArm + kForearm) * along});
}

void add_leg(std::vector<Joint>& joints, Side side, const std::string& name) {
    const float x = 0.095f * sign_of(side);
    const auto first = static_cast<int>(joints.size());
    joints.push_back({name + "_thigh", hips, {x, kAnkleHeight + kShin + kThigh, 0}});
    joints.push_back({name + "_shin", first, {x, kAnkleHeight + kShin, 0}});
    joints.push_back({name + "_foot", first + 1, {x, kAnkleHeight, 0}});
    joints.push_back({name + "_toes", first + 2, {x, kBallHeight, kBallAhead}});
}

} // namespace

glm::vec3 arm_direction(Side side) {
    return {sign_of(side) * std::sin(kArmAngle), -std::cos(kArmAngle), 0};
}

std::vector<Joint> joints() {
    std::vector<Joint> all = {{"hips", -1, {0, 0.95f, 0}},
                              {"spine", hips, {0, 1.08f, 0}},
                              {"chest", spine, {0, 1.25f, 0}},
                              {"neck", chest, {0, 1.49f, -0.01f}},
                              {"head", neck, {0, 1.585f, 0}}};
    add_arm(all, Side::left, "left");
    add_arm(all, Side::right, "right");
    add_leg(all, Side::left, "left");
    add_leg(all, Side::right, "right");
    return all;
}

} // namespace examples::anatomy
