#pragma once

// Rotation of bands 2 to 5 of one function in SIMD lanes.

#include "prt/core/sh_rotation.h"
#include "runtime/core/sh/quarter_turn.h"

#include <cstddef>
#include <cstring>
#include <utility>

namespace prt {

/// Bands 2 to 5, one per lane. Indexed by k = l - |m|, the rotations of all bands by 90 degrees have their
/// zeros at the same indices.
using Bands [[gnu::vector_size(sizeof(double) * 4)]] = double;
inline constexpr std::size_t kLanes = 4, kFirstLane = 2, kDegrees = kFirstLane + kLanes;
inline constexpr int kLaneOrder = static_cast<int>(kDegrees);

/// Coefficients of m = l - k at [0][k], and of -m at [1][k]. Entries with k > l are unused and multiplied by
/// 0.
struct Sides {
    Bands at[2][kDegrees];
};

constexpr std::size_t row_in_band(std::size_t l, bool minus, std::size_t k) {
    return minus ? k : 2 * l - k;
}

/// Returns an element of the rotation of band l by 90 degrees about x.
template <bool Inverse>
constexpr double lane_factor(std::size_t l, bool to_minus, std::size_t to, bool from_minus,
                             std::size_t from) {
    if (to > l || from > l || (to_minus && to == l) || (from_minus && from == l))
        return 0;
    const std::size_t row = row_in_band(l, to_minus, to), column = row_in_band(l, from_minus, from);
    return Inverse ? kQuarterTurn.at(l, column, row) : kQuarterTurn.at(l, row, column);
}

template <bool Inverse, bool ToMinus, std::size_t To, std::size_t... From>
[[gnu::always_inline]] inline Bands rotated_lanes(const Sides& c, std::index_sequence<From...>) {
    Bands sum{};
    const auto add = [&]<bool Minus, std::size_t K>() __attribute__((always_inline)) {
        constexpr double factor[kLanes] = {
            lane_factor<Inverse>(2, ToMinus, To, Minus, K), lane_factor<Inverse>(3, ToMinus, To, Minus, K),
            lane_factor<Inverse>(4, ToMinus, To, Minus, K), lane_factor<Inverse>(5, ToMinus, To, Minus, K)};
        if constexpr (factor[0] != 0 || factor[1] != 0 || factor[2] != 0 || factor[3] != 0)
            sum += Bands{factor[0], factor[1], factor[2], factor[3]} * c.at[Minus][K];
    };
    (add.template operator()<false, From>(), ...);
    (add.template operator()<true, From>(), ...);
    return sum;
}

template <bool Inverse, std::size_t... K>
[[gnu::always_inline]] inline void quarter_turn_lanes(Sides& c, std::index_sequence<K...> all) {
    c = {{{rotated_lanes<Inverse, false, K>(c, all)...}, {rotated_lanes<Inverse, true, K>(c, all)...}}};
}

[[gnu::always_inline]] inline void rotate_lanes_about_z(const ShRotation::Rotation& rotation, Sides& c) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kDegrees; ++k) {
        Bands cosine, sine;
        std::memcpy(&cosine, &rotation.cosine[ShRotation::Rotation::kZero + kFirstLane - k], sizeof cosine);
        std::memcpy(&sine, &rotation.sine[ShRotation::Rotation::kZero + kFirstLane - k], sizeof sine);
        const Bands plus = c.at[0][k], minus = c.at[1][k];
        c.at[0][k] = plus * cosine - minus * sine;
        c.at[1][k] = plus * sine + minus * cosine;
    }
}

/// Rotates bands 2 to 5 of `in` to `out`, both [36].
template <class Real>
[[gnu::always_inline]] inline void rotate_lanes(const ShRotation::Rotations& rotations, const Real* in,
                                                Real* out) {
    using Four [[gnu::vector_size(sizeof(Real) * kLanes)]] = Real;
    constexpr auto all = std::make_index_sequence<kDegrees>();
    Sides c;
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kDegrees; ++k) {
        const auto from = [&](std::size_t l, bool minus) __attribute__((always_inline)) {
            return k <= l ? in[l * l + row_in_band(l, minus, k)] : Real(0);
        };
        c.at[0][k] = __builtin_convertvector(
            (Four{from(2, false), from(3, false), from(4, false), from(5, false)}), Bands);
        c.at[1][k] = __builtin_convertvector(
            (Four{from(2, true), from(3, true), from(4, true), from(5, true)}), Bands);
    }
    rotate_lanes_about_z(rotations.first, c);
    if (rotations.tilted) {
        quarter_turn_lanes<false>(c, all);
        rotate_lanes_about_z(rotations.tilt, c);
        quarter_turn_lanes<true>(c, all);
        rotate_lanes_about_z(rotations.last, c);
    }
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kDegrees; ++k) {
        const Four plus = __builtin_convertvector(c.at[0][k], Four),
                   minus = __builtin_convertvector(c.at[1][k], Four);
#pragma GCC unroll 4
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t l = kFirstLane + lane;
            if (k < l)
                out[l * l + row_in_band(l, true, k)] = minus[lane];
            if (k <= l)
                out[l * l + row_in_band(l, false, k)] = plus[lane];
        }
    }
}

} // namespace prt
