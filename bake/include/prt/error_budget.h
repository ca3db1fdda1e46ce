#pragma once

// The error of a lit surface taken apart by its causes. Experimental.

#include "prt/surface_radiance.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace prt {

/// What makes the light of a model differ from that of path tracing.
enum class ErrorCause {
    light,    ///< what the bands of the order cannot hold
    bounces,  ///< those that were not baked
    vertices, ///< between them light is interpolated
    rays,     ///< noise of the bake
    bytes,    ///< compression
};
inline constexpr std::size_t kErrorCauses = 5;

/// The words of reports: "light", "bounces", "vertices", "rays", "bytes".
const char* to_string(ErrorCause cause);

/// What squared errors are relative to.
enum class BudgetMeasure {
    relative, ///< the mean squared radiance of the surface, three channels alike
    /// At each point (Y + Y_a)², channels weighted as luminance is: contrast errors (docs/math.md, eq. 33b).
    visible,
};

/// Squared error by a `BudgetMeasure`, with its 95 % interval over which points were
/// looked at and which paths were traced. An unbiased estimate of what is near zero may be less.
struct SquaredError {
    double value = 0, low = 0, high = 0;

    /// Relative L2; 0 where the estimate is negative.
    double root() const;
};

struct ErrorBudget {
    std::array<SquaredError, kErrorCauses> causes; ///< [ErrorCause] each as if it were the only one
    /// What they do to each other, twice the sum of their products: total less the sum of causes.
    SquaredError together;
    SquaredError total; ///< measured by itself

    SquaredError& of(ErrorCause cause) { return causes[static_cast<std::size_t>(cause)]; }
    const SquaredError& of(ErrorCause cause) const { return causes[static_cast<std::size_t>(cause)]; }
    double sum() const;
};

/// Exit radiance of one lighting, interpolated to points: without direct light of suns that the renderer
/// adds.
struct InterpolatedRadiance {
    std::vector<glm::vec3> baked;
    std::vector<glm::vec3> repeated; ///< by the same bake with another seed
    std::vector<glm::vec3> shipped;  ///< equal to `baked` where nothing is compressed
    bool alike = true;               ///< `repeated` is of as many rays as `baked`; else it may be of fewer
};

/// Every stage is replaced by truth in turn: by the path tracer's light for that of the bands (light), by all
/// bounces (bounces), by radiance at the points (vertices), by an independent bake (rays), and by the
/// uncompressed bake (bytes); docs/math.md, section 16. `cut`: of the bake.
ErrorBudget error_budget(const SurfacePoints& points, const SurfaceRadiance& reference, const BandCut& cut,
                         const InterpolatedRadiance& radiance,
                         BudgetMeasure measure = BudgetMeasure::relative);

/// What another cut would leave: of the bands of its order, with all bounces; and of its bounces.
SquaredError light_error(const SurfacePoints& points, const SurfaceRadiance& reference, const BandCut& cut);
SquaredError bounces_error(const SurfacePoints& points, const SurfaceRadiance& reference, const BandCut& cut);

/// Squared relative error between vertices, were all triangles split at the middles of their edges and light
/// exact at their corners, by `corners` of `quarters` [3 points]. `points` are those of `reference`.
SquaredError split_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const QuarterCorners& quarters, const SurfaceRadiance& corners, const BandCut& cut);

/// The mean over several lights.
ErrorBudget mean_budget(std::span<const ErrorBudget> budgets);

} // namespace prt
