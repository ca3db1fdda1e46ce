// Extensions of glTF that the reader supports.
#include "runtime/load/supported_extensions.h"

#include "prt/core/error.h"
#include "runtime/load/extensions.h"

#include <algorithm>
#include <array>
#include <string>

namespace prt {
namespace {

/// Extensions that a file may list in extensionsRequired. Extensions of materials and lights change only
/// reflection, and the base color is used instead. Missing textures of other formats are an error only if
/// they are needed.
constexpr std::array<std::string_view, 34> kSupportedExtensions = {
    kTransferExtension,
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

} // namespace

bool is_supported_extension(std::string_view name) {
    return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), name) !=
           kSupportedExtensions.end();
}

void check_required_extensions(const Json& json) {
    if (!json.contains("extensionsRequired"))
        return;
    for (const Json& name : json["extensionsRequired"])
        if (!name.is_string() || !is_supported_extension(name.get<std::string>()))
            throw Error("requires the glTF extension " +
                        (name.is_string() ? name.get<std::string>() : name.dump()) +
                        ", which is not supported");
}

} // namespace prt
