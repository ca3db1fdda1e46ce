#pragma once

// The work of a game for instances with shared transfer when the lighting changes: computes separate
// constants for each instance. The shader of the mesh reads these instead of the constants of the model
// (shaders/prt_instances.glsl).
//
//     InstanceRelighter relighter(transfer, instances); // once; `relighter.table()` into instance attributes
//     std::vector<glm::vec4> constants(relighter.size());
//     relighter.update(lighting, constants); // when the lighting changes
//
// Constants of an instance are linear in the position within the box of its mesh. A row therefore takes three
// vectors instead of one. The number of weights per vertex does not change. Experimental.

#include "prt/cluster_lighting.h"
#include "prt/instances.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Range of rows in the constants of compressed transfer that covers the clusters of a mesh.
struct ConstantRows {
    std::uint32_t first = 0, count = 0;
};
/// Returns the range of rows that receivers [first, first + count) read.
ConstantRows rows_of(const ClusteredTransfer& transfer, std::size_t first, std::size_t count);
/// Returns the smallest range that contains `a` and `b`.
ConstantRows joined(const ConstantRows& a, const ConstantRows& b);

/// An instance, and the rows that its mesh reads.
struct RelitInstance {
    PlacedInstance placed;
    ConstantRows rows;
};

/// Computes constants for instances. Immutable, thread-safe.
class InstanceRelighter {
public:
    /// Copies the required data. `yaws`: number of equally spaced rotations about +Y; an upright instance
    /// uses the nearest one for its lighting. 0: each distinct rotation is used exactly. Throws `Error` for
    /// transfer of lamps or of several outputs, and for constants of more than 4 GB.
    InstanceRelighter(const ClusteredTransfer& transfer, std::span<const RelitInstance> instances,
                      int yaws = 64);

    /// Number of vectors in the constants of all instances: three per row.
    std::size_t size() const { return size_; }
    /// Maximum angular error of an instance's rounded rotation, in degrees.
    double max_degrees() const { return rotations_.max_degrees; }
    /// Returns the attributes of each instance, [instances][2]: in xyz the center of its box, then the
    /// inverse half widths. The offset of its constants is split: the first w is the value of its low 16
    /// bits, the second w that of its high 16 bits, both as floats.
    std::vector<glm::vec4> table() const;
    /// Computes the constants of all instances for `lighting` and writes them to `constants` [size()]. Throws
    /// `Error` for lamps, and if the lighting has fewer bands than the transfer.
    void update(const Lighting& lighting, std::span<glm::vec4> constants, int threads = 0) const;

private:
    ClusterLighting relighter_;
    InstanceModes modes_;
    InstanceRotations rotations_;
    std::vector<RelitInstance> instances_;
    std::vector<std::size_t> begins_;            ///< [instances] index of their first constant
    std::vector<std::vector<std::uint32_t>> of_; ///< [rotations] instances with each rotation
    std::size_t size_ = 0;
};

} // namespace prt
