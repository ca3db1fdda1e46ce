#pragma once

// Selects instanced meshes that share transfer, and bakes them.

#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model_levels.h"
#include "prt/bake/instance_bake.h"
#include "prt/gltf/refinement.h"

#include <optional>
#include <string>
#include <vector>

namespace prt::pipeline {

enum class InstanceMode {
    own,       ///< each instance has separate transfer
    shared,    ///< instances use the transfer of their mesh times factors
    automatic, ///< shared if possible, and if it saves three quarters of the receivers
};

struct InstanceArguments {
    InstanceMode mode = InstanceMode::own;
    double error = 0.1;    ///< an instance with a larger error is baked separately
    bool settings = false; ///< true if a setting of shared transfer was given
    std::vector<Path> lights;
    SunCount suns; ///< number of suns of `lights`
    InstanceBakeOptions bake;
    Notify notify = {}; ///< receives notices about lights and about meshes that cannot be shared
};

struct AskedFor {
    const BakeOptions& options;
    bool texels;    ///< the bake is for texels, which do not support shared transfer
    bool high_poly; ///< receivers are on a high-poly model, which has no parts for shared meshes
    bool refined;   ///< meshes are refined: InstanceMode::automatic bakes all instances separately
    LevelMode levels = LevelMode::ignore;
};

/// Meshes whose instances share transfer, and numbers of instances that are baked separately.
struct FoundMeshes {
    SharedMeshes meshes;
    std::size_t other_scales = 0, ///< instances of meshes with a medium that have another scale than most
        leveled = 0;              ///< instances that coarser levels of detail replace
};
FoundMeshes find_shared_meshes(const GltfDocument& document, const Scene& scene, const BakeOptions& options,
                               LevelMode levels);

/// Returns the meshes whose instances share transfer; none if sharing is off. Sends a notice about meshes
/// that cannot be shared. Throws `Error` if sharing is required but impossible.
SharedMeshes meshes_to_share(const InstanceArguments& arguments, const GltfDocument& document,
                             const Scene& scene, const AskedFor& asked);

struct InstancedBake {
    /// Document without transfer, in the form of `Instancing::separate`; empty if no instance can share.
    std::optional<GltfDocument> document;
    Scene stored;             ///< the scene of `document`
    std::vector<int> node_of; ///< [nodes of the flat document] node of `document`; -1: none
    InstanceBake bake;
    SharedMeshes meshes;              ///< meshes that share in the result
    std::vector<double> first_errors; ///< errors of all instances in the first pass
    std::size_t baked_alone = 0;
    double seconds = 0; ///< total of all passes
    std::size_t rays = 0;
};

struct FlatScene {
    const GltfDocument& document;
    const Scene& scene;
    const std::vector<std::string>& no_shadow;
};
/// Bakes, and repeats while instances have too large an error to share. Throws `Error` for a light that
/// cannot be read.
InstancedBake bake_shared(const InstanceArguments& arguments, const FlatScene& flat, SharedMeshes meshes,
                          const BakeOptions& options, const Progress& progress);

/// Returns `document` with `refinement`, which must not change shared meshes. `scene` is the flat scene.
GltfDocument refined(const GltfDocument& document, const Scene& scene, const SharedMeshes& meshes,
                     const Refinement& refinement);

/// Writes transfer and factors into `baked.document`. `levels`: coarser levels of the nodes of `flat` that do
/// not share; their transfer is added. May be null.
void write_shared(InstancedBake& baked, const FlatScene& flat, BakedLevels* levels,
                  const BakeOptions& options, const Progress& progress);

} // namespace prt::pipeline
