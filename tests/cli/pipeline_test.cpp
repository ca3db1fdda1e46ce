// Tests the whole pipeline: scene, bake, compress, evaluate, render.

#include "demanding_file.h"
#include "pipeline.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace prt::test {
namespace {

TEST_F(Pipeline, NoticesArePrintedOnceAndReported) {
    GlbFile file = triangle_file();
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {2, 1, 1, 1}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "a.glb");
    const std::string notice = "values clamped to 0..1: baseColorFactor of materials (1)";
    const Outcome bake =
        prt({"bake", at("a.glb"), "-o", at("b.glb"), "--rays", "16", "--json", at("b.json")});
    EXPECT_EQ(bake.err, "prt: note: " + at("a.glb") + ": " + notice + "\n");
    EXPECT_EQ(prt({"info", at("a.glb"), "--json", at("i.json")}).status, 0);
    for (const char* report : {"b.json", "i.json"}) {
        const nlohmann::json notices = read_json(folder / report)["notices"];
        EXPECT_EQ(std::count(notices.begin(), notices.end(), notice), 1) << report;
    }
}

class ExamplePipeline : public Pipeline, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, ExamplePipeline, testing::Values("knot", "room", "terrain", "tree"));

TEST_P(ExamplePipeline, LeadsFromSceneToPictures) {
    copy_examples(folder.path(), {GetParam(), "sky"});
    const std::string scene = at((std::string(GetParam()) + ".glb").c_str());
    const Outcome bake =
        prt({"bake", scene, "-o", at("b.glb"), "--rays", "32", "--order", "4", "--json", at("b.json")});
    ASSERT_EQ(bake.status, 0) << bake.err;
    const auto bake_report = read_json(folder / "b.json");
    EXPECT_EQ(bake_report["order"], 4);
    EXPECT_GT(bake_report["rays_per_second"], 0);
    EXPECT_GT(bake_report["mean_visibility"], 0.05);

    const Outcome compress = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "16",
                                  "--components", "4", "--json", at("c.json")});
    ASSERT_EQ(compress.status, 0) << compress.err;
    const auto compress_report = read_json(folder / "c.json");
    EXPECT_LT(compress_report["relative_l2"], 0.3);
    EXPECT_EQ(compress_report["bytes_bound_per_vertex"], 4); // 4 bits of cluster, 24 of weights
    EXPECT_LE(compress_report["bits_used_per_vertex"], 28);

    const Outcome evaluate = prt({"evaluate", at("b.glb"), at("c.glb"), "--lights", at("sky.exr"), "--json",
                                  at("e.json"), "--report", at("e.html")});
    ASSERT_EQ(evaluate.status, 0) << evaluate.err;
    const auto report = read_json(folder / "e.json");
    EXPECT_NEAR(report["relative_l2"].get<double>(), compress_report["relative_l2"].get<double>(), 1e-9);
    EXPECT_LT(report["lights"][0]["lit_rms"], 0.2);
    EXPECT_GT(std::filesystem::file_size(folder / "e.html"), 1000u);

    for (const char* backend : {"cpu", "gpu"}) {
        const Outcome render = prt({"render", at("c.glb"), "--lights", at("sky.exr"), "-o",
                                    at((std::string(backend) + ".exr").c_str()), "--size", "96x64",
                                    "--samples", "1", "--device", backend});
        ASSERT_EQ(render.status, 0) << render.err;
    }
    const EnvironmentOptions any{EnvironmentLayout::lat_long, BadPixels::error};
    const Image cpu = load_environment(folder / "cpu.exr", any).environment.image,
                gpu = load_environment(folder / "gpu.exr", any).environment.image;
    std::size_t equal = 0;
    for (std::size_t i = 0; i < cpu.pixels.size(); ++i)
        equal +=
            glm::all(glm::lessThan(glm::abs(cpu.pixels[i] - gpu.pixels[i]), 0.01f + 0.01f * cpu.pixels[i]));
    EXPECT_GT(static_cast<double>(equal),
              0.95 * static_cast<double>(cpu.pixels.size())); // the rest are silhouettes

    for (const char* file : {"b.glb", "c.glb"})
        if (validator_errors(folder / file) < 0)
            GTEST_SKIP() << "gltf-validator is not installed";
}
TEST_F(Pipeline, ADecoderWrittenFromTheFormatPageFindsTheSameError) {
    if (std::string(PRT_NODE).empty())
        GTEST_SKIP() << "node is not installed";
    copy_examples(folder.path(), {"knot"});
    ASSERT_EQ(
        prt({"bake", at("knot.glb"), "-o", at("b.glb"), "--rays", "16", "--order", "3", "--bounces", "1"})
            .status,
        0); // two parts, one of them colored
    const std::vector<std::vector<std::string>> ways = {
        {"--bits", "float", "--clusters", "20", "--components", "5"},
        {},
        {"--preset", "u64"},
        {"--clusters", "50", "--bits", "40"},
        {"--clusters", "1", "--bits", "0"},
        {"--clusters", "300", "--bits", "23"}};
    for (const std::vector<std::string>& way : ways) {
        std::vector<std::string> arguments = {"compress", at("b.glb"),  "-o",       at("c.glb"),
                                              "--json",   at("c.json"), "--lights", "natural"};
        arguments.insert(arguments.end(), way.begin(), way.end());
        ASSERT_EQ(prt(arguments).status, 0);
        const Outcome decoder = run(PRT_NODE, {PRT_DECODE, at("b.glb"), at("c.glb")});
        ASSERT_EQ(decoder.status, 0) << decoder.err;
        std::istringstream found(decoder.out);
        double l2 = 0, lit_rms = 0;
        found >> l2 >> lit_rms;
        const auto report = read_json(folder / "c.json");
        const double expected_l2 = report["relative_l2"], expected_lit_rms = report["lit_rms"];
        EXPECT_NEAR(l2, expected_l2, 1e-5 * expected_l2); // areas and vectors are floats there
        EXPECT_NEAR(lit_rms, expected_lit_rms, 1e-5 * expected_lit_rms);
    }
}

