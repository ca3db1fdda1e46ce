// Finds levels by MSFT_lod and by names, and computes their transforms.
#include "runtime/load/level_nodes.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/allowance.h"
#include "runtime/load/level_names.h"

#include <algorithm>
#include <map>

namespace prt {
namespace {

constexpr const char* kLodExtension = "MSFT_lod";

/// A node and its coarser levels, finest first.
struct FoundLevels {
    int node;
    bool by_name;
    std::vector<int> coarser;
};

class LevelFinder {
public:
    LevelFinder(const GltfData& data, const NodeTree& tree)
        : data_(data), model_(data.model), tree_(tree), first_(model_.nodes.size(), 0),
          last_(model_.nodes.size(), 0), is_listed_(model_.nodes.size(), false),
          level_of_(model_.nodes.size(), -1) {
        number_nodes();
    }

    std::vector<FoundLevels> find() {
        find_listed();
        find_named();
        return std::move(found_);
    }
    std::vector<std::string> take_notices() { return std::move(notices_); }

private:
    static std::size_t at(int node) { return static_cast<std::size_t>(node); }

    void find_listed() {
        std::vector<FoundLevels> listed;
        for (std::size_t n = 0; n < model_.nodes.size(); ++n)
            if (const Json* extension = extension_of(data_.json["nodes"][n], kLodExtension))
                listed.push_back({static_cast<int>(n), false, ids_of(static_cast<int>(n), *extension)});
        for (const FoundLevels& levels : listed)
            for (const int level : levels.coarser)
                check_listed(levels.node, level);
        for (const FoundLevels& levels : listed)
            if (level_of_[at(levels.node)] >= 0)
                throw Error(node_name(model_, levels.node) + " is a level of detail of node " +
                            std::to_string(level_of_[at(levels.node)]) +
                            " and cannot have levels of detail itself");
        for (FoundLevels& levels : listed)
            if (first_[at(levels.node)] > 0 && !levels.coarser.empty()) {
                is_listed_[at(levels.node)] = true;
                found_.push_back(std::move(levels));
            }
    }

    /// Numbers the nodes of the scene: those below a node have numbers between its first and its last.
    void number_nodes() {
        std::vector<std::size_t> sizes(model_.nodes.size(), 1);
        for (auto position = tree_.order.rbegin(); position != tree_.order.rend(); ++position)
            if (position->parent >= 0)
                sizes[at(position->parent)] += sizes[at(position->node)];
        std::vector<std::size_t> next(model_.nodes.size(), 0);
        std::size_t root = 1;
        for (const NodeTree::Entry& position : tree_.order) {
            std::size_t& first = position.parent < 0 ? root : next[at(position.parent)];
            first_[at(position.node)] = first;
            next[at(position.node)] = first + 1;
            first += sizes[at(position.node)];
            last_[at(position.node)] = first - 1;
        }
    }

    /// Returns whether `node` is below `above` in the scene.
    bool is_above(int above, int node) const {
        return first_[at(above)] > 0 && first_[at(node)] > first_[at(above)] &&
               first_[at(node)] <= last_[at(above)];
    }

    std::vector<int> ids_of(int node, const Json& extension) const {
        const std::string what = std::string(kLodExtension) + " of " + node_name(model_, node);
        if (!extension.is_object() || !extension.contains("ids") || !extension["ids"].is_array())
            throw Error(what + " has no list of ids");
        std::vector<int> ids;
        for (const Json& id : extension["ids"]) {
            if (!id.is_number_unsigned() || id.get<std::uint64_t>() >= model_.nodes.size())
                throw Error(what + " refers to node " +
                            id.dump(-1, ' ', true, Json::error_handler_t::replace) +
                            ", which does not exist");
            ids.push_back(id.get<int>());
        }
        return ids;
    }

    void check_listed(int node, int level) {
        const std::string what = node_name(model_, level) + " is a level of detail of node ";
        if (level_of_[at(level)] >= 0)
            throw Error(what + std::to_string(level_of_[at(level)]) +
                        (level_of_[at(level)] == node ? " twice" : " and of node " + std::to_string(node)) +
                        "; each level needs a separate node, but nodes can share a mesh");
        if (node == level || is_above(level, node))
            throw Error(what + std::to_string(node) +
                        (level == node ? ", which is the same node" : ", which is one of its descendants"));
        level_of_[at(level)] = node;
    }

    /// Siblings, grouped by names that make them levels of one object: [level][copies].
    using Named = std::map<std::pair<int, std::string>, std::map<int, std::vector<int>>>;

    void find_named() {
        Named named;
        for (const NodeTree::Entry& position : tree_.order)
            if (const auto name = level_name(model_.nodes[at(position.node)].name))
                named[{position.parent, name->stem}][name->level].push_back(position.node);
        std::vector<FoundLevels> pairs;
        for (const auto& [key, levels] : named)
            add_named(levels, pairs);
        std::ranges::sort(pairs, {}, &FoundLevels::node);
        std::ranges::move(pairs, std::back_inserter(found_));
    }

    void add_named(const std::map<int, std::vector<int>>& levels, std::vector<FoundLevels>& pairs) {
        if (!levels.contains(0) || levels.size() < 2 || says_more(levels))
            return;
        const std::vector<int>& finest = levels.at(0);
        for (const auto& [level, nodes] : levels)
            if (nodes.size() != finest.size()) {
                notices_.push_back("the node names give different numbers of levels of detail for " +
                                   node_name(model_, finest.front()) + " and " +
                                   node_name(model_, nodes.front()) + "; they are not read as levels");
                return;
            }
        for (std::size_t i = 0; i < finest.size(); ++i) {
            FoundLevels copy{finest[i], true, {}};
            for (auto level = std::next(levels.begin()); level != levels.end(); ++level) {
                copy.coarser.push_back(level->second[i]);
                level_of_[at(level->second[i])] = finest[i];
            }
            pairs.push_back(std::move(copy));
        }
    }

