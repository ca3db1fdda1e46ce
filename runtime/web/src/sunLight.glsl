// Visibility of three's directional lights at surfaces that transfer lights from the sky. Included into the
// fragment shader of three's materials, before main; sunLoop.glsl shades by it. Names without prt are three's own.
// Define PRT_PACKED_SHADOW_MAPS if three packs depths into colors.

uniform bool prtSeparateSuns;
uniform vec4 prtTransmission; // color of transmitted light through a thin sheet, and its fraction

#if NUM_DIR_LIGHTS > 0

#if defined(USE_SHADOWMAP) && NUM_DIR_LIGHT_SHADOWS > 0

uniform mat4 directionalShadowMatrix[NUM_DIR_LIGHT_SHADOWS];

#if defined(SHADOWMAP_TYPE_BASIC) && !defined(USE_REVERSED_DEPTH_BUFFER)

// Percentage-closer soft shadows (R. Fernando, SIGGRAPH 2005 sketch): blockers are searched in the cone of
// the sun, and the map is filtered over the width of that cone at the mean blocker. Both compare with the
// plane of the surface, so that a slope does not shadow itself.

const int kPrtSearch = 24, kPrtTaps = 32;
const float kPrtSteepest = 50.0; // planes interpolated from pixels are unreliable at steeper slopes
const float kPrtRadiusAt = 0.1;  // shadow.radius of SunLights is for a blocker at this fraction of the depth range

float prtMapDepth(sampler2D map, ivec2 texel) {
  vec4 stored = texelFetch(map, clamp(texel, ivec2(0), textureSize(map, 0) - 1), 0);
#ifdef PRT_PACKED_SHADOW_MAPS
  return unpackRGBAToDepth(stored);
#else
  return stored.r;
#endif
}

// Returns the depth of the plane at the center of a texel; `slope`: depth per texel.
float prtPlaneDepth(vec3 point, vec2 slope, ivec2 texel) {
  return point.z + dot(slope, vec2(texel) + 0.5 - point.xy);
}

// Point i on a spiral (H. Vogel 1979).
vec2 prtSpiral(int i, float turn) {
  float angle = turn + 2.39996323 * float(i);
  return vec2(cos(angle), sin(angle));
}

// Returns the mean distance of blockers over the disc of the sun, as a fraction of the map's depth; negative if
// none exist. `spread`: radius of the sun in texels per unit of depth. Each doubling of the radius has an
// equal number of taps: blockers next to the surface are found near the center, distant ones anywhere.
float prtBlockerDistance(sampler2D map, vec3 point, vec2 slope, float spread, float turn) {
  float away = 0.0, found = 0.0;
  float steps = log2(spread * point.z + 1.5) + 1.0; // from half a texel
  for (int i = 0; i < kPrtSearch; ++i) {
    float radius = exp2(steps * (float(i) + 0.5) / float(kPrtSearch) - 1.0);
    ivec2 texelAt = ivec2(floor(point.xy + radius * prtSpiral(i, turn)));
    float depth = prtMapDepth(map, texelAt);
    float between = max(point.z - depth, 0.0);
    float share = radius / (spread * between + 1.5); // relative to the sun's radius there
    if (share <= 1.0 && depth < prtPlaneDepth(point, slope, texelAt)) {
      away += share * share * between;
      found += share * share;
    }
  }
  return found > 0.0 ? away / found : -1.0;
}

// Returns the visible fraction of a sun at a position in the world. `face`: unit normal of the triangle, on
// the lit side.
float prtVisibility(sampler2D map, mat4 toMap, DirectionalLightShadow sun, vec3 at, vec3 face) {
  // The rows of the matrix of an orthographic camera are orthogonal: two in texels, the third is the depth.
  mat3 axes = transpose(mat3(toMap));
  axes[0] *= sun.shadowMapSize.x;
  axes[1] *= sun.shadowMapSize.y;
  vec3 squares = vec3(dot(axes[0], axes[0]), dot(axes[1], axes[1]), dot(axes[2], axes[2]));
  // One texel off the surface: in a corner, a position nearer than a texel does not see the other wall in the
  // map.
  vec3 point = (toMap * vec4(at + face * inversesqrt(squares.x), 1.0)).xyz;
  point.z += sun.shadowBias;
  if (any(lessThan(point, vec3(0.0))) || any(greaterThan(point, vec3(1.0))))
    return 1.0;
  point.xy *= sun.shadowMapSize;
  vec3 n = face * axes / squares;
  vec2 slope = -n.xy / (n.z < 0.0 ? min(n.z, -1e-12) : max(n.z, 1e-12));
  slope *= min(1.0, kPrtSteepest * sqrt(squares.z / squares.x) / max(length(slope), 1e-12));

  // Patterns of neighbouring pixels are rotated relative to each other (J. Jimenez, SIGGRAPH 2014 course).
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  float spread = sun.shadowRadius / kPrtRadiusAt; // texels for each depth between
  float away = prtBlockerDistance(map, point, slope, spread, turn);
  if (away < 0.0)
    return 1.0;
  float width = spread * away, radius = max(width, 1.0);
  float open = 0.0;
  for (int i = 0; i < kPrtTaps; ++i) {
    float share = sqrt((float(i) + 0.5) / float(kPrtTaps)); // even over the disc
    ivec2 texelAt = ivec2(floor(point.xy + radius * share * prtSpiral(i, turn)));
    open += step(prtPlaneDepth(point, slope, texelAt), prtMapDepth(map, texelAt));
  }
  open /= float(kPrtTaps);
  // A penumbra within a texel is not resolved. In a corner half of the taps are beyond the other wall: half
  // open then counts as closed.
  open = mix(max(2.0 * open - 1.0, 0.0), open, clamp(width - 1.0, 0.0, 1.0));
  return mix(1.0, open, sun.shadowIntensity);
}

#define PRT_VISIBILITY(i)                                                                                              \
  prtVisibility(directionalShadowMap[i], directionalShadowMatrix[i], directionalLightShadows[i], prtPosition,          \
                towardsSun* worldFace)

#else

// Other types of shadow maps use three's filter with three's bias. Maps also contain the lit sides of baked meshes,
// which three omits by default: the filter needs at least the normal offset of SunLights.js.

float prtNormalBias(mat4 toMap, DirectionalLightShadow sun) {
  float texel = inversesqrt(dot(transpose(mat3(toMap))[0], transpose(mat3(toMap))[0])) / sun.shadowMapSize.x;
  return max(sun.shadowNormalBias, 1.41421356 * (sun.shadowRadius + 1.0) * texel);
}

#define PRT_VISIBILITY(i)                                                                                              \
  getShadow(directionalShadowMap[i], directionalLightShadows[i].shadowMapSize,                                         \
            directionalLightShadows[i].shadowIntensity, directionalLightShadows[i].shadowBias,                         \
            directionalLightShadows[i].shadowRadius,                                                                   \
            directionalShadowMatrix[i] *                                                                               \
                vec4(prtPosition + prtNormalBias(directionalShadowMatrix[i], directionalLightShadows[i]) *             \
                                       towardsSun * worldFace,                                                         \
                     1.0))

#endif
#endif

#endif
