#pragma once

// Splits the error of a lit surface into its causes. Experimental.

#include "bake/reference/surface_radiance.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace prt {

/// Reasons why the light of a model differs from path tracing.
enum class ErrorCause {
    light,    ///< the transfer contains only the SH bands of its order
    bounces,  ///< the bake contains only some bounces
    vertices, ///< light is interpolated between the vertices
    rays,     ///< the bake has noise of rays
    bytes,    ///< compression changes the transfer
};
/// Number of values of `ErrorCause`.
inline constexpr std::size_t kErrorCauses = 5;

/// Returns the name in reports: "light", "bounces", "vertices", "rays" or "bytes".
const char* to_string(ErrorCause cause);

/// Value by which squared errors of exit radiance are divided. It includes direct light of suns that the
/// renderer adds.
enum class BudgetMeasure {
    /// The mean of the squared exit radiance over the area of the surface. The three channels have equal
    /// weights.
    relative,
    /// (Y + Y_a)² at each point, for contrast errors (docs/math.md, eq. 33b). Y is the luminance of the
    /// exit radiance at the point, Y_a a tenth of the logarithmic mean luminance of the surface. Squared
    /// errors of the channels have the weights of luminance.
    visible,
};

/// Squared error divided by the value of a `BudgetMeasure`, as an area-weighted mean over the surface. The
/// estimate is unbiased, and can be negative if the true value is near zero.
struct SquaredError {
    /// `value`: the estimate; `low`, `high`: its 95 % confidence interval over the random choice of points
    /// and paths. All are 0 if the surface is not lit.
    double value = 0, low = 0, high = 0;

    /// Returns the square root of `value`, which is the relative error; 0 if `value` is negative.
    double root() const;
};

/// Error of a model, split into its causes.
struct ErrorBudget {
    /// [ErrorCause] squared error that the cause would have if it were the only one.
    std::array<SquaredError, kErrorCauses> causes;
    /// Interaction of the causes: `total` minus the sum of `causes`, which is twice the sum of the products
    /// of the errors of each two causes. `low` and `high` are 0, because this interval is not estimated.
    SquaredError together;
    SquaredError total; ///< squared error of all causes at once, measured directly instead of as a sum

    /// Returns the entry of `causes` for `cause`.
    SquaredError& of(ErrorCause cause) { return causes[static_cast<std::size_t>(cause)]; }
    /// Returns the entry of `causes` for `cause`.
    const SquaredError& of(ErrorCause cause) const { return causes[static_cast<std::size_t>(cause)]; }
    /// Returns the sum of the values of `causes`.
    double sum() const;
};

/// Exit radiance for albedo 1 under one lighting, interpolated from the receivers to points of the surface.
/// Each array has the length [points] and linear Rec. 709 values. Direct light of suns that the renderer adds
/// is not included.
struct InterpolatedRadiance {
    std::vector<glm::vec3> baked;    ///< radiance from the bake, uncompressed
    std::vector<glm::vec3> repeated; ///< radiance from another bake of the scene with a different seed
    std::vector<glm::vec3> shipped; ///< radiance after compression of `baked`; equal to `baked` if nothing is
                                    ///< compressed
    bool alike = true; ///< true: `repeated` has the same number of rays as `baked`; false: it may have
                       ///< another number
};

/// Computes the error of each cause (docs/math.md, section 16) as a difference of two radiances at `points`:
/// `light` between the SH bands of the order and the exact light, `bounces` between the baked bounces and all
/// bounces, `vertices` between interpolated radiance and radiance at the points, `rays` between two
/// independent bakes, `bytes` between the compressed and the uncompressed bake. `reference` must be traced at
/// `points` (at least one), and the arrays of `radiance` must have one entry per point. `cut`: order and
/// bounces of the bake, and the factors on the bands of the sky in `radiance`; factors other than 1 add to
/// the error of `light`.
ErrorBudget error_budget(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut, const InterpolatedRadiance& radiance,
                         BudgetMeasure measure = BudgetMeasure::relative);

/// Returns the squared error of light with all bounces if it consists only of the SH bands of `cut` times
/// `cut.factors`; factors other than 1, as those of deringing, add to the error. Relative as in
/// BudgetMeasure::relative. The bounces of `cut` are ignored. `reference` must be traced at `points`.
SquaredError light_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const BandTruncation& cut);
/// Returns the squared error that the limited number of bounces of `cut` causes in the SH bands of `cut`
/// times `cut.factors`, relative as in BudgetMeasure::relative. `reference` must be traced at `points`.
SquaredError bounces_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                           const BandTruncation& cut);

/// Returns the squared interpolation error, relative as in BudgetMeasure::relative, that would remain if all
/// triangles were split at the midpoints of their edges and the light at all corners were exact. The light is
/// limited to the bands and bounces of `cut`, with its factors. `quarters`: corners of the smaller triangles
/// at `points`. `corners`: radiance traced at `quarters.corners` [3 per point]; `reference`: radiance traced
/// at `points`.
SquaredError split_error(const SurfacePoints& points, const SurfaceRadiance& reference,
                         const QuarterCorners& quarters, const SurfaceRadiance& corners,
                         const BandTruncation& cut);

/// Returns the arithmetic mean of the squared errors and intervals of `budgets`, one budget per lighting.
/// `budgets` must not be empty.
ErrorBudget mean_budget(std::span<const ErrorBudget> budgets);

} // namespace prt
