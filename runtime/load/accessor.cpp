// Reads accessors, including sparse ones and normalised integers, with checks of every index.
#include "runtime/load/accessor.h"

#include "runtime/core/support/counted.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace prt {
namespace {

std::string accessor_name(int accessor) {
    return "accessor " + std::to_string(accessor);
}

template <class Value>
Value load(const std::byte* from) {
    Value value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

/// Elements at a distance of `stride` bytes in a buffer view.
struct StridedElements {
    std::span<const std::byte> view;
    std::size_t offset, stride, size, count;

    void copy(std::byte* to) const {
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(to + i * size, view.data() + offset + i * stride, size);
    }
};

/// Throws if the elements exceed the view.
void check_fits(const StridedElements& e, const std::string& name) {
    if (e.stride < e.size)
        throw Error(name + " has elements of " + std::to_string(e.size) + " bytes, but a stride of only " +
                    counted(e.stride, "byte"));
    if (e.count == 0)
        return;
    if (e.offset > e.view.size() || e.size > e.view.size() - e.offset ||
        (e.count - 1) > (e.view.size() - e.offset - e.size) / e.stride)
        throw Error(name + " reaches outside its buffer view: " + counted(e.count, "element") + " of " +
                    counted(e.size, "byte") + " at offset " + std::to_string(e.offset) +
                    ", but the view has " + counted(e.view.size(), "byte"));
}

/// Returns the size of an element, also for component types of extensions that are never read.
std::size_t element_bytes(const GltfAccessor& accessor) {
    constexpr int kSignedInt = 5124, kDouble = 5130; // of KHR_accessor_float64 and others
    const std::size_t bytes = accessor.componentType == kSignedInt ? 4
                              : accessor.componentType == kDouble  ? 8
                                                                   : component_bytes(accessor.componentType);
    return bytes * static_cast<std::size_t>(accessor.components);
}

StridedElements elements_of(const GltfModel& model, const GltfAccessor& accessor) {
    const std::size_t size = element_bytes(accessor);
    const auto bytes = buffer_view_bytes(model, accessor.bufferView);
    const std::size_t stride = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    return {bytes, accessor.byteOffset, stride > 0 ? stride : size, size, accessor.count};
}

/// Returns the indices or values that replace elements of an accessor.
template <class Part>
StridedElements replacements(const GltfModel& model, const GltfAccessor& accessor, const Part& part,
                             std::size_t size) {
    return {buffer_view_bytes(model, part.bufferView), part.byteOffset, size, size, accessor.sparse->count};
}

/// Applies sparse substitutions of an accessor that check_accessor has accepted.
void apply_sparse(const GltfModel& model, const GltfAccessor& accessor, std::vector<std::byte>& elements,
                  const std::string& name) {
    const GltfSparse& sparse = *accessor.sparse;
    const std::size_t count = sparse.count, size = element_bytes(accessor);
    const std::size_t index_size = component_bytes(sparse.indices.componentType);
    std::vector<std::byte> indices(count * index_size), values(count * size);
    replacements(model, accessor, sparse.indices, index_size).copy(indices.data());
    replacements(model, accessor, sparse.values, size).copy(values.data());
    with_component_type(sparse.indices.componentType, [&](auto type) {
        for (std::size_t i = 0; i < count; ++i) {
            const auto index = static_cast<std::size_t>(load<decltype(type)>(&indices[i * sizeof type]));
            if (index >= accessor.count)
                throw Error(name + " is sparse and replaces element " + std::to_string(index) +
                            ", but has only " + counted(accessor.count, "element"));
            std::memcpy(&elements[index * size], &values[i * size], size);
        }
    });
}

void check_components(const GltfAccessor& accessor, int components, const std::string& name) {
    if (accessor.components != components)
        throw Error(name + " has " + counted(accessor.components, "component") + ", but " +
                    std::to_string(components) + " are required");
}

/// Returns the tightly packed elements of type `Stored`; an empty list if they have another layout.
template <class Stored>
std::span<const Stored> in_place(const GltfModel& model, int index, int components, int component_type) {
    check_accessor(model, index);
    const GltfAccessor& accessor = get_accessor(model, index);
    if (accessor.componentType != component_type || accessor.components != components ||
        accessor.bufferView < 0 || accessor.sparse || accessor.count == 0)
        return {};
    const StridedElements elements = elements_of(model, accessor);
    const std::byte* first = elements.view.data() + elements.offset;
    if (elements.stride != elements.size || reinterpret_cast<std::uintptr_t>(first) % alignof(Stored) != 0)
        return {};
    return {reinterpret_cast<const Stored*>(first), accessor.count * static_cast<std::size_t>(components)};
}

template <class Stored>
float normalised(Stored value, bool is_normalised) {
    if constexpr (std::is_same_v<Stored, float>)
        return value;
    const auto number = static_cast<float>(value);
    return is_normalised ? std::max(number / static_cast<float>(std::numeric_limits<Stored>::max()), -1.0f)
                         : number;
}

} // namespace

std::size_t component_bytes(int component_type) {
    std::size_t bytes = 0;
    with_component_type(component_type, [&](auto type) { bytes = sizeof type; });
    return bytes;
}

std::span<const std::byte> buffer_view_bytes(const GltfModel& model, int view) {
    const std::string name = "buffer view " + std::to_string(view);
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
        throw Error(name + " does not exist");
    const GltfBufferView& v = model.bufferViews[static_cast<std::size_t>(view)];
    if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= model.buffers.size())
        throw Error(name + " refers to buffer " + std::to_string(v.buffer) + ", which does not exist");
    const std::span<const std::byte> data = model.buffers[static_cast<std::size_t>(v.buffer)].bytes();
    if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
        throw Error(name + " reaches outside buffer " + std::to_string(v.buffer) + ", which has " +
                    std::to_string(data.size()) + " bytes");
    return data.subspan(v.byteOffset, v.byteLength);
}

