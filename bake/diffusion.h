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

/// Receivers round one body of one medium: X'(p) = sum_i area_i K(|p - i|) X(i), where K is the dipole's Rd
/// over its integral. The body's own reflectance, which is its albedo, is so left out, as everywhere in
/// transfer.
class DiffusionOperator {
public:
    /// `members`: the receivers on the body. `tolerance`: a group of receivers stands as one where the solid
    /// angle under which it is seen is below this.
    DiffusionOperator(const Receivers& receivers, std::vector<std::uint32_t> members, const Medium& medium,
                      double tolerance = 0.1);

    /// Replaces the values of the members; [receivers][channels][order²]. With one channel the red kernel serves.
    void apply(int channels, int coefficients, std::span<float> values, int threads) const;

    /// Red, green and blue spread alike.
    bool is_grey() const;

private:
    struct Node {
        glm::dvec3 low, high, centre; ///< box of the positions, and their mean weighted by area
        double area = 0;
        std::uint32_t begin = 0, end = 0; ///< members
        std::uint32_t right = 0;          ///< the left child follows; 0: a leaf
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    void gather(const glm::dvec3& position, int channels, int coefficients, std::span<const float> means,
                std::span<double> sums) const;

    const Receivers& receivers_;
    std::vector<std::uint32_t> members_; ///< in the order of the tree
    std::array<Dipole, 3> dipoles_;
    double tolerance_;
    std::vector<Node> nodes_;
};

} // namespace prt
