#pragma once

// Where the error over the surface comes from, measured in the background.

#include "core/findings.h"

namespace viewer {

/// What a budget is measured of.
struct BudgetSubject {
    LoadedModel loaded;                            ///< with raw transfer; what is compressed may be missing
    std::shared_ptr<const prt::Transfer> repeated; ///< `raw` baked again with another seed; null: not yet
    LightRig rig;
    int light_order = 6; ///< whose bands the rig's window is laid over
    RadianceVersion version;
};

/// Suns are apart where the version says so and transfer keeps direct light apart; lamps are off. Where there
/// is compressed transfer it is of its order, else of the bake's. Posts the repeated bake and the budget.
/// Throws `prt::Error` for what path tracing cannot be a reference for.
void find_budget(Channel& channel, const BudgetSubject& subject);

/// Why there is no budget where only a lightmap is open.
inline constexpr const char* kMeasuredOfVertices =
    "the error over the surface is measured of vertices; open the model without its lightmap, too";

/// The total of `SurfaceBudget` that is white in its picture, as relative L2.
inline constexpr double kWhiteSurfaceError = 0.3;

/// Squared errors at points as heat at receivers: the mean by area of points near by. Receivers of triangles
/// without points take it from the nearest along edges; dark blue where none is. `norm`: of the radiance,
/// squared.
std::vector<glm::vec3> surface_error_colors(const Model& model, const prt::SurfacePoints& points,
                                            std::span<const double> squared, double norm);

} // namespace viewer