    /// Returns whether MSFT_lod already covers one of the nodes.
    bool says_more(const std::map<int, std::vector<int>>& levels) const {
        return std::ranges::any_of(levels, [&](const auto& level) {
            return std::ranges::any_of(
                level.second, [&](int node) { return level_of_[at(node)] >= 0 || is_listed_[at(node)]; });
        });
    }

    const GltfData& data_;
    const GltfModel& model_;
    const NodeTree& tree_;
    std::vector<std::size_t> first_, last_; ///< [nodes] 0: not in the scene
    std::vector<bool> is_listed_;           ///< [nodes] has levels of MSFT_lod
    std::vector<int> level_of_;             ///< -1: not a level
    std::vector<FoundLevels> found_;
    std::vector<std::string> notices_;
};

/// Traverses the descendants of nodes, inside and outside the scene.
class LevelPlacer {
public:
    LevelPlacer(const GltfData& data, const NodeTree& tree, std::span<const FoundLevels> found)
        : data_(data), model_(data.model), tree_(tree), coarser_(model_.nodes.size(), false),
          seen_(model_.nodes.size(), false), parent_(model_.nodes.size(), -1) {
        for (const FoundLevels& levels : found)
            for (const int level : levels.coarser)
                coarser_[at(level)] = true;
        result_.world.assign(model_.nodes.size(), glm::dmat4(1));
        for (const NodeTree::Entry& position : tree.order)
            parent_[at(position.node)] = position.parent, seen_[at(position.node)] = true;
    }

    LevelNodes place(std::span<const FoundLevels> found) {
        std::vector<NodeTransform> all = world_transforms(model_);
        std::vector<bool> left_out(model_.nodes.size(), false), visible = left_out, in_scene = left_out;
        for (const NodeTransform& node : all) {
            const std::size_t n = at(node.node);
            result_.world[n] = node.world;
            in_scene[n] = true;
            visible[n] = node.visible;
            left_out[n] = coarser_[n] || (parent_[n] >= 0 && left_out[at(parent_[n])]);
            result_.left_out += coarser_[n] ? 1 : 0;
            if (!left_out[n])
                result_.finest.push_back(node);
        }
        double bytes = 0;
        for (const FoundLevels& levels : found) {
            if (left_out[at(levels.node)] || !visible[at(levels.node)])
                continue;
            NodeLevels placed{levels.node, levels.by_name, {}, {}};
            for (const NodeTransform& node : below(levels.node, true))
                placed.finest.push_back(node.node);
            // Nested nodes with levels list their descendants repeatedly.
            bytes += static_cast<double>(placed.finest.size() * sizeof(int));
            check_allowed(bytes, data_.file_bytes, "the nodes of its levels of detail");
            for (const int level : levels.coarser) {
                if (!in_scene[at(level)])
                    parent_[at(level)] = parent_[at(levels.node)];
                placed.coarser.push_back(
                    {static_cast<int>(placed.coarser.size()) + 1, level, below(level, in_scene[at(level)])});
            }
            result_.levels.push_back(std::move(placed));
        }
        return std::move(result_);
    }

private:
    static std::size_t at(int node) { return static_cast<std::size_t>(node); }

    /// Returns `root`, which is visible, and its descendants except coarser levels. Transforms of nodes in
    /// the scene are known already.
    std::vector<NodeTransform> below(int root, bool in_scene) {
        std::vector<NodeTransform> nodes = {{root, {}, true}};
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const int node = nodes[i].node;
            if (!in_scene)
                position_out_of_scene(node);
            nodes[i].world = result_.world[at(node)];
            const bool visible = nodes[i].visible;
            for (const int child : model_.nodes[at(node)].children) {
                if (child < 0 || at(child) >= model_.nodes.size())
                    throw Error("node " + std::to_string(child) + " does not exist");
                if (child == root)
                    throw Error("node " + std::to_string(child) + " has two parents or is its own ancestor");
                if (coarser_[at(child)])
                    continue;
                if (!in_scene)
                    parent_[at(child)] = node;
                nodes.push_back({child, {}, visible && model_.nodes[at(child)].visible});
            }
        }
        return nodes;
    }

    void position_out_of_scene(int node) {
        if (seen_[at(node)])
            throw Error("node " + std::to_string(node) + " has two parents or is its own ancestor");
        seen_[at(node)] = true;
        const int parent = parent_[at(node)];
        result_.outside.push_back({node, parent});
        const glm::dmat4 local = tree_.poses[at(node)].transform();
        result_.world[at(node)] = parent < 0 ? local : result_.world[at(parent)] * local;
    }

    const GltfData& data_;
    const GltfModel& model_;
    const NodeTree& tree_;
    std::vector<bool> coarser_, seen_; ///< [nodes]; seen: has a transform
    std::vector<int> parent_;          ///< [nodes]
    LevelNodes result_;
};

} // namespace

std::string node_name(const GltfModel& model, int node) {
    const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
    return "node " + std::to_string(node) + (name.empty() ? "" : " '" + printable(name) + "'");
}

LevelNodes level_nodes(const GltfData& data) {
    const NodeTree tree = node_tree(data.model);
    LevelFinder finder(data, tree);
    const std::vector<FoundLevels> found = finder.find();
    LevelNodes nodes = LevelPlacer(data, tree, found).place(found);
    nodes.notices = finder.take_notices();
    return nodes;
}

} // namespace prt
