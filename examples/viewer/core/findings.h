#pragma once

// What work in the background finds. Values: nothing in them is changed once they are posted.

#include "core/background_work.h"
#include "core/light_rig.h"
#include "pictures/model.h"
#include "pictures/picture_kind.h"

#include "prt/animation.h"
#include "prt/error_budget.h"
#include "prt/lobes.h"
#include "prt/occluder_gltf.h"
#include "prt/transfer_volume.h"

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace viewer {

/// What is asked of the compressor; changed by sliders, carried out in the background.
struct CompressionSettings {
    int order = 6; ///< at most the bake's
    int clusters = 256;
    int components = 4;

    friend bool operator==(const CompressionSettings&, const CompressionSettings&) = default;
};

/// Transfer as it was baked, and how.
struct Baked {
    std::shared_ptr<const prt::Transfer> transfer;
    prt::BakeRecord record;
};

/// Of `model`: of its vertices, or of texels.
struct Compressed {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const prt::ClusteredTransfer> transfer = {};
    std::shared_ptr<const prt::CompressedLightmap> lightmap = {}; ///< instead
    CompressionSettings how;
};

/// A scene, by vertices, by a lightmap, or by both: then each has a model, whose vertices may differ.
struct OpenModels {
    LoadedModel first;
    LoadedModel beside; ///< of texels, where the first is of vertices
};

/// Share of the hemisphere that is open. [receivers]
using Occlusion = std::shared_ptr<const std::vector<float>>;

struct EnvironmentFile {
    std::filesystem::path path;
    std::shared_ptr<const LoadedEnvironment> environment; ///< null where it cannot be read
    std::string why;                                      ///< then
};

/// Colors of all pictures of numbers that there are of `model`.
struct NumberPictures {
    std::shared_ptr<const Model> model;
    std::vector<std::pair<PictureKind, std::vector<glm::vec3>>> colors;
};

/// Tells two states of the light on the model apart.
struct RadianceVersion {
    std::uint64_t transfer = 0, light = 0, lamps = 0;
    bool suns_apart = false;

    friend bool operator==(const RadianceVersion&, const RadianceVersion&) = default;
};

/// A bake done again with another seed.
struct RepeatedBake {
    std::shared_ptr<const prt::Transfer> of, transfer;
};

/// Where the error over the surface of `model` comes from, under one light without lamps.
struct SurfaceBudget {
    std::shared_ptr<const Model> model;
    RadianceVersion version; ///< `lamps` is 0
    prt::ErrorBudget errors;
    std::vector<glm::vec3> colors; ///< [receivers] of the total, for `PictureKind::surface_error`
};

/// Files apart by what they are: those with animations are figures, where others are scenes or one is open.
struct SortedFiles {
    std::vector<std::filesystem::path> scenes, figures;
};

/// A file that was opened as a figure.
struct FigureFile {
    std::filesystem::path path;
    std::shared_ptr<const prt::AnimatedScene> figure;
    std::shared_ptr<const prt::LobeModel> lobes = {}; ///< of its vertices; null: it has none
};

/// What the nodes of a figure's file block around them.
struct FoundOccluders {
    std::shared_ptr<const prt::AnimatedScene> figure;
    std::vector<prt::NodeOccluder> occluders;
};

/// A volume of `model`, and the rays of each probe of a bake that goes on; 0: it is what the file holds.
struct FoundVolume {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const prt::CompressedVolume> volume;
    int rays = 0;
};

struct Saved {
    std::filesystem::path path;
};

enum class JobKind { model, environments, numbers, saving, budget, figure, volume };

/// A job ended with this message.
struct Failure {
    JobKind job;
    std::string why;
};

using Finding =
    std::variant<OpenModels, Baked, Compressed, Occlusion, EnvironmentFile, NumberPictures, RepeatedBake,
                 SurfaceBudget, SortedFiles, FigureFile, FoundOccluders, FoundVolume, Saved, Failure>;

using Channel = BackgroundWork<Finding>::Channel;

} // namespace viewer
