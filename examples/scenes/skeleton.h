#pragma once

// A skeleton with skin weights and its movements.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace examples {

/// A joint; at rest it is not rotated relative to the world.
struct Joint {
    std::string name;
    int parent;         ///< index of an earlier joint, -1 for the first
    glm::vec3 position; ///< at rest, metres, in the world
};

/// The rotations of one joint relative to its parent.
struct JointTrack {
    int joint;
    std::vector<glm::quat> rotations;      ///< one per key
    std::vector<glm::vec3> positions = {}; ///< relative to the parent, metres; empty: the rest position
};

/// A movement whose last key equals its first, linear between keys.
struct Movement {
    std::string name;
    std::vector<float> times; ///< times of the keys, seconds
    std::vector<JointTrack> tracks;
    float speed = 0; ///< metres per second along +Z at which feet on the ground do not slide
};

struct Skeleton {
    std::vector<Joint> joints;
    std::vector<Movement> movements;
};

/// Joints and weights of each vertex. [vertices]; empty: it is not skinned
struct SkinWeights {
    std::vector<glm::u8vec4> joints;
    std::vector<glm::vec4> weights; ///< sum to 1
};

} // namespace examples
