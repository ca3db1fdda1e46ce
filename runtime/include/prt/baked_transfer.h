#pragma once

// What a bake makes and a compression keeps: transfer and the record of how it was made. Stable.

#include "prt/clustered_transfer.h"
#include "prt/transfer.h"

#include <cstdint>
#include <string>

namespace prt {

/// What a bake runs on.
enum class Backend {
    automatic, ///< a hardware GPU where there is one, else the CPU; not in records
    cpu,
    gpu, ///< Vulkan 1.2
};

enum class BakeMethod {
    trace,  ///< rays
    raster, ///< depth maps from many directions (Hill 2004): direct light, GPU only
};

/// The words of files and reports: "auto", "cpu", "gpu"; "trace", "raster".
const char* to_string(Backend backend);
const char* to_string(BakeMethod method);

/// How a bake was made; written to the file and shown by `prt info`.
struct BakeRecord {
    int bounces = 0;      ///< done
    bool endless = false; ///< all bounces are; then `bounces` says how often the solver applied the operator
    int rays = 0;         ///< per receiver, the mean where it differs; directions where method is raster
    std::uint64_t seed = 0;
    BakeMethod method = BakeMethod::trace;
    Backend backend = Backend::cpu;
    std::string receivers;     ///< receivers_id of the scene
    double sampling_error = 0; ///< estimated relative L2 of the direct light
    bool fitted = false;       ///< values of vertices come nearest to the light between them, interpolated
};

/// How the numbers of raw transfer are stored in a file.
enum class TransferStorage { float32, float16 };

const char* to_string(TransferStorage storage);

struct BakedTransfer {
    Transfer transfer; ///< receivers in the order of the scene's vertex arrays
    BakeRecord record;
    TransferStorage storage = TransferStorage::float32;
};

struct CompressedTransfer {
    ClusteredTransfer transfer;
    BakeRecord record;
};

} // namespace prt
