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

/// Reference value of squared errors.
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

struct ErrorBudget {
    std::array<SquaredError, kErrorCauses> causes; ///< [ErrorCause] error if the cause were the only one
    /// Interaction of the causes, twice the sum of their products: `total` minus the sum of `causes`.
    SquaredError together;
    SquaredError total; ///< total error, measured independently of `causes`

    SquaredError& of(ErrorCause cause) { return causes[static_cast<std::size_t>(cause)]; }
    const SquaredError& of(ErrorCause cause) const { return causes[static_cast<std::size_t>(cause)]; }
    double sum() const;
};

/// Exit radiance under one lighting, interpolated to points, without direct light of suns that the renderer
/// adds.
struct InterpolatedRadiance {
    std::vector<glm::vec3> baked;
    std::vector<glm::vec3> repeated; ///< radiance from the same bake with another seed
    std::vector<glm::vec3> shipped;  ///< radiance after compression; equal to `baked` if nothing is
                                     ///< compressed
    bool alike = true;               ///< `repeated` has the same number of rays as `baked`; otherwise it may
                                     ///< have fewer
};

/// Computes the error of each stage. The stages are replaced by the truth one after the other: the light of
/// the bands by the path tracer's light (light), the baked bounces by all bounces (bounces), interpolated
/// radiance by radiance at the points (vertices), the bake by an independent bake (rays), and the compressed
/// bake by the uncompressed one (bytes); docs/math.md, section 16. `cut`: order and bounces of the bake.
ErrorBudget error_budget(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut, const InterpolatedRadiance& radiance,
                         BudgetMeasure measure = BudgetMeasure::relative);

/// Error that `cut` would leave because of its order, with all bounces.
SquaredError light_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut);
/// Error that `cut` would leave because of its number of bounces.
SquaredError bounces_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                           const BandTruncation& cut);

/// Squared relative interpolation error if all triangles were split at the midpoints of their edges and the
/// light at their corners were exact. `corners` is the radiance at the corners of `quarters` [3 points].
/// `points` are those of `reference`.
SquaredError split_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const QuarterCorners& quarters, const SurfaceRadiance& corners,
                         const BandTruncation& cut);

/// Mean over several lights.
ErrorBudget mean_budget(std::span<const ErrorBudget> budgets);

} // namespace prt
