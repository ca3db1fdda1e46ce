// Smooth normals of meshes that have none: a sphere's are radial, a cube's corners are those of its
// diagonals.

#include "prt/gltf/gltf.h"
#include "support/glb_file.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

namespace prt {
namespace {

using test::GlbFile;

/// A mesh without normals.
GlbFile mesh_file(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices) {
    GlbFile file;
    std::vector<float> values;
    for (const glm::vec3& p : positions)
        values.insert(values.end(), {p.x, p.y, p.z});
    const std::size_t position = file.accessor(values, test::kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {-1, -1, -1};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    const std::size_t index = file.accessor(indices, test::kUnsignedInt, "SCALAR", 1);
    file.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}}};
    file.json["nodes"] = {{{"mesh", 0}}};
    file.json["scenes"] = {{{"nodes", {0}}}};
    file.json["scene"] = 0;
    return file;
}

Scene smoothed(const GlbFile& file, double degrees, Instancing instancing = Instancing::nodes) {
    const std::string bytes = file.bytes();
    return extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "mesh.glb",
                                    {.instancing = instancing, .smooth_normals_degrees = degrees}));
}

/// Corner i is at the signs of the bits of i. Faces are cut along a diagonal that `cut` chooses for each.
GlbFile cube(unsigned cut) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<std::uint32_t> indices;
    for (unsigned f = 0; f < 6; ++f) {
        const auto& q = faces[f];
        const unsigned s = cut >> f & 1u;
        indices.insert(indices.end(), {q[s], q[s + 1], q[s + 2], q[s], q[s + 2], q[(s + 3) % 4]});
    }
    return mesh_file(corners, indices);
}

TEST(SmoothNormals, CubeNormalsDoNotDependOnTriangulation) {
    for (const unsigned cut : {0u, 63u, 21u, 5u}) {
        const Scene scene = smoothed(cube(cut), 90);
        const VertexArray& v = scene.vertex_arrays[0];
        ASSERT_EQ(v.size(), 8u);
        for (std::size_t i = 0; i < 8; ++i)
            EXPECT_LT(glm::distance(v.normals[i], glm::normalize(v.positions[i])), 1e-6f) << cut;
    }
}

TEST(SmoothNormals, EndAtTheCreaseAngle) {
    const Scene scene = smoothed(cube(21), 89);
    const VertexArray& v = scene.vertex_arrays[0];
    EXPECT_EQ(v.size(), 24u);
    for (const glm::uvec3& t : scene.primitives[0].triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 face = glm::normalize(
                glm::cross(v.positions[t.y] - v.positions[t.x], v.positions[t.z] - v.positions[t.x]));
            EXPECT_LT(glm::distance(v.normals[t[corner]], face), 1e-6f);
        }
}

/// `rows` x 2 `rows` quads, without the poles' triangles that have no area; a seam of two columns of
/// vertices.
GlbFile sphere(int rows) {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    const int columns = 2 * rows;
    const double pi = std::numbers::pi;
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
            const double theta = pi * i / rows, phi = 2 * pi * (j % columns) / columns;
            const double s = i % rows == 0 ? 0 : std::sin(theta);
            positions.emplace_back(s * std::cos(phi), std::cos(theta), s * std::sin(phi));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (columns + 1) + j); };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            if (i > 0)
                indices.insert(indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j)});
            if (i < rows - 1)
                indices.insert(indices.end(), {at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh_file(positions, indices);
}

TEST(SmoothNormals, SphereNormalsAreRadialAtSeams) {
    for (const int rows : {16, 32}) {
        const Scene scene = smoothed(sphere(rows), 30);
        const VertexArray& v = scene.vertex_arrays[0];
        // Poles have a vertex for each column, of which each pole's triangle uses one; no other is added.
        EXPECT_EQ(v.size(), static_cast<std::size_t>((rows - 1) * (2 * rows + 1) + 4 * rows));
        float worst = 0;
        for (std::size_t i = 0; i < v.size(); ++i)
            worst = std::max(worst, glm::distance(v.normals[i], glm::normalize(v.positions[i])));
        EXPECT_LT(worst, 2.0f / static_cast<float>(rows * rows)); // second order: 1.54 and 1.56 measured
    }
}

TEST(SmoothNormals, ExistingNormalsAreKept) {
    const GlbFile file = test::triangle_file();
    const Scene scene = smoothed(file, 30);
    EXPECT_TRUE(scene.notices.empty());
    for (const Instancing instancing : {Instancing::nodes, Instancing::separate})
        EXPECT_EQ(smoothed(file, 30, instancing).vertex_arrays[0].size(), 3u);
}

TEST(SmoothNormals, AreInWorldSpaceUnderMirroredNodes) {
    GlbFile file = cube(0);
    file.json["nodes"][0]["scale"] = {-1, 1, 1};
    const Scene scene = smoothed(file, 90);
    const VertexArray& v = scene.vertex_arrays[0];
    for (std::size_t i = 0; i < v.size(); ++i)
        EXPECT_LT(glm::distance(v.normals[i], glm::normalize(v.positions[i])), 1e-6f);
}

/// A triangle that is a line takes part in nothing, and is kept.
TEST(SmoothNormals, IgnoreTrianglesWithoutArea) {
    const Scene scene =
        smoothed(mesh_file({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0, 0}}, {0, 1, 2, 0, 1, 3}), 180);
    ASSERT_EQ(scene.triangles(), 2u);
    EXPECT_EQ(scene.vertex_arrays[0].size(), 4u);
    for (const glm::vec3& normal : scene.vertex_arrays[0].normals)
        EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(SmoothNormals, NoticesReportTheGrowthOfVertices) {
    const Scene scene = smoothed(cube(0), 30);
    ASSERT_EQ(scene.notices.size(), 1u);
    EXPECT_EQ(scene.notices[0], "1 primitive has no normals; normals are created, smooth across edges of at "
                                "most 30 degrees: 8 vertices become 24");
    const std::string bytes = cube(0).bytes();
    const Scene flat = extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "mesh.glb"));
    ASSERT_EQ(flat.notices.size(), 1u);
    EXPECT_NE(flat.notices[0].find("8 vertices become 24; prt bake, make and ao create smooth normals"),
              std::string::npos)
        << flat.notices[0];
}

} // namespace
} // namespace prt
