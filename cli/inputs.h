#pragma once

// Files as the commands need them.

#include "prt/gltf.h"
#include "prt/image_file.h"
#include "prt/instances_gltf.h"
#include "prt/light.h"
#include "prt/lightmap.h"
#include "prt/lobe_gltf.h"
#include "prt/occluder_gltf.h"
#include "prt/support/error.h"
#include "prt/volume_gltf.h"
#include "session.h"

#include <optional>
#include <string>
#include <vector>

namespace prt::cli {

/// How every command reads lighting.
struct LightOptions {
    EnvironmentOptions environment;
    Window window = Window::none;
    double rotation_degrees = 0;
};

/// What a file says of texels beside their transfer.
struct LightmapOfFile {
    LightmapLayout layout;
    /// Of a bake; a compressed file has transfer of all texels.
    std::vector<std::uint32_t> texels = {};
    std::vector<float> areas = {};
    std::vector<Edge> edges = {};
};

/// A scene file with whatever transfer it holds. Notices go to stderr.
struct SceneFile {
    GltfDocument document;
    Scene scene;
    std::optional<BakedTransfer> baked;
    std::optional<CompressedTransfer> compressed;
    /// Set where receivers of the transfer are texels; else they are vertices.
    std::optional<LightmapOfFile> lightmap = {};
    /// Of probes, beside transfer of surfaces.
    std::optional<BakedVolume> volume = {};
    std::optional<CompressedVolume> compressed_volume = {};
    std::vector<NodeOccluder> occluders = {};
    std::optional<StoredLobes> lobes = {};
    /// Set where instances share transfer: `baked` is then what all vertices have by it.
    std::optional<InstancedModel> instanced = {};

    /// Order of the transfer, 0 where there is none.
    int order() const;
    /// How the transfer was baked; null where there is none.
    const BakeRecord* record() const;
};
/// Of one that holds transfer.
const TransferLayout& layout_of(const SceneFile& model);
/// Throws `Error` where anything of prtkit in the file is damaged: commands that write a model pass it on.
SceneFile load_scene_file(const Path& path, const GltfOptions& options = {});
/// The same of a document that was read from `path`.
SceneFile scene_file_of(GltfDocument document, const Path& path);

/// A model that a command writes again with additions.
struct ModelToPassOn {
    GltfDocument document;
    Scene scene;
};
/// Reads all that `load_scene_file` reads, and prints the notices of the scene.
ModelToPassOn load_to_pass_on(const Path& path, const GltfOptions& options);

/// Throws `Error` where transfer is of texels, which `command` does not do.
void check_of_vertices(const SceneFile& model, const Path& path, const std::string& command);

/// Calls `work`, whose errors are about `file`: they name it, once.
template <class Work>
auto about(const Path& file, Work work) {
    try {
        return work();
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        const std::string what = error.what(), name = file.string() + ": ";
        throw Error(what.starts_with(name) ? what : name + what);
    }
}

/// Puts the receivers of a bake in the order that they have in another file of the same scene, whose vertices
/// prt compress --reorder may have moved.
void put_in_order_of(const Scene& scene, SceneFile& baked);

/// Throws `Error` unless both hold transfer of one order for the same receivers.
void check_belong_together(const SceneFile& baked, const Path& baked_path, const SceneFile& shipped,
                           const Path& shipped_path);

struct LoadedLight {
    std::string name;
    Light light;
    std::optional<Environment> environment; ///< where it came from an image
};

/// An environment map. What was repaired or clipped in it goes to stderr.
Environment load_environment_map(const Path& path, const EnvironmentOptions& options);

/// Lighting from an environment map or a light file, windowed and rotated, with `order` bands.
LoadedLight load_light(const Path& path, int order, const LightOptions& options, int threads);

} // namespace prt::cli
