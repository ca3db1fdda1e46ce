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
template <class Value>
[[gnu::always_inline]] inline void turn_about_z(int l, const Turn& turn, Value* c) {
#pragma GCC unroll 5
    for (int m = 1; m <= l; ++m) {
        const double cosine = turn.cosine[static_cast<std::size_t>(m)],
                     sine = turn.sine[static_cast<std::size_t>(m)];
        const Value turned = c[m] * cosine - c[-m] * sine;
        c[-m] = c[m] * sine + c[-m] * cosine;
        c[m] = turned;
    }
}

/// Row `Row` of a band's quarter turn about x, or of its inverse, times `c`. Zeros take no time.
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
[[gnu::always_inline]] inline void quarter_turn(Value* c, std::index_sequence<Row...> all) {
    const Value turned[] = {turned_row<Inverse, L, Row>(c, all)...};
    ((c[Row] = turned[Row]), ...);
}

template <std::size_t L, class Value>
[[gnu::always_inline]] inline void rotate_band(const Turns& turns, Value* c) {
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
/// Those below come from the elements of the matrix.
constexpr int kFirstTurnedBand = 3;

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

template <bool Inverse, class Value>
[[gnu::always_inline]] inline void listed_quarter_turn(int l, Value* c) {
    Value turned[2 * kMaxOrder - 1] = {};
    const auto band = static_cast<std::size_t>(l);
    for (std::size_t e = kElements.first[band]; e < kElements.first[band + 1]; ++e) {
        const Element& element = kElements.elements[e];
        turned[Inverse ? element.column : element.row] +=
            element.value * c[Inverse ? element.row : element.column];
    }
    std::copy_n(turned, 2 * l + 1, c);
}

template <class Value>
[[gnu::always_inline]] inline void rotate_listed_band(int l, const Turns& turns, Value* c) {
    turn_about_z(l, turns.first, c + l);
    if (!turns.tilted)
        return;
    listed_quarter_turn<false>(l, c);
    turn_about_z(l, turns.tilt, c + l);
    listed_quarter_turn<true>(l, c);
    turn_about_z(l, turns.last, c + l);
}

/// Bands 1 and 2 from the elements of the matrix: a vector, and a quadratic form without a trace, in the
/// frame that has been turned. `r` is column-major.
template <class Value>
[[gnu::always_inline]] inline void rotate_vector(const glm::dmat3& r, Value* c) {
    const Value x = -c[3], y = -c[1], z = c[2];
    c[3] = -(r[0][0] * x + r[1][0] * y + r[2][0] * z);
    c[1] = -(r[0][1] * x + r[1][1] * y + r[2][1] * z);
    c[2] = r[0][2] * x + r[1][2] * y + r[2][2] * z;
}

template <class Value>
[[gnu::always_inline]] inline void rotate_form(const glm::dmat3& r, Value* c) {
    constexpr double kThird = 0.57735026918962576451; // sqrt(1/3)
    const Value xy = c[4], yz = -c[5], xz = -c[7], part = kThird * c[6], xx = c[8] - part, yy = -c[8] - part,
                zz = 2 * part;
    // Columns of Q R^T, of which R Q R^T needs no more than five elements.
    Value q[3][3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
        q[0][i] = r[0][i] * xx + r[1][i] * xy + r[2][i] * xz;
        q[1][i] = r[0][i] * xy + r[1][i] * yy + r[2][i] * yz;
        q[2][i] = r[0][i] * xz + r[1][i] * yz + r[2][i] * zz;
    }
    const auto element = [&](int i, int j) __attribute__((always_inline)) {
        return r[0][i] * q[0][j] + r[1][i] * q[1][j] + r[2][i] * q[2][j];
    };
    c[4] = element(0, 1);
    c[5] = -element(1, 2);
    c[7] = -element(0, 2);
    const Value last = element(2, 2), first = element(0, 0);
    c[6] = (1.5 * kThird) * last;
    c[8] = first + 0.5 * last; // (xx - yy) / 2, the trace being 0
}

/// Band by band, so that every band's code is there once for all orders.
template <class Value>
[[gnu::always_inline]] inline void rotate_high_bands(int order, const Turns& turns, Value* c) {
    for (int l = kFirstTurnedBand; l < std::min(order, kFirstListedBand); ++l)
        with_order(
            l, [&]<int L>() __attribute__((always_inline)) {
                if constexpr (L >= kFirstTurnedBand && L < kFirstListedBand)
                    rotate_band<static_cast<std::size_t>(L)>(turns, c + L * L);
            });
    for (int l = kFirstListedBand; l < order; ++l)
        rotate_listed_band(l, turns, c + l * l);
}

PRT_TWO_CLONES
void rotate(int order, const glm::dmat3& matrix, const Turns& turns, Channels* c) {
    if (order > 1)
        rotate_vector(matrix, c);
    if (order > 2)
        rotate_form(matrix, c);
    rotate_high_bands(order, turns, c);
}

PRT_TWO_CLONES
void rotate(int order, const glm::dmat3& matrix, const Turns& turns, double* c) {
    if (order > 1)
        rotate_vector(matrix, c);
    if (order > 2)
        rotate_form(matrix, c);
    rotate_high_bands(order, turns, c);
}

template <class Real>
void rotate_one(int order, const glm::dmat3& matrix, const Turns& turns, std::span<const Real> in,
                std::span<Real> out) {
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    assert(in.size() >= count && out.size() >= count);
    double c[kMaxOrder * kMaxOrder];
    for (std::size_t i = 0; i < count; ++i)
        c[i] = static_cast<double>(in[i]);
    rotate(order, matrix, turns, c);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<Real>(c[i]);
}

/// The rotation next to `r`, which is checked. Newton's iteration for the polar decomposition, R (3 - R^T R)
/// / 2, squares what is off.
glm::dmat3 checked_rotation(const glm::dmat3& r) {
    glm::dmat3 result = r;
    for (double allowed = kRotationTolerance;; allowed = 1) {
        const glm::dvec3 &x = result[0], &y = result[1], &z = result[2];
        const double xx = glm::dot(x, x) - 1, yy = glm::dot(y, y) - 1, zz = glm::dot(z, z) - 1,
                     xy = glm::dot(x, y), yz = glm::dot(y, z), xz = glm::dot(x, z);
        const double squares = xx * xx + yy * yy + zz * zz + xy * xy + yz * yz + xz * xz;
        if (!(squares <= 6 * allowed * allowed)) // nor is NaN
            throw Error("a matrix that scales, shears or is not finite is no rotation of lighting");
        for (const double off : {xx, yy, zz, xy, yz, xz})
            if (std::abs(off) > allowed)
                throw Error("a matrix that scales, shears or is not finite is no rotation of lighting");
        if (allowed < 1 && glm::dot(glm::cross(x, y), z) < 0)
            throw Error(
                "a mirrored matrix is no rotation: take the mirroring out of it, and bake the mirrored "
                "mesh");
        if (squares < 1e-28)
            return result;
        result = glm::dmat3(x - 0.5 * (xx * x + xy * y + xz * z), y - 0.5 * (xy * x + yy * y + yz * z),
                            z - 0.5 * (xz * x + yz * y + zz * z));
    }
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
    if (!(std::abs(glm::dot(q, q) - 1) <= kRotationTolerance))
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
    : order_((check_order(order), order)), matrix_(checked_rotation(rotation)) {
    if (order > kFirstTurnedBand)
        turns_ = turns_of(order, matrix_);
}

ShRotation::ShRotation(int order, const glm::dquat& rotation) : ShRotation(order, matrix_of(rotation)) {}

ShRotation ShRotation::about_x(int order, double angle) {
    return ShRotation(order, glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
}

ShRotation ShRotation::about_y(int order, double angle) {
    return ShRotation(order, glm::angleAxis(angle, glm::dvec3(0, 1, 0)));
}

ShRotation ShRotation::about_z(int order, double angle) {
    check_order(order);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    ShRotation result(order, glm::dmat3(cosine, sine, 0, -sine, cosine, 0, 0, 0, 1));
    result.turns_.first = Turn(order, cosine, sine);
    result.turns_.tilted = false;
    return result;
}

void ShRotation::apply(std::span<const float> in, std::span<float> out) const {
    rotate_one(order_, matrix_, turns_, in, out);
}

void ShRotation::apply(std::span<const double> in, std::span<double> out) const {
    rotate_one(order_, matrix_, turns_, in, out);
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
    rotate(order_, matrix_, turns_, c);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = {static_cast<float>(c[i][0]), static_cast<float>(c[i][1]), static_cast<float>(c[i][2])};
}

} // namespace prt
