#pragma once

// The baker for probes in free space: volumes of transfer that light moving objects. Experimental.

#include "prt/bake.h"
#include "prt/transfer_volume.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Minimum number of rays per probe at which a fit to points between probes reduces the error. With fewer
/// rays, the light at these points is mostly noise (docs/benchmarks.md, "Volumes").
constexpr int kRaysWorthAFit = 2048;

/// Settings of a volume bake.
struct VolumeOptions {
    double spacing = 1;     ///< distance of the finest probes, metres
    std::size_t probes = 0; ///< maximum number of probes, which determines the spacing; 0: use `spacing`
    std::optional<Bounds> bounds = {}; ///< empty: the bounds of the scene
    /// Target for the relative L2 error of transfer between probes over the whole volume, with bands weighted
    /// by 1 / (l + 1)². Cells are split where the error is largest until the target is reached, down to a
    /// quarter of `spacing`. 0: the sizes of cells depend only on the surfaces.
    double error = 0;
    int order = 3; ///< order of incident light, 2 to 4
    /// Number of points per probe at which light between probes is measured; probes are fitted to it. 0: no
    /// fit, probes store the light at their positions. Without a value: 1 if there are at least
    /// `kRaysWorthAFit` rays, otherwise 0.
    std::optional<double> fit_points = {};
};

/// Measurements of a volume bake.
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

/// Result of a volume bake.
struct VolumeBake {
    BakedVolume volume;
    VolumeStatistics statistics;
};

/// Bakes the transfer of incident light at probes, with `options.rays` rays each. Light bounces between the
/// vertices of the scene. Throws the errors of `bake`, and `Error` for invalid volume options.
VolumeBake bake_volume(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options,
                       const Progress& progress = {});

/// Transfer of incident light at positions.
struct PlacedLight {
    Transfer transfer;        ///< receivers are coefficients of incident light: [positions][order²]
    std::vector<float> backs; ///< [positions] share of rays that end at back faces
};
/// Bakes the transfer of incident light of `order` bands at `positions`, in the same way as `bake_volume`
/// does at probes. Throws the errors of `bake`.
PlacedLight bake_positions(const Scene& scene, std::span<const glm::vec3> positions, int order,
                           const BakeOptions& options, const Progress& progress = {});

} // namespace prt
