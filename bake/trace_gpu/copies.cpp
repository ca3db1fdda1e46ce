// Finds copies by the mesh index of the file, and their transforms from three vertices; the transform is
// verified at all vertices.

#include "bake/trace_gpu/copies.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <tuple>

namespace prt {
namespace {

/// Maximum distance of a vertex from its transformed position, relative to the largest coordinate of the
/// copy. Rounding of the positions is half a unit of this, and less for the first copy, which is nearest to
/// the origin; a ray starts sixteen units off its surface.
constexpr double kTolerance = 4 * static_cast<double>(std::numeric_limits<float>::epsilon());
/// Maximum difference of scales between axes: rounding of short sides causes such differences.
constexpr double kUneven = 1e-3;

/// Three vertices far from each other; they determine the transform even of a flat shape.
using Frame = std::array<std::size_t, 3>;

std::optional<Frame> frame_of(std::span<const glm::vec3> positions) {
    const auto farthest = [&](auto&& distance) {
        return static_cast<std::size_t>(std::ranges::max_element(positions, {}, distance) -
                                        positions.begin());
    };
    if (positions.size() < 3)
        return std::nullopt;
    const glm::dvec3 any(positions[0]);
    const std::size_t a = farthest([&](const glm::vec3& p) { return glm::distance(glm::dvec3(p), any); });
    const glm::dvec3 first(positions[a]);
    const std::size_t b = farthest([&](const glm::vec3& p) { return glm::distance(glm::dvec3(p), first); });
    const glm::dvec3 side = glm::dvec3(positions[b]) - first;
    const auto off_side = [&](const glm::vec3& p) {
        return glm::length(glm::cross(side, glm::dvec3(p) - first));
    };
    const std::size_t c = farthest(off_side);
    if (!(off_side(positions[c]) > 1e-3 * glm::dot(side, side))) // collinear, or nearly
        return std::nullopt;
    return Frame{a, b, c};
}

/// Returns two sides of the frame, and its normal scaled to about their length.
glm::dmat3 axes_of(std::span<const glm::vec3> positions, const Frame& frame) {
    const glm::dvec3 a(positions[frame[0]]), ab = glm::dvec3(positions[frame[1]]) - a,
                                             ac = glm::dvec3(positions[frame[2]]) - a,
                                             normal = glm::cross(ab, ac);
    return {ab, ac, normal / std::sqrt(glm::length(normal))};
}

double largest_coordinate_of(std::span<const glm::vec3> positions) {
    double largest = 0;
    for (const glm::vec3& p : positions)
        largest = std::max({largest, std::abs(static_cast<double>(p.x)), std::abs(static_cast<double>(p.y)),
                            std::abs(static_cast<double>(p.z))});
    return largest;
}

/// Whether the matrix is a rotation with a uniform scale, without reflection.
bool is_even(const glm::dmat3& rotation) {
    const double volume = glm::determinant(rotation);
    if (!(volume > 0))
        return false;
    const glm::dmat3 unit = rotation / std::cbrt(volume);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(glm::dot(unit[i], unit[j]) - (i == j ? 1 : 0)) > kUneven)
                return false;
    return true;
}

std::optional<glm::mat4x3> motion(std::span<const glm::vec3> from, std::span<const glm::vec3> to,
                                  const Frame& frame) {
    const glm::dmat3 rotation = axes_of(to, frame) * glm::inverse(axes_of(from, frame));
    if (!is_even(rotation))
        return std::nullopt;
    const glm::dvec3 shift = glm::dvec3(to[frame[0]]) - rotation * glm::dvec3(from[frame[0]]);
    // Rounded to the precision on the device.
    const glm::mat4x3 transform{glm::vec3(rotation[0]), glm::vec3(rotation[1]), glm::vec3(rotation[2]),
                                glm::vec3(shift)};
    const glm::dmat4x3 rounded(transform);
    const double most = kTolerance * largest_coordinate_of(to);
    for (std::size_t v = 0; v < from.size(); ++v)
        if (!(glm::distance(rounded * glm::dvec4(glm::dvec3(from[v]), 1), glm::dvec3(to[v])) <= most))
            return std::nullopt;
    return transform;
}

} // namespace

std::vector<std::vector<CopiedPrimitive>> find_copies(const Scene& scene) {
    std::map<std::tuple<int, int, std::size_t, bool>, std::vector<std::uint32_t>> alike;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        alike[{primitive.mesh, primitive.primitive, primitive.material, primitive.mirrored}].push_back(p);
    }
    std::vector<std::vector<CopiedPrimitive>> meshes;
    const auto reach = [&](std::uint32_t p) {
        return largest_coordinate_of(scene.vertex_arrays[scene.primitives[p].vertices].positions);
    };
    for (auto& [key, members] : alike) {
        std::iter_swap(members.begin(), std::ranges::min_element(members, {}, reach));
        const Primitive& first = scene.primitives[members.front()];
        const std::span<const glm::vec3> positions = scene.vertex_arrays[first.vertices].positions;
        const std::optional<Frame> frame = members.size() > 1 ? frame_of(positions) : std::nullopt;
        if (!frame)
            continue;
        std::vector<CopiedPrimitive> copies{{members.front(), glm::mat4x3(1)}};
        for (const std::uint32_t p : std::span(members).subspan(1)) {
            const Primitive& other = scene.primitives[p];
            const std::span<const glm::vec3> there = scene.vertex_arrays[other.vertices].positions;
            if (there.size() != positions.size() || other.triangles != first.triangles)
                continue;
            if (const std::optional<glm::mat4x3> transform = motion(positions, there, *frame))
                copies.push_back({p, *transform});
        }
        if (copies.size() > 1)
            meshes.push_back(std::move(copies));
    }
    return meshes;
}

} // namespace prt
