#pragma once

#include "example_scenes.h"

namespace examples {

/// The meshes of the courtyard by what they are made of. Each becomes a part.
struct Courtyard {
    Mesh paving, plaster, garden_plaster, stone, glazed_tiles, roof_tiles, wood, painted_wood, iron,
        dark_panes, lit_panes;
    Mesh water, clay, soil, red_cloth, blue_cloth, thin_cloth, banner, saffron_pennants, red_pennants,
        blue_pennants;
    Mesh bark, leaves, oranges, flowers, vine_leaves;
    Mesh lantern_panes, flames;
    std::vector<Lamp> lamps;
};

/// Gives every mesh its color and picture.
ExampleScene finished(const Courtyard& courtyard);

} // namespace examples
