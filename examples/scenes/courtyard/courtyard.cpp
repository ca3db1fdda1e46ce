// Assembles the courtyard from its parts.

#include "courtyard_parts.h"

namespace examples {

ExampleScene courtyard() {
    Courtyard parts;
    add_paving(parts);
    add_arcades(parts);
    add_upper_storeys(parts);
    add_roofs(parts);
    add_garden_wall(parts);
    add_balcony(parts);
    add_fountain(parts);
    add_awnings(parts);
    add_orange_tree(parts);
    add_plants(parts);
    add_lanterns(parts);
    return finished(parts);
}

} // namespace examples
