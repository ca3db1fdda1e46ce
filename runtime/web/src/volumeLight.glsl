// Light of a volume in three's materials: incident light at a pixel, and its mirrored light. Included into the
// fragment shader, before main, after prt_volume.glsl. Names without prt are three's.

uniform mat4 prtToVolume;                          // from the world; relative to the volume's origin
uniform vec3 prtSkyLight[PRT_VOLUME_COEFFICIENTS]; // light of the sky only, without occlusion
centroid in vec3 prtVolumePosition;

// Transforms a direction from camera space to the space of the volume.
vec3 prtTowards(vec3 direction) {
  return normalize(mat3(prtToVolume) * inverseTransformDirection(direction, viewMatrix));
}

// Returns factors of the bands for mirrored light at this roughness: the GGX lobe of three's blurred
// environments, cos(t) D(t/2) about the mirrored direction, within 0.04. At roughness 1 it is the cosine.
vec4 prtBlurredBands(float roughness) {
  float a = roughness * roughness;
  vec3 even = mix(vec3(1.0), vec3(2.0 / 3.0, 0.25, 0.0), a);
  vec3 less = vec3(0.231, 0.783, 1.658) + a * vec3(0.065, -0.108, -0.780);
  return vec4(1.0, even - a * (1.0 - a) * less);
}

// Returns mirrored radiance. The light of the volume includes the surroundings, but not sharply; the
// environment is sharp, but contains only the sky. The larger the fraction of an open sky's light from a
// direction, the more of the environment is visible there, dimmed accordingly; the rest, and light beyond
// that of an open sky, comes from the volume.
vec3 prtMirrored(vec3 light[PRT_VOLUME_COEFFICIENTS], vec3 normal, vec3 towardsViewer, float roughness,
                 vec3 environment) {
  // three's direction
  vec3 mirrored = normalize(mix(reflect(-towardsViewer, normal), normal, roughness * roughness));
  vec3 direction = prtTowards(mirrored);
  vec4 bands = prtBlurredBands(roughness);
  vec3 here = prt_incident_sum(light, direction, bands);
#ifdef USE_ENVMAP
  vec3 open = prt_incident_sum(prtSkyLight, direction, bands);
  vec3 share = min(here / max(open, vec3(1e-6)), vec3(1.0));
  vec3 sharp = environment * share + max(here - open, vec3(0.0));
  return mix(here, sharp, min(share.r, min(share.g, share.b)));
#else
  return here;
#endif
}
