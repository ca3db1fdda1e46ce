// Tests writing and reading of transfer in files.

#include "prt/gltf/gltf.h"

#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/glb_file.h"
#include "support/lightmap_model.h"
#include "support/predicted.h"
#include "support/random_volume.h"
#include "support/temporary_folder.h"
#include "support/volume_model.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <span>
#include <utility>

namespace prt {
namespace {

using test::GlbFile;

BakedTransfer random_bake(const Scene& scene, const TransferLayout& layout) {
    BakedTransfer baked{{layout, {}},
                        {.bounces = 2,
                         .endless = true,
                         .rays = 77,
                         .seed = 12345678901,
                         .method = BakeMethod::raster,
                         .backend = Backend::gpu,
                         .receivers = receivers_id(scene)}};
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    baked.transfer.vectors.resize(scene.receivers() * baked.transfer.dimension());
    for (float& v : baked.transfer.vectors)
        v = normal(random);
    return baked;
}

BakedTransfer random_bake(const Scene& scene, int order, int channels) {
    return random_bake(scene, layout_of_one(order, channels));
}

CompressedTransfer random_compressed(const Scene& scene, int clusters, WeightFormat format) {
    CompressedTransfer c;
    c.record = random_bake(scene, 3, 1).record;
    ClusteredBases& b = c.transfer.bases;
    b.layout = layout_of_one(3, 3);
    std::mt19937 random(4);
    std::size_t rows = 0;
    for (int k = 0; k < clusters; ++k) {
        b.components.push_back(k % 6);
        rows += static_cast<std::size_t>(1 + k % 6);
    }
    b.rows.resize(rows * b.dimension());
    for (float& v : b.rows)
        v = static_cast<float>(random() % 1000) / 100;
    ClusteredReceivers& r = c.transfer.receivers;
    r.format = format;
    if (format == WeightFormat::packed) {
        test::code_bases(b, {1, 0.5f, 0.25f, 0.125f}, random);
        r.cluster_bits = std::bit_width(static_cast<unsigned>(clusters - 1));
        r.words = std::max(1, (r.cluster_bits + 10 * b.max_components() + 31) / 32);
        for (std::size_t i = 0; i < rows - static_cast<std::size_t>(clusters); ++i)
            b.bits.push_back(10);
        const std::vector<ClusterLayout> layouts = cluster_layouts(b);
        for (std::size_t p = 0; p < scene.receivers(); ++p) {
            const auto k = static_cast<std::uint32_t>(random() % static_cast<unsigned>(clusters));
            r.clusters.push_back(static_cast<std::uint16_t>(k));
            std::vector<std::uint32_t> words(static_cast<std::size_t>(r.words)), values(6);
            for (std::uint32_t& v : values)
                v = static_cast<std::uint32_t>(random() % 1024);
            pack_words(k, r.cluster_bits, layouts[k], values, words);
            const auto bytes = std::as_bytes(std::span(words));
            r.weights.insert(r.weights.end(), bytes.begin(), bytes.end());
        }
        return c;
    }
    r.components = (b.max_components() + 3) / 4 * 4;
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        r.clusters.push_back(static_cast<std::uint16_t>(random() % static_cast<unsigned>(clusters)));
    std::vector<float> floats(scene.receivers() * static_cast<std::size_t>(r.components));
    for (float& v : floats)
        v = static_cast<float>(random() % 1000) / 100 - 5;
    const auto bytes = std::as_bytes(std::span(floats));
    r.weights.assign(bytes.begin(), bytes.end());
    return c;
}

/// Two nodes share a mesh of two primitives; one has no normals and folds. There is data nobody knows.
GlbFile demanding_file() {
    GlbFile file = test::triangle_file();
    const auto position =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1}, test::kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, 0, 0};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    const auto color =
        file.accessor(std::vector<std::uint8_t>{9, 0, 0, 255, 8, 0, 0, 255, 7, 0, 0, 255, 6, 0, 0, 255},
                      test::kUnsignedByte, "VEC4", 4, true);
    const auto indices =
        file.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, test::kUnsignedByte, "SCALAR", 1);
    file.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", position}, {"COLOR_0", color}}},
         {"indices", indices},
         {"extras", {{"keep", 1}}}});
    file.json["nodes"] = {{{"mesh", 0}, {"name", "first"}},
                          {{"mesh", 0}, {"name", "mirrored"}, {"scale", {-1, 1, 1}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["extensionsUsed"] = {"VENDOR_unknown"};
    file.json["extensions"] = {{"VENDOR_unknown", {{"data", {1, 2, 3}}}}};
    file.json["unknownMember"] = "stays";
    return file;
}

struct OnDisk {
    test::TemporaryFolder folder;
    std::filesystem::path source = folder / "source.glb", written = folder / "written.glb";

    explicit OnDisk(const GlbFile& file) { file.write(source); }
};

TEST(TransferInGltf, RawVectorsRoundTripExactly) {
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    const BakedTransfer baked = random_bake(scene, 4, 3);
    write_transfer(document, scene, baked);
    save_glb(document, files.written);

    const GltfDocument again = load_gltf(files.written);
    const Scene scene_again = extract_scene(again);
    ASSERT_EQ(scene_again.receivers(), scene.receivers());
    EXPECT_EQ(scene_again.triangles(), scene.triangles());
    const auto read = read_transfer(again, scene_again);
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->record.endless);
    EXPECT_EQ(read->transfer.layout.order, 4);
    EXPECT_EQ(read->transfer.layout.channels(), 3);
    EXPECT_EQ(read->transfer.vectors, baked.transfer.vectors);
    EXPECT_EQ(read->record.seed, baked.record.seed);
    EXPECT_EQ(read->record.rays, 77);
    EXPECT_EQ(read->record.method, BakeMethod::raster);
    EXPECT_EQ(read->record.backend, Backend::gpu);
    EXPECT_EQ(read->record.receivers, baked.record.receivers);
    EXPECT_FALSE(read_clustered(again, scene_again));
}

TEST(TransferInGltf, TermsRoundTrip) {
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    const TransferLayout layout{3,
                                {{TermKind::direct, 1},
                                 {TermKind::indirect, 3},
                                 {TermKind::lamp, 3, "lanterns", {"Lantern.1", "glass"}},
                                 {TermKind::lamp, 1, "sign"}}};
    const BakedTransfer baked = random_bake(scene, layout);
    write_transfer(document, scene, baked);
    save_glb(document, files.written);
    const GltfDocument again = load_gltf(files.written);
    const auto read = read_transfer(again, extract_scene(again));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->transfer.layout, layout);
    EXPECT_EQ(read->transfer.vectors, baked.transfer.vectors);
}

