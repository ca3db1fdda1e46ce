#pragma once

// Where in a scene somebody can stand and walk.

#include "pictures/model.h"

#include <glm/vec3.hpp>

#include <optional>

namespace viewer {

/// Of one who walks, metres.
struct Walker {
    float height = 1.8f, width = 0.6f;
    float step = 0.35f; ///< that legs climb
};

class Ground {
public:
    /// Keeps a reference to `model`.
    Ground(const Model& model, const Walker& walker) : model_(model), walker_(walker) {}

    /// The floor below a place, on which one can stand: not too steep, with room for the head.
    std::optional<glm::vec3> below(const glm::vec3& place) const;
    /// How far one can walk from a place on the floor in unit direction `towards` (horizontal), at most
    /// `reach`: up to what stands in the way of legs, body or shoulders, and as long as there is a floor to
    /// step on.
    float free_way(const glm::vec3& floor, const glm::vec3& towards, float reach) const;
    /// The floor with most room about it, at most half of the scene's height up; nothing where there is none.
    std::optional<glm::vec3> widest() const;

private:
    std::optional<prt::RayHit> hit(const glm::vec3& from, const glm::vec3& towards, float reach) const;
    float free_body_way(const glm::vec3& floor, const glm::vec3& towards, float reach) const;
    float room_about(const glm::vec3& floor) const;

    const Model& model_;
    Walker walker_;
};

} // namespace viewer
