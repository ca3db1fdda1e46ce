#pragma once

// Dense meshes as translucent voxels (docs/math.md, section 24).

#include "far/cell_grid.h"
#include "far/dense_parts.h"
#include "prt/trace_scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// What a voxel stops of a ray of unit direction w: 1 - exp(-extinction(w) length), by bands 0 and 2 of
/// spherical harmonics. Band 1 is zero, as surfaces stop a ray and the same ray backwards alike.
struct Extinction {
    glm::vec3 squares{0};  ///< of x², y², z²
    glm::vec3 products{0}; ///< of yz, zx, xy

    float along(const glm::vec3& w) const {
        return glm::dot(squares, w * w) + glm::dot(products, glm::vec3(w.y * w.z, w.z * w.x, w.x * w.y));
    }
    void scale(float by) {
        squares *= by;
        products *= by;
    }
    /// Adds small flat pieces, much smaller than a voxel of side 1, of `area` over its side's square.
    void add(const glm::vec3& normal, float area);
};

/// A place of a surface in a voxel that a ray met there.
struct VoxelHit {
    std::uint32_t triangle = 0; ///< in the order of the scene's primitives and their triangles
    glm::vec2 uv{0};            ///< barycentric coordinates of corners 1 and 2
    bool back = false;
    glm::vec3 direction{0}; ///< of that ray
};

/// Immutable, thread-safe.
class BlockerVolume {
public:
    /// Voxels of side `size` that stop as much light as the surfaces of `dense` in them do, by rays in
    /// `scene`. Empty where nothing is dense.
    BlockerVolume(const TraceScene& scene, const DenseParts& dense, float size);

    std::size_t voxels() const { return grid_.cells(); }
    std::size_t bytes() const;

    /// What is left of a ray of unit direction on the way [from, to].
    float passes(const glm::vec3& origin, const glm::vec3& direction, float from, float to) const;

    struct Met {
        VoxelHit hit;
        float distance;
    };
    /// Where a ray of which `stopped` > 0 ends on the way; `random` is uniform in 0..1.
    Met end_of(const glm::vec3& origin, const glm::vec3& direction, float from, float stopped,
               float random) const;

private:
    static constexpr int kHits = 16; ///< that a voxel keeps
    void add_pieces(const TraceScene& scene, const DenseParts& dense);
    void fit(const TraceScene& scene, const DenseParts& dense, std::uint32_t cell);
    /// What makes lines through whole nodes pass as often as they do by triangles; all voxels take it.
    float fit_nodes(const TraceScene& scene, const DenseParts& dense) const;
    float depth(const glm::vec3& origin, const glm::vec3& direction, float from, float to, float most) const;
    const VoxelHit& choose(std::uint32_t cell, const glm::vec3& direction, float random) const;

    CellGrid grid_;
    std::vector<Extinction> extinctions_; ///< [cells] over a side
    std::vector<VoxelHit> hits_;          ///< [cells][kHits]
    std::vector<std::uint8_t> kept_;      ///< [cells] how many
};

} // namespace prt
