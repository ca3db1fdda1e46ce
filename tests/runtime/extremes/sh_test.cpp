// Tests spherical harmonics with invalid numbers. Rotations reject invalid matrices. All other functions are
// arithmetic on vectors, which prt/core/sh.h and prt/core/sh.h document as unchecked: non-finite values
// propagate, and the functions must only terminate and stay within their arrays (checked by the sanitizers).

#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "support/extremes.h"

#include <climits>

namespace prt {
namespace {

using test::ExtremeCase;
using test::Numbers;

/// Returns a rotated function of finite coefficients.
Numbers rotated(int order, const ShRotation& rotation) {
    std::vector<double> function(static_cast<std::size_t>(order * order), 0.5), result(function.size());
    rotation.apply(std::span<const double>(function), std::span<double>(result));
    return result;
}

const ExtremeCase kRotations[] = {
    {"matrix",
     [](int n, float x, float y) {
         glm::dmat3 matrix(1);
         matrix[0][0] = static_cast<double>(x);
         matrix[2][1] = static_cast<double>(y);
         return rotated(n, ShRotation(n, matrix));
     }},
    {"quaternion",
     [](int n, float x, float y) {
         return rotated(n, ShRotation(n, glm::dquat(static_cast<double>(x), 0, static_cast<double>(y), 0)));
     }},
    {"about_x",
     [](int n, float x, float) { return rotated(n, ShRotation::about_x(n, static_cast<double>(x))); }},
    {"about_y",
     [](int n, float x, float) { return rotated(n, ShRotation::about_y(n, static_cast<double>(x))); }},
    {"about_z",
     [](int n, float x, float) { return rotated(n, ShRotation::about_z(n, static_cast<double>(x))); }},
    {"windows",
     [](int n, float x, float) {
         const auto width = static_cast<double>(x);
         return Numbers{hann_window(n - 1, width), lanczos_window(n - 1, width)};
     }},
};

class Rotation : public testing::TestWithParam<ExtremeCase> {};
INSTANTIATE_TEST_SUITE_P(Functions, Rotation, testing::ValuesIn(kRotations), test::name_of);
TEST_P(Rotation, IsFiniteOrRejected) {
    test::expect_finite_or_refused(GetParam());
}

TEST(Order, OutsideItsRangeIsRejected) {
    for (const int order : {INT_MIN, -1, 0, kMaxOrder + 1, INT_MAX}) {
        EXPECT_THROW(check_order(order), Error) << order;
        EXPECT_THROW(ShRotation(order, glm::dmat3(1)), Error) << order;
        EXPECT_THROW(ShRotation::about_z(order, 1), Error) << order;
    }
}

/// Runs all arithmetic of an order on two functions, with arrays of exact size. Returns the sum of the last
/// result.
double arithmetic(int order, float x, float y) {
    const auto count = static_cast<std::size_t>(order * order);
    const std::vector<float> a(count, x), b(count, y);
    std::vector<float> out(count);
    const std::span<float> to(out);
    evaluate_sh(order, glm::vec3(x, y, 0), to);
    evaluate_sh(order, std::vector<glm::vec3>(1, glm::vec3(x, y, 0)), to);
    evaluate_sh(order, std::span<const glm::vec3>(), to.first(0));
    sh_add(std::span(a), b, to);
    sh_scale(std::span(a), y, to);
    ShRotation(order, glm::dmat3(1)).apply(a, to);
    flip_condon_shortley(order, to);
    sh_product(order, a, b, to);
    std::vector<double> wide(count, static_cast<double>(x)), matrix(count * count);
    clamped_cosine_lobe(order, {static_cast<double>(x), static_cast<double>(y), 0}, wide);
    sh_product_matrix(order, std::vector<double>(count, static_cast<double>(y)), matrix);
    double sum = matrix.back() + static_cast<double>(sh_dot(std::span(a), b)) +
                 static_cast<double>(sh_value(order, a, {0, 0, 1}));
    for (const float value : out)
        sum += static_cast<double>(value);
    return sum;
}

TEST(ShArithmetic, StaysWithinItsArraysForAllNumbers) {
    test::for_each_extreme([](int order, float x, float y) { arithmetic(order, x, y); });
    for (const int order : {1, 10}) {
        EXPECT_TRUE(std::isfinite(arithmetic(order, 1e-45f, -0.0f)));
        EXPECT_TRUE(std::isfinite(arithmetic(order, 1, 1e15f)));
        EXPECT_FALSE(
            std::isfinite(arithmetic(order, test::kExtremes[0], 1))); // shows that the value propagates
    }
}

} // namespace
} // namespace prt
