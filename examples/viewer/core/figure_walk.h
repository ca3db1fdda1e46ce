#pragma once

// The way of a figure over the ground: along a path, or to wherever there is room.

#include "core/ground.h"

#include <vector>

namespace viewer {

class FigureWalk {
public:
    /// Stands still at the origin.
    FigureWalk() = default;
    /// Along `path` round and round, over the floor below its points, or, where it is empty, from the widest
    /// place on, turning before what is in the way. Keeps `model`.
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
    double walked_ = 0; ///< metres along the path
};

} // namespace viewer
