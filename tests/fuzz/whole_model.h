#pragma once

#include "prt/gltf/gltf.h"
#include "prt/render/lightmap_file.h"

#include <optional>

namespace prt::fuzz {

/// The complete content of a file.
struct WholeModel {
    GltfDocument document;
    Scene scene;
    std::optional<BakedTransfer> baked;
    std::optional<CompressedTransfer> compressed;
    std::optional<BakedLightmap> baked_lightmap;
    std::optional<CompressedLightmap> lightmap;
};

/// Reads as the program does and expects that all numbers are finite and all indices are inside. Throws
/// `Error` where the file is refused.
WholeModel read_whole(std::span<const std::byte> file, const std::filesystem::path& path);

/// Reads as a game does and expects that all numbers are finite and all indices are inside; lights
/// everything. Throws `Error` where the file is refused.
void use_loaded(std::span<const std::byte> file, const std::filesystem::path& path);

/// Decodes it, lights it, and expects finite numbers.
void expect_finite_light(const ClusteredTransfer& transfer);

/// Lights all its texels, and expects finite numbers. Large ones are left out: they show no more.
void expect_finite_light(const CompressedLightmap& lightmap);

} // namespace prt::fuzz
