// Adds transfer to the shaders of three's lit materials in `onBeforeCompile`: exit radiance, or the light of
// a volume, replaces three's diffuse ambient light, and separate suns are added. Three computes the rest:
// specular reflection, normal maps, coats, shadows, fog, tone mapping.

import { ShaderChunk } from "three";
import { MOST_OCCLUDERS } from "./PrtkitOccluders.js";
import exitRadiance from "./prt_exit_radiance.glsl.js";
import instanceRadiance from "./prt_instances.glsl.js";
import lobes from "./prt_lobes.glsl.js";
import occluders from "./prt_occluders.glsl.js";
import sunLight from "./sunLight.glsl.js";
import sunLoop from "./sunLoop.glsl.js";
import transferVertex from "./transferVertex.glsl.js";
import volume from "./prt_volume.glsl.js";
import volumeLight from "./volumeLight.glsl.js";

// Three packed the depths of its shadow maps into colors until release 181.
export const PACKED_SHADOW_MAPS = ShaderChunk.shadowmap_pars_fragment.includes("unpackRGBAToDepth");

/**
 * Returns `text` with matches of `pattern` replaced; throws for a release of three without a match, because
 * it would be drawn incorrectly.
 */
function replaced(text, pattern, replacement) {
  const result = text.replace(pattern, replacement);
  if (result === text) throw new Error(`prtkit: this release of three is not supported: its shaders do not contain ${pattern}`);
  return result;
}

