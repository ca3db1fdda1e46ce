#pragma once

// The baker at probes in free space: volumes of transfer for what moves. Experimental.

#include "prt/bake.h"
#include "prt/transfer_volume.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Rays of a probe from which the fit errs less than the same rays at probes alone: below, what is measured
/// at points is noise (docs/benchmarks.md, "Volumes").
constexpr int kRaysWorthAFit = 2048;

struct VolumeOptions {
    double spacing = 1;                ///< of the finest probes, metres
    std::size_t probes = 0;            ///< as many at most, however far apart; 0: by `spacing`
    std::optional<Bounds> bounds = {}; ///< none: those of the scene
    /// Relative L2 that transfer between probes shall have over all, bands as 1 / (l + 1)², by as few smaller
    /// cells as it takes where it errs most, down to a quarter of `spacing`; 0: all cells are as surfaces
    /// ask.
    double error = 0;
    int order = 3; ///< of incident light, 2 to 4
    /// Points for each probe where light between probes is measured, which probes are then fitted to; 0: they
    /// have what comes in where they stand; none: 1 from `kRaysWorthAFit` rays on, else 0.
    std::optional<double> fit_points = {};
};

struct VolumeStatistics {
    struct Probes {
        std::size_t all = 0, moved = 0, hanging = 0;
        std::size_t blind = 0; ///< inside of something
        std::size_t bricks = 0, fit_points = 0;
    };
    Probes probes;
    std::size_t rays = 0; ///< traced in all
    std::string device;
    struct Seconds {
        double sources = 0, probes = 0, fit = 0, all = 0;
    };
    Seconds seconds;
    double rounding_error = 0;            ///< relative L2 of storing float16
    double fit_before = 0, fit_after = 0; ///< relative L2 between probes, at the points of the fit
    std::vector<std::string> notices;

    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

struct VolumeBake {
    BakedVolume volume;
    VolumeStatistics statistics;
};

/// Bakes the light that comes in at probes, with `options.rays` rays each. Light bounces between the vertices
/// of the scene. Throws as `bake` does, and for options that make no volume.
VolumeBake bake_volume(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options,
                       const Progress& progress = {});

/// Incident light measured at places, as a bake measures it at probes.
struct PlacedLight {
    Transfer transfer;        ///< receivers are coefficients: [places][order²]
    std::vector<float> backs; ///< [places] share of rays that end at backs of surfaces
};
PlacedLight bake_places(const Scene& scene, std::span<const glm::vec3> places, int order,
                        const BakeOptions& options, const Progress& progress = {});

} // namespace prt
