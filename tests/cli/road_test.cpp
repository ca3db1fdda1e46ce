// The whole road through the program: scene, bake, compress, evaluate, render.

#include "program.h"
#include "prt/image_file.h"
#include "prt/support/file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace prt::test {
namespace {

nlohmann::json read_json(const std::filesystem::path& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
}

/// What Khronos' validator says: number of errors, or -1 where it cannot be run.
int validator_errors(const std::filesystem::path& file) {
    if (std::string(PRT_NODE).empty() || !std::filesystem::exists(PRT_VALIDATOR_MODULES))
        return -1;
    const Outcome outcome = run(PRT_NODE, {PRT_VALIDATE, PRT_VALIDATOR_MODULES, file.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
    return outcome.status;
}

std::size_t count(const std::string& text, std::string_view part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

/// A page loads nothing, from beside it or from elsewhere.
void expect_standing_alone(const std::filesystem::path& path) {
    std::ifstream file(path);
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    for (const char* loading :
         {"src=", "href", "@import", "url(", "fetch(", "import(", "XMLHttpRequest", "{{"})
        EXPECT_EQ(page.find(loading), std::string::npos) << loading;
    EXPECT_EQ(count(page, "</script>"), 2u); // the report and what draws it
}

/// The elements of a page once its script has run, or nothing where there is no browser to run it.
std::string drawn_page(const std::filesystem::path& path) {
    if (std::string(PRT_CHROMIUM).empty())
        return {};
    const Outcome outcome = run(PRT_CHROMIUM, {"--headless", "--no-sandbox", "--disable-gpu",
                                               "--user-data-dir=" + path.string() + ".profile", "--dump-dom",
                                               "file://" + path.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
}

class Road : public testing::Test {
protected:
    std::string at(const char* name) const { return (folder / name).string(); }
    TemporaryFolder folder;
};

TEST_F(Road, NoticesOfTheSceneAreSaidOnceAndStandInTheReports) {
    GlbFile file = triangle_file();
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {2, 1, 1, 1}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "a.glb");
    const std::string notice = "clamped to 0..1: baseColorFactor of materials (1)";
    const Outcome bake =
        prt({"bake", at("a.glb"), "-o", at("b.glb"), "--rays", "16", "--json", at("b.json")});
    EXPECT_EQ(bake.err, "prt: note: " + at("a.glb") + ": " + notice + "\n");
    EXPECT_EQ(prt({"info", at("a.glb"), "--json", at("i.json")}).status, 0);
    for (const char* report : {"b.json", "i.json"}) {
        const nlohmann::json notices = read_json(folder / report)["notices"];
        EXPECT_EQ(std::count(notices.begin(), notices.end(), notice), 1) << report;
    }
}

/// A dim sky with a sun of one texel.
Image sunny_image() {
    Image image{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.2f, 0.3f, 0.5f))};
    image.at(20, 9) = {900, 800, 600};
    return image;
}

double largest_difference(const nlohmann::json& a, const nlohmann::json& b) {
    double largest = 0;
    for (const char* channel : {"red", "green", "blue"})
        for (std::size_t i = 0; i < a["coefficients"][channel].size(); ++i)
            largest = std::max(largest, std::abs(a["coefficients"][channel][i].get<double>() -
                                                 b["coefficients"][channel][i].get<double>()));
    return largest;
}

TEST_F(Road, SunsOfALightFileAreAddedToItsCoefficients) {
    write_exr(folder / "sky.exr", sunny_image(), EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("full.json")}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("suns.json"), "--suns", "1"}).status, 0);
    ASSERT_EQ(prt({"project", at("suns.json"), "-o", at("back.json")}).status, 0);
    const auto full = read_json(folder / "full.json"), suns = read_json(folder / "suns.json");
    EXPECT_EQ(suns["suns"].size(), 1u);
    EXPECT_GT(largest_difference(full, suns), 0.5);
    // A disc stands for a square texel of 5.6 degrees; band 0 is the same.
    EXPECT_LT(largest_difference(full, read_json(folder / "back.json")),
              0.02 * full["coefficients"]["red"][0].get<double>());

