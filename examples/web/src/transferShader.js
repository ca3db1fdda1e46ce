// What transfer adds to the shaders of three's lit materials, as `onBeforeCompile` is given them: exit radiance in the place of
// the diffuse light that three would find around, and suns that are apart. All else is three's: specular reflection, normal
// maps, coats, shadows, fog, tone mapping.

import { ShaderChunk } from "three";
import exitRadiance from "./prt_exit_radiance.glsl.js";
import sunLight from "./sunLight.glsl.js";
import sunLoop from "./sunLoop.glsl.js";
import transferVertex from "./transferVertex.glsl.js";

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

// With an environment the transfer is what three calls the irradiance of it, and shares energy with the specular reflection as
// that does. Without, nothing is reflected but diffusely, and rough metals as bounces have them (docs/math.md, section 6).
const TRANSFER = `
#ifdef PRT_LIGHTMAP
  vec3 prtRadiance = RECIPROCAL_PI * irradiance; // of three's light map, which is the transfer's
  irradiance = vec3( 0.0 );
#endif
  vec3 prtDiffuse = max( prtRadiance, vec3( 0.0 ) );
#if defined( STANDARD ) && defined( USE_ENVMAP )
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

/** Adds transfer to the shaders of MeshStandardMaterial, MeshPhysicalMaterial or MeshLambertMaterial. */
export function addTransfer(shader) {
  const chunk = (name) => `#include <${name}>`;
  const vertex = (name, text) => (shader.vertexShader = replaced(shader.vertexShader, chunk(name), text));
  const fragment = (name, text) => (shader.fragmentShader = replaced(shader.fragmentShader, chunk(name), text));
  vertex("common", `${chunk("common")}\n#ifndef PRT_LIGHTMAP\n${exitRadiance}\n#endif\n${transferVertex}`);
  vertex("project_vertex", `${chunk("project_vertex")}\nprtLight( transformed );`);
  fragment("common", `${chunk("common")}\n#ifndef PRT_LIGHTMAP\nin vec3 prtRadiance;\n#endif\nuniform vec3 prtStrength;`);
  fragment("shadowmap_pars_fragment", `${chunk("shadowmap_pars_fragment")}\n#ifdef PRT_SUNS\n${sunLight}\n#endif`);
  fragment("normal_fragment_begin", `${chunk("normal_fragment_begin")}${FACE_NORMAL}`);
  fragment("lights_fragment_begin", `${LIGHTS}${NO_IRRADIANCE}`);
  fragment("lights_fragment_maps", `${chunk("lights_fragment_maps")}${TRANSFER}`);
  fragment("aomap_fragment", OCCLUSION);
}
