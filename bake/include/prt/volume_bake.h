#pragma once

// The baker for probes in free space: volumes of transfer that light moving objects. Experimental.

#include "prt/bake.h"
#include "prt/transfer_volume.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Minimum number of rays per probe at which a fit has a lower error than the same rays at probes only: with
/// fewer rays the light at fit points is mostly noise (docs/benchmarks.md, "Volumes").
constexpr int kRaysWorthAFit = 2048;

struct VolumeOptions {
    double spacing = 1;                ///< distance of the finest probes, metres
    std::size_t probes = 0;            ///< maximum number of probes; the spacing follows from it; 0: by
                                       ///< `spacing`
    std::optional<Bounds> bounds = {}; ///< empty: the bounds of the scene
    /// Target relative L2 error of transfer between probes over the whole volume, with bands weighted by 1 /
    /// (l + 1)². It is reached with the smallest number of smaller cells, placed where the error is largest,
    /// down to a quarter of `spacing`. 0: the sizes of cells depend on the surfaces only.
    double error = 0;
    int order = 3; ///< order of incident light, 2 to 4
    /// Number of points per probe where light between probes is measured and to which probes are fitted. 0:
    /// probes hold the light that arrives at their positions. Empty: 1 from `kRaysWorthAFit` rays on,
    /// otherwise 0.
    std::optional<double> fit_points = {};
};

struct VolumeStatistics {
    struct Probes {
        std::size_t all = 0, moved = 0, hanging = 0;
        std::size_t invalid = 0; ///< probes inside geometry
        std::size_t bricks = 0, fit_points = 0;
    };
    Probes probes;
    std::size_t rays = 0; ///< all traced rays
    std::string device;
    struct Seconds {
        double sources = 0, probes = 0, fit = 0, all = 0;
    };
    Seconds seconds;
    double rounding_error = 0;            ///< relative L2 error of storing float16
    double fit_before = 0, fit_after = 0; ///< relative L2 error between probes, at the points of the fit
    std::vector<std::string> notices;

    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

struct VolumeBake {
    BakedVolume volume;
    VolumeStatistics statistics;
};

/// Bakes the incident light at probes, with `options.rays` rays each. Light bounces between the vertices of
/// the scene. Throws the same errors as `bake`, and an `Error` for invalid volume options.
VolumeBake bake_volume(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options,
                       const Progress& progress = {});

/// Incident light measured at positions in the same way as at probes.
struct PlacedLight {
    Transfer transfer;        ///< receivers are coefficients: [places][order²]
    std::vector<float> backs; ///< [places] share of rays that end at back faces
};
/// Measures incident light at `positions`, up to `order`. Light bounces as in `bake_volume`.
PlacedLight bake_positions(const Scene& scene, std::span<const glm::vec3> positions, int order,
                           const BakeOptions& options, const Progress& progress = {});

} // namespace prt
