#pragma once

// Compares speed and error of the bake of direct light on every backend and with every method.

#include "bake/tracers/make_tracer.h"
#include "prt/load/scene.h"
#include "prt/render/texture.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Settings of the comparison.
struct BenchOptions {
    int order = 6; ///< order of the transfer, 1..kMaxOrder
    /// Numbers of rays per receiver of the runs of a series, both in 1..kMaxRays. The first run has
    /// `fewest_rays` rays, and each next run has twice the number of the previous run. The series ends when
    /// this number exceeds `max_rays`. For BakeMethod::raster these are numbers of directions.
    int fewest_rays = 64, max_rays = 4096;
    int raster_resolution = 1024; ///< texels along each side of a depth map, 16..16384, for
                                  ///< BakeMethod::raster
    /// GPU for the series with ray tracing on a GPU: its index in gpu_devices(), or a part of its name;
    /// empty: the best device.
    std::string gpu = {};
    /// Maximum expected time of a run in seconds, extrapolated from the previous run of its series. A series
    /// ends before a run with a longer expected time. The first run has no limit.
    double max_seconds = 60;
    int threads = 0;        ///< number of threads; 0: all
    std::uint64_t seed = 0; ///< seed of the rays; the reference has a different, fixed seed
    BadTextures bad_textures = BadTextures::error; ///< treatment of missing and damaged textures
};

/// One bake of direct light at all receivers.
struct BenchRun {
    int rays = 0; ///< number of rays per receiver; for BakeMethod::raster the number of directions
    /// Wall-clock time in seconds. `seconds`: the whole run without loading textures; `seconds_build`: the
    /// part of `seconds` that builds acceleration structures and prepares the device. Measuring the errors
    /// is not included.
    double seconds = 0, seconds_build = 0;
    TraceSeconds stages;        ///< wall-clock time of the stages of tracing
    double rays_per_second = 0; ///< traced rays divided by `seconds`
    /// Relative L2 error of the transfer against the reference, over the receivers of the reference.
    double relative_l2 = 0;
    /// `transfer_contrast` of the transfer against the reference, over the receivers of the reference.
    double contrast = 0;
    /// Relative L2 error over the surface: error of the transfer interpolated between vertices, at points
    /// with separate reference rays (BenchResult::surface_points).
    double surface_l2 = 0;
};

/// Runs of one backend and method with an increasing number of rays.
struct BenchSeries {
    Backend backend = Backend::cpu;
    BakeMethod method = BakeMethod::trace;
    bool fitted = false; ///< true: vertex values are fitted to samples of the surface (FitMode::surface)
    Traversal traversal = Traversal::automatic; ///< used for ray tracing on a GPU only
    std::string device = {}; ///< name of the device, for reports; empty if the device is not available
    std::vector<BenchRun> runs = {}; ///< in the order of their numbers of rays; may be empty
    std::string left_out = {}; ///< reason why the series or some of its runs are missing; empty: the series
                               ///< is complete

    /// Returns the name in reports, for example "cpu trace", "cpu trace fitted" or "gpu trace, ray queries".
    std::string name() const {
        return std::string(to_string(backend)) + " " + to_string(method) + (fitted ? " fitted" : "") +
               (traversal == Traversal::device ? ", ray queries" : "");
    }
};

/// Result of the comparison.
struct BenchResult {
    std::string scene; ///< name of the scene
    /// Numbers of receivers and of triangles of the scene.
    std::size_t receivers = 0, triangles = 0;
    int order = 0; ///< order of the transfer
    /// Number of rays per receiver of the reference: 64 times BenchOptions::max_rays, at most kMaxRays.
    int reference_rays = 0;
    std::size_t reference_receivers = 0; ///< number of receivers of the reference
    std::size_t surface_points = 0;  ///< number of points of the reference between vertices, each with 16 384
                                     ///< rays
    std::vector<BenchSeries> series; ///< one series per combination of backend, method, kind of traversal
                                     ///< and fit
};

/// Bakes direct light of the sky at the vertices of `scene` with every backend and method, and measures speed
/// and errors. The reference for errors is traced on the CPU, at receivers that are chosen evenly. `name`:
/// BenchResult::scene. A series that fails reports the reason in BenchSeries::left_out. Throws `Error` if the
/// reference fails, and for a missing or damaged texture (BadTextures::error). Throws `Cancelled` after a
/// stop request. At least one triangle of `scene` must have an area.
BenchResult run_bench(const std::string& name, const Scene& scene, const BenchOptions& options,
                      const Progress& progress);

} // namespace prt
