// Writes a refined file: vertices and triangles of a refinement, with all vertex data of the file.
#include "prt/gltf/refinement.h"

#include "bake/gltf/edit_meshes.h"
#include "bake/gltf/gathered_accessor.h"
#include "bake/gltf/midpoint_accessor.h"
#include "bake/gltf/midpoint_joints.h"

#include <map>
#include <optional>
#include <set>
#include <utility>

namespace prt {
namespace {

bool is_skinning(std::string_view name) {
    return name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

/// Attributes and morph targets of a vertex array.
struct ArrayJson {
    Json attributes, targets;
};

class DocumentRefiner {
public:
    DocumentRefiner(GltfContents& contents, const Scene& scene, const Refinement& refinement)
        : contents_(contents), scene_(scene), refinement_(refinement), arrays_(scene.vertex_arrays.size()) {}

    void refine() {
        for (std::size_t p = 0; p < scene_.primitives.size(); ++p) {
            const Primitive& primitive = scene_.primitives[p];
            if (refinement_.triangles[p] == primitive.triangles && midpoints(primitive).empty())
                continue;
            const auto mesh = contents_.json["nodes"][static_cast<std::size_t>(primitive.node)]["mesh"];
            Json& json = contents_.json["meshes"][mesh.get<std::size_t>()]["primitives"]
                                       [static_cast<std::size_t>(primitive.primitive)];
            if (!midpoints(primitive).empty())
                write_vertices(primitive, json);
            replace_triangles(contents_, json, refinement_.triangles[p], primitive.mirrored, replaced_);
        }
        contents_.remove_unused(std::move(replaced_));
    }

private:
    using Moved = std::map<std::pair<int, MidpointRule>, std::size_t>; ///< new accessors

    const std::vector<Midpoint>& midpoints(const Primitive& primitive) const {
        return refinement_.midpoints[primitive.vertices];
    }

    /// Writes the refined attributes; primitives of one vertex array share them.
    void write_vertices(const Primitive& primitive, Json& json) {
        std::optional<ArrayJson>& of_array = arrays_[primitive.vertices];
        if (!of_array)
            of_array = finer(json, midpoints(primitive));
        json["attributes"] = of_array->attributes;
        if (json.contains("targets"))
            json["targets"] = of_array->targets;
    }

    ArrayJson finer(const Json& primitive, std::span<const Midpoint> midpoints) {
        ArrayJson array{primitive["attributes"], primitive.value("targets", Json::array())};
        for (const auto& [name, accessor] : array.attributes.items())
            replaced_.insert(accessor.get<std::size_t>());
        add_midpoint_joints(contents_, array.attributes, midpoints);
        Moved moved; // several morph targets may share one accessor
        for (auto it = array.attributes.begin(); it != array.attributes.end(); ++it)
            if (!is_skinning(it.key()))
                move(it.key(), *it, AttributeOf::vertex, midpoints, moved);
        for (Json& target : array.targets)
            for (auto it = target.begin(); it != target.end(); ++it)
                move(it.key(), *it, AttributeOf::target, midpoints, moved);
        return array;
    }

    void move(const std::string& name, Json& reference, AttributeOf owner,
              std::span<const Midpoint> midpoints, Moved& moved) {
        const int old = reference.get<int>();
        const MidpointRule rule = midpoint_rule(contents_.model, name, old, owner);
        const auto [found, is_new] = moved.try_emplace({old, rule}, 0);
        if (is_new)
            found->second = add_midpoint_accessor(contents_, old, midpoints, rule);
        replaced_.insert(static_cast<std::size_t>(old));
        reference = found->second;
    }

    GltfContents& contents_;
    const Scene& scene_;
    const Refinement& refinement_;
    std::vector<std::optional<ArrayJson>> arrays_; ///< [vertex arrays]
    std::set<std::size_t> replaced_;               ///< accessors
};

} // namespace

GltfDocument refined(GltfDocument document, const Scene& scene, const Refinement& refinement) {
    return edit_meshes(std::move(document), scene, [&](GltfContents& contents) {
        DocumentRefiner(contents, scene, refinement).refine();
    });
}

GltfDocument refined(SharedDocument shared, const Scene& stored, const Refinement& refinement) {
    return edit_shared_meshes(std::move(shared), stored, [&](GltfContents& contents) {
        DocumentRefiner(contents, stored, refinement).refine();
    });
}

} // namespace prt
