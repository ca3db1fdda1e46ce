#pragma once

// Points spread over the surfaces of a scene, where light is measured instead of at vertices.

#include "bake/scene/trace_scene.h"
#include "bake/scene/transport_receivers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

/// Position of a sample: barycentric coordinates on one side of a triangle.
struct SamplePosition {
    std::uint32_t triangle; ///< index in the order of the scene's primitives and their triangles
    bool back;              ///< back of the triangle
    glm::vec2 uv;           ///< barycentric coordinates of corners 1 and 2

    std::array<float, 3> shares() const { return {1 - uv.x - uv.y, uv.x, uv.y}; }
};

/// Samples are receivers; their areas are the areas that they represent. Arrays are parallel. Groups of
/// `layers` consecutive samples are close to each other and share the net of one receiver's rays: sample g
/// layers + k is receiver g of layer k.
struct SurfaceSamples {
    Receivers receivers;
    std::vector<SamplePosition> positions;
    std::size_t layers = 1;

    std::size_t size() const { return positions.size(); }
    Receivers layer(std::size_t k) const;
};

/// Returns the receivers at the corners of a triangle on one side; kNoReceiver if a corner has no normal and
/// therefore stays dark.
glm::uvec3 corner_receivers(const Surfaces& surfaces, const TransportReceivers& receivers,
                            std::uint32_t triangle, bool back);

/// Interpolates the vectors of `corners` at `position`; none of them is kNoReceiver.
std::vector<float> interpolated(const Transfer& transfer, const glm::uvec3& corners,
                                const SamplePosition& position);

/// One side of a triangle with receivers.
struct TriangleSide {
    std::uint32_t triangle;
    bool back;
    double area;
};
std::vector<TriangleSide> triangle_sides(const Surfaces& surfaces, const TransportReceivers& receivers,
                                         bool backs);

/// Returns a hash for `even_point`, different for each side and seed.
std::uint32_t side_hash(const TriangleSide& side, std::uint64_t seed);

/// Returns the barycentric coordinates of the i-th point of a sequence that is uniform over a triangle for
/// any number of points: the sequence R2 of M. Roberts, 2018, folded. `hash` shifts it.
glm::vec2 even_point(std::uint32_t hash, std::size_t i);

/// Appends a sample at `position`, on a triangle with an area, that represents `area`. The sample is measured
/// on the detailed surface of `receivers`, if there is one.
void append_sample(SurfaceSamples& samples, const Surfaces& surfaces, const TransportReceivers& receivers,
                   const SamplePosition& position, float area);

/// Options of sample_surfaces.
struct SampleSpread {
    std::size_t count = 0; ///< approximate number of samples
    std::size_t layers = 1;
    std::uint64_t seed = 0;
};

/// Creates at least one sample on every side of every triangle with receivers, and the others by area, evenly
/// within each triangle.
SurfaceSamples sample_surfaces(const Surfaces& surfaces, const TransportReceivers& receivers,
                               const SampleSpread& spread);

} // namespace prt
