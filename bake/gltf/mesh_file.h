#pragma once

// Triangle meshes of other programs as glTF: arrays in memory, Wavefront OBJ and PLY (scans, digitisation).

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A triangle mesh of one material. Arrays other than `positions` and `triangles` may be empty; the others
/// are [vertices].
struct MeshArrays {
    std::vector<glm::dvec3> positions; ///< metres, in the file's world
    std::vector<glm::uvec3> triangles; ///< indices of vertices, counter-clockwise seen from the front
    std::vector<glm::vec3> normals;    ///< any length; empty: flat, or smooth with smooth_normals_degrees
    std::vector<glm::vec3> colors;     ///< base colors, linear Rec. 709, 0..1; empty: white
    std::vector<glm::vec2> texcoords;  ///< TEXCOORD_0, v = 0 at the top of the texture
    bool double_sided = false;         ///< whether both sides are visible and reflect light
};

/// Throws `Error` if there are no vertices or triangles, if a number is not finite or a position exceeds
/// kFarthestVertex, if a triangle refers to a vertex that does not exist, and if an array has another length.
void check_mesh(const MeshArrays& mesh);

/// Returns a .glb file with one node that draws the mesh. Positions are stored as floats relative to the
/// middle of their box, which is the translation of the node, so that a mesh far from the origin keeps its
/// precision. Throws the errors of `check_mesh`.
std::vector<std::byte> mesh_glb(const MeshArrays& mesh, const std::string& name);

/// Returns whether the suffix is that of a mesh file, .obj or .ply.
bool is_mesh_file(const std::filesystem::path& path);

/// Reads the OBJ or PLY file `file`, whose name is `path`. Polygons are triangulated; an OBJ file gets a
/// vertex for each combination of position, normal and texture coordinate. Vertex colors are decoded from
/// sRGB. Materials and textures are not read; `notices` gets a line. Throws `Error`.
MeshArrays read_mesh_file(std::span<const std::byte> file, const std::filesystem::path& path,
                          std::vector<std::string>& notices);

} // namespace prt