    nlohmann::json damaged = suns;
    damaged["suns"][0]["half_angle_radians"] = -1;
    std::ofstream(folder / "bad.json") << damaged;
    const Outcome bad = prt({"project", at("bad.json"), "-o", at("x.json")});
    EXPECT_EQ(bad.status, 1);
    EXPECT_NE(bad.err.find("\"half_angle_radians\" is not in 0..1.5708"), std::string::npos) << bad.err;
}

TEST_F(Road, SunsThatPayAreFoundAndTurnWithTheSky) {
    write_exr(folder / "sky.exr", sunny_image(), EnvironmentLayout::lat_long);
    ASSERT_EQ(
        prt({"project", at("sky.exr"), "-o", at("a.json"), "--suns", "auto", "--json", at("r.json")}).status,
        0);
    const auto report = read_json(folder / "r.json"), light = read_json(folder / "a.json");
    ASSERT_EQ(light["suns"].size(), 1u);
    EXPECT_EQ(report["suns"], light["suns"]);
    EXPECT_LT(report["error_with_suns"], 0.4 * report["error_without_suns"].get<double>());
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("t.json"), "--suns", "1", "--rotate", "90"}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("full.json"), "--rotate", "90"}).status, 0);
    ASSERT_EQ(prt({"project", at("t.json"), "-o", at("back.json")}).status, 0);
    EXPECT_LT(largest_difference(read_json(folder / "full.json"), read_json(folder / "back.json")), 0.1);
    EXPECT_EQ(prt({"project", at("sky.exr"), "-o", at("l.json"), "--suns", "some"}).status, 2);

    write_exr(folder / "gray.exr", {8, 4, std::vector<glm::vec3>(32, glm::vec3(1))},
              EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"project", at("gray.exr"), "-o", at("g.json"), "--suns", "auto"}).status, 0);
    EXPECT_TRUE(read_json(folder / "g.json")["suns"].empty());
}

TEST_F(Road, TheCentreOfALatLongImageMayLookAtX) {
    write_exr(folder / "sky.exr", sunny_image(), EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("x.json"), "--env-center", "x"}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("turned.json"), "--rotate", "90"}).status, 0);
    ASSERT_EQ(prt({"project", at("sky.exr"), "-o", at("z.json")}).status, 0);
    EXPECT_LT(largest_difference(read_json(folder / "x.json"), read_json(folder / "turned.json")), 1e-5);
    EXPECT_GT(largest_difference(read_json(folder / "x.json"), read_json(folder / "z.json")), 0.5);
}

#ifdef PRT_EXAMPLE_SCENES
class ExampleRoad : public Road, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, ExampleRoad, testing::Values("knot", "room", "terrain", "tree"));

