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
#include <cstring>
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
        const double cosine = turn.cosine[Turn::kZero + static_cast<std::size_t>(m)],
                     sine = turn.sine[Turn::kZero + static_cast<std::size_t>(m)];
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

/// Bands 2 to 5 side by side, one to a lane. Counted from the top, k = l - |m|, the quarter turns of all
/// bands have their zeros in the same places.
using Bands = Channels;
constexpr std::size_t kLanes = 4, kFirstLane = 2, kDegrees = kFirstLane + kLanes;
constexpr int kLaneOrder = static_cast<int>(kDegrees);

/// At [0][k] what belongs to m = l - k, at [1][k] what belongs to -m. Where k > l nothing does, and what
/// stands there meets factors of 0.
struct Sides {
    Bands at[2][kDegrees];
};

constexpr std::size_t place_in_band(std::size_t l, bool minus, std::size_t k) {
    return minus ? k : 2 * l - k;
}

/// Of the quarter turn of band l.
template <bool Inverse>
consteval double lane_factor(std::size_t l, bool to_minus, std::size_t to, bool from_minus,
                             std::size_t from) {
    if (to > l || from > l || (to_minus && to == l) || (from_minus && from == l))
        return 0;
    const std::size_t row = place_in_band(l, to_minus, to), column = place_in_band(l, from_minus, from);
    return Inverse ? kQuarterTurn.at(l, column, row) : kQuarterTurn.at(l, row, column);
}

template <bool Inverse, bool ToMinus, std::size_t To, std::size_t... From>
[[gnu::always_inline]] inline Bands turned_lanes(const Sides& c, std::index_sequence<From...>) {
    Bands sum{};
    const auto add = [&]<bool Minus, std::size_t K>() __attribute__((always_inline)) {
        constexpr Bands factor = {
            lane_factor<Inverse>(2, ToMinus, To, Minus, K), lane_factor<Inverse>(3, ToMinus, To, Minus, K),
            lane_factor<Inverse>(4, ToMinus, To, Minus, K), lane_factor<Inverse>(5, ToMinus, To, Minus, K)};
        if constexpr (factor[0] != 0 || factor[1] != 0 || factor[2] != 0 || factor[3] != 0)
            sum += factor * c.at[Minus][K];
    };
    (add.template operator()<false, From>(), ...);
    (add.template operator()<true, From>(), ...);
    return sum;
}

template <bool Inverse, std::size_t... K>
[[gnu::always_inline]] inline void quarter_turn_lanes(Sides& c, std::index_sequence<K...> all) {
    c = {{{turned_lanes<Inverse, false, K>(c, all)...}, {turned_lanes<Inverse, true, K>(c, all)...}}};
}

[[gnu::always_inline]] inline void turn_lanes_about_z(const Turn& turn, Sides& c) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kDegrees; ++k) {
        Bands cosine, sine;
        std::memcpy(&cosine, &turn.cosine[Turn::kZero + kFirstLane - k], sizeof cosine);
        std::memcpy(&sine, &turn.sine[Turn::kZero + kFirstLane - k], sizeof sine);
        const Bands plus = c.at[0][k], minus = c.at[1][k];
        c.at[0][k] = plus * cosine - minus * sine;
        c.at[1][k] = plus * sine + minus * cosine;
    }
}

/// Bands 2 to 5 of `in` to `out`, both [36].
template <class Real>
[[gnu::always_inline]] inline void rotate_lanes(const Turns& turns, const Real* in, Real* out) {
    using Four [[gnu::vector_size(sizeof(Real) * kLanes)]] = Real;
    constexpr auto all = std::make_index_sequence<kDegrees>();
    Sides c;
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kDegrees; ++k) {
        const auto from = [&](std::size_t l, bool minus) __attribute__((always_inline)) {
            return k <= l ? in[l * l + place_in_band(l, minus, k)] : Real(0);
        };
        c.at[0][k] = __builtin_convertvector(
            (Four{from(2, false), from(3, false), from(4, false), from(5, false)}), Bands);
        c.at[1][k] = __builtin_convertvector(
            (Four{from(2, true), from(3, true), from(4, true), from(5, true)}), Bands);
    }
    turn_lanes_about_z(turns.first, c);
    if (turns.tilted) {
        quarter_turn_lanes<false>(c, all);
        turn_lanes_about_z(turns.tilt, c);
        quarter_turn_lanes<true>(c, all);
        turn_lanes_about_z(turns.last, c);
    }
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kDegrees; ++k) {
        const Four plus = __builtin_convertvector(c.at[0][k], Four),
                   minus = __builtin_convertvector(c.at[1][k], Four);
#pragma GCC unroll 4
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t l = kFirstLane + lane;
            if (k < l)
                out[l * l + place_in_band(l, true, k)] = minus[lane];
            if (k <= l)
                out[l * l + place_in_band(l, false, k)] = plus[lane];
        }
    }
}

