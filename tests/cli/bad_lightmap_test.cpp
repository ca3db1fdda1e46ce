// Tests files with invalid lightmaps: each is rejected with a one-line error, and invalid JSON is also
// rejected by the schemas of docs/format.md. Valid files are accepted by both.

#include "pipeline.h"
#include "prt/image/image_file.h"
#include "support/lightmap_model.h"
#include "support/random_lightmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <sstream>
#include <string_view>

namespace prt::test {
namespace {

using Json = nlohmann::ordered_json;

/// Result of the schema; prt rejects all of these files.
enum class Schema { refuses, takes };

struct Damage {
    const char* name;
    std::function<void(GlbFile&)> change;
    const char* message; ///< part of the error message
    Schema schema = Schema::takes;
};

Json& extension(GlbFile& file) {
    return file.json["extensions"]["PRTKIT_transfer"];
}
Json& set(GlbFile& file) {
    return set_of(file.json, "texels");
}
Json& map(GlbFile& file) {
    return set(file)["maps"][0];
}
Json& position(GlbFile& file) {
    return file.json["meshes"][0]["primitives"][0]["extensions"]["PRTKIT_transfer"];
}

/// Replaces number `i` in buffer view `name` of the set.
template <class Number>
void put(GlbFile& file, const char* name, std::size_t i, Number value) {
    const Json& view = file.json["bufferViews"][set(file)[name]["bufferView"].get<std::size_t>()];
    std::memcpy(&file.binary[view["byteOffset"].get<std::size_t>() + i * sizeof value], &value, sizeof value);
}
void cut(GlbFile& file, const char* name, std::size_t bytes) {
    file.json["bufferViews"][set(file)[name]["bufferView"].get<std::size_t>()]["byteLength"] = bytes;
}

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

/// The first word of the first map is an image that looks like this.
void put_image(GlbFile& file, std::span<const std::byte> png) {
    map(file)["images"][0] = add_image(file, png);
}
std::vector<std::byte> image_of(const GlbFile& file, std::size_t i) {
    const Json& view = file.json["bufferViews"][file.json["images"][i]["bufferView"].get<std::size_t>()];
    const auto begin = file.binary.begin() + view["byteOffset"].get<std::ptrdiff_t>();
    return {begin, begin + view["byteLength"].get<std::ptrdiff_t>()};
}
void put_pixels(GlbFile& file, int width, int height, glm::u8vec4 pixel) {
    const std::vector<glm::u8vec4> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                          pixel);
    put_image(file, encode_png(width, height, pixels));
}

constexpr LightmapSize kFirst{8, 6}, kSecond{5, 4};

GlbFile raw_file() {
    std::mt19937 random(5);
    const TransferLayout transfer{
        2, {{TermKind::direct, 1}, {TermKind::indirect, 3}, {TermKind::lamp, 3, "lamp"}}};
    BakedLightmap lightmap = made_up_lightmap(layout_of_floor(kFirst, kSecond), transfer, random);
    return with_lightmap(mapped_floor(2), lightmap);
}

GlbFile shipped_file(bool alike = false) {
    std::mt19937 random(6);
    CompressedLightmap lightmap = random_lightmap({kFirst, kSecond}, 2, alike, random);
    lightmap.layout = layout_of_floor(kFirst, kSecond);
    return with_lightmap(mapped_floor(2), lightmap);
}

/// Returns damages to the maps, independent of their content.
std::vector<Damage> damages_to_maps() {
    constexpr Schema kRefuses = Schema::refuses;
    return {
        {"version", [](GlbFile& f) { extension(f)["version"] = 9; }, "has version 9", kRefuses},
        {"order", [](GlbFile& f) { set(f)["order"] = 11; }, "order is 11", kRefuses},
        {"no_terms", [](GlbFile& f) { set(f)["terms"] = Json::array(); }, "terms", kRefuses},
        {"no_maps", [](GlbFile& f) { set(f).erase("maps"); }, "maps", kRefuses},
        {"empty_maps", [](GlbFile& f) { set(f)["maps"] = Json::array(); },
         "the list of maps is missing or empty", kRefuses},
        {"maps_by_name",
         [](GlbFile& f) {
             set(f)["maps"] = {{"a", map(f)}, {"b", map(f)}};
         },
         "the list of maps is missing or empty", kRefuses},
        {"map_of_nothing", [](GlbFile& f) { set(f)["maps"][0] = nullptr; }, "", kRefuses},
        {"width_0", [](GlbFile& f) { map(f)["width"] = 0; }, "width of a map is 0", kRefuses},
        {"height_negative", [](GlbFile& f) { map(f)["height"] = -8; }, "height of a map is -8", kRefuses},
        {"width_2_31", [](GlbFile& f) { map(f)["width"] = 1LL << 31; }, "width of a map is 2147483648",
         kRefuses},
        {"width_2_32", [](GlbFile& f) { map(f)["width"] = (1LL << 32) + 8; }, "width of a map is 4294967304",
         kRefuses},
        {"width_of_halves", [](GlbFile& f) { map(f)["width"] = 8.5; }, "width of a map is 8.5", kRefuses},
        {"repeats_in_words", [](GlbFile& f) { map(f)["repeats"] = "no"; }, "", kRefuses},
        {"maps_beyond_memory",
         [](GlbFile& f) {
             for (int i = 0; i < 20; ++i) {
                 set(f)["maps"].push_back(map(f));
                 set(f)["maps"].back()["width"] = set(f)["maps"].back()["height"] = 16384;
             }
         },
         "lightmaps would need"},
        {"map_out_of_range", [](GlbFile& f) { position(f)["map"] = 2; }, "the index of a map is 2"},
        {"map_negative", [](GlbFile& f) { position(f)["map"] = -1; }, "the index of a map is -1", kRefuses},
        {"no_map", [](GlbFile& f) { position(f).erase("map"); }, "map", kRefuses},
        {"no_texcoord", [](GlbFile& f) { position(f).erase("texCoord"); }, "texCoord", kRefuses},
        {"texcoord_negative", [](GlbFile& f) { position(f)["texCoord"] = -1; }, "texCoord is -1", kRefuses},
        {"texcoord_that_is_not_there", [](GlbFile& f) { position(f)["texCoord"] = 3; }, "has no TEXCOORD_3"},
        {"no_position", [](GlbFile& f) { f.json["meshes"][0]["primitives"][0].erase("extensions"); },
         "mesh 0 primitive 0 has no PRTKIT_transfer"},
        {"former",
         [](GlbFile& f) {
             f.json["extensions"]["PRTKIT_lightmap"] = {{"version", 2}};
         },
         "has PRTKIT_lightmap, a format of a former version", kRefuses},
        {"no_sets", [](GlbFile& f) { extension(f)["sets"] = Json::array(); }, "or the list is empty",
         kRefuses},
        {"set_of_nothing", [](GlbFile& f) { extension(f)["sets"].push_back(nullptr); }, "is not an object",
         kRefuses},
        {"sets_twice", [](GlbFile& f) { extension(f)["sets"].push_back(set(f)); }, "has two sets of texels",
         kRefuses},
        {"receivers_unknown", [](GlbFile& f) { set(f)["receivers"] = "edges"; },
         "neither vertices, texels nor probes", kRefuses},
        {"coding_unknown", [](GlbFile& f) { set(f)["coding"] = "packed"; }, "neither raw nor clustered",
         kRefuses},
    };
}

std::vector<Damage> damages_to_raw() {
    constexpr Schema kRefuses = Schema::refuses;
    return {
        {"texels_not_ascending", [](GlbFile& f) { put(f, "texels", 1, 0u); }, "not in ascending order"},
        {"texel_beyond", [](GlbFile& f) { put(f, "texels", 44, 68u); }, "outside the maps"},
        {"texels_of_bytes", [](GlbFile& f) { cut(f, "texels", 7); }, "not 32-bit integers"},
        {"texels_without_view", [](GlbFile& f) { set(f)["texels"].erase("bufferView"); }, "bufferView",
         kRefuses},
        {"no_receivers", [](GlbFile& f) { cut(f, "texels", 0); }, ""},
        {"fewer_texels", [](GlbFile& f) { cut(f, "texels", 16); }, "the areas: expected 16 bytes"},
        {"no_areas", [](GlbFile& f) { set(f).erase("areas"); }, "areas", kRefuses},
        {"area_negative", [](GlbFile& f) { put(f, "areas", 3, -1e-6f); }, "an area is negative"},
        {"area_nan", [](GlbFile& f) { put(f, "areas", 3, std::numeric_limits<float>::quiet_NaN()); },
         "the areas contain values that are not finite"},
        {"areas_of_halves", [](GlbFile& f) { set(f)["areas"]["componentType"] = 5131; },
         "component type 5131", kRefuses},
        {"seam_beyond", [](GlbFile& f) { put(f, "seams", 1, 45u); },
         "a seam refers to receiver 45, but there are only 45"},
        {"seam_of_one", [](GlbFile& f) { cut(f, "seams", 4); }, "not pairs"},
        {"vector_nan", [](GlbFile& f) { put(f, "vectors", 0, std::numeric_limits<float>::quiet_NaN()); },
         "not finite"},
        {"vectors_short", [](GlbFile& f) { cut(f, "vectors", 64); }, "vectors of texels: expected"},
        {"vectors_of_bytes", [](GlbFile& f) { set(f)["vectors"]["componentType"] = 5121; },
         "component type 5121", kRefuses},
        {"no_vectors", [](GlbFile& f) { set(f).erase("vectors"); }, "vectors", kRefuses},
    };
}

std::vector<Damage> damages_to_images() {
    constexpr Schema kRefuses = Schema::refuses;
    constexpr const char* kNoPng = "word 0 of map 0 is not a PNG with 8 bits";
    return {
        {"image_of_another_size", [](GlbFile& f) { put_pixels(f, 7, 6, {}); },
         "has 7 x 6 pixels, but the lightmap has 8 x 6 texels"},
        {"image_of_the_other_map", [](GlbFile& f) { map(f)["images"][0] = 2; }, "has 5 x 4 pixels"},
        {"image_jpeg",
         [](GlbFile& f) { put_image(f, bytes_of("\xff\xd8\xff\xe0 and more, behind the mark of a JPEG")); },
         kNoPng},
        {"image_without_alpha",
         [](GlbFile& f) { put_image(f, encode_png(8, 6, std::vector<glm::u8vec3>(48))); }, kNoPng},
        {"image_of_16_bits",
         [](GlbFile& f) {
             std::vector<std::byte> png = image_of(f, 0);
             png[24] = std::byte{16};
             put_image(f, png);
         },
         kNoPng},
        {"image_cut_off",
         [](GlbFile& f) {
             std::vector<std::byte> png = image_of(f, 0);
             png.resize(60);
             put_image(f, png);
         },
         "word 0 of map 0 "},
        {"image_empty", [](GlbFile& f) { put_image(f, bytes_of("    ")); }, kNoPng},
        {"image_that_is_not_there", [](GlbFile& f) { map(f)["images"][0] = 9; }, "an image of a map is 9"},
        {"image_negative", [](GlbFile& f) { map(f)["images"][0] = -1; }, "an image of a map is -1", kRefuses},
        {"image_in_words", [](GlbFile& f) { map(f)["images"][0] = "word"; }, "an image of a map is",
         kRefuses},
        {"no_images_at_all", [](GlbFile& f) { f.json.erase("images"); },
         "the file has no images for the maps"},
        {"no_images", [](GlbFile& f) { map(f).erase("images"); }, "images", kRefuses},
        {"no_words", [](GlbFile& f) { map(f)["images"] = Json::array(); },
         "a map has 0 images, but a texel has 2 words", kRefuses},
        {"fewer_words_in_a_map", [](GlbFile& f) { map(f)["images"].erase(1); },
         "a map has 1 image, but a texel has 2 words"},
        {"more_words",
         [](GlbFile& f) {
             for (Json& m : set(f)["maps"])
                 m["images"].push_back(m["images"][0]);
         },
         "a map has 3 images, but a texel has 2 words"},
    };
}

std::vector<Damage> damages_to_clusters() {
    constexpr Schema kRefuses = Schema::refuses;
    return {
        {"cluster_beyond",
         [](GlbFile& f) {
             put_pixels(f, 8, 6, {15, 0, 0, 0});
         },
         "texel 0 has cluster 15, but there are only 11"},
        {"no_components", [](GlbFile& f) { set(f).erase("components"); }, "components", kRefuses},
        {"no_bases", [](GlbFile& f) { set(f).erase("bases"); }, "bases", kRefuses},
        {"no_packing", [](GlbFile& f) { set(f).erase("packing"); }, "packing", kRefuses},
        {"cluster_bits", [](GlbFile& f) { set(f)["packing"]["clusterBits"] = 17; }, "clusterBits is 17",
         kRefuses},
        {"predictors",
         [](GlbFile& f) {
             set(f)["predictors"] = {{{"kind", "normal"}, {"scale", {1, 1, 1}}}};
         },
         "which only vertices support", kRefuses},
    };
}

class BadLightmaps : public Pipeline {
protected:
    std::string write(const GlbFile& file, const std::string& name) {
        file.write(folder / (name + ".glb"));
        return (folder / (name + ".glb")).string();
    }