TEST_P(ExampleRoad, LeadsFromSceneToPictures) {
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), GetParam(), "sky"}).status, 0);
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
                                  at("e.json"), "--html", at("e.html")});
    ASSERT_EQ(evaluate.status, 0) << evaluate.err;
    const auto report = read_json(folder / "e.json");
    EXPECT_NEAR(report["relative_l2"].get<double>(), compress_report["relative_l2"].get<double>(), 1e-9);
    EXPECT_LT(report["lights"][0]["lit_rms"], 0.2);
    EXPECT_GT(std::filesystem::file_size(folder / "e.html"), 1000u);

    for (const char* backend : {"cpu", "gpu"}) {
        const Outcome render = prt({"render", at("c.glb"), "--env", at("sky.exr"), "-o",
                                    at((std::string(backend) + ".exr").c_str()), "--size", "96x64",
                                    "--samples", "1", "--backend", backend});
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
#endif

#ifdef PRT_EXAMPLE_SCENES
TEST_F(Road, ADecoderWrittenFromTheFormatPageFindsTheSameError) {
    if (std::string(PRT_NODE).empty())
        GTEST_SKIP() << "node is not installed";
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), "knot"}).status, 0);
    ASSERT_EQ(
        prt({"bake", at("knot.glb"), "-o", at("b.glb"), "--rays", "16", "--order", "3", "--bounces", "1"})
            .status,
        0); // two parts, one of them colored
    const std::vector<std::vector<std::string>> ways = {
        {"--weights", "8", "--clusters", "20", "--components", "5"},
        {"--weights", "16", "--clusters", "20", "--components", "5"},
        {"--weights", "float", "--clusters", "20", "--components", "5"},
        {},
        {"--preset", "u64"},
        {"--clusters", "50", "--bits", "40"},
        {"--clusters", "1", "--bits", "0"},
        {"--clusters", "300", "--bits", "23"}};
    for (const std::vector<std::string>& way : ways) {
        std::vector<std::string> arguments = {"compress", at("b.glb"),  "-o",       at("c.glb"),
                                              "--json",   at("c.json"), "--metric", "natural"};
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
#endif

TEST_F(Road, SunsAreWrittenApartAndTheRestRelights) {
    Image sky{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.5f, 0.6f, 0.8f))};
    sky.at(32, 10) = glm::vec3(3000, 2800, 2000); // 10.5 rows of 32 from +Y, in the column of +Z
    write_exr(folder / "sky.exr", sky, EnvironmentLayout::lat_long);
    const Outcome project = prt({"project", at("sky.exr"), "-o", at("l.json"), "--suns", "1"});
    ASSERT_EQ(project.status, 0) << project.err;
    const auto light = read_json(folder / "l.json");
    ASSERT_EQ(light["suns"].size(), 1u);
    const auto towards = light["suns"][0]["towards"].get<std::vector<double>>();
    EXPECT_NEAR(towards[1], std::cos(10.5 / 32 * 3.14159265), 0.02);
    EXPECT_GT(towards[2], 0.8);
    EXPECT_GT(light["suns"][0]["irradiance"][0], light["suns"][0]["irradiance"][2]);
    const double red = light["coefficients"]["red"][0];
    EXPECT_NEAR(red * 0.2820948, 0.5, 0.05); // the sky without its sun
    triangle_file().write(folder / "t.glb");
    EXPECT_EQ(
        prt({"render", at("t.glb"), "--env", at("l.json"), "-o", at("p.png"), "--size", "32x32"}).status, 0);
    EXPECT_EQ(prt({"project", at("sky.exr"), "-o", at("l.json"), "--suns", "-1"}).status, 2);
}

TEST_F(Road, ASweepIsAPageThatStandsAlone) {
    triangle_file().write(folder / "t.glb");
    ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at("b.glb"), "--rays", "16", "--order", "2"}).status, 0);
    const Outcome evaluate =
        prt({"evaluate", at("b.glb"), "--sweep", "--json", at("e.json"), "--html", at("e.html")});
    ASSERT_EQ(evaluate.status, 0) << evaluate.err;
    const auto sweep = read_json(folder / "e.json")["sweep"];
    EXPECT_GT(sweep["equal_bytes"].size(), 3u);
    EXPECT_GT(sweep["equal_shader_operations"].size(), 3u);
    expect_standing_alone(folder / "e.html");
    const std::string drawn = drawn_page(folder / "e.html");
    if (drawn.empty())
        GTEST_SKIP() << "chromium is not installed";
    EXPECT_EQ(count(drawn, "<svg"), 2u);
    std::size_t curves = 0;
    for (const char* points : {"equal_bytes", "equal_shader_operations"}) {
        std::set<std::string> methods = {"prtkit"}; // has its place even without a point
        for (const auto& point : sweep[points])
            methods.insert(point["method"]);
        curves += methods.size();
    }
    EXPECT_EQ(count(drawn, "<polyline"), curves);
    EXPECT_NE(drawn.find("<h2>Error at equal bytes</h2>"), std::string::npos);
}

