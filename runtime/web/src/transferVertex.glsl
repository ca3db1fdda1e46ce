// Transforms the attributes of a mesh to the space of the bake, which predictors use; the position is
// relative to their origin. Included into the vertex shader of three's materials, after
// prt_exit_radiance.glsl or prt_instances.glsl. Attributes and matrices without prt are three's. Define
// PRT_LIGHTMAP if texels have the transfer, PRT_VOLUME if probes have it, not vertices; PRT_LOBES if vertices
// have it as lobes.
#if defined(PRT_LOBES)
// Included after prt_lobes.glsl.
in vec4 prt_lobe_0;
#if PRT_LOBES > 1
in vec4 prt_lobe_1;
#endif
#if PRT_LOBES > 2
in vec4 prt_lobe_2;
#endif
#ifndef PRT_VOLUME
uniform vec3 prtLobeLight[PRT_LOBE_COEFFICIENTS];
#endif
out vec3 prtRadiance;

// `rotation`: rotation of prt_lobe_rotation, from the mesh to the space of the light: the world, or a volume, which
// contains `point`.
vec3 prtLobeRadiance(mat3 rotation, vec3 point) {
  PrtLobe lobes[PRT_LOBES];
  lobes[0] = prt_rotated_lobe(prt_lobe(prt_lobe_0), rotation);
#if PRT_LOBES > 1
  lobes[1] = prt_rotated_lobe(prt_lobe(prt_lobe_1), rotation);
#endif
#if PRT_LOBES > 2
  lobes[2] = prt_rotated_lobe(prt_lobe(prt_lobe_2), rotation);
#endif
#ifdef PRT_VOLUME
  vec3 rotated = rotation * normal;
  float size = length(rotated);
  return prt_lobes_in_volume(lobes, point, size > 0.0 ? rotated / size : vec3(0.0, 1.0, 0.0));
#else
  return prt_lobes_radiance(lobes, prtLobeLight);
#endif
}
#elif !defined(PRT_LIGHTMAP) && !defined(PRT_VOLUME)
#if defined(PRT_BAKED_ATTRIBUTES)
in vec3 prt_baked_position, prt_baked_normal;
vec3 prtBakedPosition() {
  return prt_baked_position;
}
vec3 prtBakedNormal() {
  return prt_baked_normal;
}
#elif defined(PRT_INSTANCES)
// A mesh that instances share was baked in its own space.
vec3 prtBakedPosition() {
  return position;
}
vec3 prtBakedNormal() {
  return dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0);
}
#elif !defined(PRT_PREDICTOR_NORMAL) && !defined(PRT_PREDICTOR_POSITION)
vec3 prtBakedPosition() {
  return vec3(0.0);
}
vec3 prtBakedNormal() {
  return vec3(0.0);
}
#else
uniform mat4 prtToBake;
uniform mat3 prtNormalToBake;
vec3 prtBakedPosition() {
  return (prtToBake * vec4(position, 1.0)).xyz;
}
vec3 prtBakedNormal() {
  vec3 rotated = prtNormalToBake * normal;
  float squared = dot(rotated, rotated);
  return squared > 0.0 ? rotated * inversesqrt(squared) : vec3(0.0);
}
#endif

#ifdef PRT_INSTANCES
in vec4 prt_instance_0, prt_instance_1;
#endif
out vec3 prtRadiance; // for a receiver of albedo 1
#endif

// Position in the world, within the covered part of a pixel: its center may be beyond a wall.
centroid out vec3 prtPosition;
#ifdef PRT_VOLUME
uniform mat4 prtToVolume;
centroid out vec3 prtVolumePosition; // from the origin of the volume
#endif

// `transformed`: the vertex after skinning and morph targets.
void prtLight(vec3 transformed) {
#if !defined(PRT_LIGHTMAP) && !defined(PRT_VOLUME) && !defined(PRT_LOBES)
#ifdef PRT_INSTANCES
  prtRadiance = prt_instance_radiance(prt_instance_0, prt_instance_1, prtBakedPosition(), prtBakedNormal());
#else
  prtRadiance = prt_exit_radiance(prtBakedPosition(), prtBakedNormal());
#endif
#endif
  vec4 point = vec4(transformed, 1.0);
#ifdef USE_BATCHING
  point = batchingMatrix * point;
#endif
#ifdef USE_INSTANCING
  point = instanceMatrix * point;
#endif
  point = modelMatrix * point;
  prtPosition = point.xyz;
#ifdef PRT_VOLUME
  prtVolumePosition = (prtToVolume * point).xyz;
#endif
}
