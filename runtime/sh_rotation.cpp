// Rotation matrices of real spherical harmonics by recursion over bands: J. Ivanic and K. Ruedenberg,
// "Rotation Matrices for Real Spherical Harmonics. Direct Determination by Recursion", J. Phys. Chem. 1996,
// 100, 6342, table 2 with the additions and corrections of 1998. Their basis has no Condon-Shortley phase;
// ours differs by
// (-1)^m, which is applied to rows and columns at the end.

#include "prt/sh.h"

#include <array>
#include <cassert>
#include <cmath>

namespace prt {
namespace {

std::size_t block_offset(int l) {
    return static_cast<std::size_t>(l * (2 * l - 1) * (2 * l + 1) / 3); // sum of (2k+1)² for k < l
}

struct Recursion {
    std::span<const double> first;    // band 1
    std::span<const double> previous; // band l - 1
    int l;

    double r1(int m, int n) const { return first[static_cast<std::size_t>((m + 1) * 3 + n + 1)]; }
    double r(int m, int n) const {
        return previous[static_cast<std::size_t>((m + l - 1) * (2 * l - 1) + n + l - 1)];
    }

    double p(int i, int m, int n) const {
        if (n == l)
            return r1(i, 1) * r(m, l - 1) - r1(i, -1) * r(m, 1 - l);
        if (n == -l)
            return r1(i, 1) * r(m, 1 - l) + r1(i, -1) * r(m, l - 1);
        return r1(i, 0) * r(m, n);
    }

    double v_term(int m, int n) const {
        if (m == 0)
            return p(1, 1, n) + p(-1, -1, n);
        if (m == 1)
            return std::sqrt(2.0) * p(1, 0, n);
        if (m == -1)
            return std::sqrt(2.0) * p(-1, 0, n);
        return m > 0 ? p(1, m - 1, n) - p(-1, 1 - m, n) : p(1, m + 1, n) + p(-1, -m - 1, n);
    }

    double w_term(int m, int n) const {
        return m > 0 ? p(1, m + 1, n) + p(-1, -m - 1, n) : p(1, m - 1, n) - p(-1, 1 - m, n);
    }

    double element(int m, int n) const {
        const double am = std::abs(m);
        const double denominator = std::abs(n) == l ? 2.0 * l * (2 * l - 1) : double(l + n) * (l - n);
        const double u = std::sqrt((l + am) * (l - am) / denominator);
        const double v =
            0.5 * std::sqrt((m == 0 ? 2 : 1) * (l + am - 1) * (l + am) / denominator) * (m == 0 ? -1 : 1);
        const double w = m == 0 ? 0 : -0.5 * std::sqrt((l - am - 1) * (l - am) / denominator);
        double sum = 0;
        if (u != 0)
            sum += u * p(0, m, n);
        if (v != 0)
            sum += v * v_term(m, n);
        if (w != 0)
            sum += w * w_term(m, n);
        return sum;
    }
};

} // namespace

ShRotation::ShRotation(int order, const glm::dmat3& rotation) : order_(order), blocks_(block_offset(order)) {
    check_order(order);
    blocks_[0] = 1;
    if (order > 1) {
        // Band 1 is the rotation itself, in the order (y, z, x); GLM is column-major.
        constexpr std::array axis = {1, 2, 0};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                blocks_[static_cast<std::size_t>(1 + row * 3 + column)] =
                    rotation[axis[static_cast<std::size_t>(column)]][axis[static_cast<std::size_t>(row)]];
    }
    for (int l = 2; l < order; ++l) {
        const std::span all(blocks_);
        const Recursion recursion{all.subspan(1, 9), all.subspan(block_offset(l - 1)), l};
        for (int m = -l; m <= l; ++m)
            for (int n = -l; n <= l; ++n)
                blocks_[block_offset(l) + static_cast<std::size_t>((m + l) * (2 * l + 1) + n + l)] =
                    recursion.element(m, n);
    }
    for (int l = 1; l < order; ++l)
        for (int m = -l; m <= l; ++m)
            for (int n = -l; n <= l; ++n)
                if ((m + n) % 2 != 0)
                    blocks_[block_offset(l) + static_cast<std::size_t>((m + l) * (2 * l + 1) + n + l)] *= -1;
}

double ShRotation::at(int l, int m, int n) const {
    return blocks_[block_offset(l) + static_cast<std::size_t>((m + l) * (2 * l + 1) + n + l)];
}

void ShRotation::apply(std::span<const double> in, std::span<double> out) const {
    assert(in.data() != out.data());
    for (int l = 0; l < order_; ++l) {
        for (int m = -l; m <= l; ++m) {
            double sum = 0;
            for (int n = -l; n <= l; ++n)
                sum += at(l, m, n) * in[static_cast<std::size_t>(sh_index(l, n))];
            out[static_cast<std::size_t>(sh_index(l, m))] = sum;
        }
    }
}

void ShRotation::apply(std::span<glm::vec3> coefficients) const {
    std::array<double, kMaxOrder * kMaxOrder> in{}, out{};
    const auto count = static_cast<std::size_t>(coefficient_count(order_));
    assert(coefficients.size() >= count);
    for (int channel = 0; channel < 3; ++channel) {
        for (std::size_t i = 0; i < count; ++i)
            in[i] = static_cast<double>(coefficients[i][channel]);
        apply(std::span<const double>(in), std::span<double>(out));
        for (std::size_t i = 0; i < count; ++i)
            coefficients[i][channel] = static_cast<float>(out[i]);
    }
}

} // namespace prt
