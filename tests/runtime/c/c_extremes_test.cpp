// Tests the C interface with invalid numbers: its output is finite, or it returns PRT_BAD_ARGUMENT.

#include "prt/prt.h"
#include "support/extremes.h"
#include "support/lit_model.h"

namespace prt {
namespace {

using test::ExtremeCase;
using test::Numbers;

/// Returns the values written to `to`, or throws `Error` if the function rejected its arguments. Other status
/// codes are failures.
template <class Values>
Numbers written(prt_status status, const prt_message& message, const Values& to) {
    if (status == PRT_BAD_ARGUMENT)
        throw Error(message.text);
    EXPECT_EQ(status, PRT_OK) << message.text;
    return Numbers(to.begin(), to.end());
}

/// Calls `make(to, message)` with space for `count` numbers.
template <class Make>
Numbers made(std::size_t count, Make&& make) {
    std::vector<float> to(count, 0.0f);
    prt_message message;
    const prt_status status = make(to.data(), &message);
    return written(status, message, to);
}

std::size_t square(int order) {
    return static_cast<std::size_t>(order * order);
}

constexpr float kUp[3] = {0, 1, 0}, kDown[3] = {0, -1, 0}, kAbove[3] = {0, 3, 0}, kWhite[3] = {1, 1, 1};

const ExtremeCase kFunctions[] = {
    {"evaluate",
     [](int n, float x, float y) {
         const float direction[3] = {x, y, 0};
         return made(square(n),
                     [&](float* to, prt_message* m) { return prt_sh_evaluate(n, direction, to, m); });
     }},
    {"multiply",
     [](int n, float x, float y) {
         const std::vector<float> a(square(n), x), b(square(n), y);
         return made(square(n), [&](float* to, prt_message* m) {
             return prt_sh_multiply(n, a.data(), b.data(), to, m);
         });
     }},
    {"rotate",
     [](int n, float x, float y) {
         const std::vector<float> in(square(n), y);
         const float matrix[9] = {x, 0, 0, 0, 1, 0, 0, 0, 1};
         return made(square(n),
                     [&](float* to, prt_message* m) { return prt_sh_rotate(n, matrix, in.data(), to, m); });
     }},
    {"constant",
     [](int n, float x, float y) {
         const float color[3] = {x, y, 1};
         return made(3 * square(n),
                     [&](float* to, prt_message* m) { return prt_light_constant(n, color, to, m); });
     }},
    {"directional",
     [](int n, float x, float y) {
         const float direction[3] = {x, 0, 1}, color[3] = {y, 1, 1};
         return made(3 * square(n), [&](float* to, prt_message* m) {
             return prt_light_directional(n, direction, color, to, m);
         });
     }},
    {"cone",
     [](int n, float x, float y) {
         const float color[3] = {y, 1, 1};
         return made(3 * square(n),
                     [&](float* to, prt_message* m) { return prt_light_cone(n, kUp, x, color, to, m); });
     }},
    {"sphere",
     [](int n, float x, float y) {
         const float center[3] = {0, 3, x};
         return made(3 * square(n), [&](float* to, prt_message* m) {
             return prt_light_sphere(n, center, y, kWhite, to, m);
         });
     }},
    {"disc",
     [](int n, float x, float y) {
         const float normal[3] = {x, -1, 0};
         return made(3 * square(n), [&](float* to, prt_message* m) {
             return prt_light_disc(n, kAbove, normal, y, kWhite, to, m);
         });
     }},
    {"hemisphere",
     [](int n, float x, float y) {
         const float top[3] = {x, 0, 1}, bottom[3] = {0, y, 1};
         return made(3 * square(n), [&](float* to, prt_message* m) {
             return prt_light_hemisphere(n, kDown, top, bottom, to, m);
         });
     }},
    {"lat_long",
     [](int n, float x, float y) {
         const float pixels[6] = {x, 0, 1, 0, y, 1};
         const prt_image image = {2, 1, pixels};
         return made(3 * square(n), [&](float* to, prt_message* m) {
             return prt_light_from_lat_long(n, &image, PRT_CENTER_Z, 1, to, m);
         });
     }},
    {"rotate_light",
     [](int n, float x, float y) {
         const float rotation[9] = {y, 0, 0, 0, y, 0, 0, 0, y};
         return made(3 * square(n), [&](float* to, prt_message* m) {
             std::fill_n(to, 3 * square(n), 0.5f);
             to[0] = x;
             const prt_status status = prt_light_rotate(n, rotation, to, m);
             EXPECT_TRUE(status == PRT_OK || to[3 * square(n) - 1] == (n == 1 ? to[2] : 0.5f)); // unchanged
             return status;
         });
     }},
    {"dering",
     [](int n, float x, float y) {
         return made(3 * square(n), [&](float* to, prt_message* m) {
             std::fill_n(to, 3 * square(n), 0.5f);
             to[0] = x;
             to[3 * square(n) - 1] = y;
             return prt_light_dering(n, to, m);
         });
     }},
};

class CInterface : public testing::TestWithParam<ExtremeCase> {};
INSTANTIATE_TEST_SUITE_P(Functions, CInterface, testing::ValuesIn(kFunctions), test::name_of);
TEST_P(CInterface, WritesFiniteNumbersOrRejects) {
    test::expect_finite_or_refused(GetParam());
}

TEST(CModel, WritesFiniteNumbersOrRejects) {
    const std::vector<std::byte> file = test::lit_model();
    prt_model* model = nullptr;
    prt_message message;
    ASSERT_EQ(prt_model_load_memory(file.data(), file.size(), &model, &message), PRT_OK) << message.text;
    prt_model_info info;
    ASSERT_EQ(prt_model_get_info(model, &info, nullptr), PRT_OK);
    test::expect_finite_or_refused({"constants", [&](int, float x, float y) {
                                        std::vector<float> light(27, y);
                                        light[0] = x;
                                        return made(4 * info.rows, [&](float* to, prt_message* m) {
                                            return prt_model_update_constants(model, 3, light.data(), to, m);
                                        });
                                    }});
    test::expect_finite_or_refused({"radiance", [&](int, float x, float y) {
                                        std::vector<float> constants(4 * info.rows, y);
                                        constants[0] = x;
                                        return made(3 * info.receivers, [&](float* to, prt_message* m) {
                                            return prt_model_evaluate(model, constants.data(), to, m);
                                        });
                                    }});
    prt_model_destroy(model);
}

} // namespace
} // namespace prt
