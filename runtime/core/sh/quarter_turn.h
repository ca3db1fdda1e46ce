#pragma once

// Rotation of real spherical harmonics by 90 degrees about x, at compile time, by the recursion of J. Ivanic
// and K. Ruedenberg, "Rotation Matrices for Real Spherical Harmonics. Direct Determination by Recursion", J.
// Phys. Chem. 1996, 100, 6342, table 2 with the additions and corrections of 1998. Their basis has no
// Condon-Shortley phase; the basis of prtkit differs by (-1)^m in rows and columns.

#include "prt/core/sh_basis.h"

#include <array>
#include <cstddef>

namespace prt {

/// Elements of bands l < kMaxOrder, band by band, each (2l+1)² with rows m = -l..l of the result.
class QuarterTurn {
public:
    constexpr QuarterTurn() {
        values_[0] = 1;
        // Band 1 is the rotation itself, in the order (y, z, x): y becomes z, z becomes -y.
        values_[offset(1) + 1] = -1;
        values_[offset(1) + 3] = 1;
        values_[offset(1) + 8] = 1;
        for (int l = 2; l < kMaxOrder; ++l)
            for (int m = -l; m <= l; ++m)
                for (int n = -l; n <= l; ++n)
                    values_[offset(l) + static_cast<std::size_t>((m + l) * (2 * l + 1) + n + l)] =
                        element(l, m, n);
        for (int l = 1; l < kMaxOrder; ++l)
            for (int m = -l; m <= l; ++m)
                for (int n = -l; n <= l; ++n)
                    if (double& v =
                            values_[offset(l) + static_cast<std::size_t>((m + l) * (2 * l + 1) + n + l)];
                        v < 1e-14 && v > -1e-14)
                        v = 0; // three quarters are zero: x is unchanged, y and z are exchanged
                    else if ((m + n) % 2 != 0)
                        v = -v;
    }

    /// Returns an element of band l, row and column 0..2l.
    constexpr double at(std::size_t l, std::size_t row, std::size_t column) const {
        return values_[offset(static_cast<int>(l)) + row * (2 * l + 1) + column];
    }

private:
    static constexpr std::size_t offset(int l) {
        return static_cast<std::size_t>(l * (2 * l - 1) * (2 * l + 1) / 3); // sum of (2k+1)² for k < l
    }
    static constexpr double root(double value) { return value > 0 ? detail::square_root(value) : 0; }
    static constexpr int magnitude(int m) { return m < 0 ? -m : m; }

    constexpr double first(int m, int n) const {
        return values_[offset(1) + static_cast<std::size_t>((m + 1) * 3 + n + 1)];
    }
    constexpr double previous(int l, int m, int n) const {
        return values_[offset(l - 1) + static_cast<std::size_t>((m + l - 1) * (2 * l - 1) + n + l - 1)];
    }
    constexpr double p(int l, int i, int m, int n) const {
        if (n == l)
            return first(i, 1) * previous(l, m, l - 1) - first(i, -1) * previous(l, m, 1 - l);
        if (n == -l)
            return first(i, 1) * previous(l, m, 1 - l) + first(i, -1) * previous(l, m, l - 1);
        return first(i, 0) * previous(l, m, n);
    }
    constexpr double v_term(int l, int m, int n) const {
        if (m == 0)
            return p(l, 1, 1, n) + p(l, -1, -1, n);
        if (m == 1)
            return root(2) * p(l, 1, 0, n);
        if (m == -1)
            return root(2) * p(l, -1, 0, n);
        return m > 0 ? p(l, 1, m - 1, n) - p(l, -1, 1 - m, n) : p(l, 1, m + 1, n) + p(l, -1, -m - 1, n);
    }
    constexpr double w_term(int l, int m, int n) const {
        return m > 0 ? p(l, 1, m + 1, n) + p(l, -1, -m - 1, n) : p(l, 1, m - 1, n) - p(l, -1, 1 - m, n);
    }
    constexpr double element(int l, int m, int n) const {
        const double am = magnitude(m);
        const double denominator = magnitude(n) == l ? 2.0 * l * (2 * l - 1) : double(l + n) * (l - n);
        const double u = root((l + am) * (l - am) / denominator);
        const double v =
            0.5 * root((m == 0 ? 2 : 1) * (l + am - 1) * (l + am) / denominator) * (m == 0 ? -1 : 1);
        const double w = m == 0 ? 0 : -0.5 * root((l - am - 1) * (l - am) / denominator);
        double sum = 0;
        if (u != 0)
            sum += u * p(l, 0, m, n);
        if (v != 0)
            sum += v * v_term(l, m, n);
        if (w != 0)
            sum += w * w_term(l, m, n);
        return sum;
    }

    std::array<double, static_cast<std::size_t>(kMaxOrder*(2 * kMaxOrder - 1) * (2 * kMaxOrder + 1) / 3)>
        values_{};
};

inline constexpr QuarterTurn kQuarterTurn;

} // namespace prt