TEST(TransferInGltf, VectorsOfAnotherLayoutAreRejected) {
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    write_transfer(document, scene, random_bake(scene, 3, 3));
    save_glb(document, files.written);
    std::ifstream file(files.written, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    for (const auto& [was, is] :
         {std::pair("\"channels\":3", "\"channels\":1"), std::pair("\"order\":3", "\"order\":2")}) {
        std::string changed = bytes; // there are more numbers than that
        changed.replace(changed.find(was), std::strlen(is), is);
        const GltfDocument again = parse_gltf(std::as_bytes(std::span(changed)), "changed.glb");
        EXPECT_THROW(read_transfer(again, extract_scene(again)), Error) << is;
    }
}

TEST(TransferInGltf, ReceiversKeepTheirPositions) {
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    write_transfer(document, scene, random_bake(scene, 1, 1));
    save_glb(document, files.written);
    const Scene again = extract_scene(load_gltf(files.written));
    ASSERT_EQ(again.vertex_arrays.size(), scene.vertex_arrays.size());
    for (std::size_t a = 0; a < scene.vertex_arrays.size(); ++a) {
        const VertexArray &before = scene.vertex_arrays[a], &after = again.vertex_arrays[a];
        ASSERT_EQ(before.size(), after.size());
        EXPECT_TRUE(after.source.empty());
        EXPECT_EQ(before.colors, after.colors);
        for (std::size_t i = 0; i < before.size(); ++i) {
            EXPECT_EQ(before.positions[i], after.positions[i]);
            EXPECT_LT(glm::distance(before.normals[i], after.normals[i]), 1e-6f) << a << " " << i;
        }
        EXPECT_EQ(scene.primitives[a].triangles, again.primitives[a].triangles);
    }
}

TEST(TransferInGltf, UnknownContentIsKept) {
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    write_transfer(document, scene, random_bake(scene, 2, 1));
    save_glb(document, files.written);
    const auto before = test::read_glb(files.source).json, after = test::read_glb(files.written).json;
    EXPECT_EQ(after["unknownMember"], "stays");
    EXPECT_EQ(after["extensions"]["VENDOR_unknown"], before["extensions"]["VENDOR_unknown"]);
    EXPECT_EQ(after["meshes"].size(), 2u); // unique
    EXPECT_EQ(after["meshes"][1]["primitives"][1]["extras"]["keep"], 1);
    EXPECT_EQ(after["nodes"][1]["name"], "mirrored");
    EXPECT_EQ(after["extensionsUsed"].size(), 2u);
}

class Weights : public testing::TestWithParam<std::pair<WeightFormat, int>> {};
INSTANTIATE_TEST_SUITE_P(
    Formats, Weights,
    testing::Values(std::pair{WeightFormat::float32, 3}, std::pair{WeightFormat::float32, 256},
                    std::pair{WeightFormat::float32, 257}, std::pair{WeightFormat::float32, 1},
                    std::pair{WeightFormat::packed, 1}, std::pair{WeightFormat::packed, 300}));

TEST_P(Weights, CompressedTransferRoundTripsExactly) {
    const auto [format, clusters] = GetParam();
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    const CompressedTransfer c = random_compressed(scene, clusters, format);
    write_clustered(document, scene, c);
    save_glb(document, files.written);
    const GltfDocument again = load_gltf(files.written);
    const auto read = read_clustered(again, extract_scene(again));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->transfer.bases.components, c.transfer.bases.components);
    EXPECT_EQ(read->transfer.bases.rows, c.transfer.bases.rows);
    EXPECT_EQ(read->transfer.bases.bits, c.transfer.bases.bits);
    EXPECT_EQ(read->transfer.receivers.format, format);
    EXPECT_EQ(read->transfer.receivers.words, c.transfer.receivers.words);
    EXPECT_EQ(read->transfer.receivers.cluster_indices(), c.transfer.receivers.cluster_indices());
    EXPECT_EQ(read->transfer.receivers.weights, c.transfer.receivers.weights);
    EXPECT_EQ(read->record.receivers, c.record.receivers);
}

