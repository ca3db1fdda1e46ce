// Scenes with the coarser levels of their nodes.
#include "prt/gltf/levels.h"

#include "bake/gltf/extraction.h"
#include "bake/gltf/write_set.h"
#include "runtime/load/fallback.h"
#include "runtime/load/own_attributes.h"

#include <algorithm>
#include <set>
#include <utility>

namespace prt {
namespace {

/// Returns those of primitives [first, last) that `nodes` draw.
std::vector<std::size_t> primitives_of(const Scene& scene, const std::set<int>& nodes, std::size_t first,
                                       std::size_t last) {
    std::vector<std::size_t> chosen;
    for (std::size_t p = first; p < last; ++p)
        if (nodes.contains(scene.primitives[p].node) && !scene.primitives[p].triangles.empty())
            chosen.push_back(p);
    return chosen;
}

LeveledNode leveled_node(const GltfContents& contents, const Geometry& extraction, const NodeLevels& levels) {
    const Scene& scene = extraction.scene;
    LeveledNode result{levels.node, node_name(contents.model, levels.node), levels.by_name, {}, {}};
    result.finest =
        primitives_of(scene, {levels.finest.begin(), levels.finest.end()}, 0, extraction.finest_primitives);
    for (const NodeLevels::Level& level : levels.coarser) {
        std::set<int> nodes;
        for (const NodeTransform& node : level.nodes)
            nodes.insert(node.node);
        CoarserLevel coarser{
            level.number, level.node, node_name(contents.model, level.node),
            primitives_of(scene, nodes, extraction.finest_primitives, scene.primitives.size())};
        if (!coarser.primitives.empty() && !result.finest.empty())
            result.coarser.push_back(std::move(coarser));
    }
    return result;
}

bool has_transfer(const Json& primitive) {
    if (extension_of(primitive, kTransferExtension))
        return true;
    return std::ranges::any_of(primitive["attributes"].items(), [](const auto& attribute) {
        return is_own_attribute(attribute.key()) && !is_lobe_attribute(attribute.key()) &&
               attribute.key() != kOtherColors;
    });
}

} // namespace

std::size_t LeveledScene::deepest() const {
    std::size_t deepest = 0;
    for (const LeveledNode& node : nodes)
        for (const CoarserLevel& level : node.coarser)
            deepest = std::max(deepest, static_cast<std::size_t>(level.level));
    return deepest;
}

bool has_levels(const GltfDocument& document) {
    return named(document,
                 [](const GltfContents& contents) { return !level_nodes(contents).levels.empty(); });
}

LeveledScene extract_levels(const GltfDocument& document) {
    return named(document, [](const GltfContents& contents) {
        return leveled_scene(contents, extract_with_levels(contents, Keep::scene));
    });
}

LeveledScene leveled_scene(const GltfContents& contents, Geometry geometry) {
    LeveledScene result;
    result.notices = std::move(geometry.nodes.notices);
    for (const NodeLevels& levels : geometry.nodes.levels) {
        LeveledNode node = leveled_node(contents, geometry, levels);
        if (!node.coarser.empty())
            result.nodes.push_back(std::move(node));
    }
    result.finest_primitives = geometry.finest_primitives;
    std::set<std::size_t> arrays;
    for (std::size_t p = 0; p < geometry.finest_primitives; ++p)
        arrays.insert(geometry.scene.primitives[p].vertices);
    for (const std::size_t array : arrays)
        result.finest_receivers += geometry.scene.vertex_arrays[array].size();
    result.scene = std::move(geometry.scene);
    return result;
}

void keep_levels(std::vector<LeveledNode>& nodes, const Scene& scene,
                 const std::function<bool(const Primitive&)>& keep) {
    for (LeveledNode& node : nodes)
        std::erase_if(node.coarser, [&](const CoarserLevel& level) {
            return std::ranges::none_of(level.primitives,
                                        [&](std::size_t p) { return keep(scene.primitives[p]); });
        });
    std::erase_if(nodes, [](const LeveledNode& node) { return node.coarser.empty(); });
}

bool levels_have_transfer(const GltfDocument& document, const LeveledScene& scene) {
    return named(document, [&](const GltfContents& contents) {
        for (const LeveledNode& node : scene.nodes)
            for (const CoarserLevel& level : node.coarser)
                for (const std::size_t p : level.primitives)
                    if (has_transfer(primitive_json(contents, scene.scene.primitives[p])))
                        return true;
        return false;
    });
}

std::size_t vertices_of(const Scene& scene, std::span<const std::size_t> primitives) {
    std::set<std::size_t> arrays;
    for (const std::size_t p : primitives)
        arrays.insert(scene.primitives[p].vertices);
    std::size_t count = 0;
    for (const std::size_t array : arrays)
        count += scene.vertex_arrays[array].size();
    return count;
}

std::vector<float> areas_of_level(const LeveledScene& scene, std::size_t level) {
    std::vector<float> areas = receiver_areas(scene.scene);
    std::vector<bool> kept(scene.scene.vertex_arrays.size(), false);
    for (std::size_t p = 0; level == 0 && p < scene.finest_primitives; ++p)
        kept[scene.scene.primitives[p].vertices] = true;
    for (const LeveledNode& node : scene.nodes)
        for (const CoarserLevel& coarser : node.coarser)
            if (static_cast<std::size_t>(coarser.level) == level)
                for (const std::size_t p : coarser.primitives)
                    kept[scene.scene.primitives[p].vertices] = true;
    for (std::size_t array = 0; array < kept.size(); ++array)
        if (!kept[array]) {
            const VertexArray& vertices = scene.scene.vertex_arrays[array];
            std::fill_n(areas.begin() + static_cast<std::ptrdiff_t>(vertices.first_receiver), vertices.size(),
                        0.0f);
        }
    return areas;
}

} // namespace prt
