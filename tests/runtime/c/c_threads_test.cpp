// Tests the C interface from eight threads at once, under the thread sanitizer: each has separate lights,
// messages and models, and all read one common model and one lighting.

#include "prt/prt.h"
#include "support/lit_model.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

namespace prt {
namespace {

constexpr int kThreads = 8, kRounds = 20, kOrder = 3;
constexpr std::size_t kLight = 3 * kOrder * kOrder;
constexpr float kUp[3] = {0, 1, 0}, kWhite[3] = {1, 1, 1}, kNone[3] = {0, 0, 0};
constexpr float kHalfTurn[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1};

/// All results of a thread; they must be equal in each.
struct Seen {
    std::vector<float> light, radiance;
    bool operator==(const Seen&) const = default;
};

std::vector<float> radiance_of(const prt_model* model, const float* light) {
    prt_model_info info;
    EXPECT_EQ(prt_model_get_info(model, &info, nullptr), PRT_OK);
    std::vector<float> constants(4 * info.rows), radiance(3 * info.receivers);
    EXPECT_EQ(prt_model_update_constants(model, kOrder, light, constants.data(), nullptr), PRT_OK);
    EXPECT_EQ(prt_model_evaluate(model, constants.data(), radiance.data(), nullptr), PRT_OK);
    return radiance;
}

/// Creates separate lights in a thread, by every function that makes or changes lights.
std::vector<float> own_light() {
    std::vector<float> light(kLight);
    prt_message message;
    EXPECT_EQ(prt_light_directional(kOrder, kNone, kWhite, light.data(), &message), PRT_BAD_ARGUMENT);
    EXPECT_NE(message.text[0], 0);
    EXPECT_EQ(prt_light_cone(kOrder, kUp, 0.5f, kWhite, light.data(), &message), PRT_OK);
    EXPECT_EQ(message.text[0], 0);
    const float pixels[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    const prt_image image = {4, 1, pixels};
    std::vector<float> sky(kLight);
    EXPECT_EQ(prt_light_from_lat_long(kOrder, &image, PRT_CENTER_Z, 2, sky.data(), &message), PRT_OK);
    EXPECT_EQ(prt_light_rotate(kOrder, kHalfTurn, sky.data(), &message), PRT_OK);
    EXPECT_EQ(prt_light_dering(kOrder, light.data(), &message), PRT_OK);
    std::array<float, kOrder * kOrder> product{}, basis{};
    EXPECT_EQ(prt_sh_evaluate(kOrder, kUp, basis.data(), &message), PRT_OK);
    EXPECT_EQ(prt_sh_multiply(kOrder, basis.data(), basis.data(), product.data(), &message), PRT_OK);
    light.insert(light.end(), sky.begin(), sky.end());
    light.insert(light.end(), product.begin(), product.end());
    return light;
}

Seen work(const std::vector<std::byte>& file, const prt_model* shared, const std::vector<float>& lighting) {
    Seen seen{own_light(), radiance_of(shared, lighting.data())};
    prt_model* own = nullptr;
    prt_message message;
    EXPECT_EQ(prt_model_load_memory(file.data(), file.size(), &own, &message), PRT_OK) << message.text;
    EXPECT_EQ(radiance_of(own, lighting.data()), seen.radiance);
    std::size_t size = 0;
    EXPECT_EQ(prt_model_shader(shared, PRT_GLSL450, PRT_CONSTANTS_IN_BUFFER, nullptr, &size, &message),
              PRT_TOO_SMALL);
    prt_mesh mesh;
    EXPECT_EQ(prt_model_get_mesh(shared, 0, &mesh, &message), PRT_OK);
    prt_model_destroy(own);
    return seen;
}

TEST(CInterface, ServesEightThreadsAtOnce) {
    const std::vector<std::byte> file = test::lit_model();
    prt_model* shared = nullptr;
    ASSERT_EQ(prt_model_load_memory(file.data(), file.size(), &shared, nullptr), PRT_OK);
    std::vector<float> lighting(kLight);
    ASSERT_EQ(prt_light_hemisphere(kOrder, kUp, kWhite, kNone, lighting.data(), nullptr), PRT_OK);

    std::vector<Seen> seen(kThreads);
    std::vector<std::thread> threads;
    for (Seen& own : seen)
        threads.emplace_back([&] {
            for (int round = 0; round < kRounds; ++round)
                own = work(file, shared, lighting);
        });
    for (std::thread& thread : threads)
        thread.join();
    for (const Seen& own : seen)
        EXPECT_EQ(own, seen[0]);
    prt_model_destroy(shared);
}

} // namespace
} // namespace prt
