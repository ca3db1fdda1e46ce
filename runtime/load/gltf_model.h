#pragma once

// Geometry of a glTF file: buffers, accessors, meshes, skins and nodes. Members have the names of glTF 2.0.

#include "runtime/load/json.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Types of the components of an accessor.
inline constexpr int kSignedByte = 5120, kUnsignedByte = 5121, kSignedShort = 5122, kUnsignedShort = 5123,
                     kUnsignedInt = 5125, kFloat = 5126, kHalf = 5131; // kHalf: only in extensions of prtkit

/// Modes of a primitive with triangles.
inline constexpr int kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;

/// Targets of a buffer view.
inline constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

/// Bytes of a buffer: `outside`, which it does not own, or else `data`.
struct GltfBuffer {
    std::vector<unsigned char> data = {};
    std::span<const std::byte> outside = {};

    std::span<const std::byte> bytes() const {
        return outside.empty() ? std::as_bytes(std::span(data)) : outside;
    }
};

struct GltfBufferView {
    int buffer = -1;
    std::size_t byteOffset = 0, byteLength = 0, byteStride = 0; ///< byteStride 0: no stride
};

/// Elements that replace others of a sparse accessor.
struct GltfSparse {
    std::size_t count = 0;
    struct Indices {
        int bufferView = -1;
        std::size_t byteOffset = 0;
        int componentType = -1;
    } indices;
    struct Values {
        int bufferView = -1;
        std::size_t byteOffset = 0;
    } values;
};

struct GltfAccessor {
    int bufferView = -1; ///< -1: all elements are zero
    std::size_t byteOffset = 0;
    int componentType = -1;
    std::size_t count = 0;
    int components = 0; ///< number of components of an element: 1..4, 9 or 16
    bool normalized = false;
    std::optional<GltfSparse> sparse;
};

using GltfAttributes = std::map<std::string, int>; ///< accessors by name

struct GltfPrimitive {
    GltfAttributes attributes;
    int indices = -1, material = -1, mode = kTriangles;
    std::vector<GltfAttributes> targets;
};

struct GltfMesh {
    std::vector<GltfPrimitive> primitives;
    std::vector<double> weights;
};

struct GltfNode {
    std::string name;
    int mesh = -1, skin = -1;
    std::vector<int> children;
    std::vector<double> matrix, translation, rotation, scale, weights; ///< empty: missing
    bool visible = true;                                               ///< KHR_node_visibility
};

struct GltfSkin {
    int inverseBindMatrices = -1;
    std::vector<int> joints;
};

struct GltfModel {
    std::vector<GltfBuffer> buffers;
    std::vector<GltfBufferView> bufferViews;
    std::vector<GltfAccessor> accessors;
    std::vector<GltfMesh> meshes;
    std::vector<GltfNode> nodes;
    std::vector<GltfSkin> skins;
    std::vector<std::vector<int>> scenes; ///< root nodes
    int defaultScene = -1;                ///< -1: none
};

/// Returns the model of `json`, whose shape `check_shape` accepts, without buffers. A view with
/// EXT_meshopt_compression is the view of its compressed bytes. Throws `Error` with the location if a member
/// is missing or has a wrong type.
GltfModel read_model(const Json& json);

/// Returns the accessor of an attribute; -1 if the primitive lacks it.
int attribute_of(const GltfPrimitive& primitive, const std::string& name);

/// Reads one accessor. Throws `Error` if a member is missing or has a wrong type.
GltfAccessor read_accessor(const Json& json);

/// Returns the number of components of "SCALAR", "VEC2" ... Throws `Error` for other names.
int component_count(const std::string& type);

} // namespace prt
