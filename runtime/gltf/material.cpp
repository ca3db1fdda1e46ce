#include "material.h"

#include "prt/error.h"

#include <cmath>
#include <string>

namespace prt {
namespace {

Wrap wrap_mode(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE)
        return Wrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

glm::vec2 vec2_member(const tinygltf::Value& object, const char* name, const glm::vec2& otherwise) {
    if (!object.Has(name) || object.Get(name).ArrayLen() < 2)
        return otherwise;
    return {static_cast<float>(object.Get(name).Get(0).GetNumberAsDouble()),
            static_cast<float>(object.Get(name).Get(1).GetNumberAsDouble())};
}

/// KHR_texture_transform: uv' = translation · rotation · scale · uv.
glm::mat3x2 texture_transform(const tinygltf::Value& extension) {
    const glm::vec2 offset = vec2_member(extension, "offset", glm::vec2(0));
    const glm::vec2 scale = vec2_member(extension, "scale", glm::vec2(1));
    const auto rotation =
        extension.Has("rotation") ? static_cast<float>(extension.Get("rotation").GetNumberAsDouble()) : 0.0f;
    const float c = std::cos(rotation), s = std::sin(rotation);
    return {c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y};
}

TextureUse read_texture_use(const tinygltf::Model& model, const tinygltf::TextureInfo& info) {
    TextureUse use;
    if (info.index < 0)
        return use;
    if (static_cast<std::size_t>(info.index) >= model.textures.size())
        throw Error("texture " + std::to_string(info.index) + " is not there");
    const tinygltf::Texture& texture = model.textures[static_cast<std::size_t>(info.index)];
    if (texture.source < 0 || static_cast<std::size_t>(texture.source) >= model.images.size())
        throw Error("texture " + std::to_string(info.index) + " has no image that this program reads");
    use.image = texture.source;
    use.texcoord = info.texCoord;
    if (texture.sampler >= 0 && static_cast<std::size_t>(texture.sampler) < model.samplers.size()) {
        const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
        use.wrap_u = wrap_mode(sampler.wrapS);
        use.wrap_v = wrap_mode(sampler.wrapT);
    }
    if (const auto found = info.extensions.find("KHR_texture_transform"); found != info.extensions.end()) {
        use.transform = texture_transform(found->second);
        if (found->second.Has("texCoord"))
            use.texcoord = found->second.Get("texCoord").GetNumberAsInt();
    }
    return use;
}

float number_member(const tinygltf::Value& object, const char* name, float otherwise) {
    return object.Has(name) && object.Get(name).IsNumber()
               ? static_cast<float>(object.Get(name).GetNumberAsDouble())
               : otherwise;
}

glm::vec3 color_member(const tinygltf::Value& object, const char* name) {
    glm::vec3 color(1);
    if (object.Has(name) && object.Get(name).ArrayLen() >= 3)
        for (int c = 0; c < 3; ++c)
            color[c] = static_cast<float>(object.Get(name).Get(c).GetNumberAsDouble());
    return color;
}

/// A texture reference inside an extension.
TextureUse texture_member(const tinygltf::Model& model, const tinygltf::Value& object, const char* name) {
    if (!object.Has(name))
        return {};
    const tinygltf::Value& value = object.Get(name);
    tinygltf::TextureInfo info;
    info.index = value.Has("index") ? value.Get("index").GetNumberAsInt() : -1;
    info.texCoord = value.Has("texCoord") ? value.Get("texCoord").GetNumberAsInt() : 0;
    if (value.Has("extensions") && value.Get("extensions").Has("KHR_texture_transform"))
        info.extensions["KHR_texture_transform"] = value.Get("extensions").Get("KHR_texture_transform");
    return read_texture_use(model, info);
}

DiffuseTransmission read_transmission(const tinygltf::Model& model, const tinygltf::Value& extension) {
    return {number_member(extension, "diffuseTransmissionFactor", 0),
            texture_member(model, extension, "diffuseTransmissionTexture"),
            color_member(extension, "diffuseTransmissionColorFactor"),
            texture_member(model, extension, "diffuseTransmissionColorTexture")};
}

Volume read_volume(const tinygltf::Value& extension) {
    Volume volume;
    volume.thickness = number_member(extension, "thicknessFactor", 0);
    volume.attenuation_distance =
        number_member(extension, "attenuationDistance", volume.attenuation_distance);
    volume.attenuation_color = color_member(extension, "attenuationColor");
    return volume;
}

} // namespace

std::vector<Material> read_materials(const tinygltf::Model& model) {
    std::vector<Material> materials;
    for (const tinygltf::Material& file : model.materials) {
        Material material;
        material.name = file.name;
        const auto& factor = file.pbrMetallicRoughness.baseColorFactor;
        for (std::size_t c = 0; c < 4 && c < factor.size(); ++c)
            material.base_color[static_cast<int>(c)] = static_cast<float>(factor[c]);
        material.base_color_texture = read_texture_use(model, file.pbrMetallicRoughness.baseColorTexture);
        if (file.alphaMode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (file.alphaMode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        material.alpha_cutoff = static_cast<float>(file.alphaCutoff);
        material.double_sided = file.doubleSided;
        const auto& extensions = file.extensions;
        if (const auto e = extensions.find("KHR_materials_diffuse_transmission"); e != extensions.end())
            material.transmission = read_transmission(model, e->second);
        if (const auto e = extensions.find("KHR_materials_volume"); e != extensions.end())
            material.volume = read_volume(e->second);
        materials.push_back(material);
    }
    materials.emplace_back();
    return materials;
}

} // namespace prt
