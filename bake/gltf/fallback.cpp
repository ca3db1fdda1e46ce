// Baked light for viewers without support for the extensions: docs/format.md, "Fallback".

#include "bake/gltf/vertex_fallback.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_set.h"
#include "runtime/load/fallback.h"
#include "runtime/load/receiver_sets.h"

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

namespace prt {
namespace {

Json& material_at(Json& json, int material) {
    return json.at("materials").at(static_cast<std::size_t>(material));
}

/// Returns whether a material's appearance is not only its reflected base color.
bool is_left_alone(const Json& material) {
    const Json* glass = extension_of(material, "KHR_materials_transmission");
    return is_unlit(material) || (glass && glass->value("transmissionFactor", 0.0) > 0) ||
           material.value("emissiveFactor", std::vector<double>(3, 0.0)) != std::vector<double>(3, 0.0);
}

/// Returns the materials of primitives outside `lit`, and of all variants.
std::set<int> used_elsewhere(const Json& json, std::span<Json* const> lit) {
    std::set<int> used;
    for_each_primitive(json, [&](const Json& primitive) {
        if (std::ranges::find(lit, &primitive) == lit.end())
            used.insert(material_of(primitive));
        if (const Json* variants = extension_of(primitive, "KHR_materials_variants"))
            for (const Json& mapping : variants->value("mappings", Json::array()))
                used.insert(material_of(mapping));
    });
    return used;
}

/// Purpose of unlit materials: a fallback, which readers of the transfer ignore, or the only light.
enum class UnlitUse { fallback, only };

/// Makes materials unlit, each once: copies a material that others use, and creates one for primitives
/// without.
class UnlitMaterials {
public:
    UnlitMaterials(Json& json, std::set<int> used_elsewhere, UnlitUse use)
        : json_(json), used_elsewhere_(std::move(used_elsewhere)), use_(use) {}

    int unlit(int material) {
        const auto [known, is_new] = unlit_.try_emplace(material, material);
        if (!is_new)
            return known->second;
        Json& materials = member(json_, "materials", Json::value_t::array);
        if (material < 0 || used_elsewhere_.contains(material)) {
            known->second = static_cast<int>(materials.size());
            Json copy = material < 0 ? Json::object() : Json(material_at(json_, material));
            materials.push_back(std::move(copy));
        }
        extensions_of(material_at(json_, known->second))[kUnlitExtension] =
            use_ == UnlitUse::fallback ? Json{{"extras", {{kFallbackMark, kFallbackMarked}}}}
                                       : Json::object();
        return known->second;
    }

private:
    Json& json_;
    std::set<int> used_elsewhere_;
    UnlitUse use_;
    std::map<int, int> unlit_; ///< by original material
};

std::size_t add_colors(GltfContents& contents, const VertexArray& vertices,
                       std::span<const glm::vec3> radiance, float exposure) {
    std::vector<glm::u16vec4> colors;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const glm::vec4 own = vertices.colors.empty() ? glm::vec4(1) : vertices.colors[v];
        const glm::vec4 color = own * glm::vec4(exposure * radiance[vertices.first_receiver + v], 1);
        colors.emplace_back(glm::round(65535.0f * glm::clamp(color, 0.0f, 1.0f)));
    }
    const std::size_t view =
        contents.add_buffer_view(std::as_bytes(std::span(colors)), sizeof(glm::u16vec4), true);
    return contents.add_accessor({{"bufferView", view},
                                  {"componentType", kUnsignedShort},
                                  {"normalized", true},
                                  {"count", colors.size()},
                                  {"type", "VEC4"}});
}

/// Writes the light as COLOR_0 of the primitives of `scene`. Returns the number of primitives that show it.
std::size_t show_light(GltfContents& contents, const Scene& scene, std::span<const glm::vec3> radiance,
                       float exposure, UnlitUse use) {
    const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
    UnlitMaterials materials(contents.json, used_elsewhere(contents.json, primitives), use);
    std::map<std::size_t, std::size_t> colors; // accessors by vertex array
    std::map<int, bool> left_alone;            // by original material
    std::size_t count = 0;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        Json& primitive = *primitives[i];
        const int material = material_of(primitive);
        const auto alone = left_alone.try_emplace(material, false);
        if (alone.second && material >= 0)
            alone.first->second = is_left_alone(material_at(contents.json, material));
        if (alone.first->second)
            continue;
        const std::size_t vertices = scene.primitives[i].vertices;
        const auto own = colors.try_emplace(vertices, 0);
        if (own.second)
            own.first->second = add_colors(contents, scene.vertex_arrays[vertices], radiance, exposure);
        Json& attributes = primitive["attributes"];
        if (use == UnlitUse::fallback && attributes.contains("COLOR_0"))
            attributes[kOtherColors] = Json(attributes["COLOR_0"]);
        attributes["COLOR_0"] = own.first->second;
        primitive["material"] = materials.unlit(material);
        ++count;
    }
    if (count > 0)
        contents.use_extension(kUnlitExtension);
    return count;
}

std::size_t write_into(GltfContents& contents, const Scene& scene, std::span<const glm::vec3> radiance,
                       float exposure) {
    if (!find_set(contents, ReceiverKind::vertices, Coding::clustered))
        throw Error("the file has no compressed transfer at vertices; a fallback needs it");
    const std::size_t count = show_light(contents, scene, radiance, exposure, UnlitUse::fallback);
    (*find_set_to_decode(contents))["fallback"] = {{"exposure", exposure}};
    return count;
}

} // namespace

float fallback_exposure(std::span<const glm::vec3> radiance, std::span<const float> areas) {
    constexpr double kShown = 0.995; // fraction of the surface; small bright regions are clipped
    std::vector<std::size_t> order(radiance.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto brightness = [&](std::size_t p) {
        return std::max({radiance[p].r, radiance[p].g, radiance[p].b});
    };
    std::ranges::sort(order, {}, brightness);
    double all = 0, below = 0;
    for (const float area : areas)
        all += static_cast<double>(area);
    for (const std::size_t p : order) {
        below += static_cast<double>(areas[p]);
        if (below >= kShown * all)
            return brightness(p) > 1e-6f ? 1 / brightness(p) : 1.0f; // darker than any picture can show
    }
    return 1;
}

std::size_t write_fallback(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                           float exposure) {
    return named(document,
                 [&](GltfContents& contents) { return write_into(contents, scene, radiance, exposure); });
}

std::size_t write_unlit(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                        float exposure) {
    return named(document, [&](GltfContents& contents) {
        return show_light(contents, scene, radiance, exposure, UnlitUse::only);
    });
}

} // namespace prt
