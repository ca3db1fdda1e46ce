// Reads materials with the extensions that affect transmitted light.
#include "bake/gltf/material.h"

#include "bake/gltf/lights.h"
#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace prt {
namespace {

Wrap wrap_mode(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE)
        return Wrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

/// Returns a number of a transform, clamped to a range in which computations stay finite.
float bounded(const tinygltf::Value& number) {
    constexpr double kMax = 1e6;
    return static_cast<float>(std::clamp(number.GetNumberAsDouble(), -kMax, kMax));
}

glm::vec2 vec2_member(const tinygltf::Value& object, const char* name, const glm::vec2& otherwise) {
    if (!object.Has(name) || object.Get(name).ArrayLen() < 2)
        return otherwise;
    return {bounded(object.Get(name).Get(0)), bounded(object.Get(name).Get(1))};
}

/// Returns the matrix of KHR_texture_transform: uv' = translation · rotation · scale · uv.
glm::mat3x2 texture_transform(const tinygltf::Value& extension) {
    const glm::vec2 offset = vec2_member(extension, "offset", glm::vec2(0));
    const glm::vec2 scale = vec2_member(extension, "scale", glm::vec2(1));
    const float rotation = extension.Has("rotation") ? bounded(extension.Get("rotation")) : 0.0f;
    const float c = std::cos(rotation), s = std::sin(rotation);
    return {c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y};
}

/// Returns the image of a texture: the core image, else one of an extension's format. That format may be
/// unsupported, but the image is loaded only if needed. -1: none.
int image_of(const tinygltf::Texture& texture) {
    if (texture.source >= 0)
        return texture.source;
    for (const char* name :
         {"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu", "MSFT_texture_dds"})
        if (const auto found = texture.extensions.find(name);
            found != texture.extensions.end() && found->second.Has("source"))
            return found->second.Get("source").GetNumberAsInt();
    return -1;
}

float number_member(const tinygltf::Value& object, const char* name, float otherwise) {
    return object.Has(name) && object.Get(name).IsNumber()
               ? static_cast<float>(object.Get(name).GetNumberAsDouble())
               : otherwise;
}

/// Returns a color; white if it is missing.
template <class Vector>
Vector color_member(const tinygltf::Value& object, const char* name) {
    Vector color(1);
    if (object.Has(name) && object.Get(name).ArrayLen() >= static_cast<std::size_t>(Vector::length()))
        for (int c = 0; c < Vector::length(); ++c)
            color[c] = static_cast<float>(object.Get(name).Get(c).GetNumberAsDouble());
    return color;
}

MaterialVolume read_material_volume(const tinygltf::Value& extension) {
    MaterialVolume volume;
    volume.thickness = std::max(0.0f, number_member(extension, "thicknessFactor", 0));
    volume.attenuation_distance =
        number_member(extension, "attenuationDistance", volume.attenuation_distance);
    volume.attenuation_color = color_member<glm::vec3>(extension, "attenuationColor");
    return volume;
}

class MaterialReader {
public:
    MaterialReader(const tinygltf::Model& model, Scene& scene, UnitRange& range)
        : model_(model), scene_(scene), range_(range) {}

    /// Adds what `read_base_materials` does not read.
    void complete(const tinygltf::Material& file, Material& material) {
        read_reflection(file, material);
        const auto& extensions = file.extensions;
        if (const auto e = extensions.find("KHR_materials_diffuse_transmission"); e != extensions.end())
            material.transmission = read_transmission(e->second);
        if (const auto e = extensions.find("KHR_materials_transmission"); e != extensions.end())
            material.glass = read_glass(e->second, material);
        if (const auto e = extensions.find("KHR_materials_volume"); e != extensions.end())
            material.volume = read_material_volume(e->second);
        material.emission = read_emission(file);
        range_.clamp(material.volume.attenuation_color, "attenuationColor of materials");
        for (TextureUse* colors : {&material.base_color_texture, &material.transmission.factor_texture,
                                   &material.transmission.color_texture, &material.emission.texture})
            share_image(*colors, false);
        for (TextureUse* numbers : {&material.metal.texture, &material.glass.texture})
            share_image(*numbers, true);
    }

private:
    /// Replaces images that are the same file or buffer view by the first one, so that it is decoded once.
    void share_image(TextureUse& use, bool numbers) {
        if (use.image < 0 || static_cast<std::size_t>(use.image) >= model_.images.size())
            return;
        const tinygltf::Image& image = model_.images[static_cast<std::size_t>(use.image)];
        if (image.bufferView >= 0 || !image.uri.empty()) // otherwise its bytes are in the JSON
            use.image =
                first_images_.try_emplace({image.bufferView, image.uri, numbers}, use.image).first->second;
    }

    void read_reflection(const tinygltf::Material& file, Material& material) {
        const auto glossy = file.extensions.find("KHR_materials_pbrSpecularGlossiness");
        if (glossy != file.extensions.end()) { // takes precedence over the core material
            material.base_color_texture = texture_member(glossy->second, "diffuseTexture");
            return;
        }
        const tinygltf::PbrMetallicRoughness& pbr = file.pbrMetallicRoughness;
        material.base_color_texture = texture_use(pbr.baseColorTexture);
        material.metal.factor = static_cast<float>(pbr.metallicFactor);
        material.metal.roughness = static_cast<float>(pbr.roughnessFactor);
        material.metal.texture = texture_use(pbr.metallicRoughnessTexture);
        range_.clamp(material.metal.factor, "metallicFactor of materials");
        range_.clamp(material.metal.roughness, "roughnessFactor of materials");
    }

