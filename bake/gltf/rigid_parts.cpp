// Splits a scene into rigid parts by the node that moves each triangle.

#include "bake/gltf/rigid_parts.h"

#include "bake/gltf/followed_nodes.h"
#include "bake/gltf/write_set.h"
#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/node_transforms.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace prt {
namespace {

/// Indices of triangles per primitive of a scene.
using Triangles = std::map<std::size_t, std::vector<std::size_t>>;

void append(const Triangles& from, Triangles& to) {
    for (const auto& [p, triangles] : from)
        to[p].insert(to[p].end(), triangles.begin(), triangles.end());
}

/// The node hierarchy, with the node that moves each node.
class Carriers {
public:
    Carriers(const GltfModel& model, const std::vector<tinygltf::Animation>& animations)
        : parents_(model.nodes.size(), -1), moves_(model.nodes.size()) {
        for (std::size_t n = 0; n < model.nodes.size(); ++n)
            for (const int child : model.nodes[n].children)
                if (is_node(child))
                    parents_[static_cast<std::size_t>(child)] = static_cast<int>(n);
        for (const tinygltf::Animation& animation : animations)
            for (const tinygltf::AnimationChannel& channel : animation.channels)
                if (is_node(channel.target_node) && channel.target_path != "weights")
                    moves_[static_cast<std::size_t>(channel.target_node)] = true;
        for (const GltfSkin& skin : model.skins)
            for (const int joint : skin.joints)
                if (is_node(joint))
                    moves_[static_cast<std::size_t>(joint)] = true;
    }

    /// Returns `node` if it moves, else its nearest moving ancestor, else its root.
    int of(int node) const {
        int at = node;
        while (!moves_[static_cast<std::size_t>(at)] && parent(at) >= 0)
            at = parent(at);
        return at;
    }
    /// Returns the carrier of a carrier; -1 if absent.
    int above(int carrier) const { return parent(carrier) < 0 ? -1 : of(parent(carrier)); }
    std::size_t depth(int node) const {
        std::size_t steps = 0;
        for (int at = parent(node); at >= 0 && steps < parents_.size(); at = parent(at)) // limit for cycles
            ++steps;
        return steps;
    }

private:
    bool is_node(int n) const { return n >= 0 && static_cast<std::size_t>(n) < parents_.size(); }
    int parent(int node) const { return parents_[static_cast<std::size_t>(node)]; }

    std::vector<int> parents_;
    std::vector<bool> moves_;
};

/// Joints of the vertices of a skinned primitive, with their weights.
struct SkinnedVertices {
    struct Influence {
        std::uint32_t joint;
        float weight;
    };
    std::vector<std::vector<Influence>> of; ///< [vertices of the file]
};

SkinnedVertices skinned_vertices(const GltfModel& model, const GltfPrimitive& primitive) {
    SkinnedVertices vertices;
    for (int set = 0;; ++set) {
        const auto joints = primitive.attributes.find("JOINTS_" + std::to_string(set));
        const auto weights = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
        if (joints == primitive.attributes.end() || weights == primitive.attributes.end())
            return vertices;
        const auto indices = read_unsigned(model, joints->second, 4);
        const auto shares = read_floats(model, weights->second, 4);
        vertices.of.resize(std::max(vertices.of.size(), indices.size() / 4));
        for (std::size_t i = 0; i < indices.size() && i < shares.size(); ++i)
            if (shares[i] > 0)
                vertices.of[i / 4].push_back({indices[i], shares[i]});
    }
}

/// Returns the joint with the largest influence on a triangle; -1 if absent.
int joint_of(const SkinnedVertices& vertices, const VertexArray& array, const glm::uvec3& triangle) {
    std::map<std::uint32_t, float> sums;
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t v = array.source.empty() ? triangle[corner] : array.source[triangle[corner]];
        if (v < vertices.of.size())
            for (const auto& influence : vertices.of[v])
                sums[influence.joint] += influence.weight;
    }
    const auto most = std::ranges::max_element(sums, {}, [](const auto& sum) { return sum.second; });
    return most == sums.end() ? -1 : static_cast<int>(most->first);
}

