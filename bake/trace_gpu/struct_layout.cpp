// Checks that the structs of shaders/shared_structs.h have the layout std430 in C++.

#include "shared_structs.h"

#include <cstddef>

namespace prt::gpu {

#define PRT_AT(type, member, offset) static_assert(offsetof(type, member) == (offset))
static_assert(sizeof(Receiver) == 32);
PRT_AT(Receiver, origin, 0);
PRT_AT(Receiver, normal, 16);

static_assert(sizeof(LampReceiver) == 48);
PRT_AT(LampReceiver, origin, 0);
PRT_AT(LampReceiver, normal, 16);
PRT_AT(LampReceiver, position, 32);

static_assert(sizeof(PunctualLight) == 64);
PRT_AT(PunctualLight, intensity, 0);
PRT_AT(PunctualLight, directional, 12);
PRT_AT(PunctualLight, position, 16);
PRT_AT(PunctualLight, inverse_range, 28);
PRT_AT(PunctualLight, direction, 32);
PRT_AT(PunctualLight, inner_cosine, 44);
PRT_AT(PunctualLight, outer_cosine, 48);
PRT_AT(PunctualLight, unused, 52);

static_assert(sizeof(ShiningTriangle) == 96);
PRT_AT(ShiningTriangle, a, 0);
PRT_AT(ShiningTriangle, luminance, 12);
PRT_AT(ShiningTriangle, b, 16);
PRT_AT(ShiningTriangle, offset, 28);
PRT_AT(ShiningTriangle, c, 32);
PRT_AT(ShiningTriangle, two_sided, 44);
PRT_AT(ShiningTriangle, radiance, 48);
PRT_AT(ShiningTriangle, alpha, 60);
PRT_AT(ShiningTriangle, texcoord, 64);
PRT_AT(ShiningTriangle, image, 88);
PRT_AT(ShiningTriangle, unused, 92);

static_assert(sizeof(EmissionImage) == 20);
PRT_AT(EmissionImage, texels, 0);
PRT_AT(EmissionImage, width, 4);
PRT_AT(EmissionImage, height, 8);
PRT_AT(EmissionImage, wrap, 12);
PRT_AT(EmissionImage, linear, 16);

static_assert(sizeof(TracePush) == 40);
PRT_AT(TracePush, receivers, 0);
PRT_AT(TracePush, spread, 36);

static_assert(sizeof(SumRow) == 28);
PRT_AT(SumRow, shares, 12);
PRT_AT(SumRow, sign, 24);

static_assert(sizeof(GatherPush) == 24);
static_assert(sizeof(EnergyPush) == 12);

static_assert(sizeof(HitRecord) == 24);
PRT_AT(HitRecord, triangle, 0);
PRT_AT(HitRecord, u, 4);
PRT_AT(HitRecord, weight, 12);
PRT_AT(HitRecord, footprint, 16);
PRT_AT(HitRecord, row, 20);

static_assert(sizeof(ThreadProgress) == 12);

static_assert(sizeof(LampPush) == 48);
PRT_AT(LampPush, first_receiver, 0);
PRT_AT(LampPush, radius, 40);

static_assert(sizeof(Direction) == 480);
PRT_AT(Direction, towards_light, 0);
PRT_AT(Direction, map_from_world, 16);
PRT_AT(Direction, basis, 80);

static_assert(sizeof(AlphaTriangle) == 48);
PRT_AT(AlphaTriangle, texcoord, 0);
PRT_AT(AlphaTriangle, vertex_alpha, 24);
PRT_AT(AlphaTriangle, material, 36);
PRT_AT(AlphaTriangle, texel_density, 40);
PRT_AT(AlphaTriangle, next, 44);

static_assert(sizeof(AlphaMaterial) == 32);
PRT_AT(AlphaMaterial, mode, 0);
PRT_AT(AlphaMaterial, cutoff, 4);
PRT_AT(AlphaMaterial, factor, 8);
PRT_AT(AlphaMaterial, texels, 12);
PRT_AT(AlphaMaterial, width, 16);
PRT_AT(AlphaMaterial, height, 20);
PRT_AT(AlphaMaterial, levels, 24);
PRT_AT(AlphaMaterial, wrap, 28);

static_assert(sizeof(WideNode) == 80);
PRT_AT(WideNode, origin, 0);
PRT_AT(WideNode, exponents, 12);
PRT_AT(WideNode, first_child, 16);
PRT_AT(WideNode, first_triangle, 20);
PRT_AT(WideNode, meta, 24);
PRT_AT(WideNode, low, 32);
PRT_AT(WideNode, high, 56);
#undef PRT_AT

} // namespace prt::gpu
