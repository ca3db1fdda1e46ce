// Restores colors and materials that a fallback replaces.
#include "runtime/load/fallback.h"

#include "prt/core/error.h"
#include "runtime/load/receiver_sets.h"

#include <algorithm>
#include <map>
#include <string>

namespace prt {
namespace {

bool is_unlit_for_fallback(const Json& material) {
    const Json* unlit = extension_of(material, kUnlitExtension);
    return unlit && unlit->contains("extras") && (*unlit)["extras"].is_object() &&
           (*unlit)["extras"].value(kFallbackMark, Json()) == kFallbackMarked;
}

/// Makes materials lit again that were unlit only for the fallback, and returns their indices.
std::set<int> lit_again(GltfData& data) {
    std::set<int> lit;
    if (!data.json.contains("materials"))
        return lit;
    Json& materials = data.json["materials"];
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (!is_unlit_for_fallback(materials[m]))
            continue;
        erase_extension(materials[m], kUnlitExtension);
        lit.insert(static_cast<int>(m));
    }
    if (std::ranges::none_of(materials, is_unlit))
        drop_extension(data.json, kUnlitExtension);
    return lit;
}

/// Restores a primitive's original colors; moves the fallback colors to the attribute that is removed with
/// transfer.
void exchange_colors(Json& attributes, std::map<std::string, int>& of_model) {
    if (!attributes.contains("COLOR_0"))
        return;
    const Json fallback = attributes["COLOR_0"];
    if (attributes.contains(kOtherColors))
        attributes["COLOR_0"] = Json(attributes[kOtherColors]);
    else
        attributes.erase("COLOR_0");
    attributes[kOtherColors] = fallback;
    of_model.erase("COLOR_0");
    for (const char* name : {"COLOR_0", kOtherColors})
        if (attributes.contains(name))
            of_model[name] = attributes[name].get<int>();
}

} // namespace

int material_of(const Json& primitive) {
    const auto found = primitive.find("material");
    return found != primitive.end() && found->is_number_unsigned() ? found->get<int>() : -1;
}

bool is_unlit(const Json& material) {
    return extension_of(material, kUnlitExtension) != nullptr;
}

std::set<int> set_fallback_aside(GltfData& data) {
    Json* set = find_set_to_decode(data);
    if (!set || !set->contains("fallback"))
        return {};
    const Json& exposure = set->at("fallback").at("exposure");
    if (!exposure.is_number() || !(exposure.get<double>() > 0))
        throw Error("the exposure of the fallback is not a number greater than 0");
    set->erase("fallback");
    std::set<int> lit = lit_again(data);
    for (std::size_t m = 0; m < data.model.meshes.size(); ++m)
        for (std::size_t p = 0; p < data.model.meshes[m].primitives.size(); ++p) {
            Json& primitive = data.json.at("meshes").at(m).at("primitives").at(p);
            if (lit.contains(material_of(primitive)) && primitive.contains("attributes"))
                exchange_colors(primitive["attributes"], data.model.meshes[m].primitives[p].attributes);
        }
    return lit;
}

} // namespace prt
