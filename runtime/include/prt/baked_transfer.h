#pragma once

// Baked and compressed transfer, with the record of the bake settings. Stable.

#include "prt/clustered_transfer.h"
#include "prt/transfer.h"

#include <cstdint>
#include <string>

namespace prt {

/// Hardware that runs a bake.
enum class Backend {
    automatic, ///< hardware GPU if available, else the CPU; never stored in records
    cpu,
    gpu, ///< Vulkan 1.2
};

/// Method that samples the visibility of the surroundings.
enum class BakeMethod {
    trace,  ///< ray tracing
    raster, ///< depth maps from many directions (Hill 2004): direct light, GPU only
};

/// Returns the identifier used in files and reports: "auto", "cpu" or "gpu".
const char* to_string(Backend backend);
/// Returns the identifier used in files and reports: "trace" or "raster".
const char* to_string(BakeMethod method);

/// Settings and results of a bake; written to the file and shown by `prt info`.
struct BakeRecord {
    int bounces = 0;      ///< number of bounces computed
    bool endless = false; ///< true: all bounces are included, and `bounces` is the number of solver
                          ///< iterations
    int rays = 0; ///< number of rays per receiver, or its mean if it varies; for BakeMethod::raster the
                  ///< number of directions
    std::uint64_t seed = 0;
    BakeMethod method = BakeMethod::trace;
    Backend backend = Backend::cpu;
    std::string receivers;     ///< `receivers_id` of the scene
    double sampling_error = 0; ///< estimated relative L2 error of the direct light
    bool fitted = false;       ///< vertex values are a least-squares fit to samples over the surface
};

/// Number format of raw transfer in a file.
enum class TransferStorage { float32, float16 };

/// Returns the identifier used in files and reports: "float32" or "float16".
const char* to_string(TransferStorage storage);

/// Raw transfer, with the record of its bake.
struct BakedTransfer {
    Transfer transfer; ///< receivers in the order of the scene's vertex arrays
    BakeRecord record;
    TransferStorage storage = TransferStorage::float32;
};

/// Compressed transfer, with the record of its bake.
struct CompressedTransfer {
    ClusteredTransfer transfer;
    BakeRecord record;
};

} // namespace prt
