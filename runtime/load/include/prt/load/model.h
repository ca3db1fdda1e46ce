#pragma once

// Reads files written by prt compress, prt lobes and prt ao --occluders: what a game loads. Needs no glTF
// library. Experimental.
//
//     const Model model = load_model("shipped.glb");
//     const ClusterLighting relighter(model.vertices->transfer); // prt/core/cluster_lighting.h
//
// prt/gltf/gltf.h reads all glTF files, with images, lights and raw transfer, and writes them.

#include "prt/core/baked_transfer.h"
#include "prt/core/instances.h"
#include "prt/core/lightmap.h"
#include "prt/core/lobes.h"
#include "prt/core/occlusion_volume.h"
#include "prt/core/transfer_volume.h"
#include "prt/load/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Contents of PRTKIT_instances: data of all instances that share transfer in a file.
struct StoredInstances {
    std::vector<InstanceFactors> factors; ///< [instances] in axes of the world; mesh by mesh, and within a
                                          ///< mesh placement by placement
    std::vector<InstanceBox> boxes;       ///< [shared meshes] bounding box of the mesh, in the mesh's frame
    /// [instances][lamps] light of the lamps of the transfer at each instance; empty without lamps.
    std::vector<std::vector<InstanceLampLight>> lamps = {};
};

/// An instance of a mesh that shares transfer. Some functions of prt/gltf read a file in two forms: as a flat
/// scene, in which every instance has separate vertices, and as a stored scene, which contains each shared
/// mesh once.
struct FileInstance {
    int node = 0;           ///< index in the nodes of the file; instances of EXT_mesh_gpu_instancing have
                            ///< indices after the nodes of the file
    std::size_t number = 0; ///< index of the instance in StoredInstances::factors
    PlacedInstance placed;  ///< factors and rotation of the instance; bounding box in the mesh's frame
    std::vector<std::size_t> arrays, ///< vertex arrays of the instance in the flat scene; empty in `Model`
        stored_arrays;   ///< vertex arrays of the stored scene: entry i has the transfer for `arrays[i]`
    glm::dmat4 world{1}; ///< from the mesh's frame to the file's world
};

/// Returns `instances` in the form that InstanceRelighter needs, in the same order. `transfer` has the
/// receivers of `stored`; `stored` is the scene that `FileInstance::stored_arrays` refers to. Boxes of the
/// result are relative to `stored.origin` - `seen_from`.
std::vector<RelitInstance> relit_instances(std::span<const FileInstance> instances, const Scene& stored,
                                           const ClusteredTransfer& transfer,
                                           const glm::dvec3& seen_from = glm::dvec3(0));

/// Maximum width and maximum height of a lightmap in a file, in texels.
inline constexpr int kMaxLightmapTexels = 16384;

/// A compressed lightmap whose packed words (cluster and weights of a texel) are encoded as images.
struct EncodedLightmap {
    /// The lightmap without the clusters and weights of receivers, which `images` contain.
    CompressedLightmap lightmap;
    /// [maps][words per texel] PNG files, one for each word of the texels of a map.
    std::vector<std::vector<std::byte>> images;
};

/// Settings of the lobe fit; written to the file and shown by `prt info`. A number that the file does not
/// contain is 0.
struct LobeRecord {
    int poses = 0;          ///< number of poses in the fit
    int rays = 0;           ///< number of rays per vertex in each pose
    int bounces = 0;        ///< number of bounces; 0: direct light only
    std::uint64_t seed = 0; ///< seed of the random numbers of the rays
};

/// Lobes as stored in a file, with the record of their fit.
struct StoredLobes {
    LobeModel model; ///< vertices in the order of the receivers of the scene
    LobeRecord record;
};

/// An occlusion volume, and the node with which the volume moves.
struct NodeOccluder {
    int node = 0;           ///< index in the nodes of the document
    OcclusionVolume volume; ///< in the frame of the node
};

/// Contents of a file.
struct Model {
    /// Vertices and triangles of the default scene. Materials have a name, a base color, a meaning of alpha
    /// and `double_sided`; there are no textures, images and lights. With instances that share transfer, each
    /// shared mesh occurs once, in its own frame.
    Scene scene;
    std::optional<CompressedTransfer>
        vertices; ///< transfer of vertices of `scene` without VertexArray::lobes
    /// Transfer of texels. `decoded_lightmap` of prt/render/lightmap_file.h decodes the images.
    std::optional<EncodedLightmap> lightmap;
    std::optional<CompressedVolume> volume; ///< transfer of probes; its grid is relative to Scene::origin
    std::vector<FileInstance> instances;    ///< instances that share transfer, in ascending order of nodes
    std::optional<StoredLobes> lobes;       ///< lobes of the vertices of `scene` with VertexArray::lobes
    std::vector<NodeOccluder> occluders;    ///< occlusion volumes, in ascending order of nodes
};

/// Adds the coordinates of predictors (ClusteredReceivers::predictors) to `model.vertices`, for functions
/// that evaluate or decode transfer on the CPU: `evaluate`, `exit_radiance`, `decode`. Vertex shaders do not
/// need them. Uses 12 bytes per vertex and predictor. Does nothing without transfer of vertices.
void add_coordinates(Model& model);

/// Reads a .glb file. Throws `Error`, with the path, if the file cannot be read, is damaged or too large, is
/// not a .glb, has buffers in other files or Draco compression, requires an unsupported extension, or
/// contains transfer of another version of prtkit. Raw transfer (prt bake) and coarser levels of detail are
/// ignored. A file without transfer is not an error.
Model load_model(const std::filesystem::path& path);
/// Reads a .glb file whose bytes `file` are in memory. Keeps no reference to `file`. `name`: for messages.
/// Throws the errors of `load_model`.
Model parse_model(std::span<const std::byte> file, const std::filesystem::path& name);

} // namespace prt