/// Returns the triangles, grouped by `group` of the node or joint that they belong to.
template <class Group>
std::map<int, Triangles> grouped(const GltfModel& model, const Scene& scene, const Group& group) {
    std::map<int, Triangles> parts;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        const GltfNode& node = model.nodes[static_cast<std::size_t>(primitive.node)];
        const GltfPrimitive& file = model.meshes[static_cast<std::size_t>(primitive.mesh)]
                                        .primitives[static_cast<std::size_t>(primitive.primitive)];
        const SkinnedVertices skinned = node.skin >= 0 ? skinned_vertices(model, file) : SkinnedVertices();
        for (std::size_t t = 0; t < primitive.triangles.size(); ++t) {
            int carrier = primitive.node;
            if (node.skin >= 0)
                if (const int joint =
                        joint_of(skinned, scene.vertex_arrays[primitive.vertices], primitive.triangles[t]);
                    joint >= 0)
                    carrier = model.skins[static_cast<std::size_t>(node.skin)]
                                  .joints[static_cast<std::size_t>(joint)];
            parts[group(carrier)][p].push_back(t);
        }
    }
    return parts;
}

double diagonal_of(const Scene& scene, const Triangles& triangles) {
    glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
    for (const auto& [p, chosen] : triangles)
        for (const std::size_t t : chosen)
            for (int corner = 0; corner < 3; ++corner) {
                const Primitive& primitive = scene.primitives[p];
                const glm::vec3& v =
                    scene.vertex_arrays[primitive.vertices].positions[primitive.triangles[t][corner]];
                low = glm::min(low, v);
                high = glm::max(high, v);
            }
    return static_cast<double>(glm::length(high - low));
}

/// Merges small parts into their parent part, starting at the leaves of the hierarchy.
void join_small(const Scene& scene, const Carriers& carriers, double least, std::map<int, Triangles>& parts) {
    std::set<std::pair<std::size_t, int>> open; // depth, node
    for (const auto& [node, triangles] : parts)
        open.insert({carriers.depth(node), node});
    while (!open.empty()) {
        const int node = std::prev(open.end())->second;
        open.erase(std::prev(open.end()));
        const int above = carriers.above(node);
        if (above < 0 || diagonal_of(scene, parts[node]) >= least)
            continue;
        append(parts[node], parts[above]);
        parts.erase(node);
        open.insert({carriers.depth(above), above});
    }
}

/// Materials and images that a part uses, each once, so that all parts need no more memory than the scene.
/// Materials are reduced to their effect on occlusion: cut-outs keep their textures, all others lose them.
class PartMaterials {
public:
    PartMaterials(const Scene& scene, Scene& part) : scene_(scene), part_(part) {}

    /// Returns the index in the part of a material of the scene.
    std::size_t of(std::size_t material) {
        const auto [found, is_new] = materials_.try_emplace(material, part_.materials.size());
        if (!is_new)
            return found->second;
        const Material& from = scene_.materials[material];
        Material to;
        if (from.alpha_mode != AlphaMode::opaque || from.glass.factor > 0 || from.transmission.factor > 0) {
            to = from;
            to.emission = {};
            for (TextureUse* use : {&to.base_color_texture, &to.metal.texture, &to.glass.texture,
                                    &to.transmission.factor_texture, &to.transmission.color_texture})
                if (use->image >= 0)
                    use->image = image(use->image);
        }
        to.double_sided = from.double_sided;
        to.casts_shadow = from.casts_shadow;
        part_.materials.push_back(std::move(to));
        return found->second;
    }

private:
    int image(int index) {
        const auto [found, is_new] = images_.try_emplace(index, static_cast<int>(part_.images.size()));
        if (is_new)
            part_.images.push_back(static_cast<std::size_t>(index) < scene_.images.size()
                                       ? scene_.images[static_cast<std::size_t>(index)]
                                       : EncodedImage{"image " + std::to_string(index), {}});
        return found->second;
    }

    const Scene& scene_;
    Scene& part_;
    std::map<std::size_t, std::size_t> materials_;
    std::map<int, int> images_;
};

/// Adds triangles of `scene` to `part`.
void add_triangles(const Scene& scene, const Triangles& triangles, Scene& part) {
    const glm::vec3 shift(scene.origin - part.origin);
    PartMaterials materials(scene, part);
    for (const auto& [p, chosen] : triangles) {
        const Primitive& from = scene.primitives[p];
        const VertexArray& array = scene.vertex_arrays[from.vertices];
        Primitive to{
            from.node,     from.mesh, from.primitive, part.vertex_arrays.size(), materials.of(from.material),
            from.mirrored, {}};
        VertexArray& kept = part.vertex_arrays.emplace_back();
        kept.texcoords.resize(array.texcoords.size());
        kept.first_receiver = part.receivers();
        std::map<std::uint32_t, std::uint32_t> numbers;
        const auto number_of = [&](std::uint32_t v) {
            const auto [found, is_new] = numbers.try_emplace(v, static_cast<std::uint32_t>(kept.size()));
            if (is_new) {
                kept.positions.push_back(array.positions[v] + shift);
                kept.normals.push_back(array.normals[v]);
                for (std::size_t set = 0; set < array.texcoords.size(); ++set)
                    if (!array.texcoords[set].empty())
                        kept.texcoords[set].push_back(array.texcoords[set][v]);
                if (!array.colors.empty())
                    kept.colors.push_back(array.colors[v]);
            }
            return found->second;
        };
        for (const std::size_t t : chosen) {
            const glm::uvec3& corners = from.triangles[t];
            const std::uint32_t x = number_of(corners.x), y = number_of(corners.y), z = number_of(corners.z);
            to.triangles.emplace_back(x, y, z);
        }
        part.primitives.push_back(std::move(to));
    }
}

