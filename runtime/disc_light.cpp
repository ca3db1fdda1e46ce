#include "prt/error.h"
#include "prt/light.h"
#include "prt/sh.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <string>

namespace prt {
namespace {

using detail::kPi;
using Coefficients = std::array<double, kMaxOrder * kMaxOrder>;

/// A number and its derivative along a line: the basis template runs on it as it does on numbers.
struct Dual {
    double value = 0, slope = 0;

    double operator[](int) const { return value; } // says what the scalar is
};
Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.slope + b.slope};
}
Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.slope - b.slope};
}
Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
}
Dual operator+(const Dual& a, double b) {
    return {a.value + b, a.slope};
}
Dual operator-(const Dual& a, double b) {
    return {a.value - b, a.slope};
}
Dual operator*(double a, const Dual& b) {
    return {a * b.value, a * b.slope};
}

struct Disc {
    glm::dvec3 centre, u, v; ///< the rim is centre + cos t u + sin t v, right-handed about -normal
};

/// ∫ over what the disc covers of Y_lm. The spherical Laplacian of Y_lm is -l (l+1) Y_lm, so that for l > 0
/// this is -1/(l (l+1)) of what its gradient lets flow out through the rim; for l = 0 the field of divergence
/// 1 about the direction a of the centre does, which is -(a - (a·w) w) / (1 + a·w).
Coefficients rim_integral(const Disc& disc, int nodes) {
    Coefficients sum{};
    const glm::dvec3 a = glm::normalize(disc.centre);
    for (int n = 0; n < nodes; ++n) {
        const double t = 2 * kPi * n / nodes;
        const glm::dvec3 rim = disc.centre + std::cos(t) * disc.u + std::sin(t) * disc.v;
        const glm::dvec3 along = std::cos(t) * disc.v - std::sin(t) * disc.u;
        const double distance = glm::length(rim);
        const glm::dvec3 w = rim / distance;
        // Outwards from the disc, as long as the step along the rim. Only what is at right angles to w
        // counts.
        const glm::dvec3 out = glm::cross(along, w) * (2 * kPi / nodes / distance);
        Dual basis[coefficient_count(kMaxOrder)];
        sh_basis<kMaxOrder>(Dual{w.x, out.x}, Dual{w.y, out.y}, Dual{w.z, out.z}, basis);
        sum[0] -= basis[0].value * glm::dot(a, out) / (1 + glm::dot(a, w));
        for (int l = 1; l < kMaxOrder; ++l)
            for (int m = -l; m <= l; ++m)
                sum[static_cast<std::size_t>(sh_index(l, m))] -= basis[sh_index(l, m)].slope / (l * (l + 1));
    }
    return sum;
}

/// Twice the nodes until nothing changes.
Coefficients covered(const Disc& disc) {
    constexpr int kFewest = 32, kMost = 1 << 20; // so many where the disc almost touches the receiver
    Coefficients sum = rim_integral(disc, kFewest);
    for (int nodes = 2 * kFewest; nodes <= kMost; nodes *= 2) {
        const Coefficients finer = rim_integral(disc, nodes);
        double change = 0;
        for (std::size_t i = 0; i < finer.size(); ++i)
            change = std::max(change, std::abs(finer[i] - sum[i]));
        sum = finer;
        if (change < 1e-12 * sum[0])
            break;
    }
    return sum;
}

} // namespace

Light disc_light(int order, const glm::vec3& centre, const glm::vec3& normal, double radius,
                 const glm::vec3& radiance) {
    check_order(order);
    if (!(radius > 0))
        throw Error("the radius of a disc light must be positive");
    const double length = glm::length(glm::dvec3(normal));
    if (!(length > 0))
        throw Error("a disc light needs a normal, not a vector of length 0");
    const glm::dvec3 n = glm::dvec3(normal) / length, c(centre);
    Light light{order,
                std::vector<glm::vec3>(static_cast<std::size_t>(coefficient_count(order)), glm::vec3(0))};
    if (!(glm::dot(n, c) < 0)) // the origin is behind it
        return light;
    const glm::dvec3 u =
        glm::normalize(glm::cross(std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), n));
    const Disc disc{c, radius * u, radius * glm::cross(u, n)};
    const Coefficients sum = covered(disc);
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        light.coefficients[i] = glm::vec3(glm::dvec3(radiance) * sum[i]);
    return light;
}

} // namespace prt
