// Seeds: compressed buffer views, light files, coded words, and transfer for the round trip.
#include "seeds.h"
#include "word_input.h"

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numeric>
#include <string>
#include <vector>

namespace prt::fuzz {
namespace {

void write(const Path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Encodes a seed for meshopt_target.cpp: mode and filter, and above them stride / 4 - 1 or / 2 - 1; then the
/// number of elements.
std::string view_seed(int choice, std::size_t count, const std::vector<unsigned char>& data) {
    std::string seed{char(choice), char(count % 256), char(count / 256)};
    return seed.append(data.begin(), data.end());
}

void write_view_seeds(const Path& folder) {
    constexpr std::size_t kCount = 48;
    std::vector<unsigned> indices(kCount);
    for (std::size_t i = 0; i < kCount; ++i)
        indices[i] = static_cast<unsigned>(i / 3 + i % 3);
    meshopt_encodeIndexVersion(1);
    meshopt_encodeVertexVersion(0);
    std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(kCount, kCount));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), kCount));
    std::vector<unsigned char> list(meshopt_encodeIndexSequenceBound(kCount, kCount));
    list.resize(meshopt_encodeIndexSequence(list.data(), list.size(), indices.data(), kCount));
    for (const int width : {0, 1}) {
        write(folder / ("triangles" + std::to_string(width)), view_seed(1 + 16 * width, kCount, triangles));
        write(folder / ("indices" + std::to_string(width)), view_seed(2 + 16 * width, kCount, list));
    }
    for (const int filter : {0, 1, 2, 3})
        for (const int width : {0, 1, 2, 7}) {
            const std::size_t stride = 4 * static_cast<std::size_t>(width + 1);
            std::vector<unsigned char> vertices(kCount * stride);
            std::iota(vertices.begin(), vertices.end(), static_cast<unsigned char>(0));
            std::vector<unsigned char> data(meshopt_encodeVertexBufferBound(kCount, stride));
            data.resize(
                meshopt_encodeVertexBuffer(data.data(), data.size(), vertices.data(), kCount, stride));
            write(folder / ("vertices" + std::to_string(filter) + std::to_string(width)),
                  view_seed(4 * filter + 16 * width, kCount, data));
        }
}

void write_light_seeds(const Path& folder) {
    for (const int order : {1, 2, 6}) {
        const std::vector<double> values(static_cast<std::size_t>(order * order), 0.5);
        const nlohmann::ordered_json light = {
            {"prtkit_light", 1},
            {"order", order},
            {"coefficients", {{"red", values}, {"green", values}, {"blue", values}}},
            {"suns", {{{"towards", {0, 1, 0}}, {"irradiance", {3, 2, 1}}, {"half_angle_radians", 0.004}}}}};
        write(folder / ("light" + std::to_string(order)), light.dump());
    }
}

/// Seeds for mesh_target.cpp, whose first byte chooses the format.
void write_mesh_seeds(const Path& folder) {
    const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    write(folder / "ascii.ply", std::string(1, '\0') + "ply\nformat ascii 1.0\n" + vertices + faces +
                                    "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2\n");
    std::string binary = std::string(1, '\0') + "ply\nformat binary_little_endian 1.0\n" + vertices + faces;
    binary.append(3 * 15, '\x3f').append("\x03", 1);
    for (const char corner : {'\0', '\1', '\2'})
        binary.append(1, corner).append(3, '\0');
    write(folder / "binary.ply", binary);
    write(folder / "mesh.obj", "\x01v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\n"
                               "f 1/1/1 2/1/1 -2/-1/-1 -1/1/1\nf 1//1 2//1 3//1\nf 1 2 3\n");
}

void write_round_trip_seeds(const Path& folder) {
    std::string values(256, '\0');
    std::iota(values.begin(), values.end(), '\x01');
    for (int format = 0; format < 8; ++format)
        for (int channels = 0; channels < 2; ++channels)
            write(folder / (std::to_string(format) + std::to_string(channels)),
                  std::string({char(channels), char(channels), '\x03', char(format), '\x04', '\x18', '\x20',
                               '\x41'}) +
                      values);
}

/// Writes seeds for words_target.cpp; the frequencies are padded to whole words.
void write_word_seeds(const Path& folder) {
    for (const int clusters : {0, 3, 19})
        for (const int components : {0, 4, 12}) {
            std::string seed{char(clusters), char(components), '\x03', '\x7f', '\x05', '\x00'};
            const WordInput input =
                word_input({reinterpret_cast<const std::uint8_t*>(seed.data()), kWordHead});
            const auto stride = static_cast<std::size_t>(input.layout.words);
            std::vector<std::uint32_t> words(input.neighbors.size() * stride);
            for (std::size_t v = 0; v < input.neighbors.size(); ++v)
                words[v * stride] = static_cast<std::uint32_t>(v / 40) % static_cast<unsigned>(clusters + 1);
            WordCode code = encode_words(input.layout, input.neighbors, words);
            std::vector<std::byte>& all = code.frequencies.bits;
            all.resize((all.size() + 3) / 4 * 4);
            seed[kWordHead - 1] = static_cast<char>(all.size() / 4);
            all.insert(all.end(), code.bits.begin(), code.bits.end());
            seed.append(code.frequencies.drops.begin(), code.frequencies.drops.end());
            write(folder / (std::to_string(clusters) + "." + std::to_string(components)),
                  seed.append(reinterpret_cast<const char*>(all.data()), all.size()));
        }
}

} // namespace

void write_other_seeds(const Path& folder) {
    write_view_seeds(folder / "meshopt");
    write_light_seeds(folder / "light");
    write_mesh_seeds(folder / "mesh");
    write_round_trip_seeds(folder / "round_trip");
    write_word_seeds(folder / "words");
}

} // namespace prt::fuzz
