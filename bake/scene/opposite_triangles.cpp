// Finds pairs of opposite triangles by a hash of their corner positions.

#include "bake/scene/opposite_triangles.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace prt {
namespace {

struct SingleSidedFace {
    std::uint64_t hash; ///< hash of the vertex array and of the corner positions in any order
    std::uint32_t triangle;
    std::uint32_t primitive;
    glm::uvec3 corners; ///< into the vertex array
};

/// Finalizer of MurmurHash3 (A. Appleby).
std::uint64_t mixed(std::uint64_t h) {
    h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
    h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return h ^ (h >> 33);
}

std::uint64_t position_hash(const glm::vec3& at) {
    const glm::vec3 p = at + 0.0f; // no negative zeros
    return mixed(
        (std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32 | std::bit_cast<std::uint32_t>(p.y)) +
        mixed(std::bit_cast<std::uint32_t>(p.z)));
}

bool shows_one_side(const Material& material) {
    return !material.double_sided && material.casts_shadow;
}

std::vector<SingleSidedFace> single_sided_faces(const Scene& scene) {
    std::vector<SingleSidedFace> faces;
    std::uint32_t first = 0;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        const std::vector<glm::vec3>& at = scene.vertex_arrays[primitive.vertices].positions;
        if (shows_one_side(scene.materials[primitive.material]))
            for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t) {
                const glm::uvec3& c = primitive.triangles[t];
                if (at[c.x] == at[c.y] || at[c.y] == at[c.z] || at[c.z] == at[c.x])
                    continue; // no area
                faces.push_back({position_hash(at[c.x]) + position_hash(at[c.y]) + position_hash(at[c.z]) +
                                     mixed(primitive.vertices),
                                 first + t, p, c});
            }
        first += static_cast<std::uint32_t>(primitive.triangles.size());
    }
    std::ranges::sort(faces, [](const SingleSidedFace& a, const SingleSidedFace& b) {
        return a.hash != b.hash ? a.hash < b.hash : a.triangle < b.triangle;
    });
    return faces;
}

/// Returns the corner of `a` at each corner of `b`; nothing if the triangles are not opposite.
std::optional<std::array<std::uint8_t, 3>> opposite_corners(const std::vector<glm::vec3>& at,
                                                            const glm::uvec3& a, const glm::uvec3& b) {
    for (int start = 0; start < 3; ++start) {
        const std::array corners{static_cast<std::uint8_t>(start), static_cast<std::uint8_t>((start + 2) % 3),
                                 static_cast<std::uint8_t>((start + 1) % 3)};
        if (at[a[corners[0]]] == at[b.x] && at[a[corners[1]]] == at[b.y] && at[a[corners[2]]] == at[b.z])
            return corners;
    }
    return std::nullopt;
}

} // namespace

OppositeTriangles::OppositeTriangles(const Scene& scene) {
    std::vector<SingleSidedFace> faces = single_sided_faces(scene);
    for (auto begin = faces.begin(), end = begin; begin != faces.end(); begin = end) {
        end = std::find_if(begin, faces.end(),
                           [&](const SingleSidedFace& face) { return face.hash != begin->hash; });
        const std::vector<glm::vec3>& at =
            scene.vertex_arrays[scene.primitives[begin->primitive].vertices].positions;
        const glm::uvec3 corners = begin->corners;
        const auto rotated = std::stable_partition(begin, end, [&](const SingleSidedFace& face) {
            return !opposite_corners(at, corners, face.corners);
        });
        const std::span<const SingleSidedFace> these(begin, rotated), those(rotated, end);
        if (!those.empty())
            of_.resize(scene.triangles());
        for (std::size_t i = 0; i < those.size(); ++i)
            if (const SingleSidedFace& kept = these[std::min(i, these.size() - 1)];
                kept.primitive == those[i].primitive)
                of_[those[i].triangle].traced = kept.triangle;
        const auto set = [&](std::span<const SingleSidedFace> from, std::span<const SingleSidedFace> to) {
            for (std::size_t i = 0; i < from.size() && !to.empty(); ++i) {
                const SingleSidedFace& other =
                    to[std::min(i, to.size() - 1)]; // the last triangle serves all that are left
                if (const auto of_from = opposite_corners(at, from[i].corners, other.corners)) {
                    of_[from[i].triangle].triangle = other.triangle;
                    of_[from[i].triangle].corners = *of_from;
                }
            }
        };
        set(these, those);
        set(those, these);
    }
}

bool OppositeTriangles::move_to_front(unsigned& triangle, glm::vec2& uv) const {
    if (of_.empty() || of_[triangle].triangle == kNone)
        return false;
    const Opposite& opposite = of_[triangle];
    const glm::vec3 barycentrics(1 - uv.x - uv.y, uv.x, uv.y);
    triangle = opposite.triangle;
    uv = {barycentrics[opposite.corners[1]], barycentrics[opposite.corners[2]]};
    return true;
}

Hit OppositeTriangles::shown(Hit hit) const {
    glm::vec2 uv(hit.u, hit.v);
    if (hit.back && move_to_front(hit.triangle, uv)) {
        hit.u = uv.x;
        hit.v = uv.y;
        hit.back = false;
    }
    return hit;
}

} // namespace prt
