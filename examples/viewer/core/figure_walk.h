#pragma once

// Moves a figure over the ground: along a path, or freely where there is room.

#include "core/ground.h"

#include <vector>

namespace viewer {

class FigureWalk {
public:
    /// Creates a figure that does not move, at the origin.
    FigureWalk() = default;
    /// Walks along the closed `path` over the floor below its points. If `path` is empty, starts at the
    /// position with the most free room and avoids obstacles. Keeps `model`.
    FigureWalk(std::shared_ptr<const Model> model, const Walker& walker, std::vector<glm::vec3> path);

    void advance(double metres);
    const glm::vec3& position() const { return position_; } ///< on the floor
    float heading() const { return heading_; }              ///< radians about +Y from +Z

private:
    void follow_path();
    void wander(float metres);

    std::shared_ptr<const Model> model_;
    Walker walker_;
    std::vector<glm::vec3> path_;
    glm::vec3 position_{0};
    float heading_ = 0;
    double walked_ = 0; ///< distance walked along the path, metres
};

} // namespace viewer
