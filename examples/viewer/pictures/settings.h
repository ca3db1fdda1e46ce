#pragma once

// All that the user sets, as plain data: panels, keys and scripts change it, drawing reads it.

#include "pictures/lamps.h"
#include "pictures/picture_kind.h"

namespace viewer {

struct SsaoSettings {
    float radius = 0.08f; ///< of the radius of the scene
    float bias = 0.02f;   ///< of the radius above
    float intensity = 1;  ///< exponent
    int samples = 16;

    friend bool operator==(const SsaoSettings&, const SsaoSettings&) = default;
};

/// Where both vertices and a lightmap of the scene are open: which sides show the lightmap.
struct LightmapSides {
    bool left = false, right = true;

    friend bool operator==(const LightmapSides&, const LightmapSides&) = default;
};

/// What moves through the scene, or could.
struct MovingSettings {
    bool figure = true, walks = true;
    float speed = 1;      ///< times that of its walk
    bool spheres = false; ///< a matt and a mirroring one
    bool probes = false;  ///< of the volume, in their own light
    bool contact = true;  ///< they darken what they come near to

    friend bool operator==(const MovingSettings&, const MovingSettings&) = default;
};

/// How the model is drawn.
struct DrawSettings {
    bool wireframe = false;
    bool texel_grid = false; ///< borders of the lightmap's texels; not over a difference
    LightmapSides lightmap;
    bool deferred = false; ///< through a G-buffer instead of forward
    bool dithered = true;  ///< the five bits of occlusion in the G-buffer
    bool culling = true;   ///< of clusters of triangles outside the view
    bool background = true;
    bool textured = true;
    int samples = 1; ///< per pixel along each axis
    SsaoSettings ssao;
    MovingSettings moving;

    friend bool operator==(const DrawSettings&, const DrawSettings&) = default;
};

/// What the model is lit by.
struct LitBy {
    bool suns_apart = true; ///< from the sky: shadowed at each pixel
    LampSettings lamps;

    friend bool operator==(const LitBy&, const LitBy&) = default;
};

struct Settings {
    PictureKind left = PictureKind::unshadowed, right = PictureKind::prt_compressed;
    float split = 0.5f;      ///< of the width
    bool difference = false; ///< instead of left and right
    float white = 0.3f;      ///< difference that is white, over the mean radiance of the right picture
    DrawSettings drawing;
    LitBy lit;
    bool lobe = false;        ///< of the receiver under the pointer
    float exposure_stops = 0; ///< beside the automatic exposure
    bool day_runs = false;    ///< an hour a second
    bool panels = true, help = false;

    friend bool operator==(const Settings&, const Settings&) = default;
};

/// What a side shows, of which receivers where there are both.
struct SidePicture {
    SidePicture(PictureKind wanted, Receivers of = Receivers::vertices) : kind(wanted), receivers(of) {}

    PictureKind kind;
    Receivers receivers;
};

inline SidePicture left_picture(const Settings& settings) {
    return {settings.left, settings.drawing.lightmap.left ? Receivers::texels : Receivers::vertices};
}
inline SidePicture right_picture(const Settings& settings) {
    return {settings.right, settings.drawing.lightmap.right ? Receivers::texels : Receivers::vertices};
}

} // namespace viewer
