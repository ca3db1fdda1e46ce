#pragma once

// The table of S. Hill, "Hardware Accelerating Art Production", Gamasutra 2004: seconds to bake three meshes.

#include "prt/scene.h"

#include <array>

namespace prt {

struct ClassicRow {
    int vertices = 0;
    double seconds_d3dx = 0; ///< D3DX on the CPU of 2004
    double seconds_hill = 0; ///< his fastest, on the GPU of 2004
    Scene scene;             ///< made here: his meshes are not published
};

/// Bumpy tori with as many vertices as his meshes.
std::array<ClassicRow, 3> classic_rows();

inline constexpr std::array kClassicSamples = {1024, 2048, 4096};

} // namespace prt
