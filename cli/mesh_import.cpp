// Converts meshes that assimp has read to glTF in memory. assimp's own glTF exporter splits every vertex
// again.

#include "mesh_import.h"

#include "outputs.h"
#include "prt/srgb.h"
#include "prt/support/error.h"
#include "prt/support/file.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace prt::cli {
namespace {

namespace fs = std::filesystem;
using MeshJson = nlohmann::ordered_json;

/// Opens files in one folder and below it only.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    explicit FolderFiles(const fs::path& folder) : folder_(fs::weakly_canonical(folder)) {}

    bool Exists(const char* name) const override { return is_inside(name) && DefaultIOSystem::Exists(name); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        return is_inside(name) && fs::is_regular_file(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
    }

private:
    bool is_inside(const char* name) const {
        std::error_code error;
        const fs::path path = fs::weakly_canonical(name, error);
        return !error &&
               std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end()).first == folder_.end();
    }

    fs::path folder_;
};

/// Builds a binary glTF file.
class GlbBuilder {
public:
    MeshJson json = {{"asset", {{"version", "2.0"}, {"generator", "prtkit"}}},
                     {"scene", 0},
                     {"scenes", MeshJson::array({{{"nodes", MeshJson::array({0})}}})},
                     {"nodes", MeshJson::array({{{"mesh", 0}}})},
                     {"meshes", MeshJson::array({{{"primitives", MeshJson::array()}}})}};

    /// Adds `values` and returns the index of their accessor. `components`: per element.
    template <class Value>
    std::size_t add(const std::vector<Value>& values, std::size_t components, const char* type,
                    int component_type) {
        constexpr int kFloat = 5126;
        const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", values.size() * sizeof(Value)}});
        binary_.insert(binary_.end(), bytes, bytes + values.size() * sizeof(Value));
        MeshJson accessor = {{"bufferView", json["bufferViews"].size() - 1},
                             {"componentType", component_type},
                             {"count", values.size() / components},
                             {"type", type}};
        if (component_type == kFloat && components == 3 && !values.empty()) {
            MeshJson low = MeshJson::array(), high = MeshJson::array();
            for (std::size_t c = 0; c < components; ++c) {
                Value smallest = values[c], largest = values[c];
                for (std::size_t i = c; i < values.size(); i += components) {
                    smallest = std::min(smallest, values[i]);
                    largest = std::max(largest, values[i]);
                }
                low.push_back(smallest);
                high.push_back(largest);
            }
            accessor["min"] = low;
            accessor["max"] = high;
        }
        json["accessors"].push_back(std::move(accessor));
        return json["accessors"].size() - 1;
    }

    std::vector<std::byte> file() {
        json["buffers"] = MeshJson::array({{{"byteLength", binary_.size()}}});
        std::string text = json.dump(-1, ' ', false, MeshJson::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<std::byte> file;
        const auto word = [&](std::uint32_t value) {
            const auto* bytes = reinterpret_cast<const std::byte*>(&value);
            file.insert(file.end(), bytes, bytes + sizeof(value));
        };
        constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
        word(kMagic);
        word(2);
        word(static_cast<std::uint32_t>(28 + text.size() + binary_.size()));
        word(static_cast<std::uint32_t>(text.size()));
        word(kJsonChunk);
        const auto* characters = reinterpret_cast<const std::byte*>(text.data());
        file.insert(file.end(), characters, characters + text.size());
        word(static_cast<std::uint32_t>(binary_.size()));
        word(kBinaryChunk);
        file.insert(file.end(), binary_.begin(), binary_.end());
        return file;
    }

private:
    std::vector<std::byte> binary_;
};

MeshJson material_json(const aiMaterial& material, MeshJson& json) {
    aiColor3D diffuse(1, 1, 1), emission(0, 0, 0);
    float opacity = 1;
    aiString name, texture;
    material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    material.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
    material.Get(AI_MATKEY_OPACITY, opacity);
    material.Get(AI_MATKEY_NAME, name);
    const auto unit = [](float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 1.0f; };
    MeshJson surface = {{"metallicFactor", 0},
                        {"baseColorFactor", MeshJson::array({unit(diffuse.r), unit(diffuse.g),
                                                             unit(diffuse.b), unit(opacity)})}};
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == AI_SUCCESS && texture.length > 0) {
        json["images"].push_back({{"uri", texture.C_Str()}});
        json["textures"].push_back({{"source", json["images"].size() - 1}});
        surface["baseColorTexture"] = {{"index", json["textures"].size() - 1}};
    }
    MeshJson result = {{"name", name.C_Str()}, {"pbrMetallicRoughness", std::move(surface)}};
    if (opacity < 1)
        result["alphaMode"] = "BLEND";
    if (emission.r > 0 || emission.g > 0 || emission.b > 0)
        result["emissiveFactor"] = MeshJson::array({unit(emission.r), unit(emission.g), unit(emission.b)});
    return result;
}

