// Writes materials, textures and lights of a scene.

#include "gltf_materials.h"

#include "prt/image/image_file.h"

#include <algorithm>

namespace examples {
namespace {

std::vector<double> doubles(const glm::vec3& color) {
    return {color.r, color.g, color.b};
}

/// The index of the texture of a picture, which is there once.
int add_texture(tinygltf::Model& model, const SharedPicture& picture) {
    for (std::size_t i = 0; i < model.images.size(); ++i)
        if (model.images[i].name == picture->name)
            return static_cast<int>(i);
    const std::vector<std::byte> png = prt::encode_png(picture->width, picture->height, picture->pixels);
    tinygltf::Image image;
    image.name = picture->name;
    image.mimeType = "image/png";
    image.bufferView = add_view(model, png.data(), png.size(), 0);
    model.images.push_back(image);
    tinygltf::Texture texture;
    texture.source = static_cast<int>(model.images.size()) - 1;
    texture.sampler = 0;
    if (model.samplers.empty()) {
        tinygltf::Sampler sampler;
        sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
        sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
        model.samplers.push_back(sampler);
    }
    model.textures.push_back(texture);
    return texture.source;
}

void set_transmission(tinygltf::Model& model, tinygltf::Material& material, const Part& part) {
    material.doubleSided = true;
    tinygltf::Value::Object extension;
    extension["diffuseTransmissionFactor"] = extension_value(part.transmission);
    extension["diffuseTransmissionColorFactor"] = extension_value(part.transmission_color);
    if (part.picture) { // the picture colors reflected and transmitted light
        tinygltf::Value::Object texture;
        texture["index"] = tinygltf::Value(material.pbrMetallicRoughness.baseColorTexture.index);
        extension["diffuseTransmissionColorTexture"] = tinygltf::Value(texture);
    }
    material.extensions["KHR_materials_diffuse_transmission"] = tinygltf::Value(extension);
    use_extension(model, "KHR_materials_diffuse_transmission");
}

void set_emission(tinygltf::Model& model, tinygltf::Material& material, const Part& part) {
    material.emissiveFactor = doubles(part.emission.color);
    if (part.emission.picture)
        material.emissiveTexture.index = add_texture(model, part.emission.picture);
    tinygltf::Value::Object extension;
    extension["emissiveStrength"] = extension_value(part.emission.strength);
    material.extensions["KHR_materials_emissive_strength"] = tinygltf::Value(extension);
    use_extension(model, "KHR_materials_emissive_strength");
}

} // namespace

void use_extension(tinygltf::Model& model, const std::string& name) {
    if (std::find(model.extensionsUsed.begin(), model.extensionsUsed.end(), name) ==
        model.extensionsUsed.end())
        model.extensionsUsed.push_back(name);
}

tinygltf::Value extension_value(float number) {
    return tinygltf::Value(static_cast<double>(number));
}

tinygltf::Value extension_value(const glm::vec3& color) {
    return tinygltf::Value(
        tinygltf::Value::Array{extension_value(color.r), extension_value(color.g), extension_value(color.b)});
}

int add_material(tinygltf::Model& model, const Part& part) {
    tinygltf::Material material;
    material.name = part.name;
    material.pbrMetallicRoughness.baseColorFactor = doubles(part.color);
    material.pbrMetallicRoughness.baseColorFactor.push_back(static_cast<double>(part.opacity));
    material.pbrMetallicRoughness.metallicFactor = 0;
    if (part.picture)
        material.pbrMetallicRoughness.baseColorTexture.index = add_texture(model, part.picture);
    if (part.opacity < 1)
        material.alphaMode = "BLEND";
    if (part.transmission > 0)
        set_transmission(model, material, part);
    if (part.emission.color != glm::vec3(0))
        set_emission(model, material, part);
    model.materials.push_back(material);
    return static_cast<int>(model.materials.size()) - 1;
}

} // namespace examples
