// Adds transfer to a model that was read, writes it, plain or compressed, and reads it back, as bake and
// compress do.
#include "input_file.h"
#include "whole_model.h"

#include "bake/gltf/reorder.h"
#include "runtime/core/support/file.h"

#include <algorithm>
#include <numeric>

namespace prt::fuzz {
namespace {

/// Options in the bits of the input's last byte.
constexpr unsigned kWithMeshopt = 1, kWithClusters = 2, kWithNewOrder = 4;

BakedTransfer some_transfer(const Scene& scene) {
    BakedTransfer baked{{layout_of_one(1, 1), {}}, {.rays = 1, .receivers = receivers_id(scene)}};
    baked.transfer.vectors.resize(scene.receivers());
    std::iota(baked.transfer.vectors.begin(), baked.transfer.vectors.end(), 0.f);
    return baked;
}

CompressedTransfer some_clusters(const Scene& scene) {
    CompressedTransfer compressed;
    compressed.record.receivers = receivers_id(scene);
    ClusteredTransfer& transfer = compressed.transfer;
    transfer.bases = {
        .layout = layout_of_one(1, 1), .components = {1}, .rows = {0, 1}, .bits = {7}, .coded = {}};
    transfer.receivers.format = WeightFormat::packed;
    transfer.receivers.words = 1;
    transfer.receivers.weights.resize(4 * scene.receivers());
    for (std::size_t i = 0; i < transfer.receivers.weights.size(); i += 4)
        transfer.receivers.weights[i] = static_cast<std::byte>(i / 4 % 128);
    return compressed;
}

/// Reads a written file; an error is a bug of the writer.
WholeModel read_again(const InputFile& file, std::size_t receivers) {
    try {
        WholeModel model = read_whole(read_file(file.path()), file.path());
        expect(model.scene.receivers() == receivers, "the written file has another number of vertices");
        return model;
    } catch (const Error& error) {
        std::fprintf(stderr, "fuzz: %s\n", error.what());
        expect(false, "what was written cannot be read");
        throw;
    }
}

void reverse_vertices(WholeModel& model) {
    std::vector<std::uint32_t> order(model.scene.receivers());
    std::iota(order.begin(), order.end(), 0u);
    for (const VertexArray& vertices : model.scene.vertex_arrays) {
        const auto begin = order.begin() + static_cast<std::ptrdiff_t>(vertices.first_receiver);
        std::reverse(begin, begin + static_cast<std::ptrdiff_t>(vertices.size()));
    }
    reorder_vertices(model.document, model.scene, order);
}

void rewrite(WholeModel model, const InputFile& file, unsigned bits) {
    const std::size_t receivers = model.scene.receivers();
    if (receivers > 20'000) // slow, and covers no other code
        return;
    if (std::ranges::all_of(model.scene.vertex_arrays, &VertexArray::lobes)) // prt bake rejects such a file
        return;
    write_transfer(model.document, model.scene, some_transfer(model.scene));
    save_glb(model.document, file.path());
    WholeModel baked = read_again(file, receivers);
    expect(baked.baked.has_value(), "the written file has lost its transfer");
    if (bits & kWithNewOrder)
        reverse_vertices(baked);
    if (bits & kWithClusters)
        write_clustered(baked.document, baked.scene, some_clusters(baked.scene));
    else
        write_transfer(baked.document, baked.scene, some_transfer(baked.scene));
    save_glb(baked.document, file.path(),
             bits & kWithMeshopt ? BufferCompression::meshopt : BufferCompression::none);
    const WholeModel last = read_again(file, receivers);
    expect(bits & kWithClusters ? last.compressed.has_value() : last.baked.has_value(),
           "the written file has lost its transfer");
}

} // namespace
} // namespace prt::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt::fuzz;
    static const InputFile file("rewritten.glb");
    return take([&] {
        const unsigned bits = size > 0 ? data[size - 1] : 0;
        rewrite(read_whole(bytes(data, size), file.path()), file, bits);
    });
}