TEST(TransferInGltf, CompressionRemovesRawVectors) {
    const OnDisk files(demanding_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    write_transfer(document, scene, random_bake(scene, 10, 3));
    save_glb(document, files.written);
    const auto baked_size = std::filesystem::file_size(files.written);

    GltfDocument baked = load_gltf(files.written);
    const Scene baked_scene = extract_scene(baked);
    write_clustered(baked, baked_scene, random_compressed(baked_scene, 2, WeightFormat::packed));
    save_glb(baked, files.written);
    EXPECT_LT(std::filesystem::file_size(files.written) + scene.receivers() * 1000, baked_size);
    const auto json = test::read_glb(files.written).json;
    EXPECT_EQ(json["extensions"]["PRTKIT_transfer"]["sets"].size(), 1u);
    EXPECT_EQ(test::set_of(json, "vertices")["coding"], "clustered");
    EXPECT_FALSE(json["meshes"][0]["primitives"][0].contains("extensions"));
    EXPECT_EQ(json["extensionsUsed"], (nlohmann::ordered_json{"VENDOR_unknown", "PRTKIT_transfer"}));
    const Scene again = extract_scene(load_gltf(files.written));
    for (std::size_t a = 0; a < again.vertex_arrays.size(); ++a)
        EXPECT_EQ(again.vertex_arrays[a].positions, baked_scene.vertex_arrays[a].positions);
}

TEST(TransferInGltf, WritingIsIdempotent) {
    const OnDisk files(demanding_file());
    for (int time = 0; time < 3; ++time) {
        GltfDocument document = load_gltf(time == 0 ? files.source : files.written);
        const Scene scene = extract_scene(document);
        if (time % 2 == 1)
            write_clustered(document, scene, random_compressed(scene, 2, WeightFormat::packed));
        write_transfer(document, scene, random_bake(scene, 3, 1));
        save_glb(document, files.folder / ("size" + std::to_string(time)));
        save_glb(document, files.written);
    }
    EXPECT_EQ(std::filesystem::file_size(files.folder / "size0"),
              std::filesystem::file_size(files.folder / "size1"));
    EXPECT_EQ(std::filesystem::file_size(files.folder / "size1"),
              std::filesystem::file_size(files.folder / "size2"));
}

/// A file with compressed transfer whose JSON can be changed before it is read again.
class Damage {
public:
    explicit Damage(WeightFormat format) : files_(test::triangle_file()) {
        GltfDocument document = load_gltf(files_.source);
        const Scene scene = extract_scene(document);
        write_clustered(document, scene, random_compressed(scene, 2, format));
        save_glb(document, files_.written);
        good_ = test::read_glb(files_.written).json;
        std::ifstream file(files_.written, std::ios::binary);
        bytes_.assign((std::istreambuf_iterator<char>(file)), {});
    }
    void operator()(const std::function<void(nlohmann::ordered_json&)>& change) const {
        in_file([&](GlbFile& file) { change(file.json); });
    }
    void in_file(const std::function<void(GlbFile&)>& change) const {
        GlbFile changed;
        changed.json = good_;
        std::uint32_t length = 0;
        std::memcpy(&length, bytes_.data() + 12, 4);
        const auto* data = reinterpret_cast<const std::byte*>(bytes_.data());
        changed.binary.assign(data + 28 + length, data + bytes_.size());
        change(changed);
        changed.json.erase("buffers"); // it is rewritten with the current length
        changed.write(files_.folder / "changed.glb");
        const GltfDocument d = load_gltf(files_.folder / "changed.glb");
        read_clustered(d, extract_scene(d));
    }

private:
    OnDisk files_;
    nlohmann::ordered_json good_;
    std::string bytes_;
};

nlohmann::ordered_json& extension(nlohmann::ordered_json& json) {
    return test::set_of(json, "vertices");
}

TEST(TransferInGltf, DamagedPackedTransferIsRejected) {
    const Damage read_changed(WeightFormat::packed);
    EXPECT_NO_THROW(read_changed([](auto&) {}));
    EXPECT_THROW(read_changed([&](auto& j) { extension(j).erase("packing"); }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["packing"]["clusterBits"] = 17; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["components"] = {9, 17}; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) {
                     extension(j)["components"] = {0, 5};
                 }),
                 Error); // rows are missing
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["bases"]["values"]["drops"].push_back(1); }),
                 Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["bases"]["axes"]["drops"].erase(0); }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["bases"].erase("steps"); }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["bases"]["scales"]["bufferView"] = 99; }), Error);
}

