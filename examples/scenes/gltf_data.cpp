// Appends data, views and accessors to a glTF buffer.

#include "gltf_data.h"

#include <glm/common.hpp>

#include <algorithm>

namespace examples {

int add_view(tinygltf::Model& model, const void* bytes, std::size_t size, int target) {
    std::vector<unsigned char>& data = model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    view.target = target;
    const auto* first = static_cast<const unsigned char*>(bytes);
    data.insert(data.end(), first, first + size);
    model.bufferViews.push_back(view);
    return static_cast<int>(model.bufferViews.size()) - 1;
}

void set_bounds(tinygltf::Accessor& accessor, const std::vector<glm::vec3>& values) {
    glm::vec3 low = values[0], high = values[0];
    for (const glm::vec3& value : values) {
        low = glm::min(low, value);
        high = glm::max(high, value);
    }
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
}

void set_bounds(tinygltf::Accessor& accessor, const std::vector<float>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    accessor.minValues = {*low};
    accessor.maxValues = {*high};
}

} // namespace examples
