#include "prt/sh_rotation.h"

#include "prt/error.h"
#include "prt/sh.h"
#include "prt/vector_lanes.h"
#include "quarter_turn.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <cassert>
#include <cmath>
#include <utility>

namespace prt {
namespace {

using Turn = ShRotation::Turn;
using Turns = ShRotation::Turns;

/// Three channels and one that is idle.
using Channels [[gnu::vector_size(sizeof(double) * 4)]] = double;

template <int Order, class Value>
[[gnu::always_inline]] inline void turn_about_z(const Turn& turn, Value* c) {
#pragma GCC unroll 10
    for (int m = 1; m < Order; ++m) {
        const double cosine = turn.cosine[static_cast<std::size_t>(m)],
                     sine = turn.sine[static_cast<std::size_t>(m)];
#pragma GCC unroll 10
        for (int l = m; l < Order; ++l) {
            Value& a = c[sh_index(l, m)];
            Value& b = c[sh_index(l, -m)];
            const Value turned = a * cosine - b * sine;
            b = a * sine + b * cosine;
            a = turned;
        }
    }
}

/// Row `Row` of a band's quarter turn, or of its inverse, times `c`. Zeros take no time.
template <bool Inverse, std::size_t L, std::size_t Row, class Value, std::size_t... Column>
[[gnu::always_inline]] inline Value turned_row(const Value* c, std::index_sequence<Column...>) {
    Value sum{};
    const auto add = [&]<std::size_t I>() __attribute__((always_inline)) {
        constexpr double factor = Inverse ? kQuarterTurn.at(L, I, Row) : kQuarterTurn.at(L, Row, I);
        if constexpr (factor != 0)
            sum += factor * c[I];
    };
    (add.template operator()<Column>(), ...);
    return sum;
}

template <bool Inverse, std::size_t L, class Value, std::size_t... Row>
[[gnu::always_inline]] inline void turn_band(Value* c, std::index_sequence<Row...> all) {
    const Value turned[] = {turned_row<Inverse, L, Row>(c, all)...};
    ((c[Row] = turned[Row]), ...);
}

/// By 90 degrees about x, or back.
template <bool Inverse, class Value, std::size_t... L>
[[gnu::always_inline]] inline void quarter_turn(Value* c, std::index_sequence<L...>) {
    (turn_band<Inverse, L>(c + L * L, std::make_index_sequence<2 * L + 1>()), ...);
}

template <int Order, class Value>
[[gnu::always_inline]] inline void rotate(const Turns& turns, Value* c) {
    turn_about_z<Order>(turns.first, c);
    if (!turns.tilted)
        return;
    constexpr auto bands = std::make_index_sequence<Order>();
    quarter_turn<false>(c, bands);
    turn_about_z<Order>(turns.tilt, c);
    quarter_turn<true>(c, bands);
    turn_about_z<Order>(turns.last, c);
}

PRT_TARGET_CLONES
void rotate_channels(int order, const Turns& turns, const glm::vec3* in, glm::vec3* out) {
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            Channels c[coefficient_count(Order)];
            for (int i = 0; i < coefficient_count(Order); ++i)
                c[i] = Channels{in[i].r, in[i].g, in[i].b, 0};
            rotate<Order>(turns, c);
            for (int i = 0; i < coefficient_count(Order); ++i)
                out[i] = {static_cast<float>(c[i][0]), static_cast<float>(c[i][1]),
                          static_cast<float>(c[i][2])};
        });
}

template <class Real>
void rotate_one(int order, const Turns& turns, std::span<const Real> in, std::span<Real> out) {
    assert(in.size() >= static_cast<std::size_t>(coefficient_count(order)) && out.size() >= in.size());
    with_order(order, [&]<int Order>() {
        std::array<double, static_cast<std::size_t>(coefficient_count(Order))> c;
        for (std::size_t i = 0; i < c.size(); ++i)
            c[i] = static_cast<double>(in[i]);
        rotate<Order>(turns, c.data());
        for (std::size_t i = 0; i < c.size(); ++i)
            out[i] = static_cast<Real>(c[i]);
    });
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
    assert(in.size() >= static_cast<std::size_t>(coefficient_count(order_)) && out.size() >= in.size());
    rotate_channels(order_, turns_, in.data(), out.data());
}

} // namespace prt
