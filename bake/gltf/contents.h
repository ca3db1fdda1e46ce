#pragma once

// Contents of a GltfDocument. tinygltf reads buffers, images, materials and animations; writing edits the
// JSON, because tinygltf's writer drops unknown data.

#include "runtime/load/extensions.h"
#include "runtime/load/gltf_data.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// The functions keep views and accessors of `model` in step with `json`; `remove_unused` and its callers
/// update all of it. Other edits of `json` do not update `model`.
struct GltfContents : GltfData {
    tinygltf::Model parsed; ///< materials, textures, images and animations; without buffers
    std::vector<std::vector<std::byte>> images; ///< encoded, by image index; empty: cannot be read
    std::vector<std::string> image_troubles;    ///< why images cannot be read, by image index

    /// The single buffer for all views of `json` and of `model`.
    std::vector<unsigned char>& binary() { return model.buffers.front().data; }
    std::span<const std::byte> binary() const { return std::as_bytes(std::span(model.buffers.front().data)); }

    /// Appends bytes, aligned to 4, and a buffer view for them. `stride` 0: no stride. Returns the index of
    /// the view.
    std::size_t add_buffer_view(std::span<const std::byte> bytes, std::size_t stride = 0,
                                bool vertices = false);
    /// Appends an accessor and returns its index.
    std::size_t add_accessor(Json accessor);
    /// Adds `name` to extensionsUsed.
    void use_extension(const std::string& name);
    /// Removes bytes from the buffer that no view references.
    void cut_unused_bytes();
    /// Removes transfer of surfaces and shared instances, with their attributes, accessors and data. Keeps
    /// lobes.
    void remove_transfer();
    /// Removes the transfer of `primitives`.
    void remove_transfer_of(std::span<Json* const> primitives);
    /// Removes all lobes with their data.
    void remove_lobes();
    /// Removes the volume of prtkit with its data.
    void remove_volume();
    /// Removes unreferenced elements of `accessors` and `views`, with their data, and updates `model`.
    void remove_unused(std::set<std::size_t> accessors, std::set<std::size_t> views = {});

private:
    struct Removed;
    void finish(Removed removed);
    void drop_unused_extensions();
};

} // namespace prt
