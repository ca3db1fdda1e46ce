// Writes a scene as a binary glTF file.

#include "write_scene.h"

#include "gltf_materials.h"
#include "write_skeleton.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <stdexcept>

namespace examples {
namespace {

tinygltf::Primitive make_primitive(tinygltf::Model& model, const Part& part) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const auto add_attribute = [&](const char* name, const auto& values, int type) {
        primitive.attributes[name] =
            add_accessor(model, values, {TINYGLTF_COMPONENT_TYPE_FLOAT, type, TINYGLTF_TARGET_ARRAY_BUFFER});
    };
    add_attribute("POSITION", part.mesh.positions, TINYGLTF_TYPE_VEC3);
    set_bounds(model.accessors.back(), part.mesh.positions);
    add_attribute("NORMAL", part.mesh.normals, TINYGLTF_TYPE_VEC3);
    if (part.picture || part.emission.picture)
        add_attribute("TEXCOORD_0", part.mesh.texcoords, TINYGLTF_TYPE_VEC2);
    add_skin_attributes(model, primitive, part.skin);
    primitive.indices = add_accessor(
        model, part.mesh.indices,
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER});
    primitive.material = add_material(model, part);
    return primitive;
}

/// The light of a lamp as KHR_lights_punctual has it.
tinygltf::Value punctual_light(const GltfLight& lamp) {
    tinygltf::Value::Object light;
    const bool is_spot = glm::length(lamp.direction) > 0;
    light["name"] = tinygltf::Value(lamp.name);
    light["type"] = tinygltf::Value(std::string(is_spot ? "spot" : "point"));
    light["color"] = extension_value(lamp.color);
    light["intensity"] = extension_value(lamp.intensity);
    light["range"] = extension_value(lamp.range);
    if (is_spot) {
        tinygltf::Value::Object cone;
        cone["innerConeAngle"] = extension_value(lamp.inner_cone);
        cone["outerConeAngle"] = extension_value(lamp.outer_cone);
        light["spot"] = tinygltf::Value(cone);
    }
    return tinygltf::Value(light);
}

/// A node that carries light number `index`. Spots shine along -Z of their nodes.
tinygltf::Node lamp_node(const GltfLight& lamp, int index) {
    tinygltf::Node node;
    node.name = lamp.name;
    node.translation = {lamp.position.x, lamp.position.y, lamp.position.z};
    if (glm::length(lamp.direction) > 0) {
        const glm::dquat rotation(glm::dvec3(0, 0, -1), glm::dvec3(lamp.direction));
        node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
    }
    tinygltf::Value::Object extension;
    extension["light"] = tinygltf::Value(index);
    node.extensions["KHR_lights_punctual"] = tinygltf::Value(extension);
    return node;
}

tinygltf::Mesh make_mesh(tinygltf::Model& model, const std::string& name, const std::vector<Part>& parts) {
    tinygltf::Mesh mesh;
    mesh.name = name;
    for (const Part& part : parts)
        mesh.primitives.push_back(make_primitive(model, part));
    return mesh;
}

/// Returns a node that draws mesh number `mesh` at every placement of `drawn`.
tinygltf::Node instancing_node(tinygltf::Model& model, const Model& drawn, int mesh) {
    std::vector<glm::vec3> translations, scales;
    std::vector<glm::vec4> rotations; // x, y, z, w
    for (const Placement& placement : drawn.placements) {
        const float half = placement.degrees * kTurn / 720;
        translations.push_back(placement.origin);
        rotations.emplace_back(0, std::sin(half), 0, std::cos(half));
        scales.emplace_back(placement.scale);
    }
    tinygltf::Value::Object attributes, extension;
    const auto add = [&](const char* name, const auto& values, int type) {
        attributes[name] =
            tinygltf::Value(add_accessor(model, values, {TINYGLTF_COMPONENT_TYPE_FLOAT, type}));
    };
    add("TRANSLATION", translations, TINYGLTF_TYPE_VEC3);
    add("ROTATION", rotations, TINYGLTF_TYPE_VEC4);
    add("SCALE", scales, TINYGLTF_TYPE_VEC3);
    extension["attributes"] = tinygltf::Value(attributes);
    tinygltf::Node node;
    node.name = drawn.name;
    node.mesh = mesh;
    node.extensions["EXT_mesh_gpu_instancing"] = tinygltf::Value(extension);
    return node;
}

void add_models(tinygltf::Model& model, const std::vector<Model>& models) {
    for (const Model& drawn : models) {
        if (drawn.placements.empty())
            continue;
        model.meshes.push_back(make_mesh(model, drawn.name, drawn.parts));
        model.nodes.push_back(instancing_node(model, drawn, static_cast<int>(model.meshes.size()) - 1));
        model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
        use_extension(model, "EXT_mesh_gpu_instancing");
    }
}

void add_lamps(tinygltf::Model& model, const std::vector<GltfLight>& lamps) {
    if (lamps.empty())
        return;
    tinygltf::Value::Array lights;
    for (const GltfLight& lamp : lamps) {
        model.nodes.push_back(lamp_node(lamp, static_cast<int>(lights.size())));
        model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
        lights.push_back(punctual_light(lamp));
    }
    tinygltf::Value::Object extension;
    extension["lights"] = tinygltf::Value(lights);
    model.extensions["KHR_lights_punctual"] = tinygltf::Value(extension);
    use_extension(model, "KHR_lights_punctual");
}

} // namespace

void write_scene(const ExampleScene& scene, const std::filesystem::path& path) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "prtkit example scenes";
    model.buffers.emplace_back();
    model.meshes.push_back(make_mesh(model, {}, scene.parts));
    tinygltf::Node node;
    node.mesh = 0;
    model.nodes.push_back(node);
    tinygltf::Scene file_scene;
    file_scene.nodes = {0};
    model.scenes.push_back(file_scene);
    model.defaultScene = 0;
    add_skeleton(model, scene.skeleton, 0);
    add_models(model, scene.models);
    add_lamps(model, scene.lamps);
    if (!tinygltf::TinyGLTF().WriteGltfSceneToFile(&model, path.string(), true, true, false, true))
        throw std::runtime_error(path.string() + ": cannot be written");
}

} // namespace examples