/// The triangles of a scene, grouped by the nodes of its parts.
struct Split {
    Split(const GltfContents& contents, const Scene& scene, const RigidPartsOptions& options)
        : carriers(contents.model, contents.parsed.animations),
          triangles(grouped(contents.model, scene, [&](int node) { return carriers.of(node); })) {
        const Bounds box = bounds(scene);
        join_small(scene, carriers, options.min_share * static_cast<double>(glm::distance(box.low, box.high)),
                   triangles);
    }
    /// Returns the node of the part that contains `node`; -1 without such a part.
    int part(int node) const {
        int at = node < 0 ? -1 : carriers.of(node);
        while (at >= 0 && !triangles.contains(at))
            at = carriers.above(at);
        return at;
    }

    Carriers carriers;
    std::map<int, Triangles> triangles;
};

/// Returns the parts of a scene without their triangles.
std::vector<RigidPart> placed_parts(const GltfModel& model, const Scene& scene, const Split& split) {
    std::map<int, glm::dmat4> worlds;
    for (const NodeTransform& node : world_transforms(model))
        worlds[node.node] = node.world;
    std::vector<RigidPart> parts;
    for (const auto& [node, triangles] : split.triangles) {
        if (!worlds.contains(node))
            throw Error("joint " + std::to_string(node) + " of a skin is not in the scene");
        parts.push_back(
            {node, name_of(model, node), glm::translate(glm::dmat4(1), -scene.origin) * worlds[node], {}});
        parts.back().scene.origin = scene.origin;
    }
    return parts;
}

/// Returns the triangles of a high-poly model, grouped by the nodes of the parts of `split`. `leaders`: names
/// of the nodes of the file of the parts.
std::map<int, Triangles> finer_triangles(const GltfModel& model, const Scene& finer, const Split& split,
                                         std::span<const std::string> leaders) {
    const std::vector<int> followed = followed_nodes(leaders, node_names(model), node_tree(model).order);
    return grouped(model, finer,
                   [&](int node) { return split.part(followed[static_cast<std::size_t>(node)]); });
}

} // namespace

std::vector<RigidPart> rigid_parts(const GltfDocument& document, const Scene& scene,
                                   const RigidPartsOptions& options) {
    return named(document, [&](const GltfContents& contents) {
        const Split split(contents, scene, options);
        std::vector<RigidPart> parts = placed_parts(contents.model, scene, split);
        for (RigidPart& part : parts)
            add_triangles(scene, split.triangles.at(part.node), part.scene);
        return parts;
    });
}

DetailedParts detailed_parts(const GltfDocument& document, const Scene& scene, const GltfDocument& high_poly,
                             const Scene& finer, const RigidPartsOptions& options) {
    return named(document, [&](const GltfContents& contents) {
        const Split split(contents, scene, options);
        const std::map<int, Triangles> detailed =
            finer_triangles(high_poly.contents().model, finer, split, node_names(contents.model));
        DetailedParts result{.parts = placed_parts(contents.model, scene, split)};
        result.scene.origin = scene.origin;
        Triangles all_detailed, all_own;
        for (RigidPart& part : result.parts) {
            const auto found = detailed.find(part.node);
            const bool own = found == detailed.end();
            const Triangles& triangles = own ? split.triangles.at(part.node) : found->second;
            add_triangles(own ? scene : finer, triangles, part.scene);
            append(triangles, own ? all_own : all_detailed);
            if (own)
                result.own.push_back(part.name);
        }
        if (all_detailed.empty())
            throw Error("no object has the name of a node of the high-poly model with triangles");
        add_triangles(finer, all_detailed, result.scene);
        result.unused = finer.triangles() - result.scene.triangles();
        add_triangles(scene, all_own, result.scene);
        return result;
    });
}

} // namespace prt