/// `in` and `out` hold all that the order has, and no less than 36 where it is above 3.
template <class Real>
[[gnu::always_inline]] inline void rotate_one_channel(int order, const glm::dmat3& matrix, const Turns& turns,
                                                      const Real* in, Real* out) {
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
        rotate_form(matrix, c);
#pragma GCC unroll 8
        for (int i = 4; i < 9; ++i)
            out[i] = static_cast<Real>(c[i]);
    } else if (order > 3) {
        rotate_lanes(turns, in, out);
    }
}

PRT_TWO_CLONES
void rotate_floats(int order, const glm::dmat3& matrix, const Turns& turns, const float* in, float* out) {
    rotate_one_channel(order, matrix, turns, in, out);
}

void rotate_low_bands(int order, const glm::dmat3& matrix, const Turns& turns, const float* in, float* out) {
    rotate_floats(order, matrix, turns, in, out);
}

void rotate_low_bands(int order, const glm::dmat3& matrix, const Turns& turns, const double* in,
                      double* out) {
    rotate_one_channel(order, matrix, turns, in, out);
}

/// Where bands are missing, their lanes turn zeros.
template <std::size_t Count, class Real>
void rotate_padded(int order, const glm::dmat3& matrix, const Turns& turns, const Real* in, Real* out) {
    Real padded[kLaneOrder * kLaneOrder] = {};
    std::copy_n(in, Count, padded);
    rotate_low_bands(order, matrix, turns, padded, padded);
    std::copy_n(padded, Count, out);
}

template <class Real>
void rotate_one(int order, const glm::dmat3& matrix, const Turns& turns, std::span<const Real> in,
                std::span<Real> out) {
    assert(std::min(in.size(), out.size()) >= static_cast<std::size_t>(coefficient_count(order)));
    if (order == 4)
        return rotate_padded<16>(order, matrix, turns, in.data(), out.data());
    if (order == 5)
        return rotate_padded<25>(order, matrix, turns, in.data(), out.data());
    rotate_low_bands(order, matrix, turns, in.data(), out.data());
    for (int l = kFirstListedBand; l < order; ++l) {
        double c[2 * kMaxOrder - 1];
        const auto width = static_cast<std::size_t>(2 * l + 1), first = static_cast<std::size_t>(l * l);
        for (std::size_t i = 0; i < width; ++i)
            c[i] = static_cast<double>(in[first + i]);
        rotate_listed_band(l, turns, c);
        for (std::size_t i = 0; i < width; ++i)
            out[first + i] = static_cast<Real>(c[i]);
    }
}

