// Extensions of glTF that the reader supports.
#include "runtime/scene/gltf/supported_extensions.h"

#include "runtime/scene/gltf/contents.h"
#include "runtime/scene/gltf/draco_primitives.h"
#include "runtime/scene/gltf/meshopt_views.h"
#include "runtime/scene/gltf/unread.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace prt {
namespace {

/// Extensions that a file may list in extensionsRequired. Extensions of materials and lights change only
/// reflection, and the base color is used instead. Missing textures of other formats are an error only if
/// they are needed.
constexpr std::array<std::string_view, 37> kSupportedExtensions = {
    kTransferExtension,
    kClusteredExtension,
    kLightmapExtension,
    kVolumeExtension,
    kInstancesExtension,
    kLobeExtension,
    kOccluderExtension,
    kMeshoptExtension,
    kDracoExtension,
    "EXT_mesh_gpu_instancing",
    "MSFT_lod",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_animation_pointer",
    "KHR_xmp_json_ld",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "EXT_lights_image_based",
    kCesiumExtension, // moves the whole scene, which does not change its light
};

std::string light_name(const Json& light, std::size_t index) {
    const std::string name = light.is_object() ? light.value("name", "") : "";
    return "light " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

} // namespace

bool is_supported_extension(std::string_view name) {
    return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), name) !=
           kSupportedExtensions.end();
}

std::vector<std::string> unread_extensions(const GltfDocument& document) {
    std::vector<std::string> unread;
    const Json& json = document.contents().json;
    if (const auto used = json.find("extensionsUsed"); used != json.end() && used->is_array())
        for (const Json& name : *used)
            if (name.is_string() && !is_supported_extension(name.get<std::string>()))
                unread.push_back(name.get<std::string>());
    return unread;
}

std::vector<std::string> unused_lights(const GltfDocument& document) {
    const Json& json = document.contents().json;
    std::vector<std::string> unused;
    const Json* extension = extension_of(json, "KHR_lights_punctual");
    if (!extension || !extension->contains("lights"))
        return unused;
    std::set<std::size_t> used;
    if (const auto nodes = json.find("nodes"); nodes != json.end())
        for (const Json& node : *nodes)
            if (const Json* light = extension_of(node, "KHR_lights_punctual");
                light && light->contains("light") && light->at("light").is_number_unsigned())
                used.insert(light->at("light").get<std::size_t>());
    const Json& lights = extension->at("lights");
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (!used.contains(i))
            unused.push_back(light_name(lights[i], i));
    return unused;
}

} // namespace prt