    DiffuseTransmission read_transmission(const tinygltf::Value& extension) {
        DiffuseTransmission transmission{number_member(extension, "diffuseTransmissionFactor", 0),
                                         texture_member(extension, "diffuseTransmissionTexture"),
                                         color_member<glm::vec3>(extension, "diffuseTransmissionColorFactor"),
                                         texture_member(extension, "diffuseTransmissionColorTexture")};
        range_.clamp(transmission.factor, "diffuseTransmissionFactor of materials");
        range_.clamp(transmission.color, "diffuseTransmissionColorFactor of materials");
        return transmission;
    }

    Glass read_glass(const tinygltf::Value& extension, const Material& material) {
        Glass glass{number_member(extension, "transmissionFactor", 0),
                    texture_member(extension, "transmissionTexture")};
        range_.clamp(glass.factor, "transmissionFactor of materials");
        if (material.metal.texture.image < 0) // otherwise its dielectric parts are glass
            glass.factor *= 1 - material.metal.factor;
        return glass;
    }

    Emission read_emission(const tinygltf::Material& file) {
        Emission emission;
        if (file.extensions.contains("KHR_materials_unlit")) // shows its base color, and emits no light
            return emission;
        for (std::size_t c = 0; c < 3 && c < file.emissiveFactor.size(); ++c)
            emission.radiance[static_cast<int>(c)] = static_cast<float>(file.emissiveFactor[c]);
        range_.clamp(emission.radiance, "emissiveFactor of materials");
        const auto strength = file.extensions.find("KHR_materials_emissive_strength");
        if (strength != file.extensions.end())
            emission.radiance *= number_member(strength->second, "emissiveStrength", 1);
        if (emission.radiance == glm::vec3(0))
            return {};
        for (int c = 0; c < 3; ++c)
            if (!(emission.radiance[c] >= 0 && emission.radiance[c] <= kMaxIntensity))
                throw Error("the emission of material '" + printable(file.name) +
                            "' is not in the range 0..1e9");
        emission.texture = texture_use(file.emissiveTexture);
        return emission;
    }

    TextureUse texture_use(int index, int texcoord, const tinygltf::Value* transform) {
        TextureUse use;
        if (index < 0)
            return use;
        if (static_cast<std::size_t>(index) >= model_.textures.size())
            throw Error("texture " + std::to_string(index) + " does not exist");
        const tinygltf::Texture& texture = model_.textures[static_cast<std::size_t>(index)];
        use.image = image_of(texture);
        if (use.image < 0) { // an image without data: `load_textures` reports it if its pixels are needed
            use.image = static_cast<int>(scene_.images.size());
            scene_.images.push_back({"the image of texture " + std::to_string(index), {}});
        } else if (static_cast<std::size_t>(use.image) >= model_.images.size()) {
            throw Error("texture " + std::to_string(index) + " refers to image " + std::to_string(use.image) +
                        ", which does not exist");
        }
        use.texcoord = texcoord;
        if (texture.sampler >= 0 && static_cast<std::size_t>(texture.sampler) < model_.samplers.size()) {
            const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(texture.sampler)];
            use.wrap_u = wrap_mode(sampler.wrapS);
            use.wrap_v = wrap_mode(sampler.wrapT);
        }
        if (transform) {
            use.transform = texture_transform(*transform);
            if (transform->Has("texCoord"))
                use.texcoord = transform->Get("texCoord").GetNumberAsInt();
        }
        return use;
    }

    TextureUse texture_use(const tinygltf::TextureInfo& info) {
        const auto transform = info.extensions.find("KHR_texture_transform");
        return texture_use(info.index, info.texCoord,
                           transform == info.extensions.end() ? nullptr : &transform->second);
    }

    /// Reads a texture reference inside an extension.
    TextureUse texture_member(const tinygltf::Value& object, const char* name) {
        if (!object.Has(name))
            return {};
        const tinygltf::Value& value = object.Get(name);
        const bool transformed =
            value.Has("extensions") && value.Get("extensions").Has("KHR_texture_transform");
        return texture_use(value.Has("index") ? value.Get("index").GetNumberAsInt() : -1,
                           value.Has("texCoord") ? value.Get("texCoord").GetNumberAsInt() : 0,
                           transformed ? &value.Get("extensions").Get("KHR_texture_transform") : nullptr);
    }

    const tinygltf::Model& model_;
    Scene& scene_;
    UnitRange& range_;
    std::map<std::tuple<int, std::string, bool>, int> first_images_; ///< by source and kind
};

} // namespace

void read_materials(const tinygltf::Model& model, Scene& scene, UnitRange& range) {
    MaterialReader reader(model, scene, range);
    for (std::size_t m = 0; m < model.materials.size(); ++m)
        reader.complete(model.materials[m], scene.materials.at(m));
}

std::vector<std::string> unread_material_notices(const tinygltf::Model& model, const Scene& scene) {
    std::set<std::size_t> used;
    for (const Primitive& primitive : scene.primitives)
        used.insert(primitive.material);
    std::size_t bumpy = 0;
    for (const std::size_t m : used) {
        if (m >= model.materials.size())
            continue;
        const tinygltf::Material& file = model.materials[m];
        bumpy += file.normalTexture.index >= 0;
    }
    std::vector<std::string> notices;
    if (bumpy > 0)
        notices.push_back(counted(bumpy, "material has a normal map", "materials have normal maps") +
                          "; light is baked for the vertex normals, normal maps are ignored");
    return notices;
}

} // namespace prt
