#pragma once

// Measures the sources of the error over the surface in the background.

#include "core/findings.h"

namespace viewer {

/// Input of an error budget.
struct BudgetSubject {
    LoadedModel loaded;                            ///< must have raw transfer; compressed transfer is
                                                   ///< optional
    std::shared_ptr<const prt::Transfer> repeated; ///< `raw` baked again with another seed; null: not baked
                                                   ///< yet
    LightRig rig;
    int light_order = 6; ///< the rig's window filters the bands of this order
    RadianceVersion version;
};

/// Posts the repeated bake and the error budget. Suns are separate if `version` requires it and the transfer
/// has a separate direct term; lamps are off. The budget uses the order of the compressed transfer if there
/// is one, otherwise that of the bake. Throws `prt::Error` if path tracing cannot provide a reference.
void find_budget(Channel& channel, const BudgetSubject& subject);

/// Message shown if only a lightmap is open: a budget is measured for vertices only.
inline constexpr const char* kMeasuredOfVertices =
    "only vertices can be measured; also open a file with vertex transfer";

/// Total error of `SurfaceBudget` (relative L2) that is drawn white.
inline constexpr double kWhiteSurfaceError = 0.3;

/// Converts squared errors at points to heat colors at receivers: the area-weighted mean over nearby points.
/// Receivers of triangles without points take the value of the nearest receiver along edges; dark blue if
/// none is reachable. `norm` is the squared radiance that errors are relative to.
std::vector<glm::vec3> surface_error_colors(const Model& model, const prt::SurfacePoints& points,
                                            std::span<const double> squared, double norm);

} // namespace viewer
