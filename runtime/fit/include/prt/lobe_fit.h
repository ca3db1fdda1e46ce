#pragma once

// Fits zonal lobes to transfer vectors, and puts them into bytes (docs/math.md, section 21). Experimental.

#include "prt/lobes.h"
#include "prt/support/progress.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// What lobes are fitted to: grey transfer of vertices in the frames of their normals, as
/// `mean_of_poses` of prt/pose_bake.h gives it.
struct LobeTargets {
    int order = 4;                   ///< 2..kMostLobeOrder
    std::span<const double> vectors; ///< [vertices][order²]
    std::span<const float> areas;    ///< [vertices], m²: what a vertex counts for profiles that many share

    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    std::span<const double> vector(std::size_t vertex) const {
        return vectors.subspan(vertex * coefficients(), coefficients());
    }
};

struct LobeFitOptions {
    std::size_t lobes = 2; ///< of a vertex, 1..kMostLobes
    /// What the square of an error of a band costs: the mean square of lighting there. Lobes turn, so that
    /// only lighting which is as likely any way up makes sense.
    std::array<double, kMostLobeOrder> band_costs = {1, 1, 1, 1};
    std::size_t profiles = kMostProfiles; ///< at most
    int rounds = 4;                       ///< of words, then profiles
    int threads = 0;                      ///< 0: all
};

/// Axes are free and every lobe has a profile of its own: the least squares of docs/math.md, section 21, by
/// Ceres for each vertex. [vertices][lobes]. Throws `Error` for options outside their range, shapes that do
/// not go together and targets that are not finite.
std::vector<Lobe> fit_lobes(const LobeTargets& targets, const LobeFitOptions& options = {},
                            const Progress& progress = {});

/// The same in words of four bytes and profiles that vertices share: words are chosen again by turns with
/// profiles, so that what rounding one lobe costs the others of its vertex make up. Under light from
/// everywhere alike no vertex sends out more than arrives. Throws `Error` as `fit_lobes` does.
LobeModel code_lobes(const LobeTargets& targets, std::span<const Lobe> fitted,
                     const LobeFitOptions& options = {}, const Progress& progress = {});

/// sqrt( sum_p a_p |T_p - T'_p|² / sum_p a_p |T_p|² ) in the metric of the fit.
double lobe_error(const LobeTargets& targets, std::span<const Lobe> lobes, const LobeFitOptions& options);

/// Lobes of a model, [vertices][lobes].
std::vector<Lobe> decoded(const LobeModel& model);

} // namespace prt
