// Reads raw transfer of one view.
#include "bake/gltf/read_raw_set.h"

#include "runtime/load/allowance.h"
#include "runtime/load/transfer_json.h"

#include <string>

namespace prt {

BakedTransfer read_raw_set(const GltfData& data, const Json& set, std::size_t receivers) {
    BakedTransfer baked;
    baked.transfer.layout = read_layout(set);
    baked.record = read_record(set.value("bake", Json::object()));
    const std::size_t dimension = baked.transfer.dimension();
    check_allowed(static_cast<double>(receivers) * static_cast<double>(dimension * sizeof(float)),
                  data.file_bytes, "its transfer");
    baked.transfer.vectors.resize(receivers * dimension);
    const Json& vectors = set.at("vectors");
    baked.storage = is_half(vectors) ? TransferStorage::float16 : TransferStorage::float32;
    read_float_view(data, vectors, baked.transfer.vectors,
                    "the vectors of " + set.at("receivers").get<std::string>());
    return baked;
}

} // namespace prt
