#pragma once

#include <cstdint>

namespace examples {

/// Random but fixed, in [0, 1), for every point of a lattice.
float lattice(int x, int y);

/// Returns value noise with quintic interpolation, in [0, 1], over a lattice of unit steps. It repeats after
/// `period` steps; 0: never.
float noise(float x, float y, int period = 0);

/// Returns octaves of noise over (u, v) with period 1: the first has `frequency` steps, each following one
/// twice the frequency and half the amplitude. In [0, 1], about 1/2 on average.
float tiling_noise(float u, float v, int frequency, int octaves);

} // namespace examples
