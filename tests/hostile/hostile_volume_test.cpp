// Tests files with damaged volumes through the C interface: each is rejected with a one-line error, or its
// constants and lookups are finite.

#include "damage.h"
#include "fuzz/target.h"
#include "fuzz/whole_model.h"
#include "prt/prt.h"
#include "shipped_files.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace prt::test {
namespace {

/// Returns true if the volume was read.
bool use(const std::string& file) {
    prt_volume* volume = nullptr;
    prt_message message = {};
    if (prt_volume_load_memory(file.data(), file.size(), &volume, &message) != PRT_OK) {
        fuzz::expect_plain(message.text);
        fuzz::expect(volume == nullptr, "a rejected volume is not null");
        return false;
    }
    prt_volume_info info;
    prt_volume_textures textures;
    EXPECT_EQ(prt_volume_get_info(volume, &info, nullptr), PRT_OK);
    EXPECT_EQ(prt_volume_get_textures(volume, &textures, nullptr), PRT_OK);
    const auto coefficients = static_cast<std::size_t>(info.incident_order * info.incident_order);
    const std::vector<float> light(3 * static_cast<std::size_t>(info.order * info.order), 0.5f);
    std::vector<float> constants(4 * info.rows), incident(3 * coefficients * info.probes),
        found(3 * coefficients);
    std::vector<std::byte> texels(textures.light_bytes);
    const float up[3] = {0, 1, 0};
    const prt_lighting lighting{info.order, light.data(), nullptr, nullptr, up};
    EXPECT_EQ(prt_volume_update_constants(volume, &lighting, constants.data(), &message), PRT_OK)
        << message.text;
    EXPECT_EQ(prt_volume_update_light(volume, constants.data(), 0, info.probes, texels.data(), &message),
              PRT_OK);
    EXPECT_EQ(prt_volume_evaluate(volume, constants.data(), incident.data(), &message), PRT_OK);
    fuzz::expect_finite(std::span<const float>(incident), "incident light");
    for (int i = 0; i < 27; ++i) {
        prt_volume_position point{{0, 0, 0}, {0, 1, 0}};
        for (int a = 0; a < 3; ++a)
            point.position[a] = info.corner[a] + 7.5f * info.spacing * static_cast<float>((i + a) % 4 - 1);
        if (prt_volume_incident(volume, incident.data(), &point, found.data(), &message) == PRT_OK)
            fuzz::expect_finite(std::span<const float>(found), "light at a position");
    }
    prt_volume_destroy(volume);
    return true;
}

TEST(HostileVolumes, AreRejectedInOneLineOrComputedToFiniteNumbers) {
    const std::vector<ShippedFile> files = volume_files();
    for (const ShippedFile& shipped : files)
        EXPECT_TRUE(use(shipped.file.bytes()));
    int read = 0;
    constexpr std::uint32_t kCases = 250;
    for (std::uint32_t seed = 0; seed < kCases; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        try {
            const std::string file = damaged(files[seed % 2].file, seed).bytes();
            read += use(file);
            fuzz::take([&] { fuzz::use_loaded(std::as_bytes(std::span(file)), "damaged.glb"); });
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    }
    // Some files are read, others are rejected.
    EXPECT_GT(read, static_cast<int>(kCases / 20));
    EXPECT_LT(read, static_cast<int>(kCases - kCases / 5));
}

} // namespace
} // namespace prt::test
