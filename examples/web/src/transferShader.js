// What transfer adds to the shaders of three's lit materials, as `onBeforeCompile` is given them: exit radiance, or the light of
// a volume, in the place of the diffuse light that three would find around, and suns that are apart. All else is three's:
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

/** `text` with what `pattern` finds replaced; a three that has it otherwise is refused, not drawn wrong. */
function replaced(text, pattern, replacement) {
  const result = text.replace(pattern, replacement);
  if (result === text) throw new Error(`prtkit: this release of three has no ${pattern} in its shaders`);
  return result;
}

// Three's own lights are left out: point, spot and area lights, ambient light, probes. What they would be is in the sky, or
// a lamp of the transfer. Directional lights are shaded by sunLoop.glsl.
const LIGHTS = replaced(
  replaced(ShaderChunk.lights_fragment_begin, /#if \( (NUM_\w+_LIGHTS) > 0 \) && defined\( RE_Direct\w* \)/g, "#if 0 // $1"),
  "vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );",
  "vec3 irradiance = vec3( 0.0 );",
);

// Without those that three adds to it behind ambient light. A light map is the user's own, and stays.
const NO_IRRADIANCE = `
  irradiance = vec3( 0.0 );
  totalEmissiveRadiance *= prtStrength;
${sunLoop}`;

// What takes light from baked surfaces, in the world.
const OCCLUDERS = `
#ifdef PRT_OCCLUDERS
#define PRT_MOST_OCCLUDERS ${MOST_OCCLUDERS}
#define PRT_OCCLUDER_ROWS prtOccluderRows
#define PRT_OCCLUDER_COUNT prtOccluderCount
uniform vec4 prtOccluderRows[ 5 * PRT_MOST_OCCLUDERS ];
uniform int prtOccluderCount;
uniform vec4 prtOccluderReach; // a sphere, out of which none takes any
${occluders}
#endif`;

// How shaders of one's own look a volume up: the uniforms of PrtkitVolume.
export const VOLUME = `
#define PRT_VOLUME_ORIGIN vec3( 0.0 ) // prtToVolume has taken it off
#define PRT_VOLUME_SPACING prtVolumeSpacing
#define PRT_VOLUME_SIZE prtVolumeSize
#define PRT_VOLUME_FIRST prtVolumeFirst
#define PRT_VOLUME_BRICKS prtVolumeBricks
uniform highp float prtVolumeSpacing;
uniform highp ivec3 prtVolumeSize, prtVolumeBricks;
uniform highp ivec4 prtVolumeFirst;
${volume}`;

// Of what moves: by the normal of the surface for where it is looked up, by that of the pixel for what it is lit with.
const INCIDENT = `
  vec3 prtIncident[ PRT_VOLUME_COEFFICIENTS ];
  prt_volume_incident( prtVolumePlace, prtTowards( nonPerturbedNormal ), prtIncident );
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

// With an environment the transfer is what three calls the irradiance of it, and shares energy with the specular reflection as
// that does. Without, nothing is reflected but diffusely, and rough metals as bounces have them (docs/math.md, section 6).
const TRANSFER = `
#ifdef PRT_LIGHTMAP
  vec3 prtRadiance = RECIPROCAL_PI * irradiance; // of three's light map, which is the transfer's
  irradiance = vec3( 0.0 );
#endif
  vec3 prtDiffuse = max( prtRadiance, vec3( 0.0 ) );
#ifdef PRT_OCCLUDERS
  if ( distance( prtPlace, prtOccluderReach.xyz ) < prtOccluderReach.w )
    prtDiffuse *= prt_occluders_openness( prtPlace, inverseTransformDirection( nonPerturbedNormal, viewMatrix ) );
#endif
#if defined( STANDARD ) && ( defined( USE_ENVMAP ) || defined( PRT_VOLUME ) )
  iblIrradiance = PI * prtDiffuse;
#elif defined( STANDARD )
  reflectedLight.indirectDiffuse += prtDiffuse * diffuseColor.rgb * ( 1.0 - metalnessFactor * ( 1.0 - roughnessFactor * roughnessFactor ) );
#else
  iblIrradiance = vec3( 0.0 );
  reflectedLight.indirectDiffuse += prtDiffuse * diffuseColor.rgb;
#endif`;

// Occlusion of the surroundings is in the transfer; three's texture of it stays with what is specular.
const OCCLUSION = replaced(ShaderChunk.aomap_fragment, "reflectedLight.indirectDiffuse *= ambientOcclusion;", "");

// A vertex without a normal has that of its triangle.
const FACE_NORMAL = `
  vec3 prtFace = normalize( cross( dFdx( vViewPosition ), dFdy( vViewPosition ) ) ); // on the side that shows
  if ( ! ( dot( normal, normal ) > 0.5 ) ) normal = prtFace;`;

const include = (name) => `#include <${name}>`;

/** What both have: `vertex` and `fragment` before main, `lights` behind three's own. */
function addLight(shader, { vertex, fragment, lights }) {
  const add = (stage, name, text) => (shader[stage] = replaced(shader[stage], include(name), text));
  const addFragment = (name, text) => add("fragmentShader", name, text);
  add("vertexShader", "common", `${include("common")}\n${vertex}\n${transferVertex}`);
  add("vertexShader", "project_vertex", `${include("project_vertex")}\nprtLight( transformed );`);
  addFragment("common", `${include("common")}\n${fragment}\nuniform vec3 prtStrength;\ncentroid in vec3 prtPlace;`);
  addFragment("shadowmap_pars_fragment", `${include("shadowmap_pars_fragment")}\n#ifdef PRT_SUNS\n${sunLight}\n#endif`);
  addFragment("normal_fragment_begin", `${include("normal_fragment_begin")}${FACE_NORMAL}`);
  addFragment("lights_fragment_begin", `${LIGHTS}${NO_IRRADIANCE}`);
  addFragment("lights_fragment_maps", `${include("lights_fragment_maps")}${lights}${TRANSFER}`);
}

/** Adds transfer to the shaders of MeshStandardMaterial, MeshPhysicalMaterial or MeshLambertMaterial with these defines. */
export function addTransfer(shader, { PRT_INSTANCES }) {
  addLight(shader, {
    vertex: `#ifndef PRT_LIGHTMAP\n${PRT_INSTANCES ? instanceRadiance : exitRadiance}\n#endif`,
    fragment: `#ifndef PRT_LIGHTMAP\nin vec3 prtRadiance;\n#endif${OCCLUDERS}`,
    lights: "",
  });
  shader.fragmentShader = replaced(shader.fragmentShader, include("aomap_fragment"), OCCLUSION);
}

// Axes of lobes turn as normals do: with all that moves a vertex. `skinMatrix` is three's.
const LOBE_TURN = `
  mat3 prtMoved = mat3( modelMatrix );
#ifdef USE_INSTANCING
  prtMoved = prtMoved * mat3( instanceMatrix );
#endif
#ifdef USE_SKINNING
  prtMoved = prtMoved * mat3( skinMatrix );
#endif
#ifdef PRT_VOLUME
  prtRadiance = prtLobeRadiance( prt_lobe_turn( mat3( prtToVolume ) * prtMoved ), prtVolumePlace );
#else
  prtRadiance = prtLobeRadiance( prt_lobe_turn( prtMoved ), vec3( 0.0 ) );
#endif`;

const PROFILES = `
uniform highp sampler2D prt_lobe_profiles;
#define PRT_LOBE_PROFILE(i) texelFetch( prt_lobe_profiles, ivec2( i, 0 ), 0 )`;

const LIT_AT_VERTICES = "in vec3 prtRadiance;";

/** Behind the place of the vertex. */
function turnLobes(shader) {
  shader.vertexShader = replaced(shader.vertexShader, "prtLight( transformed );", `prtLight( transformed );${LOBE_TURN}`);
}

/** Adds transfer that turns with a skin to them. */
export function addLobes(shader) {
  addLight(shader, { vertex: `${PROFILES}\n${lobes}`, fragment: LIT_AT_VERTICES, lights: "" });
  turnLobes(shader);
  shader.fragmentShader = replaced(shader.fragmentShader, include("aomap_fragment"), OCCLUSION);
}

/** Adds the light of a volume to them, by lobes where they have some. Occlusion of its own is what a thing that moves has in textures: it stays. */
export function addVolume(shader, { PRT_LOBES }) {
  const [vertex, fragment] = PRT_LOBES ? [`${VOLUME}\n${PROFILES}\n${lobes}`, LIT_AT_VERTICES] : ["", ""];
  addLight(shader, { vertex, fragment: `${VOLUME}\n${volumeLight}\n${fragment}`, lights: INCIDENT });
  if (PRT_LOBES) turnLobes(shader);
}