TEST(TransferInGltf, DamagedTransferIsRejected) {
    const Damage read_changed(WeightFormat::float32);
    EXPECT_NO_THROW(read_changed([](auto&) {}));
    EXPECT_THROW(read_changed([&](auto& j) { j["extensions"]["PRTKIT_transfer"]["version"] = 99; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["order"] = 11; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["terms"][0]["channels"] = 2; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["bake"]["method"] = "guess"; }), Error);
    EXPECT_NO_THROW(read_changed([&](auto& j) { extension(j)["bake"].erase("method"); }));
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["components"] = {100}; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["components"] = nlohmann::ordered_json::array(); }),
                 Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["components"] = {9, 9, 9}; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j)["bases"]["bufferView"] = 77; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { extension(j).erase("bases"); }), Error);
    EXPECT_THROW(
        read_changed([&](auto& j) { j["meshes"][0]["primitives"][0]["attributes"].erase("_PRT_CLUSTER"); }),
        Error);
    EXPECT_THROW(
        read_changed([&](auto& j) { j["meshes"][0]["primitives"][0]["attributes"]["_PRT_CLUSTER"] = 0; }),
        Error);
}

TEST(TransferInGltf, PrimitivesOfTheSameVerticesAreInTheSameClusters) {
    const Damage read_changed(WeightFormat::float32);
    const auto doubled = [](auto& j) -> auto& {
        auto& primitives = j["meshes"][0]["primitives"];
        primitives.push_back(primitives[0]);
        return primitives[1]["attributes"];
    };
    EXPECT_NO_THROW(read_changed([&](auto& j) { doubled(j); }));
    EXPECT_THROW(read_changed([&](auto& j) { doubled(j)["_PRT_CLUSTER"] = 0; }), Error);
    EXPECT_THROW(read_changed([&](auto& j) { doubled(j).erase("_PRT_WEIGHTS_0"); }), Error);
}

