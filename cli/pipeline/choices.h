#pragma once

// Rules by which `prt make` divides the allowed error among its causes. All errors are squared, relative to
// the squared radiance of the surface.

#include "bake/studies/error_budget.h"

#include <functional>

namespace prt::pipeline {

/// Fractions of the allowed error; bytes get the rest after light, vertices and rays. Bands and rays cost
/// little compared with bytes, which grow without bound as their fraction approaches zero.
inline constexpr double kShareOfLight = 0.4, kShareOfBounces = 0.05, kShareOfRays = 0.05;
/// Meshes are refined if the error between vertices exceeds the first fraction of the allowed error; the
/// second is the target.
inline constexpr double kMaxVertexShare = 0.3, kShareOfVertices = 0.15;
/// Minimum number of rays per vertex, even if time is short.
inline constexpr int kFewestRays = 64;
/// Allowed uncertainty of points and paths, as a fraction of the allowed error.
inline constexpr double kShareOfNoise = 0.1;
/// Minimum of this uncertainty: the square of a third of a per cent, which is invisible.
inline constexpr double kMinNoise = 1e-5;
/// Maximum fraction for light, vertices and rays together; a smaller rest would require too many bytes.
inline constexpr double kMaxUncompressedShare = 0.85;
/// Default target: 3 %, or, if light and vertices have a larger error, that error times kAboveRest (squared),
/// so that bytes get a third of it.
inline constexpr double kUsualError = 0.03, kAboveRest = 1.5;

/// Target of light, vertices and rays if bytes are given: about the error of eight bytes.
inline constexpr double kBesideBytes = 0.01;
/// Fraction of the allowed time for path tracing before the bakes.
inline constexpr double kShareOfTime = 0.15;

/// Path-traced errors of truncating bands and bounces.
struct TruncationErrors {
    std::function<double(int order)> light;     ///< with all bounces
    std::function<double(int bounces)> bounces; ///< error of the missing bounces
};

struct TruncationChoice {
    int order, bounces;
    double squared; ///< sum of light and bounces
};

/// Returns the minimum number of bounces with a negligible error, and the minimum order whose light error is
/// within its fraction of `allowed`. If no order is, its error is at most slightly above that of the maximum
/// order.
TruncationChoice choose_truncation(const TruncationErrors& errors, double allowed);

/// Rays per receiver, a power of two, so that their noise, `measured` with `rays`, has its share of
/// `allowed`.
int choose_rays(double measured, int rays, double allowed);

/// Searches for the error to request from the compressor, so that the total is just below the allowed error.
class AskedError {
public:
    explicit AskedError(double first) : next_(first) {}

    double next() const { return next_; }
    /// True if `next` may save bytes, or meet the allowed error.
    bool worth_trying() const { return open_; }
    /// Reports the result of `next`: total squared error, squared error of bytes, and size.
    void came_out(double allowed, double total, double of_bytes, double size);

private:
    /// maximum that met the allowed error, minimum that did not; 0: none yet
    double next_, low_ = 0, high_ = 0;
    double last_size_ = 0;
    bool open_ = true;
};

} // namespace prt::pipeline
