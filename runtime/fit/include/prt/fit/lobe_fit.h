#pragma once

// Fits zonal lobes to transfer vectors, and codes these lobes in bytes (docs/math.md, section 21).
// Experimental.

#include "prt/core/lobes.h"
#include "prt/core/progress.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Target of the fit: one transfer vector per vertex, with one channel (grey), in the frame of the vertex
/// normal, as `mean_of_poses` of prt/bake/pose_bake.h returns. Does not own the arrays.
struct LobeTargets {
    int order = 4;                   ///< number of SH bands, 2..kMaxLobeOrder
    std::span<const double> vectors; ///< [vertices][order²]
    std::span<const float> areas; ///< [vertices] m², not negative: weight of a vertex in errors and profiles

    /// Returns the length of a vector: order².
    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    /// Returns the vector of `vertex`, [order²].
    std::span<const double> vector(std::size_t vertex) const {
        return vectors.subspan(vertex * coefficients(), coefficients());
    }
};

/// Settings of the fit and of the coding.
struct LobeFitOptions {
    std::size_t lobes = 2; ///< number of lobes per vertex, 1..kMaxLobes
    /// [band] cost of a squared error of a coefficient in each band: the mean square of the coefficients of
    /// the lighting in that band. Not negative, which is not checked. Bands from the order on are ignored.
    /// There is one cost per band, because lobes rotate with the surface and the lighting therefore has no
    /// preferred orientation.
    std::array<double, kMaxLobeOrder> band_costs = {1, 1, 1, 1};
    std::size_t profiles = kMaxProfiles; ///< maximum number of profiles per model, 1..kMaxProfiles
    int rounds = 4;  ///< number of refits of the profiles by `code_lobes`, at least 0; not checked
    int threads = 0; ///< 0: all
};

/// Fits the lobes of each vertex by nonlinear least squares, with free axes and a separate profile for each
/// lobe (docs/math.md, section 21). Returns [vertices][lobes], with axes in the frame of the vertex normal.
/// Throws `Error` if the order or the number of lobes or profiles is out of range, if the numbers of vectors
/// and areas differ, and if vectors are not finite. Throws `Cancelled` after a stop request.
std::vector<Lobe> fit_lobes(const LobeTargets& targets, const LobeFitOptions& options = {},
                            const Progress& progress = {});

/// Codes `fitted` [vertices][options.lobes], the result of `fit_lobes` for the same targets and options, as
/// words of four bytes with profiles that all vertices share. Optimises words and profiles alternately for
/// the error against `targets`; the lobes of a vertex compensate each other's rounding. Under uniform light
/// no coded vertex has an exit radiance (albedo 1) above the radiance of the light. Throws the errors of
/// `fit_lobes`, and `Error` if `fitted` has another length.
LobeModel code_lobes(const LobeTargets& targets, std::span<const Lobe> fitted,
                     const LobeFitOptions& options = {}, const Progress& progress = {});

/// Returns the relative L2 error of `lobes` [vertices][options.lobes]: sqrt( sum_p a_p |T_p - T'_p|² / sum_p
/// a_p |T_p|² ) over vertices p, with a_p the area, T_p the target and T'_p the vector of the lobes. Squares
/// of coefficients are multiplied by `band_costs`. Returns 0 if all targets are 0. Throws `Error` for the
/// targets and options for which `fit_lobes` does; does not check the length of `lobes`.
double lobe_error(const LobeTargets& targets, std::span<const Lobe> lobes, const LobeFitOptions& options);

/// Decodes all words of `model`. Returns [vertices][lobes], with axes in the frame of the vertex normal.
std::vector<Lobe> decoded(const LobeModel& model);

} // namespace prt
