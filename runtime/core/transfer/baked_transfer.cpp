// Names of bake settings in files and reports.
#include "prt/core/baked_transfer.h"

namespace prt {

const char* to_string(Backend backend) {
    return backend == Backend::automatic ? "auto" : backend == Backend::cpu ? "cpu" : "gpu";
}

const char* to_string(BakeMethod method) {
    return method == BakeMethod::trace ? "trace" : "raster";
}

const char* to_string(TransferStorage storage) {
    return storage == TransferStorage::float16 ? "float16" : "float32";
}

} // namespace prt
