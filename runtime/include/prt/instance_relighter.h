#pragma once

// The work of a game for instances with shared transfer when the lighting changes: computes separate
// constants for each instance. The shader of the mesh reads the constants of the instance instead of those of
// the model (shaders/prt_instances.glsl).
//
//     InstanceRelighter relighter(transfer, instances); // once; `relighter.table()` into instance attributes
//     std::vector<glm::vec4> constants(relighter.size());
//     relighter.update(lighting, constants); // when the lighting changes
//
// A row is a mean, predictor row or direction of a cluster. Its constant is a color. For an instance the
// color is a linear function of the position within the box of the mesh, so that a row takes three vectors
// (red, green, blue) instead of one. The number of weights per vertex does not change. Experimental.

#include "prt/cluster_lighting.h"
#include "prt/instances.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Range of consecutive rows in the constants of compressed transfer, such as the rows that a mesh reads.
struct ConstantRows {
    std::uint32_t first = 0, ///< index of the first row
        count = 0;           ///< number of rows; 0: empty range
};
/// Returns the smallest range that contains all rows of the clusters of receivers [first, first + count). It
/// also contains the rows of all clusters with indices between these. Returns an empty range if `count` is 0.
ConstantRows rows_of(const ClusteredTransfer& transfer, std::size_t first, std::size_t count);
/// Returns the smallest range that contains `a` and `b`. If one of them is empty, returns the other.
ConstantRows joined(const ConstantRows& a, const ConstantRows& b);

/// An instance, and the rows that its mesh reads.
struct RelitInstance {
    PlacedInstance placed; ///< factors, rotation and box
    ConstantRows rows;     ///< the union by `joined` of `rows_of` over the vertices of the mesh
};

/// Computes constants for instances. Immutable, thread-safe.
class InstanceRelighter {
public:
    /// Copies the required data; keeps no references. `transfer` contains all meshes of the instances. For an
    /// instance that is rotated only about +Y, the lighting is rotated by the nearest multiple of 360 / yaws
    /// degrees: all these instances together need at most `yaws` rotated lightings. For all other instances,
    /// and for all instances if `yaws` is 0, the error of the rotation is at most 0.01 degrees
    /// (`instance_rotations`). Throws `Error` if the layout of `transfer` is invalid (`check_layout`), if
    /// `transfer` has lamps or several outputs, or if the constants exceed 4 GB.
    InstanceRelighter(const ClusteredTransfer& transfer, std::span<const RelitInstance> instances,
                      int yaws = 64);

    /// Returns the number of vectors in the constants of all instances together: three per row.
    std::size_t size() const { return size_; }
    /// Returns the maximum angle, over all instances, between the rotation of an instance and the rounded
    /// rotation of its lighting, in degrees.
    double max_degrees() const { return rotations_.max_degrees; }
    /// Returns two vectors per instance, [instances][2], for the attributes of the shader. xyz of the first
    /// is the center of the mesh's box, xyz of the second 1 / `InstanceBox::half` along each axis. The w
    /// components are integers in floats, 0..65535: the low 16 bits (first) and the high 16 bits (second) of
    /// a 32-bit offset. The red vector of row r of the model is at index 3 ((r + offset) mod 2^32) of the
    /// constants; green and blue follow.
    std::vector<glm::vec4> table() const;
    /// Computes the constants of all instances for `lighting`, which is in the frame of the world, and writes
    /// them to `constants` [size()]: instance by instance, row by row, then red, green, blue. The color of a
    /// row at the relative position u in the box is dot(vector, (u, 1)) for each of the three vectors. Throws
    /// `Error` if `lighting.lamps` is not empty, or if sky or suns have fewer bands than the transfer. Throws
    /// the errors of `rotated_into` for instances whose rotation the constructor does not round. Uses
    /// `threads` threads; 0: all hardware threads.
    void update(const Lighting& lighting, std::span<glm::vec4> constants, int threads = 0) const;

private:
    ClusterLighting relighter_;
    InstanceModes modes_;
    InstanceRotations rotations_;
    std::vector<RelitInstance> instances_;
    std::vector<std::size_t> begins_; ///< [instances] index of the instance's first vector in the constants
    std::vector<std::vector<std::uint32_t>> of_; ///< [rotations] indices of the instances with each rotation
    std::size_t size_ = 0;
};

} // namespace prt
