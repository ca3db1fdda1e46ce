// Measures size and decoding speed of the packed words of shipped files: words_benchmark SHIPPED.glb ...
#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "runtime/core/support/stopwatch.h"
#include "runtime/core/transfer/coded_words.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace prt {
namespace {

struct Words {
    WordLayout layout;
    std::vector<std::uint32_t> triangles, words;
};

Words read_words(const char* path) {
    const GltfDocument document = load_gltf(path);
    const Scene scene = extract_scene(document);
    const std::optional<CompressedTransfer> compressed = read_clustered(document, scene);
    if (!compressed || compressed->transfer.receivers.format != WeightFormat::packed)
        throw Error(std::string(path) + ": has no packed weights");
    const ClusteredReceivers& receivers = compressed->transfer.receivers;
    Words result{
        {cluster_layouts(compressed->transfer.bases), receivers.cluster_bits, receivers.words}, {}, {}};
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            for (int i = 0; i < 3; ++i)
                result.triangles.push_back(first + t[i]);
    }
    result.words.resize(receivers.weights.size() / 4);
    std::memcpy(result.words.data(), receivers.weights.data(), receivers.weights.size());
    return result;
}

void measure(const char* path) {
    const Words given = read_words(path);
    const std::size_t receivers = given.words.size() / static_cast<std::size_t>(given.layout.words);
    const WordCode code =
        encode_words(given.layout, earlier_neighbors(given.triangles, receivers), given.words);
    double neighbor_seconds = 1e9, seconds = 1e9; // minimum of many runs, because of other programs
    for (int i = 0; i < 50; ++i) {
        Stopwatch watch;
        const auto neighbors = earlier_neighbors(given.triangles, receivers);
        const double first = watch.seconds();
        const auto decoded = decode_words(code, given.layout, neighbors);
        neighbor_seconds = std::min(neighbor_seconds, first);
        seconds = std::min(seconds, watch.seconds());
        if (decoded != given.words)
            throw Error(std::string(path) + ": decoded words differ from the coded ones");
    }
    const double bytes = 4 * static_cast<double>(given.words.size());
    const std::size_t frequencies = coded_bytes(code.frequencies);
    std::printf(
        "%s: %zu vertices, %.0f bytes coded in %zu and %zu of frequencies: %.3f; %.0f MB/s, %.0f ns per "
        "vertex, of which neighbors %.0f\n",
        path, receivers, bytes, code.bits.size(), frequencies,
        static_cast<double>(code.bits.size() + frequencies) / bytes, 1e-6 * bytes / seconds,
        1e9 * seconds / static_cast<double>(receivers),
        1e9 * neighbor_seconds / static_cast<double>(receivers));
}

} // namespace
} // namespace prt

int main(int argc, char** argv) {
    try {
        for (int i = 1; i < argc; ++i)
            prt::measure(argv[i]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "words_benchmark: %s\n", error.what());
        return 1;
    }
}
