#include "prt/sh_rotation.h"

#include "prt/error.h"
#include "prt/sh.h"
#include "prt/vector_lanes.h"
#include "quarter_turn.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace prt {
namespace {

using Turn = ShRotation::Turn;
using Turns = ShRotation::Turns;

/// Three channels and one that is idle.
using Channels [[gnu::vector_size(sizeof(double) * 4)]] = double;

/// Band l about z; `c` points at its coefficient of m = 0.
[[gnu::always_inline]] inline void turn_about_z(int l, const Turn& turn, Channels* c) {
#pragma GCC unroll 5
    for (int m = 1; m <= l; ++m) {
        const double cosine = turn.cosine[static_cast<std::size_t>(m)],
                     sine = turn.sine[static_cast<std::size_t>(m)];
        const Channels turned = c[m] * cosine - c[-m] * sine;
        c[-m] = c[m] * sine + c[-m] * cosine;
        c[m] = turned;
    }
}

/// Row `Row` of a band's quarter turn about x, or of its inverse, times `c`. Zeros take no time.
template <bool Inverse, std::size_t L, std::size_t Row, std::size_t... Column>
[[gnu::always_inline]] inline Channels turned_row(const Channels* c, std::index_sequence<Column...>) {
    Channels sum{};
    const auto add = [&]<std::size_t I>() __attribute__((always_inline)) {
        constexpr double factor = Inverse ? kQuarterTurn.at(L, I, Row) : kQuarterTurn.at(L, Row, I);
        if constexpr (factor != 0)
            sum += factor * c[I];
    };
    (add.template operator()<Column>(), ...);
    return sum;
}

template <bool Inverse, std::size_t L, std::size_t... Row>
[[gnu::always_inline]] inline void quarter_turn(Channels* c, std::index_sequence<Row...> all) {
    const Channels turned[] = {turned_row<Inverse, L, Row>(c, all)...};
    ((c[Row] = turned[Row]), ...);
}

template <std::size_t L>
[[gnu::always_inline]] inline void rotate_band(const Turns& turns, Channels* c) {
    constexpr auto all = std::make_index_sequence<2 * L + 1>();
    constexpr int l = static_cast<int>(L);
    turn_about_z(l, turns.first, c + L);
    if (!turns.tilted)
        return;
    quarter_turn<false, L>(c, all);
    turn_about_z(l, turns.tilt, c + L);
    quarter_turn<true, L>(c, all);
    turn_about_z(l, turns.last, c + L);
}

/// The quarter turns of the bands that games hardly use, element by element: their code would be as long as
/// that of the whole rest.
constexpr int kFirstListedBand = 6;

struct Element {
    std::uint8_t row, column;
    double value;
};

consteval std::size_t listed_elements() {
    std::size_t count = 0;
    for (std::size_t l = kFirstListedBand; l < kMaxOrder; ++l)
        for (std::size_t row = 0; row <= 2 * l; ++row)
            for (std::size_t column = 0; column <= 2 * l; ++column)
                count += kQuarterTurn.at(l, row, column) != 0;
    return count;
}

/// The elements that are not zero of bands kFirstListedBand to kMaxOrder - 1, and where each band starts.
struct ElementList {
    std::array<Element, listed_elements()> elements{};
    std::array<std::size_t, kMaxOrder + 1> first{};

    consteval ElementList() {
        std::size_t count = 0;
        for (std::size_t l = kFirstListedBand; l < kMaxOrder; ++l) {
            first[l] = count;
            for (std::size_t row = 0; row <= 2 * l; ++row)
                for (std::size_t column = 0; column <= 2 * l; ++column)
                    if (const double value = kQuarterTurn.at(l, row, column); value != 0)
                        elements[count++] = {static_cast<std::uint8_t>(row),
                                             static_cast<std::uint8_t>(column), value};
        }
        first[kMaxOrder] = count;
    }
};
constexpr ElementList kElements;

template <bool Inverse>
[[gnu::always_inline]] inline void listed_quarter_turn(int l, Channels* c) {
    Channels turned[2 * kMaxOrder - 1] = {};
    const auto band = static_cast<std::size_t>(l);
    for (std::size_t e = kElements.first[band]; e < kElements.first[band + 1]; ++e) {
        const Element& element = kElements.elements[e];
        turned[Inverse ? element.column : element.row] +=
            element.value * c[Inverse ? element.row : element.column];
    }
    std::copy_n(turned, 2 * l + 1, c);
}

[[gnu::always_inline]] inline void rotate_listed_band(int l, const Turns& turns, Channels* c) {
    turn_about_z(l, turns.first, c + l);
    if (!turns.tilted)
        return;
    listed_quarter_turn<false>(l, c);
    turn_about_z(l, turns.tilt, c + l);
    listed_quarter_turn<true>(l, c);
    turn_about_z(l, turns.last, c + l);
}

/// Band by band, so that every band's code is there once for all orders.
PRT_TWO_CLONES
void rotate(int order, const Turns& turns, Channels* c) {
    for (int l = 1; l < std::min(order, kFirstListedBand); ++l)
        with_order(
            l, [&]<int L>() __attribute__((always_inline)) {
                if constexpr (L < kFirstListedBand)
                    rotate_band<static_cast<std::size_t>(L)>(turns, c + L * L);
            });
    for (int l = kFirstListedBand; l < order; ++l)
        rotate_listed_band(l, turns, c + l * l);
}

/// One function is rotated as three are, in the first lane.
template <class Real>
void rotate_one(int order, const Turns& turns, std::span<const Real> in, std::span<Real> out) {
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    assert(in.size() >= count && out.size() >= count);
    Channels c[kMaxOrder * kMaxOrder];
    for (std::size_t i = 0; i < count; ++i)
        c[i] = Channels{static_cast<double>(in[i]), 0, 0, 0};
    rotate(order, turns, c);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<Real>(c[i][0]);
}

void check_rotation(const glm::dmat3& r) {
    const glm::dmat3 squared = glm::transpose(r) * r;
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double off = std::abs(squared[i][j] - (i == j ? 1 : 0));
            worst = off <= worst ? worst : off; // NaN wins
        }
    if (!(worst <= 2e-3)) // what thousands of products of float matrices leave
        throw Error("a matrix that scales, shears or is not finite is no rotation of lighting");
    if (glm::determinant(r) < 0)
        throw Error(
            "a mirrored matrix is no rotation: take the mirroring out of it, and bake the mirrored mesh");
}

