// Samples the poses of a cycle as keys.

#include "figure/movement.h"

#include <cmath>
#include <numbers>

namespace examples::anatomy {

float wave(float phase) {
    return std::cos(2 * std::numbers::pi_v<float> * phase);
}

Movement movement_of(std::string name, Pose (*pose_at)(float phase), float period, int keys) {
    Movement movement{std::move(name), {}, {}};
    for (int joint = 0; joint < bone_count; ++joint)
        movement.tracks.push_back({joint, {}});
    for (int key = 0; key <= keys; ++key) {
        const float phase = static_cast<float>(key) / static_cast<float>(keys);
        const Pose pose = pose_at(key == keys ? 0 : phase);
        movement.times.push_back(period * phase);
        movement.tracks[hips].positions.push_back(pose.hips_position);
        for (JointTrack& track : movement.tracks)
            track.rotations.push_back(pose.rotations[static_cast<std::size_t>(track.joint)]);
    }
    return movement;
}

} // namespace examples::anatomy
