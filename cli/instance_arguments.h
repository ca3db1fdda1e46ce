#pragma once

// How a bake deals with meshes that are drawn often.

#include "prt/instance_bake.h"
#include "split_light.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace prt::cli {

enum class InstanceMode {
    own,       ///< each has transfer of its own
    shared,    ///< that of their mesh, times factors
    automatic, ///< shared where that can be, and spares three quarters of the receivers
};

struct InstanceArguments {
    InstanceMode mode = InstanceMode::own;
    double error = 0.1; ///< above that an instance is baked alone
    std::vector<Path> lights;
    SunCount suns; ///< of `lights`
    InstanceBakeOptions bake;
};

/// --instances and what goes with it.
void add_instances(CLI::App* command, InstanceArguments& arguments);

struct AskedFor {
    const BakeOptions& options;
    bool other; ///< texels, volumes or finer meshes, which know no shared transfer
};
/// The meshes of the scene whose instances shall share; none where each shall have its own. What cannot be
/// shared is told on stderr. Throws `Error` where sharing is asked for and cannot be.
SharedMeshes meshes_to_share(const InstanceArguments& arguments, const GltfDocument& document,
                             const Scene& scene, const AskedFor& asked);

struct InstancedBake {
    std::optional<GltfDocument> document; ///< to be written; nothing where no instance can share
    InstanceBake bake;
    SharedMeshes meshes;              ///< that share at last
    std::vector<double> first_errors; ///< of all instances, before some were baked alone
    std::size_t baked_alone = 0;
    double seconds = 0; ///< of all passes
    std::size_t rays = 0;
};

struct FlatScene {
    const GltfDocument& document;
    const Scene& scene;
    const std::vector<std::string>& no_shadow;
};
/// Bakes, and again while instances err too much to share. Throws `Error` for a light that cannot be read.
InstancedBake bake_shared(const InstanceArguments& arguments, const FlatScene& flat, SharedMeshes meshes,
                          const BakeOptions& options, const Progress& progress);

} // namespace prt::cli