/// A file that gives the writer work: instances, missing normals, strips, an image beside it, sparse data.
GlbFile demanding_file() {
    GlbFile file = triangle_file();
    const auto position =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1}, kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, 0, 0};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    const auto uv =
        file.accessor(std::vector<std::uint8_t>{0, 0, 9, 9, 255, 0, 9, 9, 0, 255, 9, 9, 255, 255, 9, 9},
                      kUnsignedByte, "VEC2", 4, true, 4);
    file.json["accessors"][uv]["count"] = 4;
    file.json["images"] = {{{"uri", "a%20picture.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"mode", 5}, {"material", 0}});
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {3, 0, 0}}, {"scale", {1, -1, 1}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    return file;
}

TEST_F(Road, FilesWrittenFromDemandingScenesAreValidGltf) {
    demanding_file().write(folder / "d.glb");
    write_png(folder / "a picture.png", 2, 2, std::vector<glm::u8vec3>(4, glm::u8vec3(200)));
    for (const char* weights : {"8", "16", "float"}) {
        ASSERT_EQ(prt({"bake", at("d.glb"), "-o", at("b.glb"), "--rays", "16"}).status, 0);
        const Outcome compress = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "3",
                                      "--components", "5", "--weights", weights});
        ASSERT_EQ(compress.status, 0) << compress.err;
        std::filesystem::rename(folder / "a picture.png",
                                folder / "moved.png"); // what is written needs no other file
        const Outcome render = prt({"render", at("c.glb"), "--env", at("light.json"), "-o", at("p.png")});
        EXPECT_EQ(render.status, 1);
        EXPECT_NE(render.err.find("light.json"), std::string::npos) << render.err; // the image was there
        std::filesystem::rename(folder / "moved.png", folder / "a picture.png");
        for (const char* file : {"b.glb", "c.glb"})
            if (validator_errors(folder / file) < 0)
                GTEST_SKIP() << "gltf-validator is not installed";
    }
}

TEST_F(Road, LightFilesServeAsEnvironments) {
    triangle_file().write(folder / "t.glb");
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(1, 2, 3))});
    ASSERT_EQ(
        prt({"project", at("e.exr"), "-o", at("l.json"), "--order", "6", "--json", at("r.json")}).status, 0);
    EXPECT_NEAR(read_json(folder / "r.json")["mean_radiance"][2].get<double>(), 3, 1e-5);
    ASSERT_EQ(prt({"render", at("t.glb"), "--env", at("l.json"), "-o", at("a.exr"), "--size", "32x32",
                   "--backend", "cpu"})
                  .status,
              0);
    ASSERT_EQ(prt({"render", at("t.glb"), "--env", at("e.exr"), "-o", at("b.exr"), "--size", "32x32",
                   "--backend", "cpu", "--no-background"})
                  .status,
              0);
    EXPECT_EQ(read_file(folder / "a.exr"), read_file(folder / "b.exr"));
}

TEST_F(Road, AutomaticExposureIsThatOfTheModelAndIsReported) {
    GlbFile file = triangle_file();
    file.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.125, 1}}, {"metallicFactor", 0}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "t.glb");
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(4))});
    const auto stops = [&](const char* exposure, const char* backend) {
        const Outcome outcome =
            prt({"render", at("t.glb"), "--env", at("e.exr"), "-o", at("p.png"), "--size", "64x48",
                 "--backend", backend, "--exposure", exposure, "--json", at("r.json")});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(outcome.out.find(" stops"), std::string::npos) << outcome.out;
        const auto report = read_json(folder / "r.json");
        EXPECT_EQ(report["exposure_automatic"].get<bool>(), std::string(exposure).starts_with("auto"));
        return report["exposure_stops"].get<double>();
    };
    // An open receiver of that base colour under light of radiance 4 comes to 0.22.
    const double luminance = 4 * (0.2126 * 0.25 + 0.7152 * 0.5 + 0.0722 * 0.125);
    for (const char* backend : {"cpu", "gpu"}) {
        EXPECT_NEAR(stops("auto", backend), std::log2(0.22 / luminance), 1e-3);
        EXPECT_NEAR(stops("auto+1", backend), std::log2(0.22 / luminance) + 1, 1e-3);
        EXPECT_NEAR(stops("auto-0.5", backend), std::log2(0.22 / luminance) - 0.5, 1e-3);
        EXPECT_NEAR(stops("-1.5", backend), -1.5, 1e-6);
    }
    for (const char* wrong : {"auto1", "auto+", "bright", "", "nan", "auto+inf"})
        EXPECT_EQ(
            prt({"render", at("t.glb"), "--env", at("e.exr"), "-o", at("p.png"), "--exposure", wrong}).status,
            2)
            << wrong;
}