std::string refusal(const Damage& read_changed, const std::function<void(GlbFile&)>& change) {
    try {
        read_changed.in_file(change);
    } catch (const Error& error) {
        return error.what();
    }
    return "was read";
}

/// Other programs change files with data that they do not support: each change is refused with the reason and
/// the remedy.
TEST(TransferInGltf, ChangesOfOtherProgramsAreRejectedWithTheRemedy) {
    const std::string remedy =
        ": another program has changed the file; run that program before prt bake, or run prt compress again";
    const auto attributes = [](GlbFile& file) -> nlohmann::ordered_json& {
        return file.json["meshes"][0]["primitives"][0]["attributes"];
    };
    const auto weights = [&](GlbFile& file) -> nlohmann::ordered_json& {
        return file.json["accessors"][attributes(file)["_PRT_WEIGHTS_0"].get<std::size_t>()];
    };
    const auto expect = [&](WeightFormat format, const std::string& reason,
                            const std::function<void(GlbFile&)>& change) {
        const std::string refused = refusal(Damage(format), change);
        EXPECT_NE(refused.find(reason + remedy), std::string::npos) << refused;
    };
    for (const WeightFormat format : {WeightFormat::packed, WeightFormat::float32}) {
        const std::string type = format == WeightFormat::packed ? "5121" : "5126";
        expect(format, "_PRT_WEIGHTS_0 has component type 5120, not " + type, [&](GlbFile& file) {
            weights(file)["componentType"] = test::kByte;
            weights(file)["normalized"] = true;
        });
        expect(format, "has no attribute _PRT_WEIGHTS_0",
               [&](GlbFile& file) { attributes(file).erase("_PRT_WEIGHTS_0"); });
        expect(format, "_PRT_WEIGHTS_0, but not the extension PRTKIT_transfer", [&](GlbFile& file) {
            file.json.erase("extensions");
            attributes(file).erase("_PRT_CLUSTER");
        });
    }
    expect(WeightFormat::float32, "has no attribute _PRT_CLUSTER",
           [&](GlbFile& file) { attributes(file).erase("_PRT_CLUSTER"); });
    expect(WeightFormat::float32, "_PRT_CLUSTER, but not the extension PRTKIT_transfer",
           [&](GlbFile& file) { file.json.erase("extensions"); });
    // Integers as floats, and as shares of their type.
    expect(WeightFormat::packed, "_PRT_WEIGHTS_0 has component type 5126, not 5121", [&](GlbFile& file) {
        const std::size_t count = weights(file)["count"];
        attributes(file)["_PRT_WEIGHTS_0"] =
            file.accessor(std::vector<float>(4 * count, 1), test::kFloat, "VEC4", 4);
    });
    expect(WeightFormat::packed, "_PRT_WEIGHTS_0 is normalized, but must not be",
           [&](GlbFile& file) { weights(file)["normalized"] = true; });
}

/// Puts `value` over float `index` of a buffer view.
void put_float(GlbFile& file, const nlohmann::ordered_json& view, std::size_t index, float value) {
    const auto offset = file.json["bufferViews"][view.get<std::size_t>()]["byteOffset"].get<std::size_t>();
    std::memcpy(&file.binary[offset + index * sizeof value], &value, sizeof value);
}

