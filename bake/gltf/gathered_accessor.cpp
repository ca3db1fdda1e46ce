// Creates accessors with the elements of another in a new order.
#include "bake/gltf/gathered_accessor.h"

#include "runtime/load/accessor.h"

#include <algorithm>
#include <cstring>

namespace prt {
namespace {

/// Sets the minimum and maximum of each component, which glTF requires for positions.
void set_bounds(Json& accessor, std::span<const double> values, std::size_t components) {
    std::vector<double> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components)),
        high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % components] = std::min(low[i % components], values[i]);
        high[i % components] = std::max(high[i % components], values[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
}

/// Returns components as numbers, integers without normalisation.
std::vector<double> stored_values(int component_type, std::span<const std::byte> elements) {
    std::vector<double> values;
    with_component_type(component_type, [&](auto type) {
        values.reserve(elements.size() / sizeof type);
        for (std::size_t at = 0; at < elements.size(); at += sizeof type) {
            std::memcpy(&type, &elements[at], sizeof type);
            values.push_back(static_cast<double>(type));
        }
    });
    return values;
}

} // namespace

std::size_t add_vertex_accessor(GltfContents& contents, Json accessor, std::span<const std::byte> elements) {
    const int component_type = accessor["componentType"].get<int>();
    const auto components = static_cast<std::size_t>(component_count(accessor["type"].get<std::string>()));
    const std::size_t size = component_bytes(component_type) * components, count = elements.size() / size;
    const std::size_t stride = (size + 3) / 4 * 4; // vertex attributes are aligned to 4 bytes
    std::vector<std::byte> padded(count * stride);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&padded[i * stride], &elements[i * size], size);
    accessor.erase("sparse");
    accessor.erase("byteOffset");
    accessor["count"] = count;
    accessor["bufferView"] = contents.add_buffer_view(padded, stride, true);
    if (accessor.contains("min") || accessor.contains("max"))
        set_bounds(accessor, stored_values(component_type, elements), components);
    return contents.add_accessor(std::move(accessor));
}

std::vector<std::byte> gathered_elements(const GltfModel& model, int accessor,
                                         const std::vector<std::uint32_t>& source) {
    const std::size_t size = check_accessor(model, accessor);
    const std::vector<std::byte> elements = read_elements(model, accessor);
    std::vector<std::byte> gathered(source.size() * size);
    for (std::size_t i = 0; i < source.size(); ++i)
        std::memcpy(&gathered[i * size], &elements[source[i] * size], size);
    return gathered;
}

std::size_t add_gathered_accessor(GltfContents& contents, const Json& reference,
                                  const std::vector<std::uint32_t>& source) {
    const int index = reference.get<int>();
    return add_vertex_accessor(contents, contents.json["accessors"][static_cast<std::size_t>(index)],
                               gathered_elements(contents.model, index, source));
}

std::size_t add_index_accessor(GltfContents& contents, std::span<const std::uint32_t> indices) {
    const std::size_t view = contents.add_buffer_view(std::as_bytes(indices));
    contents.json["bufferViews"][view]["target"] = kElementArrayBuffer;
    return contents.add_accessor({{"bufferView", view},
                                  {"componentType", kUnsignedInt},
                                  {"count", indices.size()},
                                  {"type", "SCALAR"}});
}

void replace_triangles(GltfContents& contents, Json& primitive, std::span<const glm::uvec3> triangles,
                       bool mirrored, std::set<std::size_t>& replaced) {
    std::vector<std::uint32_t> indices;
    for (const glm::uvec3& t : triangles)
        indices.insert(indices.end(), {t.x, mirrored ? t.z : t.y, mirrored ? t.y : t.z});
    if (primitive.contains("indices"))
        replaced.insert(primitive["indices"].get<std::size_t>());
    primitive["indices"] = add_index_accessor(contents, indices);
    primitive.erase("mode");
}

} // namespace prt
