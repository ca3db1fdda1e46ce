#pragma once

// Picks patches of surfaces that are lit by lamps, in proportion to the light that they send to a receiver.

#include "bake/plan/plan.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace prt {

/// A light tree (A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree
/// Splitting", HPG 2018) over sides of triangles that reflect light of lamps. It is split by the surface area
/// orientation heuristic, and picks by radiosity times an upper bound of the form factor without shadows.
class BrightPatches {
public:
    /// `light`: light of lamps without a bounce, as in LampLight::transfer, for the receivers of `plan`. All
    /// lamps have the same weight, independent of their brightness. Keeps a reference to `plan`.
    BrightPatches(const BakePlan& plan, const Transfer& light);

    bool empty() const { return patches_.empty(); }

    struct Receiver {
        glm::dvec3 position, normal; ///< unit normal
    };
    struct Point {
        std::uint32_t triangle;
        bool back; ///< back of the triangle
        glm::dvec3 position;
        double density; ///< probability density, per m²
    };
    /// Picks a triangle by `choice` in [0, 1), and a point on it with barycentric coordinates `uv` of corners
    /// 1 and 2, which must be uniform over a triangle. Returns nothing if no patch lights the receiver.
    std::optional<Point> pick(const Receiver& receiver, double choice, const glm::dvec2& uv) const;
    /// Density with which `pick` returns points of a side of a triangle, per m².
    double density(const Receiver& receiver, std::uint32_t triangle, bool back) const;

    /// Corners of a triangle.
    std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const;

private:
    struct Patch {
        std::uint32_t triangle;
        bool back;
        double power; ///< radiosity times area, relative to all patches
        double area;
        std::uint32_t leaf = 0; ///< index of the leaf's node
    };
    /// Cone of directions about an axis.
    struct Cone {
        glm::dvec3 axis{0};
        double cosine = 1;
    };
    struct Bounds {
        glm::dvec3 low, high;
        Cone normals;
        double power = 0;
    };
    struct Node {
        glm::dvec3 center{0}, half{0}; ///< center and half size of the box
        double radius = 0;             ///< radius of the bounding sphere
        Cone normals;
        double power = 0;
        std::uint32_t begin = 0, end = 0;    ///< range of patches
        std::uint32_t parent = 0, right = 0; ///< the left child is the next node; right = 0: a leaf
    };
    struct Split;

    void add_patches(const Transfer& light);
    Bounds bounds_of(const Patch& patch) const;
    static Cone joined(const Cone& a, const Cone& b);
    static Bounds joined(const Bounds& a, const Bounds& b);
    static double cost(const Bounds& bounds);
    std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::uint32_t parent);
    std::uint32_t split(std::uint32_t begin, std::uint32_t end, const Bounds& all);
    static double importance(const Node& node, const Receiver& receiver);
    /// Probability of picking the left child.
    double share_of_left(std::uint32_t node, const Receiver& receiver) const;

    const BakePlan& plan_;
    std::vector<Patch> patches_; ///< in the order of the tree
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> patch_of_; ///< [triangles][sides] index of the patch; kNoReceiver: none
};

} // namespace prt