// Three's lights are omitted: point, spot and area lights, ambient light, probes. Their light is in the sky,
// or in a lamp of the transfer. sunLoop.glsl shades directional lights.
const LIGHTS = replaced(
  replaced(ShaderChunk.lights_fragment_begin, /#if \( (NUM_\w+_LIGHTS) > 0 \) && defined\( RE_Direct\w* \)/g, "#if 0 // $1"),
  "vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );",
  "vec3 irradiance = vec3( 0.0 );",
);

// Omits the terms that three adds after ambient light. A light map belongs to the user and is kept.
const NO_IRRADIANCE = `
  irradiance = vec3( 0.0 );
  totalEmissiveRadiance *= prtStrength;
${sunLoop}`;

// Occluders of baked surfaces, in world space.
const OCCLUDERS = `
#ifdef PRT_OCCLUDERS
#define PRT_MAX_OCCLUDERS ${MOST_OCCLUDERS}
#define PRT_OCCLUDER_ROWS prtOccluderRows
#define PRT_OCCLUDER_COUNT prtOccluderCount
uniform vec4 prtOccluderRows[ 5 * PRT_MAX_OCCLUDERS ];
uniform int prtOccluderCount;
uniform vec4 prtOccluderReach; // a sphere; outside it no occluder has an effect
${occluders}
#endif`;

// Lookup of a volume for custom shaders: the uniforms of PrtkitVolume.
export const VOLUME = `
#define PRT_VOLUME_ORIGIN vec3( 0.0 ) // prtToVolume already subtracts it
#define PRT_VOLUME_SPACING prtVolumeSpacing
#define PRT_VOLUME_SIZE prtVolumeSize
#define PRT_VOLUME_FIRST prtVolumeFirst
#define PRT_VOLUME_BRICKS prtVolumeBricks
uniform highp float prtVolumeSpacing;
uniform highp ivec3 prtVolumeSize, prtVolumeBricks;
uniform highp ivec4 prtVolumeFirst;
${volume}`;

// Light of moving objects: the normal of the surface is used for the lookup, and the normal of the pixel for
// the light.
const INCIDENT = `
  vec3 prtIncident[ PRT_VOLUME_COEFFICIENTS ];
  prt_volume_incident( prtVolumePosition, prtTowards( nonPerturbedNormal ), prtIncident );
#ifndef PRT_LOBES
  vec3 prtRadiance = prt_incident_irradiance( prtIncident, prtTowards( normal ) );
#endif
#ifdef STANDARD
  radiance = prtMirrored( prtIncident, geometryNormal, geometryViewDir, material.roughness, radiance );
#ifdef USE_CLEARCOAT
  clearcoatRadiance =
    prtMirrored( prtIncident, geometryClearcoatNormal, geometryViewDir, material.clearcoatRoughness, clearcoatRadiance );
#endif
#endif`;

// With an environment the transfer replaces three's irradiance, and shares energy with the specular
// reflection in the same way. Without an environment there is only diffuse reflection, and rough metals as in
// bounces (docs/math.md, section 6).
const TRANSFER = `
#ifdef PRT_LIGHTMAP
  vec3 prtRadiance = RECIPROCAL_PI * irradiance; // of three's light map, which contains the transfer
  irradiance = vec3( 0.0 );
#endif
  vec3 prtDiffuse = max( prtRadiance, vec3( 0.0 ) );
#ifdef PRT_OCCLUDERS
  if ( distance( prtPosition, prtOccluderReach.xyz ) < prtOccluderReach.w )
    prtDiffuse *= prt_occluders_visibility( prtPosition, inverseTransformDirection( nonPerturbedNormal, viewMatrix ) );
#endif
#if defined( STANDARD ) && ( defined( USE_ENVMAP ) || defined( PRT_VOLUME ) )
  iblIrradiance = PI * prtDiffuse;
#elif defined( STANDARD )
  reflectedLight.indirectDiffuse += prtDiffuse * diffuseColor.rgb * ( 1.0 - metalnessFactor * ( 1.0 - roughnessFactor * roughnessFactor ) );
#else
  iblIrradiance = vec3( 0.0 );
  reflectedLight.indirectDiffuse += prtDiffuse * diffuseColor.rgb;
#endif`;

// The transfer includes ambient occlusion; three's occlusion texture is applied only to specular light.
const OCCLUSION = replaced(ShaderChunk.aomap_fragment, "reflectedLight.indirectDiffuse *= ambientOcclusion;", "");

// A vertex without a normal uses the normal of its triangle.
const FACE_NORMAL = `
  vec3 prtFace = normalize( cross( dFdx( vViewPosition ), dFdy( vViewPosition ) ) ); // on the visible side
  if ( ! ( dot( normal, normal ) > 0.5 ) ) normal = prtFace;`;

const include = (name) => `#include <${name}>`;

/** Applies common changes: `vertex` and `fragment` before main, `lights` after three's lights. */
function addLight(shader, { vertex, fragment, lights }) {
  const add = (stage, name, text) => (shader[stage] = replaced(shader[stage], include(name), text));
  const addFragment = (name, text) => add("fragmentShader", name, text);
  add("vertexShader", "common", `${include("common")}\n${vertex}\n${transferVertex}`);
  add("vertexShader", "project_vertex", `${include("project_vertex")}\nprtLight( transformed );`);
  addFragment("common", `${include("common")}\n${fragment}\nuniform vec3 prtStrength;\ncentroid in vec3 prtPosition;`);
  addFragment("shadowmap_pars_fragment", `${include("shadowmap_pars_fragment")}\n#ifdef PRT_SUNS\n${sunLight}\n#endif`);
  addFragment("normal_fragment_begin", `${include("normal_fragment_begin")}${FACE_NORMAL}`);
  addFragment("lights_fragment_begin", `${LIGHTS}${NO_IRRADIANCE}`);
  addFragment("lights_fragment_maps", `${include("lights_fragment_maps")}${lights}${TRANSFER}`);
}

/**
 * Adds transfer to the shaders of MeshStandardMaterial, MeshPhysicalMaterial or MeshLambertMaterial with
 * these defines.
 */
export function addTransfer(shader, { PRT_INSTANCES }) {
  addLight(shader, {
    vertex: `#ifndef PRT_LIGHTMAP\n${PRT_INSTANCES ? instanceRadiance : exitRadiance}\n#endif`,
    fragment: `#ifndef PRT_LIGHTMAP\nin vec3 prtRadiance;\n#endif${OCCLUDERS}`,
    lights: "",
  });
  shader.fragmentShader = replaced(shader.fragmentShader, include("aomap_fragment"), OCCLUSION);
}

// Axes of lobes rotate like normals: by all transforms of a vertex. `skinMatrix` belongs to three.
const LOBE_ROTATION = `
  mat3 prtMoved = mat3( modelMatrix );
#ifdef USE_INSTANCING
  prtMoved = prtMoved * mat3( instanceMatrix );
#endif
#ifdef USE_SKINNING
  prtMoved = prtMoved * mat3( skinMatrix );
#endif
#ifdef PRT_VOLUME
  prtRadiance = prtLobeRadiance( prt_lobe_rotation( mat3( prtToVolume ) * prtMoved ), prtVolumePosition );
#else
  prtRadiance = prtLobeRadiance( prt_lobe_rotation( prtMoved ), vec3( 0.0 ) );
#endif`;

const PROFILES = `
uniform highp sampler2D prt_lobe_profiles;
#define PRT_LOBE_PROFILE(i) texelFetch( prt_lobe_profiles, ivec2( i, 0 ), 0 )`;

const LIT_AT_VERTICES = "in vec3 prtRadiance;";

/** Inserted after the position of the vertex. */
function rotateLobes(shader) {
  shader.vertexShader = replaced(shader.vertexShader, "prtLight( transformed );", `prtLight( transformed );${LOBE_ROTATION}`);
}

/** Adds transfer that rotates with a skin to the shaders. */
export function addLobes(shader) {
  addLight(shader, { vertex: `${PROFILES}\n${lobes}`, fragment: LIT_AT_VERTICES, lights: "" });
  rotateLobes(shader);
  shader.fragmentShader = replaced(shader.fragmentShader, include("aomap_fragment"), OCCLUSION);
}

/**
 * Adds the light of a volume to the shaders, by lobes if there are any. Occlusion textures of a moving object
 * contain its self-occlusion and are kept.
 */
export function addVolume(shader, { PRT_LOBES }) {
  const [vertex, fragment] = PRT_LOBES ? [`${VOLUME}\n${PROFILES}\n${lobes}`, LIT_AT_VERTICES] : ["", ""];
  addLight(shader, { vertex, fragment: `${VOLUME}\n${volumeLight}\n${fragment}`, lights: INCIDENT });
  if (PRT_LOBES) rotateLobes(shader);
}