TEST_F(Road, EveryViewIsDrawn) {
    triangle_file().write(folder / "t.glb");
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(1))});
    ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at("b.glb"), "--rays", "16"}).status, 0);
    ASSERT_EQ(
        prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "1", "--components", "1"}).status, 0);
    for (const char* backend : {"cpu", "gpu"})
        for (const char* model : {"t.glb", "b.glb", "c.glb"})
            for (const std::string show : {"lit", "ao", "clusters", "error"}) {
                std::vector<std::string> arguments = {"render",    at(model),   "--env",  at("e.exr"),
                                                      "-o",        at("p.png"), "--size", "48x32",
                                                      "--backend", backend,     "--show", show};
                if (show == "error")
                    arguments.insert(arguments.end(), {"--baked", at("b.glb")});
                const Outcome outcome = prt(arguments);
                const bool possible = show != "clusters" || std::string(model) == "c.glb";
                const bool comparable = show != "error" || std::string(model) != "t.glb";
                EXPECT_EQ(outcome.status, possible && comparable ? 0 : 1) << model << show << outcome.err;
            }
}

TEST_F(Road, EveryOptionOfTheContractThatThereIsIsTaken) {
    triangle_file().write(folder / "t.glb");
    const Outcome outcome =
        prt({"bake",      at("t.glb"), "-o",     at("b.glb"), "--order", "3",         "--rays",
             "8",         "--bounces", "0",      "--backend", "cpu",     "--method",  "trace",
             "--threads", "1",         "--seed", "5",         "--json",  at("b.json")});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_json(folder / "b.json")["bake"]["seed"], 5);
}

TEST_F(Road, SameSeedSameBytesWhateverTheThreads) {
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

#ifdef PRT_EXAMPLE_SCENES
/// A bake, or another command, that takes minutes.
class LongWork : public Road, public testing::WithParamInterface<std::vector<const char*>> {};
INSTANTIATE_TEST_SUITE_P(Phases, LongWork,
                         testing::Values(std::vector<const char*>{"--rays", "1000000"},
                                         std::vector<const char*>{"--rays", "1000000", "--bounces", "1"},
                                         std::vector<const char*>{"--target-error", "0.00001"},
                                         std::vector<const char*>{"--rays", "1000000", "--backend", "gpu"},
                                         std::vector<const char*>{"--rays", "1000000", "--backend", "gpu",
                                                                  "--method", "raster"},
                                         std::vector<const char*>{"--rays", "1", "--subsurface",
                                                                  "1,1,1,0,0,0", "--bounces", "inf"}));

TEST_P(LongWork, IsEndedByCtrlCAndLeavesNothing) {
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), "room"}).status, 0);
    const std::size_t before = folder.files();
    const std::string scene = at("room.glb"), output = at("b.glb");
    const pid_t child = fork();
    if (child == 0) {
        std::freopen("/dev/null", "w", stderr);
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1); // what is cut short has not cleaned up
        std::vector<const char*> arguments = {PRT_PROGRAM, "bake", scene.c_str(), "-o", output.c_str()};
        arguments.insert(arguments.end(), GetParam().begin(), GetParam().end());
        arguments.push_back(nullptr);
        execv(PRT_PROGRAM, const_cast<char**>(arguments.data()));
        _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    kill(child, SIGINT);
    int status = 0;
    for (int waited = 0; waitpid(child, &status, WNOHANG) == 0; ++waited) {
        ASSERT_LT(waited, 500) << "does not end"; // generous: a sanitizer on a busy machine
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    EXPECT_EQ(folder.files(), before);
}

TEST_F(Road, BouncesOnTheGpuLandInTheFileAndItsReport) {
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), "tree"}).status, 0);
    const Outcome bake = prt({"bake", at("tree.glb"), "-o", at("b.glb"), "--rays", "16", "--order", "2",
                              "--bounces", "2", "--backend", "gpu", "--json", at("b.json")});
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
    int lights, lamps; ///< besides the group windows that are lit; bulbs and a sign
};
void PrintTo(const LampScene& scene, std::ostream* to) {
    *to << scene.name;
}
class LampRoad : public Road, public testing::WithParamInterface<LampScene> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LampRoad,
                         testing::Values(LampScene{"courtyard", "Lanterns=Lantern*", 8, 2},
                                         LampScene{"night_room", "Lamps=Lamp*", 3, 4}),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST_P(LampRoad, BakesTheLampsOfAScene) {
    const auto& [name, group, lights, lamps] = GetParam();
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), name}).status, 0);
    const std::string scene = at((std::string(name) + ".glb").c_str());
    const Outcome bake = prt({"bake", scene, "-o", at("b.glb"), "--rays", "2", "--order", "1", "--lamp-rays",
                              "1", "--lamp-group", group, "--json", at("b.json")});
    ASSERT_EQ(bake.status, 0) << bake.err;
    const auto report = read_json(folder / "b.json");
    EXPECT_LT(report["receivers"], 150000);
    EXPECT_EQ(report["lamp_lights"], lights);
    EXPECT_EQ(report["lamps"], lamps);
    EXPECT_EQ(bake.out.find("on no surface"), std::string::npos) << bake.out;
    if (validator_errors(scene) < 0)
        GTEST_SKIP() << "gltf-validator is not installed";
}

