#pragma once

// Propagates light over bounces, with repairs and subsurface scattering between them.

#include "bake/scene/refill.h"
#include "bake/surface_fit/surface_fit.h"
#include "bake/trace/gather.h"
#include "bake/trace/gather_product.h"
#include "bake/transport/diffusion.h"
#include "prt/core/progress.h"
#include "prt/core/transfer.h"

#include <functional>
#include <span>

namespace prt {

/// The linear operators of a scene. `refill` and then `diffusion` convert incident transfer to exit transfer;
/// `gather` converts exit transfer to the incident transfer of the next bounce.
struct TransportOperators {
    const Refill& refill;
    std::span<const DiffusionOperator> diffusion;
    const GatherOperator* gather = nullptr; ///< null: no bounces
    GatherProduct* product = nullptr;       ///< product on a device; null: on the CPU
    const SurfaceFit* fit = nullptr;   ///< fit whose samples are the rows of `gather`; receivers use smooth
                                       ///< values of them; null: rows are receivers
    const Transfer* sources = nullptr; ///< exit transfer before the last bounce of the surfaces that `gather`
                                       ///< gathers from; null: the receivers are these surfaces
    std::vector<const GatherOperator*> optional_work = {}; ///< additional rows that gather the last bounce
};

struct Propagated {
    Transfer transfer; ///< exit transfer of direct light and bounces
    int bounces = 0;   ///< number of computed bounces; for endless bounces the number of operator
                       ///< applications in the solver
    /// Energy of the bounces that were not computed, estimated as a geometric series: maximum norm of a
    /// receiver's transfer relative to that of the sum. For endless bounces the estimated error of the
    /// solution, relative to its largest element.
    double remaining = 0;
    double last = 0;       ///< energy of the last bounce; 0 if no single bounce was computed
    bool converged = true; ///< endless bounces reached the solver's tolerance
    /// Bounced light at the rows of each of `optional_work`, [rows][channels][order²], as if they were
    /// receivers.
    std::vector<std::vector<float>> optional_work = {};
};

/// Computes the sum over `direct` light and `bounces` bounces of it (or kEndlessBounces).
Propagated propagate(Transfer direct, const TransportOperators& operators, int bounces, int threads,
                     const Progress& progress);

/// Light measured at samples of the surface.
struct LightAtSamples {
    const SampledLight& direct;
    const FitSolver& solver;                                     ///< for direct light
    std::function<FitSolver(const SampledLight& rest)> for_rest; ///< null: the same solver
    const TestValues& of_direct;                                 ///< tests for the channels of `direct`
    const TestValues& of_rest;                                   ///< tests for the channels of `gather`
    /// Rows of the last bounce at the samples; null: rows of all bounces.
    const GatherOperator* last = nullptr;
};

struct SharpTransfer {
    Transfer direct; ///< incident transfer without a bounce
    Propagated exit; ///< exit transfer of all light
};

/// Computes the sum over bounces of `light`, which was measured at the samples of a surface fit. Bounces use
/// smooth values; `smooth` is the direct light with the number of channels of `operators.gather`. The written
/// values are fitted sharply at the end.
SharpTransfer propagate_sharply(Transfer smooth, const LightAtSamples& light,
                                const TransportOperators& operators, int bounces, int threads,
                                const Progress& progress);

/// Replaces light [channels][columns] that arrives at the front of a thin sheet by (1 - f) T_front + f c/rho
/// T_back (docs/math.md, eq. 38).
void mix_sides(const Surfaces& surfaces, const SurfacePoint& point, std::size_t channels,
               std::span<float> front, std::span<const float> back);

/// Adds light through thin sheets: replaces the transfer of front receivers by (1 - f) T_front + f c/rho
/// T_back, so that it is valid for a receiver of base color rho whose surface transmits f c (docs/math.md,
/// eq. 38).
void add_transmission(Transfer& transfer, const Surfaces& surfaces, const TransportReceivers& receivers);

} // namespace prt
