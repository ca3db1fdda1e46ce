#pragma once

// Attributes of edge midpoints.

#include "bake/gltf/contents.h"
#include "prt/gltf/refinement.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace prt {

/// Computation of a midpoint's value from the values at the ends of the edge.
enum class MidpointRule {
    mean,       ///< mean, in the type of the accessor
    float_mean, ///< mean as float32, if rounding would create gaps
    unit,       ///< normalised mean; a fourth component (bitangent sign) is that of the first end
    first,      ///< value of the first end
};

/// Owner of an attribute: a primitive, or a morph target, whose values are differences.
enum class AttributeOf { vertex, target };
MidpointRule midpoint_rule(const GltfModel& model, std::string_view name, int accessor, AttributeOf owner);

/// Adds an accessor with the elements of accessor `reference`, followed by those of `midpoints`. Returns its
/// index.
std::size_t add_midpoint_accessor(GltfContents& contents, int reference, std::span<const Midpoint> midpoints,
                                  MidpointRule rule);

} // namespace prt