Turns turns_of(int order, const glm::dmat3& r) {
    // GLM is column-major: r[column][row]. The last turn takes +y's tilt plane to where z went; the first is
    // then read from the second row of what is left, which is well conditioned even where z hardly moved.
    double cosine = r[2][0], sine = r[2][1];
    const double tilt = std::sqrt(cosine * cosine + sine * sine);
    if (!(tilt > 0)) {
        cosine = 1;
        sine = 0;
    } else {
        cosine /= tilt;
        sine /= tilt;
    }
    const double first_sine = cosine * r[0][1] - sine * r[0][0],
                 first_cosine = cosine * r[1][1] - sine * r[1][0];
    const double first = std::sqrt(first_sine * first_sine + first_cosine * first_cosine),
                 all = std::sqrt(tilt * tilt + r[2][2] * r[2][2]);
    Turns turns{Turn(order, first_cosine / first, first_sine / first), Turn(order, r[2][2] / all, tilt / all),
                Turn(order, cosine, sine), true};
    if (tilt == 0 && r[2][2] > 0)
        turns.tilted = false; // last is the identity
    return turns;
}

glm::dmat3 matrix_of(const glm::dquat& q) {
    if (!(std::abs(glm::dot(q, q) - 1) <= 2e-4))
        throw Error("a quaternion whose length is not 1 is no rotation");
    return glm::mat3_cast(glm::normalize(q));
}

} // namespace

Turn::Turn(int order, double c, double s) {
    cosine[0] = 1;
    sine[0] = 0;
    for (std::size_t m = 1; m < static_cast<std::size_t>(order); ++m) {
        cosine[m] = cosine[m - 1] * c - sine[m - 1] * s;
        sine[m] = cosine[m - 1] * s + sine[m - 1] * c;
    }
}

ShRotation::ShRotation(int order, const glm::dmat3& rotation)
    : order_(order), turns_((check_order(order), check_rotation(rotation), turns_of(order, rotation))) {}

ShRotation::ShRotation(int order, const glm::dquat& rotation) : ShRotation(order, matrix_of(rotation)) {}

ShRotation ShRotation::about_x(int order, double angle) {
    return ShRotation(order, glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
}

ShRotation ShRotation::about_y(int order, double angle) {
    return ShRotation(order, glm::angleAxis(angle, glm::dvec3(0, 1, 0)));
}

ShRotation ShRotation::about_z(int order, double angle) {
    check_order(order);
    return ShRotation(order, Turns{Turn(order, std::cos(angle), std::sin(angle)), Turn(order, 1, 0),
                                   Turn(order, 1, 0), false});
}

void ShRotation::apply(std::span<const float> in, std::span<float> out) const {
    rotate_one(order_, turns_, in, out);
}

void ShRotation::apply(std::span<const double> in, std::span<double> out) const {
    rotate_one(order_, turns_, in, out);
}

void ShRotation::apply(std::span<glm::vec3> coefficients) const {
    apply(coefficients, coefficients);
}

void ShRotation::apply(std::span<const glm::vec3> in, std::span<glm::vec3> out) const {
    const auto count = static_cast<std::size_t>(coefficient_count(order_));
    assert(in.size() >= count && out.size() >= count);
    Channels c[kMaxOrder * kMaxOrder];
    for (std::size_t i = 0; i < count; ++i)
        c[i] = Channels{in[i].r, in[i].g, in[i].b, 0};
    rotate(order_, turns_, c);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = {static_cast<float>(c[i][0]), static_cast<float>(c[i][1]), static_cast<float>(c[i][2])};
}

} // namespace prt
