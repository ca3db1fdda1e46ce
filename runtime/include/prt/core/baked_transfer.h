#pragma once

// Baked and compressed transfer, with the record of the bake settings. Stable.

#include "prt/core/clustered_transfer.h"
#include "prt/core/transfer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Hardware that runs a bake.
enum class Backend {
    /// Option only: a hardware GPU if available, else the CPU (an error for BakeMethod::raster). `BakeRecord`
    /// has the actual one.
    automatic,
    cpu, ///< CPU (Embree); not for BakeMethod::raster
    gpu, ///< GPU with Vulkan 1.2; with OpenGL 4.5 for BakeMethod::raster
};

/// Method by which a bake samples the visibility of the surroundings of receivers.
enum class BakeMethod {
    trace,  ///< ray tracing
    raster, ///< depth maps from many directions (Hill 2004); for direct light without bounces, GPU only
};

/// Returns the identifier used in files and reports: "auto", "cpu" or "gpu".
const char* to_string(Backend backend);
/// Returns the identifier used in files and reports: "trace" or "raster".
const char* to_string(BakeMethod method);

/// Settings and results of a bake. Files store it, and `prt info` shows it.
struct BakeRecord {
    /// Number of computed bounces; 0: direct light only. If `endless` is true, the number of solver
    /// iterations.
    int bounces = 0;
    bool endless = false; ///< true: the transfer contains all bounces
    /// BakeMethod::trace: number of rays per receiver, or the mean over receivers if it varies.
    /// BakeMethod::raster: number of directions.
    int rays = 0;
    std::uint64_t seed = 0;                ///< seed of the random numbers that choose rays
    BakeMethod method = BakeMethod::trace; ///< method that sampled visibility
    Backend backend = Backend::cpu;        ///< cpu or gpu
    /// `receivers_id` of the scene, a hash of positions and normals; empty if the file has none.
    std::string receivers;
    /// Estimated relative L2 error of transfer vectors by the limited number of rays, weighted by area: of
    /// direct light, or of all light of the sky if the bake filtered noise. 0: not estimated.
    double sampling_error = 0;
    /// Names of the materials, or "material N", whose light passes through a medium that the file does not
    /// describe (prt bake --subsurface): separate suns light them only through transfer.
    std::vector<std::string> media = {};
    /// True: vertex values are a surface fit (docs/terminology.md). False: light measured at the receivers.
    bool fitted = false;
};

/// Number format of raw transfer in a file.
enum class TransferStorage { float32, float16 };

/// Returns the identifier used in files and reports: "float32" or "float16".
const char* to_string(TransferStorage storage);

/// Raw (not compressed) transfer, with the record of its bake.
struct BakedTransfer {
    /// [receivers] vectors. Vertices: in the order of `Scene::vertex_arrays` and of the vertices in each.
    /// Lightmaps and volumes define the order of texels and probes.
    Transfer transfer;
    BakeRecord record;
    TransferStorage storage = TransferStorage::float32; ///< format to write; in memory always float32
};

/// Compressed transfer, with the record of its bake.
struct CompressedTransfer {
    ClusteredTransfer transfer; ///< receivers in the same order as before compression
    BakeRecord record;
};

} // namespace prt
