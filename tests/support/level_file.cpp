// Adds simplified levels of detail to files.

#include "support/level_file.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace prt::test {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
std::vector<T> elements(const GlbFile& file, std::size_t accessor, std::size_t components) {
    const Json &json = file.json["accessors"][accessor],
               &view = file.json["bufferViews"][json["bufferView"].get<std::size_t>()];
    const std::size_t size = components * sizeof(T), count = json["count"],
                      stride = view.value("byteStride", size),
                      begin =
                          view.value("byteOffset", std::size_t{0}) + json.value("byteOffset", std::size_t{0});
    std::vector<T> values(count * components);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&values[i * components], &file.binary[begin + i * stride], size);
    return values;
}

std::vector<unsigned> indices_of(const GlbFile& file, const Json& primitive) {
    const std::size_t accessor = primitive["indices"];
    switch (file.json["accessors"][accessor]["componentType"].get<int>()) {
    case kUnsignedByte: {
        const auto bytes = elements<std::uint8_t>(file, accessor, 1);
        return {bytes.begin(), bytes.end()};
    }
    case kUnsignedShort: {
        const auto shorts = elements<std::uint16_t>(file, accessor, 1);
        return {shorts.begin(), shorts.end()};
    }
    default:
        return elements<unsigned>(file, accessor, 1);
    }
}

/// Returns the values of the remaining vertices.
std::vector<float> kept(const std::vector<float>& values, const std::vector<unsigned>& remap,
                        std::size_t count) {
    std::vector<float> result(3 * count);
    for (std::size_t v = 0; v < remap.size(); ++v)
        if (remap[v] != ~0u)
            std::memcpy(&result[3 * remap[v]], &values[3 * v], 3 * sizeof(float));
    return result;
}

/// Positions, with the bounds that glTF wants.
std::size_t position_accessor(GlbFile& file, const std::vector<float>& positions) {
    const std::size_t accessor = file.accessor(positions, kFloat, "VEC3", 3);
    std::vector<float> low(positions.begin(), positions.begin() + 3), high = low;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], positions[i]);
        high[i % 3] = std::max(high[i % 3], positions[i]);
    }
    file.json["accessors"][accessor]["min"] = low;
    file.json["accessors"][accessor]["max"] = high;
    return accessor;
}

/// `primitive` of fewer triangles.
Json simplified(GlbFile& file, const Json& primitive, float share) {
    const auto positions = elements<float>(file, primitive["attributes"]["POSITION"], 3),
               normals = elements<float>(file, primitive["attributes"]["NORMAL"], 3);
    const std::vector<unsigned> all = indices_of(file, primitive);
    const std::size_t vertices = positions.size() / 3, triangles = all.size() / 3,
                      wanted = static_cast<std::size_t>(share * static_cast<float>(triangles)) * 3;
    std::vector<unsigned> indices(all.size()), remap(vertices);
    constexpr float kAnyError = 1;
    indices.resize(meshopt_simplify(indices.data(), all.data(), all.size(), positions.data(), vertices,
                                    3 * sizeof(float), wanted, kAnyError, 0, nullptr));
    const std::size_t left =
        meshopt_optimizeVertexFetchRemap(remap.data(), indices.data(), indices.size(), vertices);
    for (unsigned& index : indices)
        index = remap[index];
    Json result = {{"attributes",
                    {{"POSITION", position_accessor(file, kept(positions, remap, left))},
                     {"NORMAL", file.accessor(kept(normals, remap, left), kFloat, "VEC3", 3)}}},
                   {"indices", file.accessor(indices, kUnsignedInt, "SCALAR", 1)}};
    if (primitive.contains("material"))
        result["material"] = primitive["material"];
    return result;
}

/// Adds `node` to the list that contains `sibling`.
void add_sibling(Json& json, std::size_t sibling, std::size_t node) {
    const auto add_to = [&](Json& list) {
        for (const Json& other : list)
            if (other == sibling) {
                list.push_back(node);
                return;
            }
    };
    for (Json& scene : json["scenes"])
        if (scene.contains("nodes"))
            add_to(scene["nodes"]);
    for (Json& parent : json["nodes"])
        if (parent.contains("children"))
            add_to(parent["children"]);
}

} // namespace

GlbFile with_levels(GlbFile file, std::span<const float> shares, LevelsBy by) {
    file.json.erase("buffers"); // it grows
    const std::size_t nodes = file.json["nodes"].size();
    for (std::size_t n = 0; n < nodes; ++n) {
        if (!file.json["nodes"][n].contains("mesh"))
            continue;
        Json ids = Json::array();
        const std::string name = file.json["nodes"][n].value("name", "thing" + std::to_string(n));
        for (const float share : shares) {
            Json primitives = Json::array();
            const Json mesh = file.json["meshes"][file.json["nodes"][n]["mesh"].get<std::size_t>()];
            for (const Json& primitive : mesh["primitives"])
                primitives.push_back(simplified(file, primitive, share));
            Json node = file.json["nodes"][n];
            node.erase("children");
            node["mesh"] = file.json["meshes"].size();
            node["name"] = name + "_LOD" + std::to_string(ids.size() + 1);
            file.json["meshes"].push_back({{"primitives", std::move(primitives)}});
            ids.push_back(file.json["nodes"].size());
            file.json["nodes"].push_back(std::move(node));
            if (by == LevelsBy::names)
                add_sibling(file.json, n, file.json["nodes"].size() - 1);
        }
        file.json["nodes"][n]["name"] = name + (by == LevelsBy::names ? "_LOD0" : "");
        if (by == LevelsBy::extension)
            file.json["nodes"][n]["extensions"]["MSFT_lod"] = {{"ids", ids}};
    }
    if (by == LevelsBy::extension)
        file.json["extensionsUsed"].push_back("MSFT_lod");
    return file;
}

} // namespace prt::test