TEST_F(Road, TheSkyAtNoonHasTheSunItSays) {
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), "noon"}).status, 0);
    const Image image = load_environment(folder / "noon.exr").environment.image;
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.62, 0.9, 0.42));
    // The irradiance of the ground by each texel: its solid angle times its height.
    double sky = 0, sun = 0, farthest = 0;
    for (int y = 0; y < image.height / 2; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 d = lat_long_direction(image.width, image.height, x + 0.5, y + 0.5);
            const double solid_angle = 2 * glm::pi<double>() / image.width *
                                       (std::cos(glm::pi<double>() * y / image.height) -
                                        std::cos(glm::pi<double>() * (y + 1) / image.height));
            const glm::vec3 pixel = image.pixels[static_cast<std::size_t>(y * image.width + x)];
            const double luminance = glm::dot(glm::dvec3(pixel), glm::dvec3(0.2126, 0.7152, 0.0722));
            const bool in_sun = luminance > 100; // the sky beside it has about 1
            (in_sun ? sun : sky) += luminance * d.y * solid_angle;
            if (in_sun)
                farthest = std::max(farthest, std::acos(glm::dot(d, towards)));
        }
    // Texels are 0.35 degrees wide: half a diagonal of them beside the disc's 0.265.
    EXPECT_LT(glm::degrees(farthest), 0.265 + 0.25);
    EXPECT_NEAR(sun / towards.y / sky, 6, 0.06); // 1 % for the texels' middles in the place of the disc
    EXPECT_NEAR((sun + sky) / glm::pi<double>(), 1, 0.01);
}

TEST_F(Road, TooLargeABakeIsRefusedWithItsSize) {
    ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), "room"}).status, 0);
    const Outcome bake =
        prt({"bake", at("room.glb"), "-o", at("b.glb"), "--rays", "16777216", "--bounces", "1"});
    EXPECT_EQ(bake.status, 1);
    EXPECT_NE(bake.err.find(" GB of memory"), std::string::npos) << bake.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "b.glb"));
}
#endif

TEST_F(Road, BenchMeasuresEveryBackendAndMethod) {
    triangle_file().write(folder / "a<b>&.glb");
    const Outcome bench = prt({"bench", at("a<b>&.glb"), "--from", "16", "--to", "64", "--order", "3",
                               "--json", at("bench.json"), "--html", at("bench.html")});
    ASSERT_EQ(bench.status, 0) << bench.err;
    const auto report = read_json(folder / "bench.json");
    EXPECT_EQ(report["reference_rays"], 64 * 64);
    ASSERT_EQ(report["runs"].size(), 9u); // three ways, three numbers of rays
    for (const auto& run : report["runs"]) {
        EXPECT_LT(run["relative_l2"], 1e-5); // a lone triangle is open: no sampling error at all
        EXPECT_GT(run["seconds"], 0);
    }
    expect_standing_alone(folder / "bench.html");
    const std::string drawn = drawn_page(folder / "bench.html");
    if (drawn.empty())
        GTEST_SKIP() << "chromium is not installed";
    EXPECT_EQ(count(drawn, "<svg"), 2u); // error over time, speed over rays
    EXPECT_EQ(count(drawn, "<td>cpu trace</td>"), 3u);
    EXPECT_EQ(count(drawn, "<polyline"), 6u);
    EXPECT_EQ(drawn.find("NaN"), std::string::npos);
    // What a name holds is text, not markup.
    EXPECT_NE(drawn.find("a&lt;b&gt;&amp;.glb"), std::string::npos);
}

} // namespace
} // namespace prt::test
