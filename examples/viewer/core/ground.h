#pragma once

// Finds positions in a scene where a figure can walk.

#include "pictures/model.h"

#include <glm/vec3.hpp>

#include <optional>

namespace viewer {

/// Size of a walking figure, metres.
struct Walker {
    float height = 1.8f, width = 0.6f;
    float step = 0.35f; ///< maximum height of a step
};

class Ground {
public:
    /// Keeps a reference to `model`.
    Ground(const Model& model, const Walker& walker) : model_(model), walker_(walker) {}

    /// Returns the floor below `position` if a figure fits there: the floor is not too steep and the headroom
    /// suffices.
    std::optional<glm::vec3> below(const glm::vec3& position) const;
    /// Returns the free distance from the position `floor` along the horizontal unit direction `towards`, at
    /// most `reach`: up to an obstacle for legs, body or shoulders, or to the end of the floor.
    float free_way(const glm::vec3& floor, const glm::vec3& towards, float reach) const;
    /// Returns the floor position with the most free room around it, up to half of the scene's height; empty
    /// if there is none.
    std::optional<glm::vec3> widest() const;

private:
    std::optional<prt::RayHit> hit(const glm::vec3& from, const glm::vec3& towards, float reach) const;
    float free_body_way(const glm::vec3& floor, const glm::vec3& towards, float reach) const;
    float room_about(const glm::vec3& floor) const;

    const Model& model_;
    Walker walker_;
};

} // namespace viewer
