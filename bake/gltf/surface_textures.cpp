// Writes textures of surfaces into glTF files.

#include "prt/gltf/gltf.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/material_choices.h"
#include "bake/gltf/write_set.h"
#include "prt/core/error.h"

#include <map>
#include <set>
#include <utility>

namespace prt {
namespace {

std::size_t append(Json& json, const char* list, Json element) {
    Json& elements = member(json, list, Json::value_t::array);
    elements.push_back(std::move(element));
    return elements.size() - 1;
}

/// Adds a texture with a PNG image; returns its index.
std::size_t add_texture(GltfContents& contents, std::span<const std::byte> png, bool repeats,
                        const char* name) {
    const int wrap = repeats ? TINYGLTF_TEXTURE_WRAP_REPEAT : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    Json& json = contents.json;
    const std::size_t view = contents.add_buffer_view(png);
    const std::size_t image =
        append(json, "images", {{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
    const std::size_t sampler = append(json, "samplers",
                                       {{"magFilter", TINYGLTF_TEXTURE_FILTER_LINEAR},
                                        {"minFilter", TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR},
                                        {"wrapS", wrap},
                                        {"wrapT", wrap}});
    return append(json, "textures", {{"sampler", sampler}, {"source", image}});
}

/// Returns extras.prtkit of material `m`.
Json& own_extras(Json& material, std::size_t m) {
    Json* at = &material;
    for (const char* key : {"extras", "prtkit"}) {
        at = &member(*at, key, Json::value_t::object);
        if (!at->is_object())
            throw Error("material " + std::to_string(m) +
                        " has \"extras\" that are not an object, so bent normals cannot be "
                        "stored in it");
    }
    return *at;
}

/// Assigns separate materials to the primitives of each texture.
class OwnMaterials {
public:
    OwnMaterials(Json& json, const std::vector<Json*>& primitives, std::span<const SurfaceTexture> textures)
        : json_(json), primitives_(primitives) {
        for_each_primitive(json, [&](Json& primitive) {
            for_each_choice(primitive, [&](const Json& choice) {
                if (choice.contains("material"))
                    ++users_[choice["material"].get<std::size_t>()];
            });
        });
        for (const SurfaceTexture& texture : textures)
            take(texture);
    }

    const std::set<std::size_t>& of(std::size_t texture) const { return own_[texture]; }

private:
    void take(const SurfaceTexture& texture) {
        std::map<std::size_t, std::vector<Json*>> mine;
        std::vector<Json*> without;
        for (const std::size_t p : texture.primitives)
            for_each_choice(*primitives_[p], [&](Json& choice) {
                if (choice.contains("material"))
                    mine[choice["material"].get<std::size_t>()].push_back(&choice);
                else if (&choice == primitives_[p])
                    without.push_back(&choice);
            });
        std::set<std::size_t>& own = own_.emplace_back();
        for (const auto& [material, choices] : mine) {
            const bool alone = users_[material] == choices.size();
            Json copy = json_["materials"][material];
            const std::size_t now = alone ? material : append(json_, "materials", std::move(copy));
            own.insert(now);
            for (Json* const choice : choices)
                (*choice)["material"] = now;
        }
        if (without.empty())
            return;
        const std::size_t plain = append(json_, "materials", Json::object());
        own.insert(plain);
        for (Json* const primitive : without)
            (*primitive)["material"] = plain;
    }

    Json& json_;
    const std::vector<Json*>& primitives_;
    std::map<std::size_t, std::size_t> users_; ///< number of users of each material of the file
    std::vector<std::set<std::size_t>> own_;   ///< [textures] materials
};

} // namespace

std::size_t write_surface_textures(GltfDocument& document, const Scene& scene,
                                   std::span<const SurfaceTexture> textures) {
    std::size_t replaced = 0;
    named(document, [&](GltfContents& contents) {
        Json& json = contents.json;
        const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
        const OwnMaterials materials(json, primitives, textures);
        for (std::size_t i = 0; i < textures.size(); ++i) {
            const SurfaceTexture& texture = textures[i];
            const std::size_t occlusion =
                add_texture(contents, texture.occlusion, texture.repeats, "ambient occlusion");
            const std::size_t bent =
                texture.bent_normals.empty()
                    ? 0
                    : add_texture(contents, texture.bent_normals, texture.repeats, "bent normals");
            for (const std::size_t m : materials.of(i)) {
                Json& material = json["materials"][m];
                replaced += material.contains("occlusionTexture");
                material["occlusionTexture"] = {{"index", occlusion}, {"texCoord", texture.texcoord}};
                if (!texture.bent_normals.empty())
                    own_extras(material, m)["bentNormalTexture"] = {{"index", bent},
                                                                    {"texCoord", texture.texcoord}};
            }
        }
    });
    return replaced;
}

} // namespace prt
