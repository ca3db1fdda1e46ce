#pragma once

#include "example_scenes.h"

namespace examples {

/// The meshes of the courtyard by material. Each becomes a part of the scene.
struct Courtyard {
    struct Building {
        Mesh paving, plaster, garden_plaster, stone, glazed_tiles, roof_tiles, wood, painted_wood, iron;
    };
    struct Glass {
        Mesh dark_panes, lit_panes, lantern_panes, flames;
    };
    struct Garden {
        Mesh water, clay, soil, bark, leaves, oranges, flowers, vine_leaves;
    };
    struct Cloth {
        Mesh red_cloth, blue_cloth, thin_cloth, banner, saffron_pennants, red_pennants, blue_pennants;
    };
    Building building;
    Glass glass;
    Garden garden;
    Cloth cloth;
    std::vector<GltfLight> lamps;
};

/// Assigns a color and an image to every mesh.
ExampleScene finished(const Courtyard& courtyard);

} // namespace examples
