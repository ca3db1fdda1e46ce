// Covers the box of the volume with bricks of the coarsest level, and splits those near surfaces, down to the
// finest level.

#include "bake/products/volumes/place_bricks.h"

#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prt {
namespace {

struct PlacedTriangle {
    glm::vec3 a, b, c;
};

std::vector<PlacedTriangle> triangles_of(const Scene& scene) {
    std::vector<PlacedTriangle> triangles;
    for (const Primitive& primitive : scene.primitives) {
        const std::vector<glm::vec3>& at = scene.vertex_arrays[primitive.vertices].positions;
        for (const glm::uvec3& t : primitive.triangles)
            triangles.push_back({at[t.x], at[t.y], at[t.z]});
    }
    return triangles;
}

/// Whether the triangle intersects the box about `middle`, tested by its bounding box and plane:
/// conservative.
bool comes_into(const PlacedTriangle& t, const glm::vec3& middle, float half) {
    const glm::vec3 a = t.a - middle, b = t.b - middle, c = t.c - middle;
    if (glm::any(glm::greaterThan(glm::min(a, glm::min(b, c)), glm::vec3(half))) ||
        glm::any(glm::lessThan(glm::max(a, glm::max(b, c)), glm::vec3(-half))))
        return false;
    const glm::dvec3 normal = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
    const double reach =
        static_cast<double>(half) * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
    return std::abs(glm::dot(normal, glm::dvec3(a))) <= reach * 1.0001;
}

/// Splits the bricks of one grid.
class Placement {
public:
    /// Stops if there are more than `most` bricks.
    Placement(const Bounds& bounds, float spacing, std::size_t most) : most_(most) {
        const float side = spacing * static_cast<float>(kBrickCells);
        const glm::vec3 extent = bounds.high - bounds.low;
        grid_.spacing = spacing;
        grid_.size = glm::max(glm::ivec3(glm::ceil(extent / side - 1e-3f)), glm::ivec3(1));
        grid_.origin = bounds.low - 0.5f * (side * glm::vec3(grid_.size) - extent);
    }

    VolumeGrid place(const std::vector<PlacedTriangle>& triangles) {
        const int longest = std::max({grid_.size.x, grid_.size.y, grid_.size.z});
        int top = 0;
        while (top < kMaxBrickLevel && 1 << (top + 1) <= longest)
            ++top;
        const int step = 1 << top;
        for (int z = 0; z < grid_.size.z; z += step)
            for (int y = 0; y < grid_.size.y; y += step)
                for (int x = 0; x < grid_.size.x; x += step)
                    add({{x, y, z}, top}, triangles);
        return std::move(grid_);
    }

private:
    void add(const VolumeBrick& brick, const std::vector<PlacedTriangle>& triangles) {
        if (glm::any(glm::greaterThanEqual(brick.position, grid_.size)) || grid_.bricks.size() > most_)
            return;
        if (brick.level == 0) {
            grid_.bricks.push_back(brick);
            return;
        }
        const float half = 0.5f * grid_.spacing * static_cast<float>(kBrickCells << brick.level),
                    cell = grid_.spacing * static_cast<float>(1 << brick.level);
        const glm::vec3 middle = position_of(grid_, kBrickCells * brick.position) + half;
        std::vector<PlacedTriangle> here;
        for (const PlacedTriangle& t : triangles)
            if (comes_into(t, middle, half + 0.5f * cell))
                here.push_back(t);
        const glm::ivec3 end = brick.position + (1 << brick.level);
        if (here.empty() && !glm::any(glm::greaterThan(end, grid_.size))) {
            grid_.bricks.push_back(brick);
            return;
        }
        const int step = 1 << (brick.level - 1);
        for (int i = 0; i < 8; ++i)
            add({brick.position + step * glm::ivec3(i & 1, i >> 1 & 1, i >> 2), brick.level - 1}, here);
    }

    VolumeGrid grid_;
    std::size_t most_;
};

void check_bounds(const Bounds& bounds) {
    for (int a = 0; a < 3; ++a)
        if (!(bounds.low[a] < bounds.high[a]) || !(std::abs(bounds.low[a]) <= 1e9f) ||
            !(std::abs(bounds.high[a]) <= 1e9f))
            throw Error(
                "the bounds of the volume must be two corners, x0,y0,z0,x1,y1,z1, with x0 < x1, y0 < y1, "
                "z0 < z1, within 1e9 m");
}

void check_spacing(const Bounds& bounds, double spacing) {
    const glm::vec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    if (spacing < 64 * 0x1p-24 * static_cast<double>(std::max({far.x, far.y, far.z})))
        throw Error(
            fmt::format("a probe spacing of {:g} m is below the precision of positions so far from the "
                        "origin; use other bounds or a larger spacing",
                        spacing));
    const glm::dvec3 bricks = glm::dvec3(bounds.high - bounds.low) / (kBrickCells * spacing);
    if (std::max({bricks.x, bricks.y, bricks.z}) > kMaxBricksAlong)
        throw Error(fmt::format(
            "a probe spacing of {:g} m needs more than {} probes along a side of the volume; use smaller "
            "bounds or a larger spacing",
            spacing, kMaxBricksAlong * kBrickCells));
}

} // namespace

Bounds volume_bounds(const Scene& scene, const VolumeOptions& options) {
    if (options.bounds) {
        check_bounds(*options.bounds);
        return *options.bounds;
    }
    if (scene.triangles() == 0)
        throw Error("the scene has no triangles; set the bounds of the volume with --volume ...,bounds=");
    Bounds box = bounds(scene);
    // A flat scene gets some space above it.
    box.high = glm::max(box.high, box.low + 1e-3f * glm::length(box.high - box.low));
    check_bounds(box);
    return box;
}

VolumeGrid place_bricks(const Scene& scene, const VolumeOptions& options, std::size_t max_bricks) {
    const std::vector<PlacedTriangle> triangles = triangles_of(scene);
    const Bounds box = volume_bounds(scene, options);
    if (options.probes == 0) {
        check_spacing(box, options.spacing);
        VolumeGrid grid = Placement(box, static_cast<float>(options.spacing), max_bricks).place(triangles);
        if (grid.bricks.size() > max_bricks)
            throw Error(
                fmt::format("a probe spacing of {:g} m needs too much memory; use a larger spacing or "
                            "a lower order",
                            options.spacing));
        return grid;
    }
    const glm::dvec3 extent(box.high - box.low);
    const double longest = std::max({extent.x, extent.y, extent.z});
    double most = longest, least = longest / (kMaxBricksAlong * kBrickCells) * 1.01;
    VolumeGrid grid = Placement(box, static_cast<float>(most), options.probes).place(triangles);
    // Lower bound of the spacing: below it even a volume of coarsest bricks alone has more probes.
    least =
        std::max(least, std::cbrt(extent.x * extent.y * extent.z / static_cast<double>(options.probes)) / 16);
    for (int i = 0; i < 14; ++i) {
        const double spacing = std::sqrt(least * most);
        VolumeGrid finer = Placement(box, static_cast<float>(spacing), options.probes).place(triangles);
        const bool fits = finer.bricks.size() <= options.probes && probes_of(finer).size() <= options.probes;
        (fits ? most : least) = spacing;
        if (fits)
            grid = std::move(finer);
    }
    if (probes_of(grid).size() > options.probes)
        throw Error(fmt::format("a volume needs at least {} probes", kBrickProbes));
    return grid;
}

} // namespace prt
