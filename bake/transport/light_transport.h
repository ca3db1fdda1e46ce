#pragma once

// Bounces of light, with what happens to light between them.

#include "prt/support/progress.h"
#include "prt/transfer.h"
#include "scene/refill.h"
#include "surface/surface_fit.h"
#include "transport/diffusion.h"
#include "transport/gather.h"
#include "transport/gather_product.h"

#include <functional>
#include <span>

namespace prt {

/// The linear operators of a scene. Incident transfer becomes exit transfer by `refill`, then `diffusion`;
/// exit transfer becomes the incident transfer of the next bounce by `gather`.
struct TransportOperators {
    const Refill& refill;
    std::span<const DiffusionOperator> diffusion;
    const GatherOperator* gather = nullptr; ///< null: no bounces
    GatherProduct* product = nullptr;       ///< by a device; null: by the processor
    const SurfaceFit* fit = nullptr; ///< rows of `gather` are its samples, and receivers take smooth values
                                     ///< of them; null: rows are receivers
    std::vector<const GatherOperator*> beside = {}; ///< other rows that gather the last bounce
};

struct Propagated {
    Transfer transfer; ///< exit transfer, direct light and bounces
    int bounces = 0;   ///< done; for endless ones how often the solver applied the operators
    /// Energy of the bounces not done, estimated as a geometric series: largest norm of a receiver's
    /// transfer, over that of the sum. For endless ones the estimated error of the solution, over its largest
    /// element.
    double remaining = 0;
    double last = 0;       ///< energy of the last bounce; 0 where none was done alone
    bool converged = true; ///< endless bounces reached the solver's tolerance
    /// Bounced light at the rows of each of `beside`, [rows][channels][order²], as if they were receivers.
    std::vector<std::vector<float>> beside = {};
};

/// The sum over `direct` light and `bounces` bounces of it (or kEndlessBounces).
Propagated propagate(Transfer direct, const TransportOperators& operators, int bounces, int threads,
                     const Progress& progress);

/// Light that was measured at samples of the surface.
struct LightAtSamples {
    const SampledLight& direct;
    const FitSolver& solver;                                     ///< for direct light
    std::function<FitSolver(const SampledLight& rest)> for_rest; ///< none: the same
    const TestValues& of_direct;                                 ///< of the channels of `direct`
    const TestValues& of_rest;                                   ///< of the channels of `gather`
    /// Rows of the last bounce to the samples; null: as of all bounces.
    const GatherOperator* last = nullptr;
};

struct SharpTransfer {
    Transfer direct; ///< incident transfer without a bounce
    Propagated exit; ///< of all light
};

/// The same for `direct` light by a surface fit: bounces go on between smooth values, of which `smooth` is
/// the direct light, of as many channels as `operators.gather`; what is written is fitted sharply at the end.
SharpTransfer propagate_sharply(Transfer smooth, const LightAtSamples& light,
                                const TransportOperators& operators, int bounces, int threads,
                                const Progress& progress);

/// Replaces light [channels][columns] that comes in at the front of a sheet by (1 - f) T_front + f c/rho
/// T_back (docs/math.md, eq. 38).
void mix_sides(const Surfaces& surfaces, const SurfacePoint& point, std::size_t channels,
               std::span<float> front, std::span<const float> back);

/// Light through thin sheets: replaces the transfer of front receivers by (1 - f) T_front + f c/rho T_back,
/// so that it serves a receiver of base color rho whose surface transmits f c (docs/math.md, eq. 38).
void add_transmission(Transfer& transfer, const Surfaces& surfaces, const TransportReceivers& receivers);

} // namespace prt
