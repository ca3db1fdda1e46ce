#pragma once

// Speed against error of the bake, on every backend and by every method.

#include "prt/make_tracer.h"
#include "prt/scene.h"
#include "prt/texture.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

struct BenchOptions {
    int order = 6;
    int fewest_rays = 64, most_rays = 4096; ///< doubled from one to the other
    int raster_resolution = 1024;
    std::string gpu = {};     ///< TracerChoice::gpu
    double most_seconds = 60; ///< a run that would take longer is left out
    int threads = 0;
    std::uint64_t seed = 0;
    BadTextures bad_textures = BadTextures::error;
};

/// One run over all receivers.
struct BenchRun {
    int rays = 0; ///< per receiver; directions where the method is raster
    double seconds = 0, seconds_build = 0;
    TraceSeconds parts;
    double rays_per_second = 0;
    double relative_l2 = 0; ///< against the reference, over its receivers
    double contrast = 0;    ///< `transfer_contrast` against the same
    double surface_l2 = 0;  ///< over the surface, interpolated between vertices
};

struct BenchSeries {
    Backend backend = Backend::cpu;
    BakeMethod method = BakeMethod::trace;
    bool fitted = false; ///< to samples of the surface
    Traversal traversal = Traversal::automatic;
    std::string device = {};
    std::vector<BenchRun> runs = {};
    std::string left_out = {}; ///< what is missing, and why; empty: nothing

    /// "cpu trace", "cpu trace fitted", "gpu trace, ray queries"
    std::string name() const {
        return std::string(to_string(backend)) + " " + to_string(method) + (fitted ? " fitted" : "") +
               (traversal == Traversal::device ? ", ray queries" : "");
    }
};

struct BenchResult {
    std::string scene;
    std::size_t receivers = 0, triangles = 0;
    int order = 0;
    int reference_rays = 0; ///< 64 times the most rays
    std::size_t reference_receivers = 0;
    std::size_t surface_points = 0; ///< of the surface's reference, each of 16 384 rays
    std::vector<BenchSeries> series;
};

/// Measures direct light. The error is that of an even sample of the receivers. Throws `Cancelled`.
BenchResult run_bench(const std::string& name, const Scene& scene, const BenchOptions& options,
                      const Progress& progress);

} // namespace prt
