// Rotates SH: bands 1 and 2 directly, higher bands by rotations about z and by 90 degrees about x
// (docs/math.md, eq. 4).
#include "prt/core/sh_rotation.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/sh/checked_rotation.h"
#include "runtime/core/sh/quarter_turn.h"
#include "runtime/core/sh/sh_rotation_lanes.h"
#include "runtime/core/support/vector_lanes.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace prt {
namespace {

using Rotation = ShRotation::Rotation;
using Rotations = ShRotation::Rotations;

/// Three channels and one unused lane.
using Channels [[gnu::vector_size(sizeof(double) * 4)]] = double;

/// Rotates band l about z; `c` points to the coefficient of m = 0.
template <class Value>
[[gnu::always_inline]] inline void rotate_about_z(int l, const Rotation& rotation, Value* c) {
#pragma GCC unroll 5
    for (int m = 1; m <= l; ++m) {
        const double cosine = rotation.cosine[Rotation::kZero + static_cast<std::size_t>(m)],
                     sine = rotation.sine[Rotation::kZero + static_cast<std::size_t>(m)];
        const Value rotated = c[m] * cosine - c[-m] * sine;
        c[-m] = c[m] * sine + c[-m] * cosine;
        c[m] = rotated;
    }
}

/// Multiplies row `Row` of a band's rotation by 90 degrees about x, or of its inverse, with `c`. Zero factors
/// cost no time.
template <bool Inverse, std::size_t L, std::size_t Row, class Value, std::size_t... Column>
[[gnu::always_inline]] inline Value rotated_row(const Value* c, std::index_sequence<Column...>) {
    Value sum{};
    const auto add = [&]<std::size_t I>() __attribute__((always_inline)) {
        // NOLINTNEXTLINE(bugprone-branch-clone): they are one where the factor is on the diagonal
        constexpr double factor = Inverse ? kQuarterTurn.at(L, I, Row) : kQuarterTurn.at(L, Row, I);
        if constexpr (factor != 0)
            sum += factor * c[I];
    };
    (add.template operator()<Column>(), ...);
    return sum;
}

template <bool Inverse, std::size_t L, class Value, std::size_t... Row>
[[gnu::always_inline]] inline void quarter_turn(Value* c, std::index_sequence<Row...> all) {
    const Value rotated[] = {rotated_row<Inverse, L, Row>(c, all)...};
    ((c[Row] = rotated[Row]), ...);
}

template <std::size_t L, class Value>
[[gnu::always_inline]] inline void rotate_band(const Rotations& rotations, Value* c) {
    constexpr auto all = std::make_index_sequence<2 * L + 1>();
    constexpr int l = static_cast<int>(L);
    rotate_about_z(l, rotations.first, c + L);
    if (!rotations.tilted)
        return;
    quarter_turn<false, L>(c, all);
    rotate_about_z(l, rotations.tilt, c + L);
    quarter_turn<true, L>(c, all);
    rotate_about_z(l, rotations.last, c + L);
}

/// Bands from this one on use lists of elements. Games rarely use them, and unrolled code would double the
/// code size.
constexpr int kFirstListedBand = 6;
/// Lower bands are computed from the elements of the matrix.
constexpr int kFirstRotatedBand = 3;

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

/// The nonzero elements of bands kFirstListedBand to kMaxOrder - 1, and the start of each band.
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
    Value rotated[2 * kMaxOrder - 1] = {};
    const auto band = static_cast<std::size_t>(l);
    for (std::size_t e = kElements.first[band]; e < kElements.first[band + 1]; ++e) {
        const Element& element = kElements.elements[e];
        rotated[Inverse ? element.column : element.row] +=
            element.value * c[Inverse ? element.row : element.column];
    }
    std::copy_n(rotated, 2 * l + 1, c);
}

template <class Value>
[[gnu::always_inline]] inline void rotate_listed_band(int l, const Rotations& rotations, Value* c) {
    rotate_about_z(l, rotations.first, c + l);
    if (!rotations.tilted)
        return;
    listed_quarter_turn<false>(l, c);
    rotate_about_z(l, rotations.tilt, c + l);
    listed_quarter_turn<true>(l, c);
    rotate_about_z(l, rotations.last, c + l);
}

