#pragma once

// Nodes of a file that follow those of another file with the same names.

#include "runtime/load/node_transforms.h"

#include <span>
#include <string>
#include <vector>

namespace prt {

/// Returns the names of all nodes of `model`, [nodes]; empty without a name.
std::vector<std::string> node_names(const GltfModel& model);

/// Returns the node of `leaders` that each node of `names` follows: the one with its name, else the one that
/// its parent follows: [names]; -1 without one, and for nodes that are not in `order`. `order`: nodes of
/// `names`, parents before children. `leaders`, `names`: names of the nodes of both files. Throws `Error` if
/// several nodes of `leaders` have the name of a node in `order`.
std::vector<int> followed_nodes(std::span<const std::string> leaders, std::span<const std::string> names,
                                std::span<const NodeTree::Entry> order);

} // namespace prt