const GltfAccessor& get_accessor(const GltfModel& model, int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
        throw Error(accessor_name(index) + " does not exist");
    return model.accessors[static_cast<std::size_t>(index)];
}

std::size_t check_accessor(const GltfModel& model, int index) {
    const GltfAccessor& accessor = get_accessor(model, index);
    const std::string name = accessor_name(index);
    const std::size_t size = element_bytes(accessor);
    if (accessor.bufferView >= 0)
        check_fits(elements_of(model, accessor), name);
    if (!accessor.sparse)
        return size;
    const GltfSparse& sparse = *accessor.sparse;
    if (sparse.indices.componentType != kUnsignedByte && sparse.indices.componentType != kUnsignedShort &&
        sparse.indices.componentType != kUnsignedInt)
        throw Error(name + " is sparse, but its indices are not unsigned integers");
    if (sparse.count > accessor.count)
        throw Error(name + " is sparse and replaces more elements than it has");
    check_fits(replacements(model, accessor, sparse.indices, component_bytes(sparse.indices.componentType)),
               name);
    check_fits(replacements(model, accessor, sparse.values, size), name);
    return size;
}

std::vector<std::byte> read_elements(const GltfModel& model, int index) {
    const std::size_t size = check_accessor(model, index);
    const GltfAccessor& accessor = get_accessor(model, index);
    std::vector<std::byte> elements(accessor.count * size);
    if (accessor.bufferView >= 0)
        elements_of(model, accessor).copy(elements.data());
    if (accessor.sparse)
        apply_sparse(model, accessor, elements, accessor_name(index));
    return elements;
}

std::span<const float> floats_in_place(const GltfModel& model, int index, int components) {
    return in_place<float>(model, index, components, kFloat);
}

std::span<const std::uint32_t> integers_in_place(const GltfModel& model, int index, int components) {
    return in_place<std::uint32_t>(model, index, components, kUnsignedInt);
}

std::vector<float> read_floats(const GltfModel& model, int index, int components) {
    const GltfAccessor& accessor = get_accessor(model, index);
    check_components(accessor, components, accessor_name(index));
    if (const std::span<const float> plain = floats_in_place(model, index, components); !plain.empty())
        return {plain.begin(), plain.end()};
    const std::vector<std::byte> elements = read_elements(model, index);
    std::vector<float> values(accessor.count * static_cast<std::size_t>(components));
    with_component_type(accessor.componentType, [&](auto type) {
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = normalised(load<decltype(type)>(&elements[i * sizeof type]), accessor.normalized);
    });
    return values;
}

std::vector<std::uint32_t> read_unsigned(const GltfModel& model, int index, int components) {
    const GltfAccessor& accessor = get_accessor(model, index);
    check_components(accessor, components, accessor_name(index));
    if (accessor.componentType != kUnsignedByte && accessor.componentType != kUnsignedShort &&
        accessor.componentType != kUnsignedInt)
        throw Error(accessor_name(index) + " does not contain unsigned integers");
    const std::vector<std::byte> elements = read_elements(model, index);
    std::vector<std::uint32_t> values(accessor.count * static_cast<std::size_t>(components));
    with_component_type(accessor.componentType, [&](auto type) {
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<std::uint32_t>(load<decltype(type)>(&elements[i * sizeof type]));
    });
    return values;
}

} // namespace prt