/// Rotates bands 1 and 2 by the elements of the matrix, as a vector and as a traceless quadratic form. `r` is
/// column-major.
template <class Value>
[[gnu::always_inline]] inline void rotate_vector(const glm::dmat3& r, Value* c) {
    const Value x = -c[3], y = -c[1], z = c[2];
    c[3] = -(r[0][0] * x + r[1][0] * y + r[2][0] * z);
    c[1] = -(r[0][1] * x + r[1][1] * y + r[2][1] * z);
    c[2] = r[0][2] * x + r[1][2] * y + r[2][2] * z;
}

template <class Value>
[[gnu::always_inline]] inline void rotate_and_update(const glm::dmat3& r, Value* c) {
    constexpr double kThird = 0.57735026918962576451; // sqrt(1/3)
    const Value xy = c[4], yz = -c[5], xz = -c[7], part = kThird * c[6], xx = c[8] - part, yy = -c[8] - part,
                zz = 2 * part;
    // Columns of Q R^T; R Q R^T then requires only five elements.
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
    c[8] = first + 0.5 * last; // (xx - yy) / 2, because the trace is 0
}

/// Rotates band by band, so that the code of each band exists once for all orders.
template <class Value>
[[gnu::always_inline]] inline void rotate_high_bands(int order, const Rotations& rotations, Value* c) {
    for (int l = kFirstRotatedBand; l < std::min(order, kFirstListedBand); ++l)
        with_order(
            l, [&]<int L>() __attribute__((always_inline)) {
                if constexpr (L >= kFirstRotatedBand && L < kFirstListedBand)
                    rotate_band<static_cast<std::size_t>(L)>(rotations, c + L * L);
            });
    for (int l = kFirstListedBand; l < order; ++l)
        rotate_listed_band(l, rotations, c + l * l);
}

PRT_TWO_CLONES
void rotate(int order, const glm::dmat3& matrix, const Rotations& rotations, Channels* c) {
    if (order > 1)
        rotate_vector(matrix, c);
    if (order > 2)
        rotate_and_update(matrix, c);
    rotate_high_bands(order, rotations, c);
}

/// Rotates one channel. `in` and `out` hold all coefficients of the order, and at least 36 if it is above 3.
template <class Real>
[[gnu::always_inline]] inline void rotate_one_channel(int order, const glm::dmat3& matrix,
                                                      const Rotations& rotations, const Real* in, Real* out) {
    double c[9];
    out[0] = in[0];
    if (order > 1) {
#pragma GCC unroll 8
        for (int i = 1; i < 4; ++i)
            c[i] = static_cast<double>(in[i]);
        rotate_vector(matrix, c);
#pragma GCC unroll 8
        for (int i = 1; i < 4; ++i)
            out[i] = static_cast<Real>(c[i]);
    }
    if (order == 3) {
#pragma GCC unroll 8
        for (int i = 4; i < 9; ++i)
            c[i] = static_cast<double>(in[i]);
        rotate_and_update(matrix, c);
#pragma GCC unroll 8
        for (int i = 4; i < 9; ++i)
            out[i] = static_cast<Real>(c[i]);
    } else if (order > 3) {
        rotate_lanes(rotations, in, out);
    }
}

PRT_TWO_CLONES
void rotate_floats(int order, const glm::dmat3& matrix, const Rotations& rotations, const float* in,
                   float* out) {
    rotate_one_channel(order, matrix, rotations, in, out);
}

void rotate_low_bands(int order, const glm::dmat3& matrix, const Rotations& rotations, const float* in,
                      float* out) {
    rotate_floats(order, matrix, rotations, in, out);
}

void rotate_low_bands(int order, const glm::dmat3& matrix, const Rotations& rotations, const double* in,
                      double* out) {
    rotate_one_channel(order, matrix, rotations, in, out);
}

/// Rotates in a zero-padded buffer; lanes of missing bands rotate zeros.
template <std::size_t Count, class Real>
void rotate_padded(int order, const glm::dmat3& matrix, const Rotations& rotations, const Real* in,
                   Real* out) {
    Real padded[kLaneOrder * kLaneOrder] = {};
    std::copy_n(in, Count, padded);
    rotate_low_bands(order, matrix, rotations, padded, padded);
    std::copy_n(padded, Count, out);
}

