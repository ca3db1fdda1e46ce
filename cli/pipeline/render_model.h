#pragma once

// Draws a model under a light: what `prt render` does.

#include "cli/pipeline/host.h"
#include "cli/pipeline/lamp_strengths.h"
#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/pipeline/view.h"
#include "cli/report/report.h"
#include "prt/render/tone_map.h"

#include <glm/gtc/type_precision.hpp>

#include <optional>
#include <vector>

namespace prt::pipeline {

enum class Show { lit, clusters, error, ao };

struct Look {
    Show show = Show::lit;
    Exposure exposure;
    int paths = 0; ///< per pixel for path tracing; 0: no path tracing
    ToneMap tone_map = ToneMap::filmic;
    bool background = true;
};

/// Lights in addition to the sky.
struct SunAndLampOptions {
    /// automatic: shadows of suns are the most visible, and no order represents them
    SunCount suns = {std::nullopt};
    int sun_rays = 32; ///< for each pixel and sun
    LampChoice lamps;
    double lamp_scale = 1;
};

/// The reference of `--show error`.
enum class ErrorOf { none, baked, traced };

struct RenderRequest {
    FileSource model, baked;  ///< baked: the reference of Show::error; empty: path tracing
    Path environment, output; ///< output: its suffix selects linear values (.exr) or display values (.png)
    LightOptions light_options = {{}, Window::automatic, 0}; ///< a picture shows ringing as bruises
    SunAndLampOptions lights;
    View view;
    Backend backend = Backend::automatic;
    Look look;
    ReadingOptions reading;
    int threads = 0;

    ErrorOf error() const {
        if (look.show != Show::error)
            return ErrorOf::none;
        return look.paths > 0 ? ErrorOf::traced : ErrorOf::baked;
    }
    /// Whether the picture is drawn with light, with its textures and exposed.
    bool drawn_lit() const { return look.show == Show::lit || error() == ErrorOf::traced; }
    bool traced() const { return look.paths > 0; }
};

struct RenderedPicture {
    Report report;
    Image linear;                     ///< linear Rec. 709, [height][width]; empty for display values
    std::vector<glm::u8vec3> display; ///< sRGB, [height][width]; empty for linear values
};

/// Draws the picture; writes no file. Notices are sent to `request.reading.notify`. Throws `Error`.
RenderedPicture render_model(const RenderRequest& request, const Host& host);

} // namespace prt::pipeline
