#pragma once

// Triple products ∫ Y_i Y_j Y_k over the sphere for the first three bands, at compile time: the functions are
// polynomials in x, y, z, and monomials integrate in closed form.

#include "prt/core/sh_basis.h"

#include <array>
#include <cstddef>
#include <numbers>

namespace prt {

inline constexpr int kTripleOrder = 3;
inline constexpr std::size_t kTripleCount = kTripleOrder * kTripleOrder;

class TripleProducts {
public:
    constexpr TripleProducts() {
        for (std::size_t i = 0; i < kTripleCount; ++i)
            for (std::size_t j = 0; j < kTripleCount; ++j)
                for (std::size_t k = 0; k < kTripleCount; ++k)
                    values_[(i * kTripleCount + j) * kTripleCount + k] = integral(i, j, k);
    }
    constexpr double at(std::size_t i, std::size_t j, std::size_t k) const {
        return values_[(i * kTripleCount + j) * kTripleCount + k];
    }

private:
    struct Monomial {
        double factor;
        int x, y, z; ///< powers
    };
    struct Polynomial {
        int terms;
        std::array<Monomial, 2> term;
    };

    static constexpr std::array<Polynomial, kTripleCount> functions() {
        using std::numbers::pi;
        const double a = detail::square_root(1 / (4 * pi)), b = detail::square_root(3 / (4 * pi)),
                     c = detail::square_root(15 / (4 * pi)), d = detail::square_root(5 / (16 * pi));
        return {{{1, {{{a, 0, 0, 0}}}},
                 {1, {{{-b, 0, 1, 0}}}},
                 {1, {{{b, 0, 0, 1}}}},
                 {1, {{{-b, 1, 0, 0}}}},
                 {1, {{{c, 1, 1, 0}}}},
                 {1, {{{-c, 0, 1, 1}}}},
                 {2, {{{3 * d, 0, 0, 2}, {-d, 0, 0, 0}}}},
                 {1, {{{-c, 1, 0, 1}}}},
                 {2, {{{c / 2, 2, 0, 0}, {-c / 2, 0, 2, 0}}}}}};
    }

    /// Returns the double factorial n!! for odd n, and 1 for n = -1.
    static constexpr double odd_factorial(int n) {
        double product = 1;
        for (; n > 1; n -= 2)
            product *= n;
        return product;
    }
    /// Returns ∫ x^a y^b z^c dw.
    static constexpr double moment(int a, int b, int c) {
        if (a % 2 != 0 || b % 2 != 0 || c % 2 != 0)
            return 0;
        return 4 * std::numbers::pi * odd_factorial(a - 1) * odd_factorial(b - 1) * odd_factorial(c - 1) /
               odd_factorial(a + b + c + 1);
    }

    static constexpr double integral(std::size_t i, std::size_t j, std::size_t k) {
        const auto y = functions();
        double sum = 0;
        for (int p = 0; p < y[i].terms; ++p)
            for (int q = 0; q < y[j].terms; ++q)
                for (int r = 0; r < y[k].terms; ++r) {
                    const Monomial &u = y[i].term[static_cast<std::size_t>(p)],
                                   &v = y[j].term[static_cast<std::size_t>(q)],
                                   &w = y[k].term[static_cast<std::size_t>(r)];
                    sum += u.factor * v.factor * w.factor *
                           moment(u.x + v.x + w.x, u.y + v.y + w.y, u.z + v.z + w.z);
                }
        return sum < 1e-12 && sum > -1e-12 ? 0 : sum;
    }

    std::array<double, kTripleCount * kTripleCount * kTripleCount> values_{};
};

inline constexpr TripleProducts kTripleProducts;

} // namespace prt
