#pragma once

// Results of background jobs. They are immutable once posted.

#include "core/background_work.h"
#include "core/light_rig.h"
#include "pictures/model.h"
#include "pictures/picture_kind.h"

#include "bake/studies/error_budget.h"
#include "prt/core/lobes.h"
#include "prt/core/transfer_volume.h"
#include "prt/gltf/animation.h"
#include "prt/gltf/transfer_gltf.h"

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace viewer {

/// Settings of the compressor; sliders change them and a background job applies them.
struct CompressionSettings {
    int order = 6; ///< at most the order of the bake
    int clusters = 256;
    int components = 4;

    friend bool operator==(const CompressionSettings&, const CompressionSettings&) = default;
};

/// Transfer as baked, and the record of the bake.
struct Baked {
    std::shared_ptr<const prt::Transfer> transfer;
    prt::BakeRecord record;
};

/// Compressed transfer of `model`, for its vertices or for texels.
struct Compressed {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const prt::ClusteredTransfer> transfer = {};
    std::shared_ptr<const prt::CompressedLightmap> lightmap = {}; ///< set instead of `transfer` for texels
    CompressionSettings how;
};

/// A scene lit by vertices, by a lightmap, or by both. With both, each has a model, because their vertices
/// may differ.
struct OpenModels {
    LoadedModel first;
    LoadedModel beside; ///< lightmap model if `first` is lit by vertices
};

/// Fraction of the hemisphere that is open. [receivers]
using Occlusion = std::shared_ptr<const std::vector<float>>;

struct OpenedEnvironment {
    std::filesystem::path path;
    std::shared_ptr<const LoadedEnvironment> environment; ///< null: the file cannot be read
    std::string why;                                      ///< message if the file cannot be read
};

/// Colors of all available number pictures of `model`.
struct NumberPictures {
    std::shared_ptr<const Model> model;
    std::vector<std::pair<PictureKind, std::vector<glm::vec3>>> colors;
};

/// Identifies a state of the light on the model.
struct RadianceVersion {
    std::uint64_t transfer = 0, light = 0, lamps = 0;
    bool separate_suns = false;

    friend bool operator==(const RadianceVersion&, const RadianceVersion&) = default;
};

/// A bake repeated with another seed.
struct RepeatedBake {
    std::shared_ptr<const prt::Transfer> of, transfer;
};

/// Sources of the error over the surface of `model`, under one light without lamps.
struct SurfaceBudget {
    std::shared_ptr<const Model> model;
    RadianceVersion version; ///< `lamps` is 0
    prt::ErrorBudget errors;
    std::vector<glm::vec3> colors; ///< [receivers] colors of the total error, for
                                   ///< `PictureKind::surface_error`
};

/// Files sorted by kind: files with animations are figures if other files are scenes or a scene is open.
struct SortedFiles {
    std::vector<std::filesystem::path> scenes, figures;
};

/// A file opened as a figure.
struct FigureFile {
    std::filesystem::path path;
    std::shared_ptr<const prt::AnimatedScene> figure;
    std::shared_ptr<const prt::LobeModel> lobes = {}; ///< lobes of its vertices; null: the file has none
};

/// Occluders of the nodes of a figure's file.
struct FoundOccluders {
    std::shared_ptr<const prt::AnimatedScene> figure;
    std::vector<prt::NodeOccluder> occluders;
};

/// A volume of `model`. `rays` is the number of rays per probe of a bake in progress; 0: the volume comes
/// from the file.
struct FoundVolume {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const prt::CompressedVolume> volume;
    int rays = 0;
};

struct Saved {
    std::filesystem::path path;
};

enum class JobKind { model, environments, numbers, saving, budget, figure, volume };

/// The job ended with this error message.
struct Failure {
    JobKind job;
    std::string why;
};

using Finding =
    std::variant<OpenModels, Baked, Compressed, Occlusion, OpenedEnvironment, NumberPictures, RepeatedBake,
                 SurfaceBudget, SortedFiles, FigureFile, FoundOccluders, FoundVolume, Saved, Failure>;

using Channel = BackgroundWork<Finding>::Channel;

} // namespace viewer
