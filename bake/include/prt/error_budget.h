#pragma once

// Splits the error of a lit surface into its causes. Experimental.

#include "prt/surface_radiance.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace prt {

/// Reasons why the light of a model differs from path tracing.
enum class ErrorCause {
    light,    ///< light outside the bands of the order
    bounces,  ///< bounces that were not baked
    vertices, ///< interpolation between the vertices
    rays,     ///< noise of the bake
    bytes,    ///< compression
};
/// Number of values of `ErrorCause`.
inline constexpr std::size_t kErrorCauses = 5;

/// Returns the name in reports: "light", "bounces", "vertices", "rays" or "bytes".
const char* to_string(ErrorCause cause);

/// Level to which squared errors are relative.
enum class BudgetMeasure {
    relative, ///< mean squared radiance of the surface; the three channels have equal weights
    /// (Y + Y_a)² at each point, with channels weighted as in luminance: contrast errors (docs/math.md, eq.
    /// 33b).
    visible,
};

/// Squared error in a `BudgetMeasure`, with its 95 % confidence interval over the random choice of points and
/// paths. The estimate is unbiased, and can be negative if the true value is near zero.
struct SquaredError {
    double value = 0, low = 0, high = 0;

    /// Relative L2 error; 0 if the estimate is negative.
    double root() const;
};

/// Error of a model, split into its causes.
struct ErrorBudget {
    std::array<SquaredError, kErrorCauses> causes; ///< [ErrorCause] error if this cause were the only one
    /// Interaction of the causes: twice the sum of the products of their errors, which is `total` minus the
    /// sum of `causes`.
    SquaredError together;
    SquaredError total; ///< total error, measured independently of `causes`

    SquaredError& of(ErrorCause cause) { return causes[static_cast<std::size_t>(cause)]; }
    const SquaredError& of(ErrorCause cause) const { return causes[static_cast<std::size_t>(cause)]; }
    /// Returns the sum of `causes`.
    double sum() const;
};

/// Exit radiance under one lighting, interpolated to points, [points] each. Direct light of suns that the
/// renderer adds is not included.
struct InterpolatedRadiance {
    std::vector<glm::vec3> baked;
    std::vector<glm::vec3> repeated; ///< radiance from the same bake with another seed
    std::vector<glm::vec3> shipped;  ///< radiance after compression; equal to `baked` if nothing is
                                     ///< compressed
    bool alike = true; ///< true: `repeated` has the same number of rays as `baked`; false: it may have fewer
};

/// Computes the error of each cause (docs/math.md, section 16) as a difference of two radiances: `light`
/// between the bands of the order and the exact light, `bounces` between the baked bounces and all bounces,
/// `vertices` between interpolated radiance and radiance at the points, `rays` between two independent bakes,
/// `bytes` between the compressed and the uncompressed bake. `cut`: order and bounces of the bake.
ErrorBudget error_budget(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut, const InterpolatedRadiance& radiance,
                         BudgetMeasure measure = BudgetMeasure::relative);

/// Returns the error that the order of `cut` causes, with all bounces.
SquaredError light_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut);
/// Returns the error that the number of bounces of `cut` causes.
SquaredError bounces_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                           const BandTruncation& cut);

/// Returns the relative interpolation error that would remain if all triangles were split at the midpoints of
/// their edges and the light at all corners were exact. `corners`: radiance at `quarters.corners` [3 points];
/// `reference`: radiance at `points`.
SquaredError split_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const QuarterCorners& quarters, const SurfaceRadiance& corners,
                         const BandTruncation& cut);

/// Returns the mean of the budgets of several lights.
ErrorBudget mean_budget(std::span<const ErrorBudget> budgets);

} // namespace prt
