#pragma once

// How `prt make` divides an error that is allowed among its causes. Squared errors throughout, relative to
// the squared radiance of the surface.

#include "prt/error_budget.h"

#include <functional>

namespace prt::cli {

/// Shares of what is allowed: bytes get what light, vertices and rays leave. Bands and rays are cheap beside
/// bytes, which grow without end as their share goes to nothing.
inline constexpr double kShareOfLight = 0.4, kShareOfBounces = 0.05, kShareOfRays = 0.05;
/// Meshes are refined where vertices have more than so much of it, to so much.
inline constexpr double kMostOfVertices = 0.3, kShareOfVertices = 0.15;
/// Rays of a vertex at least, however little time there is.
inline constexpr int kFewestRays = 64;
/// Of what points and paths may be uncertain by.
inline constexpr double kShareOfNoise = 0.1;
/// The least that they are asked for: squares of a third of a per cent, which nobody sees.
inline constexpr double kLeastNoise = 1e-5;
/// What light, vertices and rays may take of it together: of the rest bytes would need too many.
inline constexpr double kMostBeforeBytes = 0.85;
/// What is aimed at where nothing is said: 3 %, or, where light and vertices leave more, so much that bytes
/// get a third of it.
inline constexpr double kUsualError = 0.03, kAboveRest = 1.5;

/// What light, vertices and rays are chosen for where bytes are given: about what eight of them leave.
inline constexpr double kBesideBytes = 0.01;
/// Of the time that may be taken, what paths get before bakes.
inline constexpr double kShareOfTime = 0.15;

/// What path tracing tells of bands and of bounces.
struct CutErrors {
    std::function<double(int order)> light;     ///< with all bounces
    std::function<double(int bounces)> bounces; ///< of those that are missing
};

struct CutChoice {
    int order, bounces;
    double squared; ///< of light and bounces
};

/// The fewest bounces without which next to nothing is missing, and the lowest order that leaves a share of
/// `allowed`, or, where none does, little more than the highest.
CutChoice choose_cut(const CutErrors& errors, double allowed);

/// Rays per receiver, a power of two, so that their noise, `measured` with `rays`, has its share of
/// `allowed`.
int choose_rays(double measured, int rays, double allowed);

/// Looks for the error to ask of the compressor so that what comes out is just below what is allowed.
class AskedError {
public:
    explicit AskedError(double first) : next_(first) {}

    double next() const { return next_; }
    /// Whether `next` may save bytes, or keep what is allowed.
    bool worth_trying() const { return open_; }
    /// What `next` led to: squared errors in all and of bytes, and a size.
    void came_out(double allowed, double total, double of_bytes, double size);

private:
    double next_, low_ = 0, high_ = 0; ///< the largest that kept it, the least that did not; 0: none yet
    double last_size_ = 0;
    bool open_ = true;
};

} // namespace prt::cli
