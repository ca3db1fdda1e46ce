// OBJ and PLY files as scenes: positions, triangles, normals, colors and texture coordinates of the file.

#include "bake/gltf/mesh_file.h"
#include "bake/gltf/obj_file.h"
#include "bake/gltf/ply_file.h"
#include "prt/core/error.h"
#include "prt/gltf/gltf.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace prt {
namespace {

Scene scene_of(const std::string& text, const char* name) {
    return extract_scene(parse_gltf(std::as_bytes(std::span(text)), name));
}

std::string message(const std::string& text, const char* name) {
    try {
        scene_of(text, name);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// A square of two triangles, as a polygon of four corners.
std::string ascii_square(const std::string& newline) {
    std::string text;
    for (const char* line :
         {"ply", "format ascii 1.0", "comment a square", "element vertex 4", "property float x",
          "property float y", "property float z", "property uchar red", "property uchar green",
          "property uchar blue", "element face 1", "property list uchar int vertex_indices", "end_header",
          "0 0 5 255 0 188", "2 0 5 255 0 188", "2 2 5 255 0 188", "0 2 5 255 0 188", "4 0 1 2 3"})
        text += line + newline;
    return text;
}

template <class T>
void append(std::string& file, T value, std::endian order) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (order != std::endian::native)
        std::reverse(std::begin(bytes), std::end(bytes));
    file.append(bytes, sizeof(T));
}

/// The same square in binary, with an element and a list that are not read.
std::string binary_square(std::endian order) {
    std::string file = order == std::endian::big ? "ply\nformat binary_big_endian 1.0\n"
                                                 : "ply\nformat binary_little_endian 1.0\n";
    file += "element camera 2\nproperty short id\nproperty list uchar double view\n"
            "element vertex 4\nproperty double x\nproperty float y\nproperty int z\nproperty float nx\n"
            "property float ny\nproperty float nz\nelement face 2\nproperty uchar flags\n"
            "property list ushort uint vertex_index\nend_header\n";
    for (int camera = 0; camera < 2; ++camera) {
        append<std::int16_t>(file, -7, order);
        append<std::uint8_t>(file, 1, order);
        append(file, 3.5, order);
    }
    constexpr float kCorners[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    for (const auto& corner : kCorners) {
        append(file, static_cast<double>(corner[0]), order);
        append(file, corner[1], order);
        append<std::int32_t>(file, 5, order);
        for (const float n : {0.0f, 0.0f, 2.0f})
            append(file, n, order);
    }
    for (const auto& face : {std::array<unsigned, 3>{0, 1, 2}, {0, 2, 3}}) {
        append<std::uint8_t>(file, 9, order);
        append<std::uint16_t>(file, 3, order);
        for (const unsigned corner : face)
            append<std::uint32_t>(file, corner, order);
    }
    return file;
}

void expect_square(const Scene& scene) {
    ASSERT_EQ(scene.vertex_arrays.size(), 1u);
    ASSERT_EQ(scene.triangles(), 2u);
    const std::vector<float> areas = receiver_areas(scene);
    float area = 0;
    for (const float a : areas)
        area += a;
    EXPECT_FLOAT_EQ(area, 4);
    for (const glm::vec3& p : scene.vertex_arrays[0].positions)
        EXPECT_EQ(scene.world(p).z, 5);
    for (const glm::vec3& n : scene.vertex_arrays[0].normals)
        EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(MeshFile, PlyIsReadInAllForms) {
    for (const char* newline : {"\n", "\r\n", " \n"}) {
        const Scene scene = scene_of(ascii_square(newline), "square.PLY");
        expect_square(scene);
        const glm::vec4 color = scene.vertex_arrays[0].colors.at(0);
        EXPECT_EQ(color.r, 1);
        EXPECT_EQ(color.g, 0);
        EXPECT_NEAR(color.b, 0.5029, 1e-4); // 188 of 255 in sRGB
    }
    for (const std::endian order : {std::endian::little, std::endian::big})
        expect_square(scene_of(binary_square(order), "square.ply"));
}

TEST(MeshFile, ObjIsRead) {
    const Scene plain = scene_of("v 0 0 5\nv 2 0 5\nv 2 2 5\nv 0 2 5\nv 9 9 9\nf 1 2 3 4\n", "square.obj");
    EXPECT_EQ(plain.triangles(), 2u);
    const Scene scene =
        scene_of("# comment\r\nmtllib none.mtl\r\nv 0 0 5 1 0 0\r\nv 2 0 5 1 0 0\r\nv 2 2 5 1 0 0\r\n"
                 "v 0 2 5 1 0 0\r\nvt 0 0.25\r\nvn 0 0 3\r\no part\r\nusemtl red\r\n"
                 "f 1/1/1 2/1/1 3/1/1\r\nf -4/-1/-1 -2/-1/-1 -1/-1/-1\r\n",
                 "square.obj");
    expect_square(scene);
    EXPECT_EQ(scene.receivers(), 4u);
    EXPECT_EQ(scene.vertex_arrays[0].colors.at(0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.vertex_arrays[0].texcoords.at(0).at(0), glm::vec2(0, 0.75));
    EXPECT_NE(scene.notices.size(), 0u); // materials and textures
}

TEST(MeshFile, ObjVertexOrderIsThatOfTheFile) {
    const std::string text =
        "\xef\xbb\xbfv 0 0 0 # first\nv 1 0 0\nv 1 \\\n 1 +0\nv 0 1 0\nv 5 5 5\nf 3 1 2 # face\n";
    const MeshArrays mesh = read_obj(std::as_bytes(std::span(text)));
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[2], glm::dvec3(1, 1, 0));
    EXPECT_EQ(mesh.triangles.at(0), glm::uvec3(2, 0, 1));
    const std::string corners = text + "vt 0 0\nvt 1 1\nf 3/1 1/2 2/1\n";
    const MeshArrays both = read_obj(std::as_bytes(std::span(corners)));
    EXPECT_EQ(both.positions.size(), 5u); // not all corners have texture coordinates
}

double area_of(const MeshArrays& mesh) {
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

TEST(MeshFile, ConcavePolygonsKeepTheirArea) {
    for (const auto& [text, area] :
         {std::pair("v -1 0 0\nv 0 1 0\nv 1 0 0\nv 0 10 0\nf 1 2 3 4\n", 9.0),
          {"v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 3 4 5 1 2\n", 10.0},
          {"v 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4 5 6\n", 13.0}})
        EXPECT_NEAR(area_of(read_obj(std::as_bytes(std::span(text, std::strlen(text))))), area, 1e-12)
            << text;
}

TEST(MeshFile, FarMeshesKeepTheirPrecision) {
    const std::string far = "v 5000000.25 0 0\nv 5000000.5 0 0\nv 5000000.25 0.25 0\nf 1 2 3\n";
    const Scene scene = scene_of(far, "map.obj");
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const glm::vec3& p : scene.vertex_arrays[0].positions) {
        low = std::min(low, scene.world(p).x);
        high = std::max(high, scene.world(p).x);
    }
    EXPECT_EQ(low, 5000000.25);
    EXPECT_EQ(high, 5000000.5);
}

TEST(MeshFile, DamagedFilesAreErrors) {
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                               "property float z\n";
    const std::pair<std::string, const char*> files[] = {
        {"ply\nformat ascii 1.0\nelement vertex 9\n", "ends in its header"},
        {"plx\n", "does not begin with a line 'ply'"},
        {"ply\nend_header\n", "no line 'format'"},
        {"ply\nformat text 1.0\nend_header\n", "unknown format"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty vec3 x\nend_header\n", "unknown type 'vec3'"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", "no positions"},
        {"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n", "too short"},
        {header + "end_header\n0 zero 0\n", "'zero' where a number should be"},
        {header + "end_header\n0 0 0\n", "has no faces"},
        {header + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 7\n",
         "refers to vertex 7"},
        {header + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 -1\n",
         "is not a whole number"},
        {header + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0\n",
         "ends in its data"},
        {header + "element face 1\nproperty list uchar int vertex_indices\nend_header\nnan 0 0\n3 0 0 0\n",
         "not finite"}};
    for (const auto& [text, words] : files) {
        const std::string what = message(text, "bad.ply");
        EXPECT_TRUE(what.starts_with("bad.ply: ")) << what;
        EXPECT_NE(what.find(words), std::string::npos) << words << " in: " << what;
    }
    const std::pair<std::string, const char*> objects[] = {
        {"", "no vertices"},
        {"v 0 0 0\n", "no triangles"},
        {"v 0 0 0\nf 1 2 3\n", "refers to vertex 2"},
        {"v 0 0 0\nf 1 1 -2\n", "line 2 has '-2', which refers to a line that does not exist"},
        {"v 0 0 0\nf 1 1 0\n", "line 2 has '0' where a corner should be"},
        {"v 0 0 0\nf 1 1.5 1\n", "where a corner should be"},
        {"v 0 0 0\nf 1 4294967297 1\n", "refers to vertex 4294967297"},
        {"v 0 0 0\nf 1 1\n", "a face of 2 corners"},
        {"v 0 1,5 0\nf 1 1 1\n", "line 1 has '1,5' where a number should be"},
        {"v 0 1\nf 1 1 1\n", "line 1 has 2 numbers instead of 3"},
        {"v 0 nan 0\nf 1 1 1\n", "not finite"}};
    for (const auto& [text, words] : objects)
        EXPECT_NE(message(text, "bad.obj").find(words), std::string::npos) << message(text, "bad.obj");
    const std::string whole = binary_square(std::endian::little);
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(message(whole.substr(0, length), "short.ply"), "") << length;
}

} // namespace
} // namespace prt
