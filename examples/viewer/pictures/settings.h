#pragma once

// All user settings as plain data. Panels, keys and scripts change them; drawing reads them.

#include "pictures/lamps.h"
#include "pictures/picture_kind.h"

namespace viewer {

struct SsaoSettings {
    float radius = 0.08f; ///< relative to the radius of the scene
    float bias = 0.02f;   ///< relative to the radius above
    float intensity = 1;  ///< exponent
    int samples = 16;

    friend bool operator==(const SsaoSettings&, const SsaoSettings&) = default;
};

/// Sides that show the lightmap, if both vertices and a lightmap of the scene are open.
struct LightmapSides {
    bool left = false, right = true;

    friend bool operator==(const LightmapSides&, const LightmapSides&) = default;
};

/// Settings of moving objects.
struct MovingSettings {
    bool figure = true, walks = true;
    float speed = 1;      ///< factor on its walking speed
    bool spheres = false; ///< show a matte and a mirroring sphere
    bool probes = false;  ///< show the probes of the volume in their light
    bool contact = true;  ///< moving objects darken surfaces near them

    friend bool operator==(const MovingSettings&, const MovingSettings&) = default;
};

/// Settings for drawing the model.
struct DrawSettings {
    bool wireframe = false;
    bool texel_grid = false; ///< borders of the lightmap's texels; not drawn over a difference
    LightmapSides lightmap;
    bool deferred = false; ///< use a G-buffer, not forward shading
    bool dithered = true;  ///< dither the five bits of occlusion in the G-buffer
    bool culling = true;   ///< cull clusters of triangles outside the view
    bool background = true;
    bool textured = true;
    int samples = 1; ///< per pixel along each axis
    SsaoSettings ssao;
    MovingSettings moving;

    friend bool operator==(const DrawSettings&, const DrawSettings&) = default;
};

/// Settings of the light on the model.
struct LitBy {
    bool separate_suns = true; ///< suns are separate from the sky and shadowed per pixel
    LampSettings lamps;

    friend bool operator==(const LitBy&, const LitBy&) = default;
};

struct Settings {
    PictureKind left = PictureKind::unshadowed, right = PictureKind::prt_compressed;
    float split = 0.5f;      ///< fraction of the width
    bool difference = false; ///< show the difference, not left and right
    float white = 0.3f;      ///< difference that is drawn white, relative to the mean radiance of the right
                             ///< picture
    DrawSettings drawing;
    LitBy lit;
    bool lobe = false;        ///< show the lobe of the receiver under the pointer
    float exposure_stops = 0; ///< added to the automatic exposure
    bool day_runs = false;    ///< one hour per second
    bool panels = true, help = false;

    friend bool operator==(const Settings&, const Settings&) = default;
};

/// The picture of a side, and its receivers if there are both kinds.
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
