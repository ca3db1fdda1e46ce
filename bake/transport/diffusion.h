#pragma once

// Subsurface scattering as a hierarchical linear operator on transfer: H. W. Jensen, J. Buhler, "A Rapid
// Hierarchical Rendering Technique for Translucent Materials", SIGGRAPH 2002. Cost grows as n log n.

#include "bake/scene/receivers.h"
#include "prt/bake/bake_options.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Operator for the surface of one body of one medium: X'(p) = ∫ K(|p - q|) X(q) dA(q). X is linear over each
/// triangle, and K is the dipole's Rd divided by its integral. The body's own reflectance, which is its
/// albedo, is therefore excluded, as everywhere in transfer.
class DiffusionOperator {
public:
    /// Keeps a reference to `receivers`. `triangles`: triangles of the body, as receivers. `tolerance`:
    /// triangles are merged if the square of their extent is below this share of the square of their
    /// distance.
    DiffusionOperator(const Receivers& receivers, std::vector<glm::uvec3> triangles, const Medium& medium,
                      double tolerance = 0.2);

    /// Replaces the values of the body's receivers; [receivers][channels][order²]. A single channel uses the
    /// red kernel.
    void apply(int channels, int order, std::span<float> values, int threads) const;

    /// Returns X' at `positions` on the body, [positions][channels][order²], from X at the receivers,
    /// [receivers][channels][order²].
    std::vector<float> at(std::span<const glm::dvec3> positions, int channels, int order,
                          std::span<const float> values, int threads) const;

    /// Receivers of the body in ascending order.
    std::span<const std::uint32_t> members() const { return members_; }

    /// Whether red, green and blue spread equally.
    bool is_grey() const;

private:
    struct Node {
        glm::dvec3 low, high, center; ///< bounding box of the corners, and mean position
        double area = 0;
        std::uint32_t begin = 0, end = 0; ///< range of triangles
        std::uint32_t right = 0;          ///< the left child is the next node; 0: a leaf with one triangle
    };
    /// Integrals of K times the linear function that is 1 at one corner, [channels][corner].
    using CornerWeights = std::array<glm::dvec3, 3>;
    class Gatherer;

    void tabulate_kernel();
    /// K for red, green and blue.
    glm::vec3 kernel(double squared_distance) const;

    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    glm::dvec3 position(std::uint32_t receiver) const { return glm::dvec3(receivers_.positions[receiver]); }

    const Receivers& receivers_;
    std::vector<glm::uvec3> triangles_; ///< in the order of the tree
    std::vector<std::uint32_t> members_;
    std::array<Dipole, 3> dipoles_;
    double tolerance_;
    double scale_;          ///< minimum depth of a dipole, the scale on which K varies, m
    double reach_;          ///< distance beyond which light is negligible, m
    double max_extent_ = 0; ///< maximum squared extent of merged triangles, m²
    /// K at evenly spaced logarithms of 1 + r²/scale², which are densest where the curvature of K is large;
    /// avoids slow exponentials.
    std::vector<glm::vec3> kernel_;
    double kernel_steps_ = 0; ///< steps per unit of the logarithm
    std::vector<Node> nodes_;
};

} // namespace prt