TEST(TransferInGltf, SchemaViolationsAreRejected) {
    const Damage read_changed(WeightFormat::packed);
    const auto bases = [](auto& j) -> auto& {
        return extension(j)["bases"];
    };
    const std::function<void(nlohmann::ordered_json&)> changes[] = {
        [&](auto& j) { j["extensions"]["PRTKIT_transfer"]["version"] = 2.5; },
        [&](auto& j) { j["extensions"]["PRTKIT_transfer"]["sets"] = 3; },
        [&](auto& j) { j["extensions"]["PRTKIT_transfer"]["sets"].push_back(extension(j)); },
        [&](auto& j) { extension(j)["receivers"] = 3; },
        [&](auto& j) { extension(j)["coding"] = nullptr; },
        [&](auto& j) { extension(j)["order"] = 3.5; },
        [&](auto& j) { extension(j)["terms"][0]["channels"] = 3.5; },
        [&](auto& j) { extension(j)["terms"][0]["kind"] = "lamp"; },
        [&](auto& j) { extension(j)["terms"][0]["kind"] = 1; },
        [&](auto& j) { extension(j)["terms"][0].erase("channels"); },
        [&](auto& j) { extension(j)["terms"].push_back(extension(j)["terms"][0]); },
        [&](auto& j) { extension(j)["terms"] = nlohmann::ordered_json::array(); },
        [&](auto& j) { extension(j)["terms"] = "combined"; },
        [&](auto& j) {
            extension(j)["terms"][0]["towards"] = {0, 1, 0};
        },
        [&](auto& j) { extension(j)["components"][1] = 1.5; },
        [&](auto& j) { extension(j)["components"][1] = (1LL << 33) + 1; },
        [&](auto& j) { extension(j)["components"][0] = -1; },
        [&](auto& j) { extension(j)["packing"]["clusterBits"] = 0; }, // for two clusters
        [&](auto& j) { extension(j)["packing"]["clusterBits"] = 1.5; },
        [&](auto& j) { bases(j)["step"] = 0.01; }, // not allowed together with "steps"
        [&](auto& j) { bases(j)["steps"]["least"] = -0.01; },
        [&](auto& j) { bases(j)["steps"]["least"] = "small"; },
        [&](auto& j) { bases(j)["steps"]["least"] = 1e39; },
        [&](auto& j) { bases(j)["steps"]["axes"] = nlohmann::ordered_json::array(); },
        [&](auto& j) { bases(j)["steps"]["axes"][0] = 65536; },
        [&](auto& j) { bases(j)["steps"]["axes"][0] = -1; },
        [&](auto& j) { bases(j)["steps"]["axes"] = "all"; },
        [&](auto& j) { bases(j)["steps"]["drops"].push_back(0); },
        [&](auto& j) { bases(j)["steps"].erase("drops"); },
        [&](auto& j) { bases(j)["axes"]["drops"][0] = 16; },
        [&](auto& j) { bases(j)["values"]["drops"][0] = 257; },
        [&](auto& j) { bases(j)["values"]["drops"][0] = 0.5; },
        [&](auto& j) { bases(j)["origin"]["componentType"] = 5131; },
        [&](auto& j) { extension(j)["bake"]["raysPerReceiver"] = -1; },
        [&](auto& j) { extension(j)["bake"]["raysPerReceiver"] = 1LL << 33; },
        [&](auto& j) { extension(j)["bake"]["bounces"] = 1.5; },
        [&](auto& j) { extension(j)["bake"]["seed"] = -3; },
        [&](auto& j) { extension(j)["bake"]["receivers"] = "\x1b[31mred        "; },
        [&](auto& j) { extension(j)["bake"]["samplingError"] = -1; },
        [&](auto& j) { extension(j)["bake"]["samplingError"] = nullptr; }};
    for (std::size_t i = 0; i < std::size(changes); ++i)
        EXPECT_THROW(read_changed(changes[i]), Error) << i;
}

