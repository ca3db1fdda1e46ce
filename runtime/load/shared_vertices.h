#pragma once

// Primitives of a glTF file that share a vertex array.

#include "runtime/load/gltf_model.h"
#include "runtime/load/own_attributes.h"

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace prt {

/// Identifies vertex arrays by node, primitive (if it matters), attributes and morph targets. Attributes of
/// prtkit are ignored: vertices are the same before and after a file gets or loses them.
class SharedVertices {
public:
    /// Returns the array of such a primitive, and whether it is new and has index `next`.
    std::pair<std::size_t, bool> of(int node, int alone, const GltfPrimitive& file, std::size_t next) {
        GltfAttributes attributes = file.attributes;
        std::erase_if(attributes, [](const auto& a) { return is_own_attribute(a.first); });
        const auto names =
            names_.try_emplace(std::pair(std::move(attributes), file.targets), names_.size()).first;
        const auto [found, is_new] = arrays_.try_emplace(std::tuple(node, alone, names->second), next);
        return {found->second, is_new};
    }

private:
    /// Names are replaced by numbers, because they may be long and nodes numerous.
    std::map<std::pair<GltfAttributes, std::vector<GltfAttributes>>, std::size_t> names_;
    std::map<std::tuple<int, int, std::size_t>, std::size_t> arrays_;
};

} // namespace prt
