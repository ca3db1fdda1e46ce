#pragma once

// The work of a game for instances that share transfer, when the lighting changes: constants of their own for
// all instances, which the shader of their mesh reads instead of those of the model
// (shaders/prt_instances.glsl).
//
//     InstanceFormer former(transfer, instances); // once; `former.table()` into instance attributes
//     std::vector<glm::vec4> constants(former.size());
//     former.form(lighting, constants); // when the lighting changes
//
// Constants of an instance are linear in the place within the box of its mesh, so that a row takes three
// vectors instead of one, and a vertex as many weights as any. Experimental.

#include "prt/constant_former.h"
#include "prt/instances.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Rows of the constants of compressed transfer, of the clusters that a mesh has.
struct ConstantRows {
    std::uint32_t first = 0, count = 0;
};
/// From the lowest to the highest that receivers [first, first + count) read.
ConstantRows rows_of(const ClusteredTransfer& transfer, std::size_t first, std::size_t count);
/// From the lowest to the highest of both.
ConstantRows joined(const ConstantRows& a, const ConstantRows& b);

/// An instance, and the rows that its mesh reads.
struct FormedInstance {
    PlacedInstance placed;
    ConstantRows rows;
};

/// Immutable, thread-safe.
class InstanceFormer {
public:
    /// `yaws`: turns about +Y in which the lighting is formed, to the nearest of which upright instances are
    /// rounded; 0: every one in its own. Throws `Error` for transfer of lamps or of several outputs, and for
    /// constants that take more than 4 GB.
    InstanceFormer(const ClusteredTransfer& transfer, std::span<const FormedInstance> instances,
                   int yaws = 64);

    /// Vectors of the constants of all instances, three for each row.
    std::size_t size() const { return size_; }
    /// Most degrees by which an instance's lighting is turned off.
    double most_degrees() const { return turns_.most_degrees; }
    /// Attributes of each instance, [instances][2]: the middle of its box, one over the half widths; in w
    /// where its constants begin, 16 bits in each.
    std::vector<glm::vec4> table() const;
    /// Writes the constants of all instances, [size()]. Throws `Error` for lamps, and where the lighting has
    /// fewer bands than the transfer.
    void form(const Lighting& lighting, std::span<glm::vec4> constants, int threads = 0) const;

private:
    ConstantFormer former_;
    InstanceModes modes_;
    InstanceTurns turns_;
    std::vector<FormedInstance> instances_;
    std::vector<std::size_t> begins_;            ///< [instances] of their constants
    std::vector<std::vector<std::uint32_t>> of_; ///< [turns] instances
    std::size_t size_ = 0;
};

} // namespace prt
