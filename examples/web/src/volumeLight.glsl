// Light of a volume in three's materials: what comes in at a pixel, and what of it a surface mirrors. Included into the
// fragment shader, before main, behind prt_volume.glsl. Names without prt are three's own.

uniform mat4 prtToVolume;                          // from the world, with the volume's origin taken off
uniform vec3 prtSkyLight[PRT_VOLUME_COEFFICIENTS]; // of the sky alone, as where nothing is in its way
centroid in vec3 prtVolumePlace;

// A direction of the camera's space in the frame of the volume.
vec3 prtTowards(vec3 direction) {
  return normalize(mat3(prtToVolume) * inverseTransformDirection(direction, viewMatrix));
}

// What the bands keep of light that a surface of this roughness mirrors: of the GGX lobe that three blurs its
// environments by, cos(t) D(t/2) about the mirrored direction, within 0.04. At roughness 1 that is the cosine.
vec4 prtBlurredBands(float roughness) {
  float a = roughness * roughness;
  vec3 even = mix(vec3(1.0), vec3(2.0 / 3.0, 0.25, 0.0), a);
  vec3 less = vec3(0.231, 0.783, 1.658) + a * vec3(0.065, -0.108, -0.780);
  return vec4(1.0, even - a * (1.0 - a) * less);
}

// Radiance that a surface mirrors. The light of the volume knows what stands around, but not sharply; the environment
// is sharp, but knows the sky alone. The more of an open sky's light comes from a direction, the more of the
// environment is seen there, dimmed to that; the rest, and what the volume has beyond an open sky, is the volume's.
vec3 prtMirrored(vec3 light[PRT_VOLUME_COEFFICIENTS], vec3 normal, vec3 towardsViewer, float roughness,
                 vec3 environment) {
  vec3 mirrored = normalize(mix(reflect(-towardsViewer, normal), normal, roughness * roughness)); // as three has it
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
