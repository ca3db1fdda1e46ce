// Selects the times of poses.

#include "prt/bake/pose_bake.h"
#include "prt/core/error.h"

#include <algorithm>

namespace prt {
namespace {

std::vector<const Animation*> chosen_animations(const AnimatedScene& model, const std::string& only) {
    if (model.animations().empty())
        throw Error("has no animation, but poses need one");
    std::vector<const Animation*> animations;
    for (const Animation& animation : model.animations())
        if (only.empty() || animation.name == only)
            animations.push_back(&animation);
    if (!animations.empty())
        return animations;
    std::string names;
    for (const Animation& animation : model.animations())
        names += (names.empty() ? "" : ", ") + animation.name;
    throw Error("has no animation '" + only + "'; available: " + names);
}

ModelPose pose_at(const AnimatedScene& model, const Animation& animation, double seconds) {
    return {animation.name, seconds, model.pose(animation, seconds)};
}

/// Appends poses at (i + offset) / count of the total time of all animations.
void add_poses(const AnimatedScene& model, std::span<const Animation* const> animations, int count,
               double offset, std::vector<ModelPose>& poses) {
    double all = 0;
    for (const Animation* animation : animations)
        all += animation->duration;
    for (int i = 0; i < count; ++i) {
        double seconds = (i + offset) / count * all;
        std::size_t which = 0;
        while (which + 1 < animations.size() && seconds >= animations[which]->duration)
            seconds -= animations[which++]->duration;
        if (all == 0) // all animations have zero duration
            which = static_cast<std::size_t>(i) % animations.size();
        poses.push_back(pose_at(model, *animations[which], seconds));
    }
}

void check_count(int count) {
    if (count < 1)
        throw Error("the number of poses must be at least 1");
}

} // namespace

std::vector<ModelPose> poses_of(const AnimatedScene& model, int count, const std::string& only) {
    check_count(count);
    const std::vector<const Animation*> animations = chosen_animations(model, only);
    std::vector<ModelPose> poses = {{"", 0, model.rest()}};
    add_poses(model, animations, count, 0.5, poses);
    return poses;
}

std::vector<bool> moving_arrays(const AnimatedScene& model, std::span<const ModelPose> poses) {
    const std::vector<glm::dmat4> rest = model.rest();
    std::vector<bool> moving;
    for (const MovingVertices& vertices : model.vertices())
        moving.push_back(vertices.skin >= 0 || vertices.morphs ||
                         std::ranges::any_of(poses, [&](const ModelPose& pose) {
                             return pose.nodes[vertices.node] != rest[vertices.node];
                         }));
    return moving;
}

std::vector<LeveledNode> moving_levels(const AnimatedScene& model, std::span<const ModelPose> poses) {
    const std::vector<bool> moving = moving_arrays(model, poses);
    std::vector<LeveledNode> nodes = model.leveled().nodes;
    keep_levels(nodes, model.scene(), [&](const Primitive& p) { return moving[p.vertices]; });
    return nodes;
}

std::vector<ModelPose> frames_of(const AnimatedScene& model, int count, const std::string& only) {
    check_count(count);
    const std::vector<const Animation*> animations = chosen_animations(model, only);
    std::vector<ModelPose> poses;
    add_poses(model, animations, count, 0, poses);
    return poses;
}

} // namespace prt