    void expect_refused(GlbFile file, const Damage& damage) {
        SCOPED_TRACE(damage.name);
        damage.change(file);
        const Outcome outcome = prt({"info", write(file, damage.name)});
        EXPECT_EQ(outcome.status, 1) << outcome.out << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("prt: error: ")) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_NE(outcome.err.find(std::string(damage.name) + ".glb: "), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(damage.message), std::string::npos) << outcome.err;
    }

    /// Expects that the schemas call the files named in `right` so, and no other.
    void expect_by_schemas(const std::vector<std::string>& files, const std::vector<std::string>& right) {
        if (std::string(PRT_NODE).empty() ||
            !std::filesystem::exists(std::string(PRT_VALIDATOR_MODULES) + "/ajv"))
            GTEST_SKIP() << "node or ajv is not installed";
        std::vector<std::string> arguments = {PRT_SCHEMA, PRT_VALIDATOR_MODULES, PRT_FORMAT};
        arguments.insert(arguments.end(), files.begin(), files.end());
        const Outcome outcome = run(PRT_NODE, arguments);
        ASSERT_LE(outcome.status, 1) << outcome.out << outcome.err;
        std::istringstream lines(outcome.out);
        std::size_t count = 0;
        for (std::string line; std::getline(lines, line); ++count) {
            const std::string name = line.substr(0, line.find(".glb: "));
            const bool expected = std::ranges::find(right, name) != right.end();
            EXPECT_EQ(line.ends_with(".glb: right"), expected) << line;
        }
        EXPECT_EQ(count, files.size()) << outcome.err;
    }

