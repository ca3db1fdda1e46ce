#pragma once

// Points spread over the surfaces of a scene, where light is measured instead of at vertices.

#include "prt/trace_scene.h"
#include "transport/transport_receivers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

/// Where a sample lies: shares of the corners of a triangle, of one side of it.
struct SamplePlace {
    std::uint32_t triangle; ///< in the order of the scene's primitives and their triangles
    bool back;              ///< of the triangle
    glm::vec2 uv;           ///< barycentric coordinates of corners 1 and 2

    std::array<float, 3> shares() const { return {1 - uv.x - uv.y, uv.x, uv.y}; }
};

/// Samples are receivers of their own: their areas are what they stand for. Arrays are parallel. Each
/// `layers` that follow one another lie close together and share the net of one receiver's rays: sample
/// g layers + k is receiver g of layer k.
struct SurfaceSamples {
    Receivers receivers;
    std::vector<SamplePlace> places;
    std::size_t layers = 1;

    std::size_t size() const { return places.size(); }
    Receivers layer(std::size_t k) const;
};

/// The receivers at the corners of a triangle on one side; kNoReceiver where a corner has no normal and
/// stays dark.
glm::uvec3 corner_receivers(const Surfaces& surfaces, const TransportReceivers& receivers,
                            std::uint32_t triangle, bool back);

/// The vector at `place`, interpolated between those of `corners`, which are all there.
std::vector<float> interpolated(const Transfer& transfer, const glm::uvec3& corners,
                                const SamplePlace& place);

/// One side of a triangle that receivers are on.
struct TriangleSide {
    std::uint32_t triangle;
    bool back;
    double area;
};
std::vector<TriangleSide> triangle_sides(const Surfaces& surfaces, const TransportReceivers& receivers,
                                         bool backs);

/// For `even_point`, another for each side and seed.
std::uint32_t side_hash(const TriangleSide& side, std::uint64_t seed);

/// Barycentric coordinates of the i-th of points that are even over a triangle however many there are: the
/// sequence R2 of M. Roberts, 2018, folded. `hash` moves it.
glm::vec2 even_point(std::uint32_t hash, std::size_t i);

/// Appends a sample at `place`, on a triangle with an area, that stands for `area`.
void append_sample(SurfaceSamples& samples, const Surfaces& surfaces, const TransportReceivers& receivers,
                   const SamplePlace& place, float area);

/// How samples are spread.
struct SampleSpread {
    std::size_t count = 0; ///< about so many
    std::size_t layers = 1;
    std::uint64_t seed = 0;
};

/// At least one sample on every side of every triangle that `receivers` are on, the others by area,
/// even within each triangle.
SurfaceSamples sample_surfaces(const Surfaces& surfaces, const TransportReceivers& receivers,
                               const SampleSpread& spread);

} // namespace prt
