#pragma once

#include <cstdint>

namespace examples {

/// Random but fixed, in [0, 1), for every point of a lattice.
float lattice(int x, int y);

/// Value noise with quintic interpolation, in [0, 1], over a lattice of unit steps. It comes again after
/// `period` steps; 0: never.
float noise(float x, float y, int period = 0);

/// Octaves of noise over (u, v), which come again after 1: `frequency` steps at first, each octave twice as
/// many and half as strong. In [0, 1], about 1/2 on average.
float tiling_noise(float u, float v, int frequency, int octaves);

} // namespace examples
