// Extracts world-space vertices and triangles of a glTF file.
#include "runtime/load/geometry.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/accessor.h"
#include "runtime/load/flat_normals.h"
#include "runtime/load/lobe_transfer.h"
#include "runtime/load/materials.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/scene_size.h"
#include "runtime/load/shared_vertices.h"
#include "runtime/load/skinning.h"
#include "runtime/load/transformed_normal.h"
#include "runtime/load/triangles.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace prt {
namespace {

template <class Vector>
std::vector<Vector> read_vectors(const GltfModel& model, int accessor) {
    if (const std::span<const float> plain = floats_in_place(model, accessor, Vector::length());
        !plain.empty()) {
        const auto* first = reinterpret_cast<const Vector*>(plain.data());
        return {first, first + plain.size() / static_cast<std::size_t>(Vector::length())};
    }
    const std::vector<float> floats = read_floats(model, accessor, Vector::length());
    std::vector<Vector> vectors(floats.size() / static_cast<std::size_t>(Vector::length()));
    if (!vectors.empty())
        std::memcpy(vectors.data(), floats.data(), floats.size() * sizeof(float));
    return vectors;
}

void check_count(std::size_t count, std::size_t vertices, const char* attribute) {
    if (count != vertices)
        throw Error(std::string(attribute) + " has " + std::to_string(count) +
                    " elements, but the primitive has " + counted(vertices, "vertex", "vertices"));
}

void read_texcoords(const GltfModel& model, const GltfPrimitive& primitive, VertexArray& vertices) {
    for (int set = 0;; ++set) {
        const int accessor = attribute_of(primitive, "TEXCOORD_" + std::to_string(set));
        if (accessor < 0)
            return;
        vertices.texcoords.push_back(read_vectors<glm::vec2>(model, accessor));
        check_count(vertices.texcoords.back().size(), vertices.size(), "TEXCOORD");
        for (glm::vec2& uv : vertices.texcoords.back())
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
                uv = glm::vec2(0); // as the tools repair a file
    }
}

void read_colors(const GltfModel& model, const GltfPrimitive& primitive, VertexArray& vertices) {
    const int accessor = attribute_of(primitive, "COLOR_0");
    if (accessor < 0)
        return;
    if (get_accessor(model, accessor).components == 4)
        vertices.colors = read_vectors<glm::vec4>(model, accessor);
    else
        for (const glm::vec3& rgb : read_vectors<glm::vec3>(model, accessor))
            vertices.colors.emplace_back(rgb, 1);
    check_count(vertices.colors.size(), vertices.size(), "COLOR_0");
}

void check_position(const glm::dvec3& point, std::size_t vertex) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(point[axis]) <= kFarthestVertex))
            throw Error("the position of vertex " + std::to_string(vertex) +
                        " is not finite, or more than 1e9 m from the origin of the scene");
}

/// Adds the morph targets with the weights of the mesh or node (glTF 2.0, 3.7.2.2).
void apply_morph_targets(const GltfModel& model, const GltfPrimitive& primitive,
                         const std::vector<double>& weights, VertexArray& vertices) {
    for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
        const auto weight = static_cast<float>(weights[t]);
        if (weight == 0)
            continue;
        const auto add = [&](const char* name, std::vector<glm::vec3>& to) {
            const auto found = primitive.targets[t].find(name);
            if (found == primitive.targets[t].end() || to.empty())
                return;
            const auto deltas = read_vectors<glm::vec3>(model, found->second);
            check_count(deltas.size(), to.size(), "a morph target");
            for (std::size_t i = 0; i < to.size(); ++i)
                to[i] += weight * deltas[i];
        };
        add("POSITION", vertices.positions);
        add("NORMAL", vertices.normals);
    }
}

class GeometryExtractor {
public:
    GeometryExtractor(const GltfData& data, Keep keep, UnitRange& range)
        : data_(data), model_(data.model), keep_(keep), range_(range),
          leaves_out_lobes_(data.leave_out_lobes && has_surface_transfer(data)) {
        geometry_.scene.materials = read_base_materials(data.json, range);
    }

    /// Extracts the finest levels.
    Geometry extract() {
        geometry_.nodes = level_nodes(data_);
        extract_primitives({});
        return std::move(geometry_);
    }

