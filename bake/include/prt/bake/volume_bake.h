#pragma once

// The baker for probes in free space: creates volumes of transfer, which light moving objects. Experimental.

#include "prt/bake/bake.h"
#include "prt/core/transfer_volume.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Number of rays per probe from which on VolumeOptions::fit_points has the default 1. With fewer rays, the
/// light at these points is mostly noise, and a fit increases the error (docs/benchmarks.md, "Volumes").
constexpr int kRaysWorthAFit = 2048;

/// Settings of a volume bake.
struct VolumeOptions {
    /// Distance of adjacent probes in the finest cells, metres, greater than 0 and at most kFarthestVertex.
    /// If `error` is not 0, finer cells are added where they are needed. Ignored if `probes` is not 0.
    double spacing = 1;
    /// Maximum number of probes: the bake uses about the smallest spacing that does not exceed it. At least
    /// kBrickProbes; requires that `error` is 0. 0: no maximum, `spacing` is used.
    std::size_t probes = 0;
    /// Box of the volume in metres, relative to Scene::origin; each side must be longer than 0, and
    /// coordinates at most 1e9 in magnitude. No value: the bounding box of the scene, extended along axes on
    /// which it is flat.
    std::optional<Bounds> bounds = {};
    /// Target for the error of interpolation between probes, at least 0 and less than 1: relative L2 error of
    /// incident light over the whole volume, with band l of the sky weighted by 1 / (l + 1)². With lamps, it
    /// is the root mean square of the errors of the sky and of lamps. Bricks with the largest errors are
    /// split until the target is reached or cells are a quarter of `spacing` wide. 0: no target, the sizes of
    /// cells depend only on the distance to surfaces.
    double error = 0;
    int order = 3; ///< order of incident light, 2..kMaxIncidentOrder
    int rays = 0;  ///< approximate number of rays per probe, at most kMaxRays; 0: BakeOptions::rays
    /// Mean number of random points per cell, 0..100; points inside geometry or outside `bounds` are omitted.
    /// Light is measured at these points, and probes are fitted so that interpolation matches it. A quarter
    /// of the rays is then traced from these points. 0: no fit, probes store the light at their positions. No
    /// value: 1 if the number of rays per probe is at least `kRaysWorthAFit`, otherwise 0.
    std::optional<double> fit_points = {};
};

/// Measurements of a volume bake.
struct VolumeStatistics {
    /// Numbers of probes, and of other parts of the volume.
    struct Probes {
        std::size_t all = 0, ///< number of all probes
            moved = 0,       ///< number of probes that are measured next to the corner of their cell, because
                             ///< this corner is too near to a surface
            hanging = 0;     ///< number of hanging nodes, whose light is interpolated
        std::size_t invalid = 0; ///< number of probes inside geometry, which take the light of other probes
        std::size_t bricks = 0,  ///< number of bricks
            fit_points = 0;      ///< number of points in free space to which probes were fitted; 0: no fit
    };
    Probes probes;        ///< numbers of probes, bricks and points
    std::size_t rays = 0; ///< number of all traced rays, from vertices, probes and points of the fit
    std::string device;   ///< name of the device that traced the rays
    /// Durations of the steps of the bake, in seconds.
    struct Seconds {
        double sources = 0, ///< preparation, and computation of the light at vertices, which probes receive
            probes = 0,     ///< measurement of the probes, including the split of bricks
            fit = 0,        ///< fit of the probes to points between them; 0: no fit
            all = 0;        ///< whole bake
    };
    Seconds seconds;           ///< durations of the steps
    double rounding_error = 0; ///< relative L2 error of the transfer if it is stored as float16
    double fit_before = 0,     ///< relative L2 error of interpolation between probes before the fit, at the
                               ///< points of the fit; 0 without a fit
        fit_after = 0;         ///< the same error after the fit; 0 without a fit
    std::vector<std::string> notices; ///< messages for the user about parts of the scene that the bake left
                                      ///< out or repaired, one line each

    /// Returns the number of all traced rays divided by the duration of the whole bake.
    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

/// Result of a volume bake.
struct VolumeBake {
    BakedVolume volume;          ///< grid of probes with their transfer
    VolumeStatistics statistics; ///< sizes, durations and errors
};

/// Bakes a volume: chooses probe positions in the box of `volume`, and computes the transfer of incident
/// light at each probe. Probes are measured by rays; BakeOptions::target_error and BakeMethod::raster apply
/// to the vertices of the scene, between which light bounces. The order of the lighting is `options.order`.
/// Throws the errors of `bake`, and `Error` for invalid volume options, a spacing that is too small for the
/// box, a volume that does not fit into memory, a scene without triangles if VolumeOptions::bounds has no
/// value, and if all probes are inside geometry.
VolumeBake bake_volume(const Scene& scene, const VolumeOptions& volume, const BakeOptions& options,
                       const Progress& progress = {});

/// Result of `bake_positions`.
struct PlacedLight {
    /// Transfer from lighting to incident light: one vector for each coefficient of incident light,
    /// [positions][order²] vectors, with the `order` of `bake_positions`.
    Transfer transfer;
    /// [positions] fraction of rays that hit unlit back faces, 0..1; a large value means that the position is
    /// inside geometry.
    std::vector<float> backs;
};
/// Bakes the transfer of incident light at `positions`, with about `options.rays` rays per position, like
/// `bake_volume` at probes without a fit; positions are not moved off surfaces. `positions`: metres, relative
/// to Scene::origin. `order`: order of incident light, 2..kMaxIncidentOrder; the order of the lighting is
/// `options.order`. Throws the errors of `bake`, but does not check the memory limit. Also throws `Error` for
/// another `order`.
PlacedLight bake_positions(const Scene& scene, std::span<const glm::vec3> positions, int order,
                           const BakeOptions& options, const Progress& progress = {});

} // namespace prt
