#pragma once

// Fits zonal lobes to transfer vectors, and codes them in bytes (docs/math.md, section 21). Experimental.

#include "prt/lobes.h"
#include "prt/support/progress.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Target of the fit: grey transfer of vertices in the frames of their normals, as returned by
/// `mean_of_poses` of prt/pose_bake.h.
struct LobeTargets {
    int order = 4;                   ///< 2..kMaxLobeOrder
    std::span<const double> vectors; ///< [vertices][order²]
    std::span<const float> areas;    ///< [vertices] m²: weight of a vertex in shared profiles

    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    std::span<const double> vector(std::size_t vertex) const {
        return vectors.subspan(vertex * coefficients(), coefficients());
    }
};

/// Settings of the fit and of the coding.
struct LobeFitOptions {
    std::size_t lobes = 2; ///< per vertex, 1..kMaxLobes
    /// Weight of a squared error in each band: the mean square of the lighting in that band. The lighting
    /// must have no preferred orientation, because lobes rotate with the surface.
    std::array<double, kMaxLobeOrder> band_costs = {1, 1, 1, 1};
    std::size_t profiles = kMaxProfiles; ///< maximum number of shared profiles
    int rounds = 4;                      ///< alternations between words and profiles
    int threads = 0;                     ///< 0: all
};

/// Fits lobes with free axes and an individual profile per lobe, by nonlinear least squares per vertex with
/// Ceres (docs/math.md, section 21). Returns [vertices][lobes]. Throws `Error` for options out of range, for
/// inconsistent sizes and for targets that are not finite.
std::vector<Lobe> fit_lobes(const LobeTargets& targets, const LobeFitOptions& options = {},
                            const Progress& progress = {});

/// Codes `fitted` [vertices][lobes] as words of four bytes with shared profiles. Optimises words and profiles
/// alternately, so that the lobes of a vertex compensate each other's rounding. Under uniform light no vertex
/// reflects more than it receives. Throws the errors of `fit_lobes`.
LobeModel code_lobes(const LobeTargets& targets, std::span<const Lobe> fitted,
                     const LobeFitOptions& options = {}, const Progress& progress = {});

/// Returns the relative error of `lobes` [vertices][lobes]: sqrt( sum_p a_p |T_p - T'_p|² / sum_p a_p |T_p|²
/// ), with bands weighted by `band_costs`.
double lobe_error(const LobeTargets& targets, std::span<const Lobe> lobes, const LobeFitOptions& options);

/// Returns all lobes of a model, [vertices][lobes].
std::vector<Lobe> decoded(const LobeModel& model);

} // namespace prt
