#pragma once

// Joints that vertices hang on, and how they move.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace examples {

/// At rest no joint is turned against the world.
struct Joint {
    std::string name;
    int parent;         ///< index of an earlier joint, -1 for the first
    glm::vec3 position; ///< at rest, metres, in the world
};

/// The turns of one joint against its parent.
struct JointTrack {
    int joint;
    std::vector<glm::quat> rotations;      ///< a key each
    std::vector<glm::vec3> positions = {}; ///< against the parent, metres; empty: as at rest
};

/// A movement that ends where it begins, linear between keys.
struct Movement {
    std::string name;
    std::vector<float> times; ///< seconds of the keys
    std::vector<JointTrack> tracks;
    float speed = 0; ///< metres per second along +Z at which feet on the ground stand still
};

struct Skeleton {
    std::vector<Joint> joints;
    std::vector<Movement> movements;
};

/// By which joints each vertex goes. [vertices]; empty: it hangs on none
struct SkinWeights {
    std::vector<glm::u8vec4> joints;
    std::vector<glm::vec4> weights; ///< sum to 1
};

} // namespace examples
