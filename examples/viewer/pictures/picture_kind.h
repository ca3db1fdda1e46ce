#pragma once

// The kinds of pictures that a side of the viewer can show.

#include <algorithm>
#include <array>
#include <cstddef>

namespace viewer {

enum class PictureKind {
    unshadowed,     ///< irradiance by normal, without occlusion
    ssao,           ///< unshadowed times screen-space ambient occlusion, from depth only
    ssao_normals,   ///< unshadowed times screen-space ambient occlusion, from depth and normals
    baked_ao,       ///< unshadowed times ambient occlusion of the vertices
    prt,            ///< raw transfer
    prt_compressed, ///< compressed transfer
    reference,      ///< path tracing
    clusters,       ///< a color per cluster
    components,     ///< number of components of the cluster
    error,          ///< error of the compression under this light
    seams,          ///< jumps of the compression error between clusters
    surface_error,  ///< total error against path tracing, at points over the surface
};

/// Kind of receivers.
enum class Receivers { vertices, texels };

struct PictureName {
    PictureKind kind;
    const char *id, *title; ///< name in scripts, name in the panel
};

inline constexpr std::array<PictureName, 12> kPictures = {{
    {PictureKind::unshadowed, "unshadowed", "Unshadowed irradiance"},
    {PictureKind::ssao, "ssao", "SSAO"},
    {PictureKind::ssao_normals, "ssao_normals", "SSAO with normals"},
    {PictureKind::baked_ao, "baked_ao", "Baked AO"},
    {PictureKind::prt, "prt", "PRT, uncompressed"},
    {PictureKind::prt_compressed, "prt_compressed", "PRT, compressed"},
    {PictureKind::reference, "reference", "Reference (path tracing)"},
    {PictureKind::clusters, "clusters", "Clusters"},
    {PictureKind::components, "components", "Number of components"},
    {PictureKind::error, "error", "Error of compression"},
    {PictureKind::seams, "seams", "Seams of compression"},
    {PictureKind::surface_error, "surface_error", "Error over the surface"},
}};

inline const PictureName& name_of(PictureKind kind) {
    return *std::ranges::find(kPictures, kind, &PictureName::kind);
}

/// Returns the next kind in the list; the first after the last.
inline PictureKind next(PictureKind kind) {
    const auto at = static_cast<std::size_t>(&name_of(kind) - kPictures.data());
    return kPictures[(at + 1) % kPictures.size()].kind;
}

inline bool is_ssao(PictureKind kind) {
    return kind == PictureKind::ssao || kind == PictureKind::ssao_normals;
}

/// True for pictures of transfer; a scene with vertices and a lightmap has two of each.
inline bool shows_transfer(PictureKind kind) {
    return kind == PictureKind::prt || kind == PictureKind::prt_compressed || kind == PictureKind::clusters ||
           kind == PictureKind::components || kind == PictureKind::error || kind == PictureKind::seams;
}

/// True for colors that encode numbers: shown unchanged, without exposure and base color.
inline bool shows_numbers(PictureKind kind) {
    return kind == PictureKind::clusters || kind == PictureKind::components || kind == PictureKind::error ||
           kind == PictureKind::seams || kind == PictureKind::surface_error;
}

} // namespace viewer
