#pragma once

#include "gltf/contents.h"
#include "prt/refinement.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace prt {

/// How a value in the middle of an edge comes from those at its ends.
enum class MidpointRule {
    mean,       ///< in the type of the accessor
    float_mean, ///< as float32, where rounding would tear what touches
    unit,       ///< the mean, made unit; a fourth component (which way a bitangent points) is the first end's
    first,      ///< that of the first end
};

/// The rule of an attribute of a primitive. `target`: of a morph target, whose values are differences.
enum class AttributeOf { vertex, target };
MidpointRule midpoint_rule(const tinygltf::Model& model, std::string_view name, int accessor,
                           AttributeOf owner);

/// Adds an accessor with the elements of accessor `reference` and those of `midpoints` behind them. Returns
/// its index.
std::size_t add_midpoint_accessor(GltfContents& contents, int reference, std::span<const Midpoint> midpoints,
                                  MidpointRule rule);

} // namespace prt
