#pragma once

// Numbers in the only buffer of a glTF model.

#include <glm/vec3.hpp>
#include <tiny_gltf.h>

#include <cstddef>
#include <vector>

namespace examples {

/// Target of a view: vertices or indices as glTF requires, or none.
inline constexpr int kNoTarget = 0;

/// Appends `bytes` to the model's only buffer and returns the view on them, aligned to four bytes.
int add_view(tinygltf::Model& model, const void* bytes, std::size_t size, int target);

/// How elements of an accessor are read, by the names of tinygltf.
struct ElementKind {
    int component_type, type, target = kNoTarget;
};

/// Adds an accessor on a copy of `values` and returns its index.
template <class T>
int add_accessor(tinygltf::Model& model, const std::vector<T>& values, const ElementKind& kind) {
    tinygltf::Accessor accessor;
    accessor.bufferView = add_view(model, values.data(), values.size() * sizeof(T), kind.target);
    accessor.componentType = kind.component_type;
    accessor.type = kind.type;
    accessor.count = values.size();
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

/// Sets the minimum and the maximum of `values` in their accessor.
void set_bounds(tinygltf::Accessor& accessor, const std::vector<glm::vec3>& values);
void set_bounds(tinygltf::Accessor& accessor, const std::vector<float>& values);

} // namespace examples
