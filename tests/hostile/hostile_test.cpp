// Tests shipped files with damage at every position: each is rejected with a one-line error, or its results
// are finite. PRTKIT_HOSTILE_CASES replaces the small default number of cases, starting with
// PRTKIT_HOSTILE_FIRST.

#include "damage.h"
#include "fuzz/target.h"
#include "fuzz/whole_model.h"
#include "prt/core/cluster_lighting.h"
#include "prt/prt.h"
#include "prt/shader/shader_source.h"
#include "shipped_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace prt::test {
namespace {

std::uint32_t number_from(const char* name, std::uint32_t otherwise) {
    const char* text = std::getenv(name);
    return text ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : otherwise;
}

/// Uses a shipped file as a program does. Returns true if its receivers are vertices. Throws `Error` if it is
/// rejected, and fuzz::Finding.
bool use(std::span<const std::byte> bytes) {
    const fuzz::WholeModel model = fuzz::read_whole(bytes, "damaged.glb");
    if (model.lightmap) {
        const ClusteredTransfer& of_texels = model.lightmap->compressed.transfer;
        fuzz::expect_finite_light(*model.lightmap);
        fuzz::expect(!lightmap_shader(of_texels, ConstantSource::texture, ShaderLanguage::essl300).empty(),
                     "a shader is empty");
    }
    if (!model.compressed)
        return !model.lightmap;
    const ClusteredTransfer& transfer = model.compressed->transfer;
    fuzz::expect_finite_light(transfer);
    fuzz::expect(
        !relight_shader(transfer, ConstantSource::texture, ShaderLanguage::essl300, model.scene.origin)
             .empty(),
        "a shader is empty");
    return true;
}

/// Uses a file through the C interface. Returns true if the model was read.
bool use_in_c(std::span<const std::byte> bytes) {
    prt_model* model = nullptr;
    prt_message message = {};
    if (prt_model_load_memory(bytes.data(), bytes.size(), &model, &message) != PRT_OK) {
        fuzz::expect_plain(message.text);
        fuzz::expect(model == nullptr, "a rejected model is not null");
        return false;
    }
    prt_model_info info;
    EXPECT_EQ(prt_model_get_info(model, &info, nullptr), PRT_OK);
    std::vector<float> light(3 * static_cast<std::size_t>(info.order * info.order), 0.5f);
    std::vector<float> constants(4 * info.rows), radiance(3 * info.receivers);
    EXPECT_EQ(prt_model_update_constants(model, info.order, light.data(), constants.data(), &message), PRT_OK)
        << message.text;
    fuzz::expect_finite(std::span<const float>(constants), "constants in C");
    EXPECT_EQ(prt_model_evaluate(model, constants.data(), radiance.data(), &message), PRT_OK) << message.text;
    fuzz::expect_finite(std::span<const float>(radiance), "exit radiance in C");
    prt_model_destroy(model);
    return true;
}

/// Returns true if the C++ interface of the tools read the file. The C interface then reads it too. It reads
/// some files that the tools refuse, because it needs fewer data: no textures, for example.
bool is_read(const std::string& file) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
    bool read = true, of_vertices = true; // the C interface supports only vertices
    fuzz::take([&] { fuzz::use_loaded(bytes, "damaged.glb"); });
    try {
        of_vertices = use(bytes);
    } catch (const Error& error) {
        fuzz::expect_plain(error.what());
        read = false;
    }
    EXPECT_TRUE(use_in_c(bytes) || !read || !of_vertices);
    return read;
}

TEST(HostileShippedFiles, AreReadWithoutDamage) {
    for (const ShippedFile& shipped : shipped_files())
        EXPECT_TRUE(is_read(shipped.file.bytes())) << shipped.name;
}

TEST(HostileShippedFiles, AreRejectedInOneLineOrDecodedToFiniteNumbers) {
    const std::vector<ShippedFile> files = shipped_files();
    const std::uint32_t first = number_from("PRTKIT_HOSTILE_FIRST", 0),
                        cases = number_from("PRTKIT_HOSTILE_CASES", 1200);
    std::size_t read = 0;
    for (std::uint32_t seed = first; seed < first + cases; ++seed) {
        const ShippedFile& shipped = files[seed % files.size()];
        SCOPED_TRACE(shipped.name + ", seed " + std::to_string(seed));
        try {
            read += is_read(damaged(shipped.file, seed).bytes()) ? 1 : 0;
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    }
    // Some files are read, others are rejected.
    EXPECT_GT(read, cases / 20);
    EXPECT_LT(read, cases - cases / 4);
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    RecordProperty("megabytes", std::to_string(usage.ru_maxrss / 1000));
    std::printf("%u cases, %zu read, at most %ld MB\n", cases, read, usage.ru_maxrss / 1000);
    EXPECT_LT(usage.ru_maxrss, 1'000'000); // kilobytes; a file of these sizes may need 256 MB at a time
}

} // namespace
} // namespace prt::test