TEST_F(Pipeline, FilesWrittenFromDemandingScenesAreValidGltf) {
    demanding_file().write(folder / "d.glb");
    write_png(folder / "a picture.png", 2, 2, std::vector<glm::u8vec3>(4, glm::u8vec3(200)));
    for (const char* bits : {"24", "float"}) {
        ASSERT_EQ(prt({"bake", at("d.glb"), "-o", at("b.glb"), "--rays", "16"}).status, 0);
        const Outcome compress = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "3",
                                      "--components", "5", "--bits", bits});
        ASSERT_EQ(compress.status, 0) << compress.err;
        std::filesystem::rename(folder / "a picture.png",
                                folder / "moved.png"); // the written file needs no other file
        const Outcome render = prt({"render", at("c.glb"), "--lights", at("light.json"), "-o", at("p.png")});
        EXPECT_EQ(render.status, 1);
        EXPECT_NE(render.err.find("light.json"), std::string::npos) << render.err; // the image was there
        std::filesystem::rename(folder / "moved.png", folder / "a picture.png");
        for (const char* file : {"b.glb", "c.glb"})
            if (validator_errors(folder / file) < 0)
                GTEST_SKIP() << "gltf-validator is not installed";
    }
}

TEST_F(Pipeline, EveryViewIsDrawn) {
    triangle_file().write(folder / "t.glb");
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(1))});
    ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at("b.glb"), "--rays", "16"}).status, 0);
    ASSERT_EQ(
        prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "1", "--components", "1"}).status, 0);
    for (const char* backend : {"cpu", "gpu"})
        for (const char* model : {"t.glb", "b.glb", "c.glb"})
            for (const std::string show : {"lit", "ao", "clusters", "error"}) {
                std::vector<std::string> arguments = {"render",   at(model),   "--lights", at("e.exr"),
                                                      "-o",       at("p.png"), "--size",   "48x32",
                                                      "--device", backend,     "--show",   show};
                if (show == "error")
                    arguments.insert(arguments.end(), {"--baked", at("b.glb")});
                const Outcome outcome = prt(arguments);
                const bool possible = show != "clusters" || std::string(model) == "c.glb";
                const bool comparable = show != "error" || std::string(model) != "t.glb";
                EXPECT_EQ(outcome.status, possible && comparable ? 0 : 1) << model << show << outcome.err;
            }
}

