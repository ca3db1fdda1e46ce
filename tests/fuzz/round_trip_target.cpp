// Compresses transfer, writes it, reads it and evaluates it: the light before and after is equal to the bit.
// The first eight bytes select options, the rest is transfer, repeated.
#include "input_file.h"

#include "prt/compress/compress.h"
#include "prt/gltf/gltf.h"
#include "runtime/load/mesh_edges.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <bit>
#include <cstring>

namespace prt::fuzz {
namespace {

constexpr std::size_t kHead = 8;

struct Model {
    GltfDocument document;
    Scene scene;
};

/// A floor of 24 vertices, as `prt bake` writes it.
Model floor_model() {
    const std::string file = test::scene_file(test::SceneBuilder().floor(glm::vec3(0), 1, 2).build()).bytes();
    GltfDocument document = parse_gltf(std::as_bytes(std::span(file)), "floor.glb");
    Scene scene = extract_scene(document);
    return {std::move(document), std::move(scene)};
}

/// Transfer out of bytes: fractions, or any floats at all.
Transfer transfer_of(std::span<const std::uint8_t> head, std::span<const std::uint8_t> rest,
                     std::size_t receivers) {
    TransferLayout layout = layout_of_one(1 + head[0] % 4, head[1] % 2 == 0 ? 1 : 3);
    if (head[1] & 4)
        layout.terms = {{TermKind::direct, layout.channels()}, {TermKind::indirect, head[1] & 8 ? 1 : 3}};
    Transfer transfer{layout, {}};
    transfer.vectors.resize(receivers * transfer.dimension());
    const bool raw = head[1] & 2;
    const std::size_t size = raw ? 4 : 1;
    for (std::size_t i = 0; i < transfer.vectors.size() && rest.size() >= size; ++i) {
        const std::uint8_t* at = &rest[i * size % (rest.size() - size + 1)];
        if (raw)
            std::memcpy(&transfer.vectors[i], at, size);
        else
            transfer.vectors[i] = static_cast<float>(static_cast<std::int8_t>(*at)) / 128;
    }
    return transfer;
}

CompressOptions options_of(std::span<const std::uint8_t> head) {
    CompressOptions options{.clusters = 1 + head[2] % 32, .threads = 1};
    WeightCoding& coding = options.coding;
    coding.format = head[3] % 2 == 0 ? WeightFormat::float32 : WeightFormat::packed;
    coding.components = head[4] % 20;
    coding.bits = head[5];
    if (head[3] & 4)
        coding = head[3] & 8 ? preset_u32() : preset_u64();
    if (head[3] & 16)
        options.basis_share = head[6] / 256.0;
    if (head[3] & 32)
        options.mean_components = head[7] / 16.0;
    options.bases_count = head[3] & 64;
    options.seam_weight = head[7] & 1 ? head[6] / 64.0 : 0;
    return options;
}

std::vector<glm::vec3> lit(const ClusteredTransfer& transfer) {
    std::vector<glm::vec3> radiance =
        exit_radiance(transfer, constant_light(transfer.bases.layout.order, glm::vec3(1)), 1);
    for (const glm::vec3& value : radiance)
        expect_finite(std::span<const float>(&value.x, 3), "exit radiance");
    return radiance;
}

void round_trip(std::span<const std::uint8_t> input, const InputFile& file) {
    static Model model = floor_model();
    static const std::vector<float> areas = receiver_areas(model.scene);
    static const std::vector<Edge> edges = mesh_edges(model.scene);
    const auto head = input.first(kHead);
    const Transfer transfer = transfer_of(head, input.subspan(kHead), model.scene.receivers());
    CompressedTransfer compressed{compress(transfer, {areas, edges}, options_of(head)).transfer,
                                  {.receivers = receivers_id(model.scene)}};
    write_clustered(model.document, model.scene, compressed);
    save_glb(model.document, file.path(),
             head[2] & 32 ? BufferCompression::meshopt : BufferCompression::none);
    const GltfDocument document = load_gltf(file.path());
    const auto read = read_clustered(document, extract_scene(document));
    expect(read.has_value(), "the written file has lost its transfer");
    const std::vector<glm::vec3> before = lit(compressed.transfer), after = lit(read->transfer);
    expect(before.size() == after.size() &&
               std::memcmp(before.data(), after.data(), before.size() * sizeof(glm::vec3)) == 0,
           "what was read lights in another way than what was written");
}

} // namespace
} // namespace prt::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt::fuzz;
    static const InputFile file("round_trip.glb");
    if (size < kHead)
        return 0;
    return take([&] { round_trip({data, size}, file); });
}
