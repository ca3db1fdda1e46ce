// Floors: the court, and the galleries a step above it.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <array>

namespace examples {

using namespace plan;

void add_paving(Courtyard& to) {
    const float left = -kHalf - kWing - 0.6f, right = kHalf + 3.2f, back = kDeep + kWing + 0.6f;
    const float curb = 0.04f; // how far the galleries' step reaches under the arches into the court
    // A wall that lies down: its y is -z.
    const std::array buildings = {
        Opening{{-kHalf - kWing, 0}, {-kHalf + curb, kDeep - curb}},
        Opening{{-kHalf - kWing, kDeep - curb}, {kHalf + kOuterWall, kDeep + kWing}}};
    Mesh ground = wall_with_openings({left, -kFront}, {right, back}, buildings, 0.17f);
    for (glm::vec3& p : ground.positions)
        p = {p.x, 0, -p.y};
    for (glm::vec3& n : ground.normals)
        n = {0, 1, 0};
    append(to.building.paving, ground);

    const std::array hole = {Opening{{-kHalf + curb, 0}, {kHalf + kOuterWall, kDeep - curb}}};
    Mesh galleries = wall_with_openings({-kHalf - kWing, 0},
                                        {kHalf + kOuterWall, kDeep + kArcadeWall + kGallery}, hole, 0.17f);
    for (glm::vec3& p : galleries.positions)
        p = {p.x, kStep, -p.y};
    for (glm::vec3& n : galleries.normals)
        n = {0, 1, 0};
    append(to.building.paving, galleries);
    const auto riser = [&](const glm::vec3& from, const glm::vec3& to_point) {
        append(to.building.stone,
               moulding({{0, 0}, {0, kStep - 0.02f}, {-0.02f, kStep}}, straight_way(from, to_point)));
    };
    riser({-kHalf + curb, 0, 0}, {-kHalf + curb, 0, -kDeep + curb});
    riser({-kHalf + curb, 0, -kDeep + curb}, {kHalf + kOuterWall, 0, -kDeep + curb});
    riser({-kHalf - kWing, 0, 0}, {-kHalf + curb, 0, 0});
}

} // namespace examples
