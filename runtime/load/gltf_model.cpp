// Reads the geometry of a glTF file from its JSON.
#include "runtime/load/gltf_model.h"

#include "prt/core/error.h"
#include "runtime/load/extensions.h"

#include <algorithm>
#include <climits>
#include <cstdint>
#include <utility>

namespace prt {
namespace {

std::string text(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Returns a list of numbers; an empty list if it is missing or contains anything else.
std::vector<double> numbers(const Json& object, const char* key) {
    const Json& list = list_of(object, key);
    const bool good = list.is_array() && std::ranges::all_of(list, &Json::is_number);
    return good ? list.get<std::vector<double>>() : std::vector<double>();
}

std::vector<int> indices(const Json& object, const char* key) {
    const Json& list = list_of(object, key);
    const auto is_index = [](const Json& value) {
        return value.is_number_unsigned() && value.get<std::uint64_t>() <= INT_MAX;
    };
    if (!list.is_array() || !std::ranges::all_of(list, is_index))
        throw Error(std::string("is damaged glTF: ") + key + " is not a list of indices");
    return list.get<std::vector<int>>();
}

std::size_t length(const Json& object, const char* key) {
    return object.value(key, std::size_t{0});
}

GltfBufferView read_view(const Json& json) {
    const Json* compressed = extension_of(json, kMeshoptExtension);
    const Json& source = compressed ? *compressed : json;
    return {source.at("buffer").get<int>(), length(source, "byteOffset"),
            source.at("byteLength").get<std::size_t>(), compressed ? 0 : length(json, "byteStride")};
}

GltfSparse read_sparse(const Json& json) {
    const Json &indices = json.at("indices"), &values = json.at("values");
    return {json.at("count").get<std::size_t>(),
            {indices.at("bufferView").get<int>(), length(indices, "byteOffset"),
             indices.at("componentType").get<int>()},
            {values.at("bufferView").get<int>(), length(values, "byteOffset")}};
}

GltfPrimitive read_primitive(const Json& json) {
    GltfPrimitive primitive;
    primitive.attributes = json.at("attributes").get<GltfAttributes>();
    primitive.indices = json.value("indices", -1);
    primitive.material = json.value("material", -1);
    primitive.mode = json.value("mode", kTriangles);
    for (const Json& target : list_of(json, "targets"))
        primitive.targets.push_back(target.get<GltfAttributes>());
    return primitive;
}

GltfMesh read_mesh(const Json& json) {
    GltfMesh mesh{{}, numbers(json, "weights")};
    for (const Json& primitive : list_of(json, "primitives"))
        mesh.primitives.push_back(read_primitive(primitive));
    return mesh;
}

GltfNode read_node(const Json& json) {
    GltfNode node;
    node.name = text(json, "name");
    node.mesh = json.value("mesh", -1);
    node.skin = json.value("skin", -1);
    node.children = indices(json, "children");
    node.matrix = numbers(json, "matrix");
    node.translation = numbers(json, "translation");
    node.rotation = numbers(json, "rotation");
    node.scale = numbers(json, "scale");
    node.weights = numbers(json, "weights");
    const Json* visibility = extension_of(json, "KHR_node_visibility");
    node.visible = !visibility || !visibility->contains("visible") || (*visibility)["visible"] != false;
    return node;
}

/// Calls `read` with the elements of a list, and adds their names to errors.
template <class Read>
auto read_list(const Json& json, const char* list, const char* element, Read read) {
    std::vector<decltype(read(json))> result;
    const Json& elements = list_of(json, list);
    result.reserve(elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i)
        try {
            result.push_back(read(elements[i]));
        } catch (const std::exception& error) { // errors of prtkit and of the JSON library
            throw Error(element + (' ' + std::to_string(i)) + ": " + in_plain_words(error));
        }
    return result;
}

} // namespace

int attribute_of(const GltfPrimitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

GltfAccessor read_accessor(const Json& json) {
    GltfAccessor accessor;
    accessor.bufferView = json.value("bufferView", -1);
    accessor.byteOffset = length(json, "byteOffset");
    accessor.componentType = json.at("componentType").get<int>();
    accessor.count = json.at("count").get<std::size_t>();
    accessor.components = component_count(json.at("type").get<std::string>());
    accessor.normalized = json.contains("normalized") && json["normalized"] == true;
    if (json.contains("sparse"))
        accessor.sparse = read_sparse(json["sparse"]);
    return accessor;
}

int component_count(const std::string& type) {
    for (const auto& [name, count] :
         {std::pair("SCALAR", 1), std::pair("VEC2", 2), std::pair("VEC3", 3), std::pair("VEC4", 4),
          std::pair("MAT2", 4), std::pair("MAT3", 9), std::pair("MAT4", 16)})
        if (type == name)
            return count;
    throw Error("unknown accessor type '" + type + "'");
}

GltfModel read_model(const Json& json) {
    GltfModel model;
    model.bufferViews = read_list(json, "bufferViews", "buffer view", read_view);
    model.accessors = read_list(json, "accessors", "accessor", read_accessor);
    model.meshes = read_list(json, "meshes", "mesh", read_mesh);
    model.nodes = read_list(json, "nodes", "node", read_node);
    model.skins = read_list(json, "skins", "skin", [](const Json& skin) {
        return GltfSkin{skin.value("inverseBindMatrices", -1), indices(skin, "joints")};
    });
    model.scenes =
        read_list(json, "scenes", "scene", [](const Json& scene) { return indices(scene, "nodes"); });
    model.defaultScene = json.value("scene", -1);
    return model;
}

} // namespace prt