TEST_F(Pipeline, EverySupportedOptionIsAccepted) {
    triangle_file().write(folder / "t.glb");
    const Outcome outcome =
        prt({"bake",      at("t.glb"), "-o",     at("b.glb"), "--order", "3",         "--rays",
             "8",         "--bounces", "0",      "--device",  "cpu",     "--method",  "trace",
             "--threads", "1",         "--seed", "5",         "--json",  at("b.json")});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_json(folder / "b.json")["bake"]["seed"], 5);
}

TEST_F(Pipeline, EqualSeedsGiveEqualBytesForAllThreads) {
    triangle_file().write(folder / "t.glb");
    for (const char* threads : {"1", "2"}) {
        ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at((std::string("b") + threads).c_str()), "--rays", "100",
                       "--threads", threads})
                      .status,
                  0);
        ASSERT_EQ(prt({"compress", at("b1"), "-o", at((std::string("c") + threads).c_str()), "--clusters",
                       "2", "--components", "1", "--threads", threads})
                      .status,
                  0);
    }
    EXPECT_EQ(read_file(folder / "b1"), read_file(folder / "b2"));
    EXPECT_EQ(read_file(folder / "c1"), read_file(folder / "c2"));
}

TEST_F(Pipeline, BouncesOnTheGpuLandInTheFileAndItsReport) {
    copy_examples(folder.path(), {"tree"});
    const Outcome bake = prt({"bake", at("tree.glb"), "-o", at("b.glb"), "--rays", "16", "--order", "2",
                              "--bounces", "2", "--device", "gpu", "--json", at("b.json")});
    ASSERT_EQ(bake.status, 0) << bake.err;
    const auto report = read_json(folder / "b.json");
    EXPECT_EQ(report["channels"], 3);
    EXPECT_EQ(report["bake"]["backend"], "gpu");
    EXPECT_EQ(report["bake"]["bounces"], 2);
    EXPECT_EQ(report["storage"], "float16");
    EXPECT_GT(report["back_sides"], 1000);
    EXPECT_GT(report["gather_entries"], 1000);
    const Outcome info = prt({"info", at("b.glb")});
    EXPECT_NE(info.out.find("2 bounces"), std::string::npos) << info.out;
    if (validator_errors(folder / "b.glb") < 0)
        GTEST_SKIP() << "gltf-validator is not installed";
}

struct LampScene {
    const char *name, *group;
    int lights, lamps; ///< includes the group of lit windows; bulbs and a sign
};
void PrintTo(const LampScene& scene, std::ostream* to) {
    *to << scene.name;
}
class LampPipeline : public Pipeline, public testing::WithParamInterface<LampScene> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LampPipeline,
                         testing::Values(LampScene{"courtyard", "Lanterns=Lantern*", 8, 2},
                                         LampScene{"night_room", "Lamps=Lamp*", 3, 4}),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST_P(LampPipeline, BakesTheLampsOfAScene) {
    const auto& [name, group, lights, lamps] = GetParam();
    copy_examples(folder.path(), {name});
    const std::string scene = at((std::string(name) + ".glb").c_str());
    const Outcome bake = prt({"bake", scene, "-o", at("b.glb"), "--rays", "2", "--order", "1", "--lamps",
                              "rays=1", "--lamps", std::string("group=") + group, "--json", at("b.json")});
    ASSERT_EQ(bake.status, 0) << bake.err;
    const auto report = read_json(folder / "b.json");
    EXPECT_LT(report["receivers"], 150000);
    EXPECT_EQ(report["lamp_lights"], lights);
    EXPECT_EQ(report["lamps"], lamps);
    EXPECT_EQ(bake.out.find("on no surface"), std::string::npos) << bake.out;
    if (validator_errors(scene) < 0)
        GTEST_SKIP() << "gltf-validator is not installed";
}

} // namespace
} // namespace prt::test
