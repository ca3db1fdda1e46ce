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

/// How the model is drawn.
struct DrawSettings {
    bool wireframe = false;
    bool deferred = false; ///< through a G-buffer instead of forward
    bool dithered = true;  ///< the five bits of occlusion in the G-buffer
    bool culling = true;   ///< of clusters of triangles outside the view
    bool background = true;
    bool textured = true;
    int samples = 1; ///< per pixel along each axis
    SsaoSettings ssao;

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

} // namespace viewer
