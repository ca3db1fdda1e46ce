// Reads materials as far as every renderer needs them.
#include "runtime/load/materials.h"

#include <algorithm>

namespace prt {
namespace {

/// Returns a list of four numbers; white if it is missing or invalid.
glm::vec4 color_member(const Json& object, const char* name) {
    const auto found = object.find(name);
    glm::vec4 color(1);
    if (found != object.end() && found->is_array() && found->size() == 4 &&
        std::ranges::all_of(*found, &Json::is_number))
        for (int c = 0; c < 4; ++c)
            color[c] = static_cast<float>((*found)[static_cast<std::size_t>(c)].get<double>());
    return color;
}

Material read_base_material(const Json& json, UnitRange& range) {
    Material material;
    if (const auto name = json.find("name"); name != json.end() && name->is_string())
        material.name = name->get<std::string>();
    if (const Json* glossy = extension_of(json, "KHR_materials_pbrSpecularGlossiness")) { // takes precedence
        material.base_color = color_member(*glossy, "diffuseFactor");
        range.clamp(material.base_color, "diffuseFactor of materials");
    } else if (const auto pbr = json.find("pbrMetallicRoughness"); pbr != json.end()) {
        material.base_color = color_member(*pbr, "baseColorFactor");
        range.clamp(material.base_color, "baseColorFactor of materials");
    }
    if (const auto mode = json.find("alphaMode"); mode != json.end())
        material.alpha_mode = *mode == "MASK"    ? AlphaMode::mask
                              : *mode == "BLEND" ? AlphaMode::blend
                                                 : AlphaMode::opaque;
    if (const auto cutoff = json.find("alphaCutoff"); cutoff != json.end() && cutoff->is_number())
        material.alpha_cutoff = static_cast<float>(std::clamp(cutoff->get<double>(), 0.0, 1e6));
    material.double_sided = json.contains("doubleSided") && json["doubleSided"] == true;
    return material;
}

} // namespace

std::vector<Material> read_base_materials(const Json& json, UnitRange& range) {
    std::vector<Material> materials;
    if (json.contains("materials"))
        for (const Json& material : json["materials"])
            materials.push_back(read_base_material(material, range));
    materials.emplace_back(); // a rough metal according to glTF; bounces treat it as diffuse
    return materials;
}

} // namespace prt
