// Writes the common parts of the transfer extensions.
#include "bake/gltf/write_transfer_json.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace prt {

Json record_json(const BakeRecord& record) {
    Json json = {{"method", to_string(record.method)},
                 {"backend", to_string(record.backend)},
                 {"raysPerReceiver", record.rays},
                 {"bounces", record.bounces},
                 {"seed", record.seed}};
    if (!record.receivers.empty())
        json["receivers"] = record.receivers;
    json["samplingError"] = record.sampling_error;
    if (record.endless)
        json["endless"] = true;
    if (record.fitted)
        json["fitted"] = true;
    return json;
}

Json write_float_view(GltfContents& contents, std::span<const float> values) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(values))}, {"componentType", kFloat}};
}

Json write_half_view(GltfContents& contents, std::span<const float> values) {
    std::vector<std::uint16_t> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(), glm::packHalf1x16);
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(halves)))},
            {"componentType", kHalf}};
}

Json write_row_code(GltfContents& contents, const RowCode& code) {
    return {{"bufferView", contents.add_buffer_view(code.bits)}, {"drops", code.drops}};
}

} // namespace prt
