#pragma once

// Bakes a glTF document: what `prt bake` does.

#include "cli/pipeline/back_sides.h"
#include "cli/pipeline/host.h"
#include "cli/pipeline/instance_sharing.h"
#include "cli/pipeline/model_levels.h"
#include "cli/pipeline/reading_options.h"
#include "cli/pipeline/texel_room.h"
#include "cli/report/report.h"
#include "prt/bake/bake.h"
#include "prt/bake/volume_bake.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace prt::pipeline {

/// Treatment of lobes of the scene file.
enum class LobesOfFile { keep, remove };

/// A volume of probes.
struct VolumeRequest {
    VolumeOptions volume{.spacing = 0};
    struct WorldBounds {
        glm::dvec3 least{0}, most{0};
    };
    std::optional<WorldBounds> bounds; ///< empty: the box of the scene

    /// True if a volume is requested.
    bool given() const { return volume.spacing > 0 || volume.probes > 0; }
};

struct BakeRequest {
    Path scene, output;                 ///< names for messages; `output` is passed to Host::write
    std::vector<std::string> no_shadow; ///< names of materials
    struct Finer {
        std::optional<double> refine; ///< relative L2 over the surface to split triangles for
        std::size_t max_vertices = 0; ///< maximum for a refined scene; 0: no limit except `refine`
    } finer;
    BackSides back_sides = BackSides::automatic;
    TexelRequest texels;  ///< if given: baked in place of vertices
    VolumeRequest volume; ///< if given: baked in addition to surfaces
    InstanceArguments instances;
    struct Kept {
        LevelMode levels = LevelMode::carry;
        LobesOfFile lobes = LobesOfFile::keep;
    } kept; ///< treatment of data of the scene file
    BakeOptions options;
    ReadingOptions reading; ///< of the high-poly model; its `bad_textures` apply to the scene
};

/// Bakes `document`, which was read from `request.scene`, and passes the .glb file with the transfer to
/// `host.write`. Returns the figures of the bake. Throws `Error`.
Report bake_model(BakeRequest request, GltfDocument document, const Host& host);

} // namespace prt::pipeline
