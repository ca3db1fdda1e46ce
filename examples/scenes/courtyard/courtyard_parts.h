#pragma once

// The parts of the courtyard. Each function adds to the meshes of its materials.

#include "materials.h"

namespace examples {

/// Adds the floors of court, galleries and surroundings.
void add_paving(Courtyard& to);
/// Ground floor: arches on columns, galleries behind them.
void add_arcades(Courtyard& to);
/// Upper storey: walls, windows, shutters, cornices; outer walls.
void add_upper_storeys(Courtyard& to);
void add_roofs(Courtyard& to);
void add_garden_wall(Courtyard& to);
void add_balcony(Courtyard& to);
void add_fountain(Courtyard& to);
void add_awnings(Courtyard& to);
void add_orange_tree(Courtyard& to);
/// Flowers over the garden wall, and pots.
void add_plants(Courtyard& to);
void add_lanterns(Courtyard& to);

} // namespace examples