[[gnu::always_inline]] inline double product(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// What the elements of R^T R - 1 are.
struct Deviation {
    double xx, yy, zz, xy, yz, xz;

    explicit Deviation(const glm::dmat3& r)
        : xx(product(r[0], r[0]) - 1), yy(product(r[1], r[1]) - 1), zz(product(r[2], r[2]) - 1),
          xy(product(r[0], r[1])), yz(product(r[1], r[2])), xz(product(r[0], r[2])) {}

    bool within(double allowed) const {
        return std::ranges::all_of(std::array{xx, yy, zz, xy, yz, xz},
                                   [&](double off) { return std::abs(off) <= allowed; }); // nor is NaN
    }
};

/// A step of Newton's iteration for the polar decomposition, R (3 - R^T R) / 2, which squares what is off.
glm::dmat3 nearer_rotation(const glm::dmat3& r, const Deviation& d) {
    const glm::dvec3 &x = r[0], &y = r[1], &z = r[2];
    return {x - 0.5 * (d.xx * x + d.xy * y + d.xz * z), y - 0.5 * (d.xy * x + d.yy * y + d.yz * z),
            z - 0.5 * (d.xz * x + d.yz * y + d.zz * z)};
}

/// Squares of what is off that a matrix of doubles has by rounding, and that one of floats has.
constexpr double kDoubleRounding = 1e-28, kFloatRounding = 1e-13;

/// Makes `result`, a copy of `r`, a rotation where `r` is off by no more than the rounding of floats; else
/// returns false. Of a rotation the first two columns are orthonormal and the third is their product.
PRT_TWO_CLONES
bool made_rotation(const glm::dmat3& r, glm::dmat3& result) {
    const glm::dvec3 &x = r[0], &y = r[1];
    const double xx = product(x, x) - 1, yy = product(y, y) - 1, xy = product(x, y);
    const glm::dvec3 off = r[2] - cross(x, y);
    const double squares = (xx * xx + yy * yy) + (xy * xy + product(off, off));
    if (!(squares < kFloatRounding)) // nor is NaN
        return false;
    if (squares >= kDoubleRounding) {
        result[0] = x - 0.5 * (xx * x + xy * y);
        result[1] = y - 0.5 * (xy * x + yy * y);
        result[2] = cross(result[0], result[1]);
    }
    return true;
}

/// Checks `r`, and makes `result`, a copy of it, the rotation next to it.
void make_rotation(const glm::dmat3& r, glm::dmat3& result) {
    if (made_rotation(r, result))
        return;
    if (!Deviation(r).within(kRotationTolerance))
        throw Error("a matrix that scales, shears or is not finite is no rotation of lighting");
    if (glm::dot(glm::cross(r[0], r[1]), r[2]) < 0)
        throw Error(
            "a mirrored matrix is no rotation: take the mirroring out of it, and bake the mirrored mesh");
    do {
        const glm::dmat3 before = result;
        result = nearer_rotation(before, Deviation(before));
    } while (!made_rotation(glm::dmat3(result), result));
}

[[gnu::always_inline]] inline void set_turn(int order, double c, double s, Turn& turn) {
    double *cosine = &turn.cosine[Turn::kZero], *sine = &turn.sine[Turn::kZero];
#pragma GCC unroll 3
    for (std::size_t i = 0; i < Turn::kZero; ++i)
        turn.cosine[i] = turn.sine[i] = 0;
    cosine[0] = 1;
    sine[0] = 0;
    cosine[1] = c;
    sine[1] = s;
    const auto add = [&](int m)
        __attribute__((always_inline)) { // from the halves, which hardly wait for each other
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

/// Of a rotation that holds to rounding.
PRT_TWO_CLONES
void set_turns(int order, const glm::dmat3& r, Turns& turns) {
    // GLM is column-major: r[column][row]. The last turn takes +y's tilt plane to where z went; the first is
    // then read from the second row of what is left, which is well conditioned even where z hardly moved.
    const double tilt = std::sqrt(r[2][0] * r[2][0] + r[2][1] * r[2][1]);
    const double inverse = tilt > 0 ? 1 / tilt : 0, cosine = tilt > 0 ? r[2][0] * inverse : 1,
                 sine = r[2][1] * inverse;
    set_turn(order, cosine * r[1][1] - sine * r[1][0], cosine * r[0][1] - sine * r[0][0], turns.first);
    set_turn(order, r[2][2], tilt, turns.tilt);
    set_turn(order, cosine, sine, turns.last);
    turns.tilted = tilt > 0 || r[2][2] < 0; // else last is the identity
}

glm::dmat3 matrix_of(const glm::dquat& q) {
    if (!(std::abs(glm::dot(q, q) - 1) <= kRotationTolerance))
        throw Error("a quaternion whose length is not 1 is no rotation");
    return glm::mat3_cast(glm::normalize(q));
}

} // namespace

ShRotation::ShRotation(int order, const glm::dmat3& rotation)
    : order_((check_order(order), order)), matrix_(rotation) {
    make_rotation(rotation, matrix_);
    if (order > kFirstTurnedBand)
        set_turns(order, matrix_, turns_);
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
    set_turn(order, cosine, sine, result.turns_.first);
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