    /// Extracts the finest levels, then the coarser levels.
    Geometry extract_with_levels() {
        geometry_.nodes = level_nodes(data_);
        leave_out_empty(geometry_.nodes);
        std::vector<NodeTransform> coarser;
        for (const NodeLevels& levels : geometry_.nodes.levels)
            for (const NodeLevels::Level& level : levels.coarser)
                coarser.insert(coarser.end(), level.nodes.begin(), level.nodes.end());
        extract_primitives(coarser);
        return std::move(geometry_);
    }

private:
    bool draws(int node) const {
        const int mesh = model_.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh < 0 || static_cast<std::size_t>(mesh) >= model_.meshes.size())
            return false;
        return std::ranges::any_of(
            model_.meshes[static_cast<std::size_t>(mesh)].primitives,
            [&](const GltfPrimitive& file) { return is_triangle_mode(file.mode) && has_vertices(file); });
    }

    /// Removes levels without triangles, and all levels of nodes without triangles.
    void leave_out_empty(LevelNodes& nodes) const {
        std::erase_if(nodes.levels, [&](NodeLevels& levels) {
            const std::string name = node_name(model_, levels.node);
            if (std::ranges::none_of(levels.finest, [&](int node) { return draws(node); })) {
                nodes.notices.push_back(name +
                                        " has levels of detail, but no triangles: these levels are not "
                                        "changed");
                return true;
            }
            std::erase_if(levels.coarser, [&](const NodeLevels::Level& level) {
                const bool empty = std::ranges::none_of(
                    level.nodes, [&](const NodeTransform& node) { return node.visible && draws(node.node); });
                if (empty)
                    nodes.notices.push_back(node_name(model_, level.node) + ", level " +
                                            std::to_string(level.number) + " of " + name +
                                            ", has no triangles and is ignored");
                return empty;
            });
            return levels.coarser.empty();
        });
    }

    void extract_primitives(std::span<const NodeTransform> coarser) {
        const LevelNodes& nodes = geometry_.nodes;
        std::vector<NodeTransform> all = nodes.finest;
        all.insert(all.end(), coarser.begin(), coarser.end());
        check_scene_size(data_, all);
        for (const NodeTransform& node : nodes.finest)
            add_node(node);
        if (scene_.triangles() == 0)
            throw Error("the scene has no triangles");
        geometry_.finest_primitives = scene_.primitives.size();
        for (const NodeTransform& node : coarser)
            add_node(node);
        place_about_middle(geometry_.finest_primitives);
        make_flat_normals();
        seen_.coarser_levels = nodes.left_out;
        add_notices();
        std::size_t first = 0;
        for (VertexArray& vertices : scene_.vertex_arrays) {
            vertices.first_receiver = first;
            first += vertices.size();
        }
    }

    void add_node(const NodeTransform& transform) {
        const GltfNode& node = model_.nodes[static_cast<std::size_t>(transform.node)];
        if (node.mesh < 0)
            return;
        if (!transform.visible) {
            ++seen_.hidden_nodes;
            return;
        }
        if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
            throw Error("node " + std::to_string(transform.node) + " refers to mesh " +
                        std::to_string(node.mesh) + ", which does not exist");
        const GltfMesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            try {
                add_primitive(transform, static_cast<int>(i));
            } catch (const Error& error) {
                throw Error("mesh " + std::to_string(node.mesh) + " primitive " + std::to_string(i) + ": " +
                            error.what());
            }
        }
    }

    const Skin& skin_of(int index) {
        const auto found = geometry_.skins.find(index);
        return found != geometry_.skins.end()
                   ? found->second
                   : geometry_.skins.emplace(index, read_skin(model_, index)).first->second;
    }

    /// Returns the matrices of a skin in the pose of the file; several meshes may use it.
    const std::vector<glm::dmat4>& palette_of(int skin) {
        const auto found = palettes_.find(skin);
        return found != palettes_.end()
                   ? found->second
                   : palettes_.emplace(skin, joint_palette(skin_of(skin), geometry_.nodes.world))
                         .first->second;
    }

    bool has_vertices(const GltfPrimitive& file) const {
        const int position = attribute_of(file, "POSITION");
        const auto index = static_cast<std::size_t>(position);
        return position >= 0 && (index >= model_.accessors.size() || model_.accessors[index].count > 0);
    }

    void add_primitive(const NodeTransform& transform, int index) {
        const GltfNode& node = model_.nodes[static_cast<std::size_t>(transform.node)];
        const GltfMesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        const GltfPrimitive& file = mesh.primitives[static_cast<std::size_t>(index)];
        if (!is_triangle_mode(file.mode) || !has_vertices(file)) {
            ++seen_.skipped_primitives;
            return;
        }
        if (leaves_out_lobes_ && has_lobes(data_, file))
            return;
        Primitive primitive{transform.node,
                            node.mesh,
                            index,
                            0,
                            material_index(file.material),
                            false,
                            {},
                            name_of(model_, transform.node)};
        // Flat normals depend on the triangles, so that such a primitive cannot share its vertices.
        const int alone = attribute_of(file, "NORMAL") < 0 ? index : -1;
        const auto [vertices_of, is_new] =
            shared_.of(transform.node, alone, file, scene_.vertex_arrays.size());
        primitive.vertices = vertices_of;
        if (is_new)
            add_vertices(transform, file, mesh);
        VertexArray& vertices = scene_.vertex_arrays[primitive.vertices];

        primitive.triangles = read_triangles(model_, file, vertices.size());
        primitive.mirrored = node.skin < 0 && glm::determinant(glm::dmat3(transform.world)) < 0;
        if (primitive.mirrored)
            for (glm::uvec3& t : primitive.triangles)
                std::swap(t.y, t.z);
        scene_.primitives.push_back(std::move(primitive));
    }

    void add_vertices(const NodeTransform& node_transform, const GltfPrimitive& file, const GltfMesh& mesh) {
        const GltfNode& node = model_.nodes[static_cast<std::size_t>(node_transform.node)];
        VertexArray vertices;
        vertices.positions = read_vectors<glm::vec3>(model_, attribute_of(file, "POSITION"));
        if (const int normals = attribute_of(file, "NORMAL"); normals >= 0) {
            vertices.normals = read_vectors<glm::vec3>(model_, normals);
            check_count(vertices.normals.size(), vertices.size(), "NORMAL");
        }
        read_texcoords(model_, file, vertices);
        read_colors(model_, file, vertices);
        for (glm::vec4& color : vertices.colors)
            range_.clamp(color, "COLOR_0 of vertices");
        seen_.has_morphs |= !file.targets.empty();
        apply_morph_targets(model_, file, node.weights.empty() ? mesh.weights : node.weights, vertices);

        vertices.lobes = has_lobes(data_, file);

        MovingVertices moving{static_cast<std::size_t>(node_transform.node),
                              node.skin,
                              {},
                              {},
                              1,
                              {},
                              {},
                              !file.targets.empty()};
        if (node.skin >= 0)
            read_influences(model_, file, skin_of(node.skin).joints.size(), vertices.size(), moving);
        std::vector<glm::dvec3> points;
        points.reserve(vertices.size());
        if (keep_ == Keep::moving)
            moving.positions = vertices.positions, moving.normals = vertices.normals;
        if (node.skin < 0) {
            for (const glm::vec3& position : vertices.positions)
                points.emplace_back(node_transform.world * glm::dvec4(position, 1));
            std::ranges::transform(vertices.normals, vertices.normals.begin(),
                                   NormalTransform(node_transform.world));
        } else {
            const std::vector<glm::dmat4>& palette = palette_of(node.skin);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                const glm::dmat4 matrix = vertex_matrix(palette, moving, i);
                points.emplace_back(matrix * glm::dvec4(vertices.positions[i], 1));
                if (!vertices.normals.empty())
                    vertices.normals[i] = transformed_normal(vertices.normals[i], matrix);
            }
        }
        for (std::size_t i = 0; i < points.size(); ++i)
            check_position(points[i], i);
        if (keep_ == Keep::moving)
            geometry_.moving.push_back(std::move(moving));
        positions_.push_back(std::move(points));
        scene_.vertex_arrays.push_back(std::move(vertices));
    }

    /// Converts positions to the world frame, relative to the center of the bounding box of the first
    /// `finest` primitives. They are rounded to float only here.
    void place_about_middle(std::size_t finest) {
        std::vector<std::vector<bool>> drawn(positions_.size()); // [vertex arrays][vertices]
        for (const Primitive& primitive : std::span(scene_.primitives).first(finest)) {
            std::vector<bool>& vertices = drawn[primitive.vertices];
            vertices.resize(positions_[primitive.vertices].size());
            for (const glm::uvec3& t : primitive.triangles)
                vertices[t.x] = vertices[t.y] = vertices[t.z] = true;
        }
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
        for (std::size_t array = 0; array < drawn.size(); ++array)
            for (std::size_t v = 0; v < drawn[array].size(); ++v)
                if (drawn[array][v]) {
                    low = glm::min(low, positions_[array][v]);
                    high = glm::max(high, positions_[array][v]);
                }
        scene_.origin = low + 0.5 * (high - low);
        for (std::size_t array = 0; array < positions_.size(); ++array)
            std::transform(positions_[array].begin(), positions_[array].end(),
                           scene_.vertex_arrays[array].positions.begin(),
                           [&](const glm::dvec3& point) { return glm::vec3(point - scene_.origin); });
        positions_.clear();
    }

    void make_flat_normals() {
        for (Primitive& primitive : scene_.primitives) {
            VertexArray& vertices = scene_.vertex_arrays[primitive.vertices];
            if (!vertices.normals.empty())
                continue;
            seen_.vertices_before += vertices.size();
            split_for_flat_normals(vertices, primitive.triangles);
            seen_.vertices_after += vertices.size();
            ++seen_.flat_primitives;
        }
    }

    std::size_t material_index(int material) const {
        if (material < 0)
            return scene_.materials.size() - 1;
        if (static_cast<std::size_t>(material) + 1 >= scene_.materials.size())
            throw Error("material " + std::to_string(material) + " does not exist");
        return static_cast<std::size_t>(material);
    }

    void add_notices() {
        if (!geometry_.skins.empty())
            scene_.notices.emplace_back("skinned meshes are read in the pose that the file stores");
        if (seen_.has_morphs)
            scene_.notices.emplace_back("morph targets are applied with the weights that the file stores");
        if (seen_.flat_primitives > 0)
            scene_.notices.emplace_back(
                counted(seen_.flat_primitives, "primitive has", "primitives have") +
                " no normals; flat shading is used: " + std::to_string(seen_.vertices_before) +
                " vertices become " + std::to_string(seen_.vertices_after) +
                "; prt bake, make and ao create smooth normals with --smooth-normals 30");
        if (seen_.skipped_primitives > 0)
            scene_.notices.emplace_back(counted(seen_.skipped_primitives, "primitive without triangles is",
                                                "primitives without triangles are") +
                                        " not changed (points, lines or empty)");
        if (seen_.hidden_nodes > 0)
            scene_.notices.emplace_back(counted(seen_.hidden_nodes, "hidden mesh is", "hidden meshes are") +
                                        " ignored (KHR_node_visibility)");
        if (seen_.coarser_levels > 0)
            scene_.notices.emplace_back(
                counted(seen_.coarser_levels, "node is a coarser level", "nodes are coarser levels") +
                " of detail (from MSFT_lod or node names): not drawn, and without shadows");
        if (const std::size_t zero_normals = replace_zero_normals(scene_); zero_normals > 0)
            scene_.notices.emplace_back(counted(zero_normals, "vertex has", "vertices have") +
                                        " no usable normal; the normal of the adjacent triangles is used");
    }

    /// Counts for notices to the user.
    struct Seen {
        std::size_t flat_primitives = 0, skipped_primitives = 0, hidden_nodes = 0;
        std::size_t coarser_levels = 0, vertices_before = 0, vertices_after = 0; ///< with flat normals
        bool has_morphs = false;
    };

    const GltfData& data_;
    const GltfModel& model_;
    Keep keep_;
    UnitRange& range_;
    bool leaves_out_lobes_;
    Geometry geometry_;
    Scene& scene_ = geometry_.scene;
    std::vector<std::vector<glm::dvec3>> positions_; ///< [vertex arrays][vertices] in the world
    SharedVertices shared_;
    std::map<int, std::vector<glm::dmat4>> palettes_; ///< by skin
    Seen seen_;
};

} // namespace

Geometry extract_geometry(const GltfData& data, UnitRange& range, Keep keep) {
    return GeometryExtractor(data, keep, range).extract();
}

Geometry extract_geometry_with_levels(const GltfData& data, UnitRange& range, Keep keep) {
    return GeometryExtractor(data, keep, range).extract_with_levels();
}

} // namespace prt