template <class Real>
void rotate_one(int order, const glm::dmat3& matrix, const Rotations& rotations, std::span<const Real> in,
                std::span<Real> out) {
    assert(std::min(in.size(), out.size()) >= static_cast<std::size_t>(coefficient_count(order)));
    if (order == 4)
        return rotate_padded<16>(order, matrix, rotations, in.data(), out.data());
    if (order == 5)
        return rotate_padded<25>(order, matrix, rotations, in.data(), out.data());
    rotate_low_bands(order, matrix, rotations, in.data(), out.data());
    for (int l = kFirstListedBand; l < order; ++l) {
        double c[2 * kMaxOrder - 1];
        const auto width = static_cast<std::size_t>(2 * l + 1), first = static_cast<std::size_t>(l * l);
        for (std::size_t i = 0; i < width; ++i)
            c[i] = static_cast<double>(in[first + i]);
        rotate_listed_band(l, rotations, c);
        for (std::size_t i = 0; i < width; ++i)
            out[first + i] = static_cast<Real>(c[i]);
    }
}

[[gnu::always_inline]] inline void set_rotation(int order, double c, double s, Rotation& rotation) {
    double *cosine = &rotation.cosine[Rotation::kZero], *sine = &rotation.sine[Rotation::kZero];
#pragma GCC unroll 3
    for (std::size_t i = 0; i < Rotation::kZero; ++i)
        rotation.cosine[i] = rotation.sine[i] = 0;
    cosine[0] = 1;
    sine[0] = 0;
    cosine[1] = c;
    sine[1] = s;
    const auto add = [&](int m)
        __attribute__((always_inline)) { // computed from halves, which shortens the dependency chain
        const int a = m / 2, b = m - a;
        cosine[m] = cosine[a] * cosine[b] - sine[a] * sine[b];
        sine[m] = cosine[a] * sine[b] + sine[a] * cosine[b];
    };
#pragma GCC unroll 4
    for (int m = 2; m < kLaneOrder; ++m)
        add(m);
    for (int m = kLaneOrder; m < order; ++m)
        add(m);
}

/// Decomposes a rotation that is orthonormal to rounding.
PRT_TWO_CLONES
void set_rotations(int order, const glm::dmat3& r, Rotations& rotations) {
    // GLM is column-major: r[column][row]. The last rotation maps the tilt plane to the azimuth of the
    // rotated z axis. The first is read from the second row of the remainder, which is well conditioned even
    // for a small tilt.
    const double tilt = std::sqrt(r[2][0] * r[2][0] + r[2][1] * r[2][1]);
    const double inverse = tilt > 0 ? 1 / tilt : 0, cosine = tilt > 0 ? r[2][0] * inverse : 1,
                 sine = r[2][1] * inverse;
    set_rotation(order, cosine * r[1][1] - sine * r[1][0], cosine * r[0][1] - sine * r[0][0],
                 rotations.first);
    set_rotation(order, r[2][2], tilt, rotations.tilt);
    set_rotation(order, cosine, sine, rotations.last);
    rotations.tilted = tilt > 0 || r[2][2] < 0; // otherwise `last` is the identity
}

glm::dmat3 matrix_of(const glm::dquat& q) {
    if (!(std::abs(glm::dot(q, q) - 1) <= kRotationTolerance))
        throw Error("the quaternion is not a rotation: its length is not 1");
    return glm::mat3_cast(glm::normalize(q));
}

} // namespace

ShRotation::ShRotation(int order, const glm::dmat3& rotation)
    : order_((check_order(order), order)), matrix_(rotation) {
    make_rotation(rotation, matrix_);
    if (order > kFirstRotatedBand)
        set_rotations(order, matrix_, rotations_);
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
    set_rotation(order, cosine, sine, result.rotations_.first);
    result.rotations_.tilted = false;
    return result;
}

void ShRotation::apply(std::span<const float> in, std::span<float> out) const {
    rotate_one(order_, matrix_, rotations_, in, out);
}

void ShRotation::apply(std::span<const double> in, std::span<double> out) const {
    rotate_one(order_, matrix_, rotations_, in, out);
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
    rotate(order_, matrix_, rotations_, c);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = {static_cast<float>(c[i][0]), static_cast<float>(c[i][1]), static_cast<float>(c[i][2])};
}

} // namespace prt
