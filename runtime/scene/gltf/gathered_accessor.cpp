// Accessors whose elements are those of another in a new order.
#include "gltf/gathered_accessor.h"

#include "gltf/accessor.h"

#include <algorithm>
#include <cstring>

namespace prt {
namespace {

/// Smallest and largest value of each component, as the glTF specification wants them for positions.
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

/// Gathered components as numbers, integers without normalisation.
std::vector<double> stored_values(int component_type, std::span<const std::byte> elements,
                                  std::size_t components, const std::vector<std::uint32_t>& source) {
    std::vector<double> values;
    with_component_type(component_type, [&](auto type) {
        for (const std::uint32_t i : source)
            for (std::size_t c = 0; c < components; ++c) {
                std::memcpy(&type, &elements[(i * components + c) * sizeof type], sizeof type);
                values.push_back(static_cast<double>(type));
            }
    });
    return values;
}

} // namespace

std::size_t add_gathered_accessor(GltfContents& contents, const Json& reference,
                                  const std::vector<std::uint32_t>& source) {
    const int index = reference.get<int>();
    const tinygltf::Accessor& old = contents.model.accessors.at(static_cast<std::size_t>(index));
    const std::vector<std::byte> elements = read_elements(contents.model, index);
    const auto components = static_cast<std::size_t>(component_count(old.type));
    const std::size_t size = component_bytes(old.componentType) * components;
    const std::size_t stride = (size + 3) / 4 * 4; // vertex attributes are aligned to 4 bytes
    std::vector<std::byte> gathered(source.size() * stride);
    for (std::size_t i = 0; i < source.size(); ++i)
        std::memcpy(&gathered[i * stride], &elements[source[i] * size], size);

    Json accessor = contents.json["accessors"][static_cast<std::size_t>(index)];
    accessor.erase("sparse");
    accessor.erase("byteOffset");
    accessor["count"] = source.size();
    accessor["bufferView"] = contents.add_buffer_view(gathered, stride, true);
    if (accessor.contains("min") || accessor.contains("max"))
        set_bounds(accessor, stored_values(old.componentType, elements, components, source), components);
    return contents.add_accessor(std::move(accessor));
}

} // namespace prt
