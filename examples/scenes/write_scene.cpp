#include "write_scene.h"

#include <glm/common.hpp>
#include <tiny_gltf.h>

#include <stdexcept>

namespace examples {
namespace {

/// Adds an accessor on a copy of `values`.
template <class T>
int add_accessor(tinygltf::Model& model, const std::vector<T>& values, int component_type, int type,
                 int target) {
    tinygltf::Buffer& buffer = model.buffers[0];
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.data.size();
    view.byteLength = values.size() * sizeof(T);
    view.target = target;
    buffer.data.insert(buffer.data.end(), bytes, bytes + view.byteLength);
    model.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = values.size();
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

void set_bounds(tinygltf::Accessor& accessor, const std::vector<glm::vec3>& positions) {
    glm::vec3 low = positions[0], high = positions[0];
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
}

tinygltf::Material make_material(const Part& part) {
    tinygltf::Material material;
    material.name = part.name;
    material.pbrMetallicRoughness.baseColorFactor = {part.color.r, part.color.g, part.color.b, 1};
    material.pbrMetallicRoughness.metallicFactor = 0;
    if (part.transmission > 0) {
        material.doubleSided = true;
        const auto number = [](float value) { return tinygltf::Value(static_cast<double>(value)); };
        const glm::vec3& c = part.transmission_color;
        tinygltf::Value::Object extension;
        extension["diffuseTransmissionFactor"] = number(part.transmission);
        extension["diffuseTransmissionColorFactor"] =
            tinygltf::Value(tinygltf::Value::Array{number(c.r), number(c.g), number(c.b)});
        material.extensions["KHR_materials_diffuse_transmission"] = tinygltf::Value(extension);
    }
    return material;
}

} // namespace

void write_scene(const ExampleScene& scene, const std::filesystem::path& path) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "prtkit example scenes";
    model.buffers.emplace_back();
    tinygltf::Mesh mesh;
    for (const Part& part : scene) {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.attributes["POSITION"] =
            add_accessor(model, part.mesh.positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                         TINYGLTF_TARGET_ARRAY_BUFFER);
        set_bounds(model.accessors.back(), part.mesh.positions);
        primitive.attributes["NORMAL"] = add_accessor(model, part.mesh.normals, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                                      TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
        primitive.indices = add_accessor(model, part.mesh.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                         TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        primitive.material = static_cast<int>(model.materials.size());
        model.materials.push_back(make_material(part));
        if (part.transmission > 0)
            model.extensionsUsed = {"KHR_materials_diffuse_transmission"};
        mesh.primitives.push_back(primitive);
    }
    model.meshes.push_back(mesh);
    tinygltf::Node node;
    node.mesh = 0;
    model.nodes.push_back(node);
    tinygltf::Scene file_scene;
    file_scene.nodes = {0};
    model.scenes.push_back(file_scene);
    model.defaultScene = 0;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToFile(&model, path.string(), true, true, false, true))
        throw std::runtime_error(path.string() + ": cannot be written");
}

} // namespace examples