/// Vertices, texels and probes in one file: each set is read, and removed, without the others.
TEST(TransferInGltf, SetsOfAllReceiversShareAFile) {
    std::mt19937 random(5);
    const BakedLightmap lightmap =
        test::made_up_lightmap(test::layout_of_floor({8, 6}, {5, 4}), layout_of_one(2, 1), random);
    const CompressedVolume volume = test::random_volume(2, false, random);
    GlbFile file = test::with_volume(test::with_lightmap(test::mapped_floor(2), lightmap), volume);
    const auto parsed = [&] {
        const std::string bytes = file.bytes();
        return parse_gltf(std::as_bytes(std::span(bytes)), "floor.glb");
    };
    const Scene scene = extract_scene(parsed());
    const BakedTransfer vertices = random_bake(scene, 3, 1);
    std::vector<std::size_t> views;
    for (const VertexArray& array : scene.vertex_arrays) {
        const std::size_t dimension = vertices.transfer.dimension();
        const auto vectors = std::span(vertices.transfer.vectors)
                                 .subspan(array.first_receiver * dimension, array.size() * dimension);
        views.push_back(file.view(std::as_bytes(vectors)));
    }
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        file.json["meshes"][0]["primitives"][p]["extensions"]["PRTKIT_transfer"]["vectors"] = {
            {"bufferView", views[scene.primitives[p].vertices]}};
    file.json["extensions"]["PRTKIT_transfer"]["sets"].push_back(
        {{"receivers", "vertices"},
         {"coding", "raw"},
         {"order", 3},
         {"terms", {{{"kind", "combined"}, {"channels", 1}}}}});
    file.json.erase("buffers");
    GltfDocument all = parsed();
    EXPECT_EQ(read_transfer(all, scene)->transfer.vectors, vertices.transfer.vectors);
    EXPECT_EQ(read_lightmap(all, scene)->baked.transfer.vectors, lightmap.baked.transfer.vectors);
    EXPECT_EQ(read_compressed_volume(all, scene)->compressed.transfer.receivers.weights,
              volume.compressed.transfer.receivers.weights);
    discard_volume(all);
    EXPECT_EQ(read_transfer(all, scene)->transfer.vectors, vertices.transfer.vectors);
    EXPECT_EQ(read_lightmap(all, scene)->texels, lightmap.texels);
    EXPECT_FALSE(read_compressed_volume(all, scene));
    all = parsed();
    discard_transfer(all);
    EXPECT_FALSE(read_transfer(all, scene));
    EXPECT_FALSE(read_lightmap(all, scene));
    EXPECT_TRUE(read_compressed_volume(all, scene));
    discard_volume(all);
    const test::TemporaryFolder folder;
    save_glb(all, folder / "none.glb");
    EXPECT_EQ(test::read_glb(folder / "none.glb").json.dump().find("PRTKIT"), std::string::npos);
}

/// Transfer of a former version: readers refuse it with a remedy, but a bake can replace it.
TEST(TransferInGltf, FormerTransferIsReplaced) {
    const test::TemporaryFolder folder;
    GlbFile file = test::triangle_file();
    const std::size_t view = file.view(std::vector<std::byte>(36));
    file.json["extensions"]["PRTKIT_transfer"] = {
        {"version", 5}, {"order", 1}, {"terms", {{{"kind", "combined"}, {"channels", 1}}}}};
    file.json["extensions"]["PRTKIT_transfer_volume"] = {{"version", 2}, {"bricks", {{"bufferView", view}}}};
    file.json["meshes"][0]["primitives"][0]["extensions"]["PRTKIT_transfer"]["vectors"] = {
        {"bufferView", view}};
    file.json["extensionsUsed"] = {"PRTKIT_transfer", "PRTKIT_transfer_volume"};
    file.write(folder / "former.glb");
    GltfDocument document = load_gltf(folder / "former.glb");
    const Scene scene = extract_scene(document);
    EXPECT_THROW(read_transfer(document, scene), Error);
    write_transfer(document, scene, random_bake(scene, 1, 1));
    save_glb(document, folder / "now.glb");
    EXPECT_TRUE(read_transfer(load_gltf(folder / "now.glb"), scene));
    EXPECT_EQ(test::read_glb(folder / "now.glb").json.dump().find("PRTKIT_transfer_volume"),
              std::string::npos);
}

