#pragma once

// What one side of the viewer shows.

#include <algorithm>
#include <array>
#include <cstddef>

namespace viewer {

enum class PictureKind {
    unshadowed,     ///< irradiance of the normal, nothing in the way
    ssao,           ///< times screen-space ambient occlusion, from depth alone
    ssao_normals,   ///< the same from depth and normals
    baked_ao,       ///< times ambient occlusion of the vertices
    prt,            ///< raw transfer
    prt_compressed, ///< compressed transfer
    reference,      ///< path tracing
    clusters,       ///< a color per cluster
    components,     ///< how many directions the cluster has
    error,          ///< of the compression, under this light
    seams,          ///< jumps of that error between clusters
    surface_error,  ///< all of it, at points over the surface, against path tracing
};

/// Whose transfer.
enum class Receivers { vertices, texels };

struct PictureName {
    PictureKind kind;
    const char *id, *title; ///< for scripts; for people
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

/// The next in the list; after the last the first.
inline PictureKind next(PictureKind kind) {
    const auto at = static_cast<std::size_t>(&name_of(kind) - kPictures.data());
    return kPictures[(at + 1) % kPictures.size()].kind;
}

inline bool is_ssao(PictureKind kind) {
    return kind == PictureKind::ssao || kind == PictureKind::ssao_normals;
}

/// Of transfer, so that vertices and texels of one scene have two of them.
inline bool shows_transfer(PictureKind kind) {
    return kind == PictureKind::prt || kind == PictureKind::prt_compressed || kind == PictureKind::clusters ||
           kind == PictureKind::components || kind == PictureKind::error || kind == PictureKind::seams;
}

/// Colors that stand for numbers: shown as they are, without exposure and base color.
inline bool shows_numbers(PictureKind kind) {
    return kind == PictureKind::clusters || kind == PictureKind::components || kind == PictureKind::error ||
           kind == PictureKind::seams || kind == PictureKind::surface_error;
}

} // namespace viewer
