// Splits double-sided triangles into two single-sided ones.
#include "bake/gltf/separate_sides.h"

#include "bake/gltf/edit_meshes.h"
#include "bake/gltf/gathered_accessor.h"
#include "bake/gltf/material_choices.h"
#include "prt/core/error.h"
#include "runtime/load/accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

namespace prt {
namespace {

/// The vertices of an array that get a copy, in order.
class BackVertices {
public:
    explicit BackVertices(std::size_t vertices) : back_(vertices, kNone) {}

    void add(const glm::uvec3& corners) {
        for (int corner = 0; corner < 3; ++corner)
            back_[corners[corner]] = 0;
    }
    /// Assigns indices; call after the last `add`.
    void number() {
        for (std::uint32_t v = 0; v < back_.size(); ++v)
            source_.push_back(v);
        for (std::uint32_t v = 0; v < back_.size(); ++v)
            if (back_[v] != kNone) {
                back_[v] = static_cast<std::uint32_t>(source_.size());
                source_.push_back(v);
            }
    }
    std::size_t fronts() const { return back_.size(); }
    bool empty() const { return source_.size() == back_.size(); }
    /// Source vertex of each vertex, [fronts and backs].
    const std::vector<std::uint32_t>& source() const { return source_; }
    glm::uvec3 opposite(const glm::uvec3& t) const { return {back_[t.x], back_[t.z], back_[t.y]}; }

private:
    static constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> back_; ///< [fronts]
    std::vector<std::uint32_t> source_;
};

template <class Component>
Component negated(Component value) {
    if constexpr (std::is_integral_v<Component>)
        return static_cast<Component>(std::min<int>(-int{value}, std::numeric_limits<Component>::max()));
    else
        return -value;
}

/// Negates the components of `elements`.
void negate(int component_type, std::span<std::byte> elements) {
    with_component_type(component_type, [&](auto type) {
        if constexpr (std::is_signed_v<decltype(type)>)
            for (std::size_t at = 0; at < elements.size(); at += sizeof type) {
                std::memcpy(&type, &elements[at], sizeof type);
                type = negated(type);
                std::memcpy(&elements[at], &type, sizeof type);
            }
    });
}

class SideSeparator {
public:
    SideSeparator(GltfContents& contents, const Scene& scene, const std::vector<bool>& triangles)
        : contents_(contents), scene_(scene) {
        std::size_t t = 0;
        for (const Primitive& primitive : scene.primitives) {
            std::vector<glm::uvec3>& own = separated_.emplace_back();
            std::vector<glm::uvec3>& rest = rest_.emplace_back();
            const bool can = always_double_sided(json(position(separated_.size() - 1)));
            for (const glm::uvec3& corners : primitive.triangles)
                (triangles[t++] && can ? own : rest).push_back(corners);
        }
        for (const VertexArray& vertices : scene.vertex_arrays)
            backs_.emplace_back(vertices.size());
    }

    void separate() {
        for (std::size_t p = 0; p < separated_.size(); ++p)
            for (const glm::uvec3& corners : separated_[p])
                backs_[scene_.primitives[p].vertices].add(corners);
        for (BackVertices& backs : backs_)
            backs.number();
        std::vector<JsonLocation> added;
        for (std::size_t p = 0; p < separated_.size(); ++p) {
            write_vertices(p);
            if (!separated_[p].empty())
                added.push_back(write_triangles(p));
        }
        single_sided(added);
        contents_.remove_unused(std::move(replaced_));
    }

private:
    struct JsonLocation {
        std::size_t mesh, primitive;
    };
    using Moved = std::map<std::pair<int, bool>, std::size_t>; ///< new accessors by old ones and whether they
                                                               ///< are negated

    JsonLocation position(std::size_t p) const {
        const Primitive& primitive = scene_.primitives[p];
        return {contents_.json["nodes"][static_cast<std::size_t>(primitive.node)]["mesh"].get<std::size_t>(),
                static_cast<std::size_t>(primitive.primitive)};
    }
    Json& json(const JsonLocation& at) const {
        return contents_.json["meshes"][at.mesh]["primitives"][at.primitive];
    }

    /// Returns whether the primitive is double-sided in all variants: if a variant culls its back, the new
    /// triangle would show it there.
    bool always_double_sided(const Json& primitive) const {
        bool all = true;
        for_each_choice(primitive, [&](const Json& choice) {
            if (choice.contains("material"))
                all = all && material(choice["material"].get<std::size_t>()).value("doubleSided", false);
        });
        return all;
    }

    const Json& material(std::size_t index) const {
        const Json& materials = contents_.json["materials"];
        if (index >= materials.size())
            throw Error("material " + std::to_string(index) + " does not exist");
        return materials[index];
    }

