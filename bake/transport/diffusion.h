#pragma once

// Subsurface scattering as a linear operator on transfer, hierarchical: H. W. Jensen, J. Buhler, "A Rapid
// Hierarchical Rendering Technique for Translucent Materials", SIGGRAPH 2002. Cost grows as n log n.

#include "prt/receivers.h"
#include "prt/subsurface.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// The surface round one body of one medium: X'(p) = ∫ K(|p - q|) X(q) dA(q), where X is linear over each
/// triangle and K is the dipole's Rd over its integral. The body's own reflectance, which is its albedo, is
/// so left out, as everywhere in transfer.
class DiffusionOperator {
public:
    /// Keeps a reference to `receivers`. `triangles` of the body, of receivers. `tolerance`: triangles stand
    /// as one where the square of their extent is below this share of the square of their distance.
    DiffusionOperator(const Receivers& receivers, std::vector<glm::uvec3> triangles, const Medium& medium,
                      double tolerance = 0.2);

    /// Replaces the values of the body's receivers; [receivers][channels][order²]. With one channel the red
    /// kernel serves.
    void apply(int channels, int order, std::span<float> values, int threads) const;

    /// The receivers of the body, in rising order.
    std::span<const std::uint32_t> members() const { return members_; }

    /// Red, green and blue spread alike.
    bool is_grey() const;

private:
    struct Node {
        glm::dvec3 low, high, center; ///< box of the corners, and the mean position
        double area = 0;
        std::uint32_t begin = 0, end = 0; ///< triangles
        std::uint32_t right = 0;          ///< the left child follows; 0: a leaf, which is one triangle
    };
    /// Integrals of K times the linear function that is 1 at one corner, [channels][corner].
    using CornerWeights = std::array<glm::dvec3, 3>;
    class Gatherer;

    void tabulate_kernel();
    /// K of red, green and blue.
    glm::vec3 kernel(double squared_distance) const;

    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    glm::dvec3 position(std::uint32_t receiver) const { return glm::dvec3(receivers_.positions[receiver]); }

    const Receivers& receivers_;
    std::vector<glm::uvec3> triangles_; ///< in the order of the tree
    std::vector<std::uint32_t> members_;
    std::array<Dipole, 3> dipoles_;
    double tolerance_;
    double scale_;           ///< least depth of a dipole, over which K varies, m
    double reach_;           ///< beyond this there is nothing worth looking at, m
    double most_extent_ = 0; ///< squared, of what may stand as one, m²
    /// K at evenly spaced logarithms of 1 + r²/scale², which is finest where K bends; exponentials are slow.
    std::vector<glm::vec3> kernel_;
    double kernel_steps_ = 0; ///< per unit of the logarithm
    std::vector<Node> nodes_;
};

} // namespace prt
