#pragma once

// Compares speed and error of the bake on every backend and with every method.

#include "prt/make_tracer.h"
#include "prt/scene.h"
#include "prt/texture.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Settings of the comparison.
struct BenchOptions {
    int order = 6;
    int fewest_rays = 64, max_rays = 4096; ///< rays per receiver, doubled from the minimum to the maximum
    int raster_resolution = 1024;
    std::string gpu = {};    ///< TracerChoice::gpu
    double max_seconds = 60; ///< maximum time of a run in seconds; longer runs are skipped
    int threads = 0;
    std::uint64_t seed = 0;
    BadTextures bad_textures = BadTextures::error;
};

/// One run over all receivers.
struct BenchRun {
    int rays = 0; ///< rays per receiver; for method raster the number of directions
    double seconds = 0, seconds_build = 0;
    TraceSeconds stages;
    double rays_per_second = 0;
    double relative_l2 = 0; ///< against the reference, over the reference's receivers
    double contrast = 0;    ///< `transfer_contrast` against the same reference
    double surface_l2 = 0;  ///< relative L2 error over the surface, interpolated between vertices
};

/// Runs of one backend and method.
struct BenchSeries {
    Backend backend = Backend::cpu;
    BakeMethod method = BakeMethod::trace;
    bool fitted = false; ///< vertex values are fitted to samples of the surface
    Traversal traversal = Traversal::automatic;
    std::string device = {};
    std::vector<BenchRun> runs = {};
    std::string left_out = {}; ///< reason why the series or some of its runs are missing; empty: it is
                               ///< complete

    /// Name in reports, for example "cpu trace", "cpu trace fitted" or "gpu trace, ray queries".
    std::string name() const {
        return std::string(to_string(backend)) + " " + to_string(method) + (fitted ? " fitted" : "") +
               (traversal == Traversal::device ? ", ray queries" : "");
    }
};

/// Result of the comparison.
struct BenchResult {
    std::string scene;
    std::size_t receivers = 0, triangles = 0;
    int order = 0;
    int reference_rays = 0; ///< rays per receiver of the reference: 64 times the maximum
    std::size_t reference_receivers = 0;
    std::size_t surface_points = 0; ///< points of the surface reference, with 16 384 rays each
    std::vector<BenchSeries> series;
};

/// Bakes direct light with every backend and method. Measures errors at receivers that are chosen evenly.
/// Throws `Cancelled` after a stop request.
BenchResult run_bench(const std::string& name, const Scene& scene, const BenchOptions& options,
                      const Progress& progress);

} // namespace prt
