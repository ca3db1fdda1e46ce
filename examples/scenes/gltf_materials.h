#pragma once

#include "example_scenes.h"
#include "gltf_data.h"

#include <tiny_gltf.h>

namespace examples {

/// Adds an extension to the list of extensions used.
void use_extension(tinygltf::Model& model, const std::string& name);

/// A number, or a list of three, of an extension.
tinygltf::Value extension_value(float number);
tinygltf::Value extension_value(const glm::vec3& color);

/// Adds the material of a part, with its pictures as PNG inside the buffer, and returns its index. Pictures
/// that parts share are written once.
int add_material(tinygltf::Model& model, const Part& part);

} // namespace examples