TEST(TransferInGltf, DecodedBasesAreFinite) {
    const Damage read_changed(WeightFormat::packed);
    const auto huge = [](GlbFile& file) {
        auto& bases = extension(file.json)["bases"];
        bases["steps"]["least"] = 3e38;
        put_float(file, bases["scales"]["bufferView"], 0, 3e38f);
    };
    EXPECT_NE(refusal(read_changed, huge).find("decoded bases"), std::string::npos);
}

TEST(TransferInGltf, WeightsAndVectorsAreFiniteAndNotHuge) {
    const Damage read_changed(WeightFormat::float32);
    for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity(), 3e38f}) {
        const auto weight = [&](GlbFile& file) {
            const auto accessor =
                file.json["meshes"][0]["primitives"][0]["attributes"]["_PRT_WEIGHTS_0"].get<std::size_t>();
            put_float(file, file.json["accessors"][accessor]["bufferView"], 1, value);
        };
        EXPECT_NE(refusal(read_changed, weight).find("the weights"), std::string::npos);
        const auto basis = [&](GlbFile& file) {
            put_float(file, extension(file.json)["bases"]["bufferView"], 2, value);
        };
        EXPECT_NE(refusal(read_changed, basis).find("the bases"), std::string::npos);

        const OnDisk files(test::triangle_file());
        GltfDocument document = load_gltf(files.source);
        const Scene scene = extract_scene(document);
        BakedTransfer baked = random_bake(scene, 2, 1);
        baked.transfer.vectors[3] = value;
        write_transfer(document, scene, baked);
        save_glb(document, files.written);
        EXPECT_THROW(read_transfer(load_gltf(files.written), scene), Error);
    }
}

TEST(TransferInGltf, MissingDataIsNotAllocated) {
    const Damage read_plain(WeightFormat::float32), read_coded(WeightFormat::packed);
    const auto many_clusters = [](GlbFile& file) {
        extension(file.json)["components"] = std::vector<int>(65536, 27);
    };
    EXPECT_NE(refusal(read_plain, many_clusters).find("bytes, but the buffer view has"), std::string::npos);
    // A row of zeros has four bits and is decoded to one value per axis.
    const auto many_axes = [&](GlbFile& file) {
        auto& e = extension(file.json);
        e["components"] = std::vector<int>(2048, 16);
        e["packing"]["clusterBits"] = 11;
        e["packing"]["bufferView"] = file.view(std::vector<std::byte>(2048 * 8));
        e["bases"]["values"] = {{"drops", std::vector<int>(20000, 0)},
                                {"bufferView", file.view(std::vector<std::byte>(17 * 2048 / 2))}};
        e["bases"]["scales"]["bufferView"] = file.view(std::vector<std::byte>(80000));
    };
    EXPECT_NE(refusal(read_coded, many_axes).find("its bases would need"), std::string::npos);
}

TEST(TransferInGltf, DataSharedWithGeometryIsKept) {
    const OnDisk files(test::triangle_file());
    GltfDocument document = load_gltf(files.source);
    const Scene scene = extract_scene(document);
    write_transfer(document, scene, random_bake(scene, 1, 1));
    save_glb(document, files.written);
    GlbFile shared = test::triangle_file();
    shared.json["extensions"]["PRTKIT_transfer"] =
        test::read_glb(files.written).json["extensions"]["PRTKIT_transfer"];
    auto& primitive = shared.json["meshes"][0]["primitives"][0];
    primitive["extensions"]["PRTKIT_transfer"]["vectors"] = {{"bufferView", 0}}; // the view of the positions
    primitive["attributes"]["_PRT_CLUSTER"] = 1;                                 // the normals
    shared.write(files.source);
    GltfDocument again = load_gltf(files.source);
    write_transfer(again, extract_scene(again), random_bake(scene, 1, 1));
    save_glb(again, files.written);
    const Scene after = extract_scene(load_gltf(files.written));
    EXPECT_EQ(after.vertex_arrays[0].positions, scene.vertex_arrays[0].positions);
    EXPECT_EQ(after.vertex_arrays[0].normals, scene.vertex_arrays[0].normals);
}

} // namespace
} // namespace prt
