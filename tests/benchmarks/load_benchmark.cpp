// Measures the time and the memory of loading shipped files, relative to a bare glTF parser:
// load_benchmark SHIPPED.glb ...
#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "prt/load/model.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/stopwatch.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include <malloc.h>

namespace prt {
namespace {

constexpr int kRuns = 7;

/// Returns the minimum time of several runs, seconds.
template <class Work>
double best(Work work) {
    double seconds = 1e9;
    for (int i = 0; i < kRuns; ++i) {
        const Stopwatch watch;
        work();
        seconds = std::min(seconds, watch.seconds());
    }
    return seconds;
}

/// Parses the file as a program does that only draws it: no images, and no copies of accessors.
void parse_bare(const char* path) {
    const std::vector<std::byte> file = read_file(path);
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader([](auto...) { return true; }, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    if (!loader.LoadBinaryFromMemory(&model, &error, &warning,
                                     reinterpret_cast<const unsigned char*>(file.data()),
                                     static_cast<unsigned>(file.size())))
        throw Error(path + (": " + error));
}

void read_with_tools(const char* path) {
    const GltfDocument document = load_gltf(path);
    read_clustered(document, extract_scene(document));
}

double megabytes(std::size_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

std::size_t heap() {
    return mallinfo2().uordblks + mallinfo2().hblkhd;
}

void measure(const char* path) {
    const double bare = best([&] { parse_bare(path); }), load = best([&] { load_model(path); }),
                 tools = best([&] { read_with_tools(path); });
    const std::size_t before = heap();
    const Model model = load_model(path);
    const std::size_t after = heap();
    if (!model.vertices)
        throw Error(path + std::string(": contains no compressed transfer of vertices"));
    const ClusteredReceivers& receivers = model.vertices->transfer.receivers;
    std::size_t geometry = 0;
    for (const VertexArray& vertices : model.scene.vertex_arrays)
        geometry += vertices.size() * 2 * sizeof(glm::vec3);
    geometry += model.scene.triangles() * sizeof(glm::uvec3);
    const auto per_vertex = [&](std::size_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(receivers.size());
    };
    std::printf(
        "%s: %zu vertices\n"
        "  bare parser %.1f ms, load_model %.1f ms (%.2f), load_gltf and extract_scene %.1f ms (%.2f)\n"
        "  heap %.1f MB: positions, normals and indices %.1f MB, weights %.1f MB; other %.2f bytes per "
        "vertex\n",
        path, receivers.size(), 1e3 * bare, 1e3 * load, load / bare, 1e3 * tools, tools / bare,
        megabytes(after - before), megabytes(geometry), megabytes(receivers.weights.size()),
        per_vertex(after - before - geometry - receivers.weights.size()));
}

} // namespace
} // namespace prt

int main(int count, char** paths) {
    try {
        for (int i = 1; i < count; ++i)
            prt::measure(paths[i]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "load_benchmark: %s\n", error.what());
        return 1;
    }
    return 0;
}
