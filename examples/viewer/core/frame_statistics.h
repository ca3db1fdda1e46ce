#pragma once

// What is measured from frame to frame.

#include "core/document.h"
#include "pictures/frame_renderer.h"

#include "prt/support/stopwatch.h"

#include <optional>

namespace viewer {

struct Milliseconds {
    double frame = 0;     ///< mean of the last frames, from one to the next
    double longest = 0;   ///< between two frames, since it was set to 0
    double gpu = 0;       ///< of a frame
    double vertices = 0;  ///< of the vertex stage of the right picture alone
    double constants = 0; ///< forming and uploading, when the light changes
    double open = 0;      ///< from asking for the model to its first frame
};

/// What the panel and scripts report.
struct Figures {
    Milliseconds milliseconds;
    std::size_t receivers = 0, triangles = 0, triangles_drawn = 0;
    TransferFigures transfer; ///< of vertices
    std::optional<LightmapFigures> lightmap;
    std::optional<InstanceFigures> instances; ///< that share transfer
    int reference_passes = 0;
    Difference difference; ///< of the two pictures, while it is shown
};

class FrameStatistics {
public:
    Figures figures;

    void begin_frame();
    /// True for every 16th frame of a model, which takes the time of its vertex stage.
    bool times_vertices() { return frames_++ % 16 == 0; }

    void begin_opening() { opening_.emplace(); }
    void fail_opening() { opening_.reset(); }
    /// A frame of a model is drawn. Waits for the GPU where it is the first.
    void end_opening();

private:
    std::optional<prt::Stopwatch> opening_;
    prt::Stopwatch since_frame_;
    std::uint64_t frames_ = 0;
};

} // namespace viewer
