// Pairs nodes of two files by name.

#include "bake/gltf/followed_nodes.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <map>

namespace prt {

std::vector<std::string> node_names(const GltfModel& model) {
    std::vector<std::string> names;
    for (const GltfNode& node : model.nodes)
        names.push_back(node.name);
    return names;
}

std::vector<int> followed_nodes(std::span<const std::string> leaders, std::span<const std::string> names,
                                std::span<const NodeTree::Entry> order) {
    std::map<std::string, std::vector<int>> named;
    for (std::size_t node = 0; node < leaders.size(); ++node)
        if (!leaders[node].empty())
            named[leaders[node]].push_back(static_cast<int>(node));
    std::vector<int> followed(names.size(), -1);
    for (const NodeTree::Entry& entry : order) {
        const auto node = static_cast<std::size_t>(entry.node);
        if (const auto found = named.find(names[node]); found != named.end()) {
            if (found->second.size() > 1)
                throw Error("several nodes have the name '" + printable(names[node]) +
                            "', which the high-poly model follows");
            followed[node] = found->second[0];
        } else if (entry.parent >= 0) {
            followed[node] = followed[static_cast<std::size_t>(entry.parent)];
        }
    }
    return followed;
}

} // namespace prt
