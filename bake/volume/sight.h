#pragma once

// How far a place sees along the axes: the distances whose planes come nearest to what its rays met.

#include <glm/vec3.hpp>

#include <array>

namespace prt {

/// Sums over rays of distances r, no further than `most`, that make x = 1 / distance along -x, +x, -y, .. by
/// least squares: r sum_a |d_a| x_a = 1, x_a >= 0. For rays that meet one plane that is exact.
class SightSums {
public:
    explicit SightSums(float most = 1) : most_(most) {}

    /// A ray in direction `d`, as if it met nothing.
    void add_ray(const glm::vec3& d) { add(d, most_ * most_, most_); }
    /// `weight` of it met something at `distance`.
    void add_hit(const glm::vec3& d, float distance, float weight) {
        if (distance < most_)
            add(d, weight * (distance * distance - most_ * most_), weight * (distance - most_));
    }
    std::array<float, 6> distances() const;

private:
    void add(const glm::vec3& d, float square, float linear);

    float most_;
    std::array<std::array<double, 6>, 6> a_{};
    std::array<double, 6> b_{};
};

} // namespace prt
