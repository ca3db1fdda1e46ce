#pragma once

// Entropy-coded words of vertices in files, stored outside the attributes (docs/format.md).

#include "prt/core/error.h"
#include "runtime/core/transfer/coded_words.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Returns the layout of the words of a set of vertices, which must have packed weights.
WordLayout word_layout(const GltfData& data, const Json& set);
/// Returns the name of an attribute of weights: of a word, or of four floats.
std::string weights_name(std::size_t group);
/// Returns the number of vertices of a primitive with words.
std::size_t vertex_count(const GltfModel& model, const GltfPrimitive& primitive);

/// Calls `visit` with every primitive in the JSON and in the model; adds its name to errors.
template <class Data, class Visit>
void for_each_pair(Data& data, Visit&& visit) {
    for (std::size_t m = 0; m < data.model.meshes.size(); ++m)
        for (std::size_t p = 0; p < data.model.meshes[m].primitives.size(); ++p) {
            const std::string name = "mesh " + std::to_string(m) + " primitive " + std::to_string(p);
            try {
                visit(data.json.at("meshes").at(m).at("primitives").at(p),
                      data.model.meshes[m].primitives[p]);
            } catch (const std::exception& error) {
                throw Error(name + ": " + in_plain_words(error));
            }
        }
}

/// Triangles with vertices numbered over all primitives.
class WordMesh {
public:
    explicit WordMesh(std::size_t vertices) : vertices_(vertices) {}
    void add(const GltfModel& model, const GltfPrimitive& primitive, std::size_t first, std::size_t count);
    std::vector<EarlierNeighbors> neighbors() const { return earlier_neighbors(triangles_, vertices_); }

private:
    std::size_t vertices_;
    std::vector<std::uint32_t> triangles_;
};

/// Replaces coded words by attributes _PRT_WEIGHTS_ in a new buffer, in the JSON and the model of `data`.
/// Returns whether there were any. Throws `Error` if the words are damaged.
bool decode_vertices(GltfData& data);

} // namespace prt
