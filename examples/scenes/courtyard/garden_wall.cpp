// The wall on the right: plaster on a foot of stone, with a coping of tiles and a gate.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <cmath>

namespace examples {

using namespace plan;

void add_garden_wall(Courtyard& to) {
    const float inner = kHalf, outer = kHalf + kOuterWall;
    append(to.building.garden_plaster,
           placed(wall_with_openings({0, 0}, {kDeep, kGardenWall}, {}), placement({inner, 0, -kDeep}, -90)));
    append(to.building.garden_plaster,
           placed(wall_with_openings({0, 0}, {kDeep, kGardenWall}, {}, 0.3f), placement({outer, 0, 0}, 90)));
    append(to.building.garden_plaster,
           placed(wall_with_openings({0, 0}, {kOuterWall, kGardenWall}, {}), placement({inner, 0, 0}, 0)));
    append(to.building.stone, moulding({{0.05f, 0}, {0.05f, 0.45f}, {0.05f, 0.45f}, {0, 0.5f}},
                                       straight_way({inner, 0, -kDeep}, {inner, 0, 0.05f})));
    append(to.building.stone, moulding({{0.05f, 0}, {0.05f, 0.45f}, {0.05f, 0.45f}, {0, 0.5f}},
                                       straight_way({inner - 0.05f, 0, 0}, {outer, 0, 0})));
    // Round tiles across the wall, to both sides.
    const int tiles = static_cast<int>(std::lround(kDeep / 0.26f));
    Mesh coping = parametric_surface(6 * tiles, 8, [&](float u, float v) {
        const float x = std::lerp(outer + 0.14f, inner - 0.14f, v), middle = (inner + outer) / 2;
        const float wave = 0.045f * std::cos(kTurn * u * static_cast<float>(tiles));
        return glm::vec3(x, kGardenWall + 0.2f - 0.5f * std::abs(x - middle) + wave,
                         std::lerp(0.1f, -kDeep, u));
    });
    append(to.building.roof_tiles, with_scaled_texcoords(coping, {static_cast<float>(tiles) / 8, 0.25f}));
}

} // namespace examples
