#pragma once

#include "support/glb_file.h"

#include <cstring>
#include <vector>

namespace prt::test {

/// Components of element `i` of accessor `index`, as stored.
template <class T>
std::vector<T> glb_element(const GlbFile& file, std::size_t index, std::size_t i, std::size_t components) {
    const nlohmann::ordered_json accessor = file.json["accessors"][index],
                                 view = file.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<T> values(components);
    const std::size_t stride = view.value("byteStride", components * sizeof(T));
    std::memcpy(values.data(), file.binary.data() + view.value("byteOffset", std::size_t{0}) + i * stride,
                components * sizeof(T));
    return values;
}

} // namespace prt::test