    /// Writes the extended attributes; primitives of one vertex array share them.
    void write_vertices(std::size_t p) {
        const BackVertices& backs = backs_[scene_.primitives[p].vertices];
        if (backs.empty())
            return;
        Json& primitive = json(position(p));
        Moved& moved = moved_[scene_.primitives[p].vertices];
        const auto move = [&](Json& attributes) {
            for (auto it = attributes.begin(); it != attributes.end(); ++it)
                *it = moved_accessor(it->get<int>(), it.key() == "NORMAL" || it.key() == "TANGENT", backs,
                                     moved);
        };
        move(primitive["attributes"]);
        if (primitive.contains("targets"))
            for (Json& target : primitive["targets"])
                move(target);
    }

    std::size_t moved_accessor(int old, bool rotations, const BackVertices& backs, Moved& moved) {
        const auto [found, is_new] = moved.try_emplace({old, rotations}, 0);
        if (!is_new)
            return found->second;
        replaced_.insert(static_cast<std::size_t>(old));
        std::vector<std::byte> elements = gathered_elements(contents_.model, old, backs.source());
        const std::size_t size = elements.size() / backs.source().size();
        if (rotations)
            negate(get_accessor(contents_.model, old).componentType,
                   std::span(elements).subspan(backs.fronts() * size));
        return found->second = add_vertex_accessor(
                   contents_, contents_.json["accessors"][static_cast<std::size_t>(old)], elements);
    }

    /// Moves separated triangles to a new primitive, unless all are separated.
    JsonLocation write_triangles(std::size_t p) {
        JsonLocation at = position(p);
        const bool mirrored = scene_.primitives[p].mirrored;
        if (!rest_[p].empty()) {
            Json copy = json(at);
            replace_triangles(contents_, json(at), rest_[p], mirrored, replaced_);
            Json& primitives = contents_.json["meshes"][at.mesh]["primitives"];
            at.primitive = primitives.size();
            primitives.push_back(std::move(copy));
        }
        std::vector<glm::uvec3> both = separated_[p];
        for (const glm::uvec3& corners : separated_[p])
            both.push_back(backs_[scene_.primitives[p].vertices].opposite(corners));
        replace_triangles(contents_, json(at), both, mirrored, replaced_);
        return at;
    }

    /// Makes the materials of these primitives single-sided; copies materials that others also use.
    void single_sided(const std::vector<JsonLocation>& primitives) {
        std::map<std::size_t, std::size_t> users;
        for_each_primitive(contents_.json, [&](Json& primitive) {
            for_each_choice(primitive, [&](const Json& choice) {
                if (choice.contains("material"))
                    ++users[choice["material"].get<std::size_t>()];
            });
        });
        std::map<std::size_t, std::vector<Json*>> ours;
        for (const JsonLocation& at : primitives)
            for_each_choice(json(at), [&](Json& choice) {
                if (choice.contains("material"))
                    ours[choice["material"].get<std::size_t>()].push_back(&choice);
            });
        Json& materials = contents_.json["materials"];
        for (const auto& [material, choices] : ours) {
            std::size_t now = material;
            if (users[material] > choices.size()) {
                now = materials.size();
                Json copy = materials[material];
                copy["name"] = lamp_name(scene_, material); // one lamp needs one name
                materials.push_back(std::move(copy));
                animate_alike(material, now);
            }
            materials[now].erase("doubleSided");
            for (Json* const choice : choices)
                (*choice)["material"] = now;
        }
    }

    /// Copies the channels of KHR_animation_pointer for the animated properties of a material.
    void animate_alike(std::size_t material, std::size_t copy) {
        if (!contents_.json.contains("animations"))
            return;
        const std::string from = "/materials/" + std::to_string(material) + "/",
                          to = "/materials/" + std::to_string(copy) + "/";
        for (Json& animation : contents_.json["animations"])
            for (const Json& channel : Json(animation.value("channels", Json::array()))) {
                const Json::json_pointer at("/target/extensions/KHR_animation_pointer/pointer");
                const std::string pointer = channel.contains(at) ? channel.at(at).get<std::string>() : "";
                if (!pointer.starts_with(from))
                    continue;
                Json other = channel;
                other[at] = to + pointer.substr(from.size());
                animation["channels"].push_back(std::move(other));
            }
    }

    GltfContents& contents_;
    const Scene& scene_;
    std::vector<std::vector<glm::uvec3>> separated_, rest_; ///< [primitives]
    std::vector<BackVertices> backs_;                       ///< [vertex arrays]
    std::map<std::size_t, Moved> moved_;                    ///< by vertex array
    std::set<std::size_t> replaced_;                        ///< accessors
};

} // namespace

GltfDocument with_separate_sides(GltfDocument document, const Scene& scene,
                                 const std::vector<bool>& triangles, ChangedMeshes changed) {
    return edit_meshes(
        std::move(document), scene,
        [&](GltfContents& contents) { SideSeparator(contents, scene, triangles).separate(); }, changed);
}

GltfDocument with_separate_sides_of_meshes(SharedDocument shared, const Scene& stored,
                                           const std::vector<bool>& triangles) {
    return edit_shared_meshes(std::move(shared), stored, [&](GltfContents& contents) {
        SideSeparator(contents, stored, triangles).separate();
    });
}

} // namespace prt
