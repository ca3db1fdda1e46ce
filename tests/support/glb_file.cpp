// Builds and parses .glb files.

#include "glb_file.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

namespace prt::test {

std::size_t GlbFile::view(std::span<const std::byte> bytes, std::size_t stride) {
    binary.resize((binary.size() + 3) / 4 * 4);
    nlohmann::ordered_json view = {
        {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0)
        view["byteStride"] = stride;
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
}

std::size_t GlbFile::accessor(std::span<const std::byte> bytes, std::size_t count, int component_type,
                              const char* type, bool normalized, std::size_t stride) {
    nlohmann::ordered_json accessor = {{"bufferView", view(bytes, stride)},
                                       {"componentType", component_type},
                                       {"count", count},
                                       {"type", type}};
    if (normalized)
        accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return json["accessors"].size() - 1;
}

std::string GlbFile::bytes() const {
    nlohmann::ordered_json complete = json;
    if (!binary.empty() && !complete.contains("buffers"))
        complete["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = complete.dump(), data(reinterpret_cast<const char*>(binary.data()), binary.size());
    text.append((4 - text.size() % 4) % 4, ' ');
    data.append((4 - data.size() % 4) % 4, '\0');
    const auto word = [](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&v), 4);
    };
    std::string file = "glTF" + word(2) + word(20 + text.size() + (data.empty() ? 0 : 8 + data.size())) +
                       word(text.size()) + "JSON" + text;
    if (!data.empty())
        file += word(data.size()) + std::string("BIN\0", 4) + data;
    return file;
}

void GlbFile::write(const std::filesystem::path& path) const {
    std::ofstream(path, std::ios::binary) << bytes();
}

GlbFile glb_of(std::span<const std::byte> bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, &bytes[12], sizeof length);
    GlbFile glb;
    const auto* text = reinterpret_cast<const char*>(&bytes[20]);
    glb.json = nlohmann::ordered_json::parse(text, text + length);
    if (const std::size_t begin = 28 + length; begin < bytes.size())
        glb.binary.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end());
    return glb;
}

GlbFile read_glb(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    return glb_of(std::as_bytes(std::span(bytes)));
}

const nlohmann::ordered_json& set_of(const nlohmann::ordered_json& json, std::string_view receivers) {
    for (const nlohmann::ordered_json& set : json.at("extensions").at("PRTKIT_transfer").at("sets"))
        if (set.at("receivers") == receivers)
            return set;
    throw std::out_of_range("no set of " + std::string(receivers));
}

nlohmann::ordered_json& set_of(nlohmann::ordered_json& json, std::string_view receivers) {
    return const_cast<nlohmann::ordered_json&>(set_of(std::as_const(json), receivers));
}

GlbFile triangle_file() {
    GlbFile file;
    const std::size_t position =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, 0, 0};
    file.json["accessors"][position]["max"] = {1, 1, 0};
    const std::size_t normal =
        file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    const std::size_t indices =
        file.accessor(std::vector<std::uint16_t>{0, 1, 2}, kUnsignedShort, "SCALAR", 1);
    file.json["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", indices}}}}}};
    file.json["nodes"] = {{{"mesh", 0}}};
    file.json["scenes"] = {{{"nodes", {0}}}};
    file.json["scene"] = 0;
    return file;
}

GlbFile scene_file(const Scene& scene) {
    const VertexArray& vertices = scene.vertex_arrays.at(0);
    const auto floats = [](const std::vector<glm::vec3>& values) {
        return std::vector<float>(&values[0].x, &values[0].x + 3 * values.size());
    };
    const auto& triangles = scene.primitives.at(0).triangles;
    GlbFile file;
    const std::size_t positions = file.accessor(floats(vertices.positions), kFloat, "VEC3", 3),
                      normals = file.accessor(floats(vertices.normals), kFloat, "VEC3", 3),
                      indices = file.accessor(
                          std::vector<std::uint32_t>(&triangles[0].x, &triangles[0].x + 3 * triangles.size()),
                          kUnsignedInt, "SCALAR", 1);
    const Bounds box = bounds(scene);
    file.json["accessors"][positions]["min"] = {box.low.x, box.low.y, box.low.z};
    file.json["accessors"][positions]["max"] = {box.high.x, box.high.y, box.high.z};
    file.json["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}}}}}};
    file.json["nodes"] = {{{"mesh", 0}}};
    file.json["scenes"] = {{{"nodes", {0}}}};
    file.json["scene"] = 0;
    return file;
}

} // namespace prt::test