    void expect_refused(const GlbFile& file, const std::vector<Damage>& damages) {
        std::vector<std::string> files, right;
        for (const Damage& damage : damages) {
            expect_refused(file, damage);
            files.push_back((folder / (std::string(damage.name) + ".glb")).string());
            if (damage.schema == Schema::takes)
                right.emplace_back(damage.name);
        }
        expect_by_schemas(files, right);
    }
};

TEST_F(BadLightmaps, AreRejectedForInvalidMaps) {
    expect_refused(raw_file(), damages_to_maps());
    expect_refused(shipped_file(), damages_to_maps());
}

TEST_F(BadLightmaps, AreRejectedForInvalidBakes) {
    expect_refused(raw_file(), damages_to_raw());
}

TEST_F(BadLightmaps, AreRejectedForInvalidWords) {
    expect_refused(shipped_file(), damages_to_images());
    expect_refused(shipped_file(), damages_to_clusters());
}

TEST_F(BadLightmaps, AcceptsValidLightmaps) {
    std::vector<std::string> files = {write(raw_file(), "raw"), write(shipped_file(), "shipped"),
                                      write(shipped_file(true), "alike")};
    const Outcome compressed = prt({"compress", at("raw.glb"), "-o", at("coded.glb"), "--clusters", "3"});
    ASSERT_EQ(compressed.status, 0) << compressed.err;
    files.push_back(at("coded.glb"));
    for (const std::string& file : files) {
        const Outcome outcome = prt({"info", file});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(validator_errors(file), std::filesystem::exists(PRT_VALIDATOR_MODULES) ? 0 : -1);
    }
    triangle_file().write(folder / "t.glb"); // and transfer of vertices
    ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at("vertices.glb"), "--rays", "16", "--bounces", "1"}).status,
              0);
    ASSERT_EQ(prt({"compress", at("vertices.glb"), "-o", at("packed.glb"), "--clusters", "1", "--predictors",
                   "position"})
                  .status,
              0);
    ASSERT_EQ(
        prt({"compress", at("vertices.glb"), "-o", at("floats.glb"), "--clusters", "1", "--bits", "float"})
            .status,
        0);
    for (const char* name : {"vertices.glb", "packed.glb", "floats.glb"})
        files.push_back(at(name));
    expect_by_schemas(files, {"raw", "shipped", "alike", "coded", "vertices", "packed", "floats"});
}

} // namespace
} // namespace prt::test
