// OBJ and PLY files as inputs of the program.

#include "program.h"
#include "prt/gltf.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace prt::test {
namespace {

class MeshImport : public testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    std::string at(const std::string& name) const { return (folder / name).string(); }
    /// Bakes a file and returns the scene that was written.
    Scene baked(const std::string& name, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments = {"bake", at(name), "-o", at("b.glb"), "--order",
                                              "2",    "--rays", "64", "--backend", "cpu"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.status == 0 ? extract_scene(load_gltf(folder / "b.glb")) : Scene{};
    }

    TemporaryFolder folder;
};

/// A quad and a triangle of another material share an edge.
TEST_F(MeshImport, ObjPolygonsBecomeTrianglesWithMaterials) {
    write("house.mtl", "newmtl wall\nKd 0.8 0.2 0.1\nnewmtl roof\nKd 0.1 0.2 0.3\nKe 2 0 0\n");
    write("house.obj", "mtllib house.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 1.5 0\n"
                       "vt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 0.75\nvt 0.5 1\nvn 0 0 1\n"
                       "usemtl wall\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl roof\nf 4/4/1 3/3/1 5/5/1\n");
    const Scene scene = baked("house.obj");
    ASSERT_EQ(scene.primitives.size(), 2u);
    std::size_t triangles = 0;
    double area = 0;
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        const Material& material = scene.materials[primitive.material];
        const bool roof = primitive.triangles.size() == 1;
        EXPECT_EQ(material.name, roof ? "roof" : "wall");
        EXPECT_NEAR(material.base_color.g, 0.2f, 1e-6f);
        EXPECT_EQ(vertices.positions.size(), roof ? 3u : 4u); // welded
        for (const glm::uvec3& t : primitive.triangles) {
            const glm::dvec3 a(vertices.positions[t.x]), b(vertices.positions[t.y]),
                c(vertices.positions[t.z]);
            area += 0.5 * glm::cross(b - a, c - a).z;
            ++triangles;
        }
        for (std::size_t v = 0; v < vertices.positions.size(); ++v) {
            // v of OBJ points up: 0 at the floor, 0.75 at the eaves, 1 at the ridge.
            const float y = vertices.positions[v].y, up = y <= 1 ? 0.75f * y : 1;
            EXPECT_NEAR(vertices.texcoords[0][v].y, 1 - up, 1e-6f);
        }
    }
    EXPECT_EQ(triangles, 3u);
    EXPECT_NEAR(area, 1.25, 1e-6);
}

/// 188 of 255 in sRGB is 0.5029 in linear light.
TEST_F(MeshImport, PlyColorsAreSrgb) {
    write("scan.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0 188 0 255\n1 0 0 188 0 255\n1 1 0 188 0 255\n0 1 0 188 0 255\n4 0 1 2 3\n");
    const Scene scene = baked("scan.ply");
    ASSERT_EQ(scene.primitives.size(), 1u);
    const VertexArray& vertices = scene.vertex_arrays[scene.primitives[0].vertices];
    ASSERT_FALSE(vertices.colors.empty());
    EXPECT_NEAR(vertices.colors[0].r, 0.5029, 1e-3);
    EXPECT_NEAR(vertices.colors[0].g, 0, 1e-6);
    EXPECT_NEAR(vertices.colors[0].b, 1, 1e-6);
}

TEST_F(MeshImport, RefusesWhatHoldsNoTriangles) {
    for (const auto& [name, text] : {std::pair("points.ply", "ply\nformat ascii 1.0\nelement vertex 1\n"
                                                             "property float x\nproperty float y\n"
                                                             "property float z\nend_header\n0 0 0\n"),
                                     std::pair("cut.ply", "ply\nformat ascii 1.0\nelement vertex 4\n"),
                                     std::pair("text.obj", "this is no mesh\n")}) {
        write(name, text);
        const Outcome outcome = prt({"info", at(name)});
        EXPECT_EQ(outcome.status, 1) << name;
        EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    }
}

/// A library beside the folder of the mesh is read with --allow-outside only.
TEST_F(MeshImport, KeepsToTheFolderOfTheMesh) {
    std::filesystem::create_directory(folder / "in");
    write("secret.mtl", "newmtl wall\nKd 0.25 0.25 0.25\n");
    write("in/a.obj", "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wall\nf 1 2 3\n");
    const auto red = [&](const std::vector<std::string>& more) {
        const Scene scene = baked("in/a.obj", more);
        return scene.materials[scene.primitives.at(0).material].base_color.r;
    };
    EXPECT_EQ(red({"--allow-outside"}), 0.25f);
    EXPECT_NE(red({}), 0.25f);
}

} // namespace
} // namespace prt::test