std::vector<float> floats_of(const aiVector3D* vectors, std::size_t count) {
    std::vector<float> floats;
    for (std::size_t i = 0; i < count; ++i)
        floats.insert(floats.end(), {vectors[i].x, vectors[i].y, vectors[i].z});
    return floats;
}

void add_primitive(const aiMesh& mesh, GlbBuilder& builder) {
    constexpr int kFloat = 5126, kUnsignedInt = 5125;
    const std::size_t count = mesh.mNumVertices;
    MeshJson attributes = {{"POSITION", builder.add(floats_of(mesh.mVertices, count), 3, "VEC3", kFloat)}};
    if (mesh.HasNormals())
        attributes["NORMAL"] = builder.add(floats_of(mesh.mNormals, count), 3, "VEC3", kFloat);
    if (mesh.HasTextureCoords(0)) {
        std::vector<float> coordinates; // v points down in glTF
        for (std::size_t i = 0; i < count; ++i)
            coordinates.insert(coordinates.end(),
                               {mesh.mTextureCoords[0][i].x, 1 - mesh.mTextureCoords[0][i].y});
        attributes["TEXCOORD_0"] = builder.add(coordinates, 2, "VEC2", kFloat);
    }
    if (mesh.HasVertexColors(0)) {
        std::vector<float> colors;
        for (std::size_t i = 0; i < count; ++i) {
            const aiColor4D& c = mesh.mColors[0][i];
            for (const float channel : {c.r, c.g, c.b})
                colors.push_back(srgb_decode(std::clamp(channel, 0.0f, 1.0f)));
            colors.push_back(std::clamp(c.a, 0.0f, 1.0f));
        }
        attributes["COLOR_0"] = builder.add(colors, 4, "VEC4", kFloat);
    }
    std::vector<std::uint32_t> indices;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        if (const aiFace& face = mesh.mFaces[f]; face.mNumIndices == 3)
            indices.insert(indices.end(), face.mIndices, face.mIndices + 3);
    builder.json["meshes"][0]["primitives"].push_back(
        {{"attributes", std::move(attributes)},
         {"indices", builder.add(indices, 1, "SCALAR", kUnsignedInt)},
         {"material", mesh.mMaterialIndex}});
}

std::vector<std::byte> as_glb(const fs::path& path, bool allow_outside) {
    Assimp::Importer importer;
    if (!allow_outside)
        importer.SetIOHandler(new FolderFiles(fs::absolute(path).parent_path())); // the importer owns it
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(fs::absolute(path).string(),
                                             aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                                 aiProcess_SortByPType | aiProcess_ValidateDataStructure);
    if (!scene)
        throw Error(std::string("cannot be read: ") + importer.GetErrorString());
    if (scene->mNumMeshes == 0)
        throw Error("has no triangles");
    GlbBuilder builder;
    for (unsigned m = 0; m < scene->mNumMaterials; ++m)
        builder.json["materials"].push_back(material_json(*scene->mMaterials[m], builder.json));
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
        add_primitive(*scene->mMeshes[m], builder);
    return builder.file();
}

} // namespace

GltfDocument load_model(const fs::path& path, const GltfOptions& options) {
    const std::string suffix = suffix_of(path);
    if (suffix != ".obj" && suffix != ".ply")
        return load_gltf(path, options);
    std::vector<std::byte> file;
    try {
        read_file(path); // reports what is missing or is no regular file, as for all inputs
        file = as_glb(path, options.allow_outside);
    } catch (const Error& error) {
        const std::string message = error.what();
        throw message.starts_with(path.string()) ? error : Error(path.string() + ": " + message);
    }
    return parse_gltf(file, path, options);
}

} // namespace prt::cli
