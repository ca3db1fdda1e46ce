// Base color, texture, cut-outs, blending and emission of a material, lit by transfer, and by suns that are apart from it.

import { DoubleSide, MeshLambertMaterial, ShaderChunk, Vector4 } from "three";
import exitRadiance from "./prt_exit_radiance.glsl.js";
import sunLight from "./sunLight.glsl.js";

// Three packed the depths of its shadow maps into colors until release 181.
const PACKED = ShaderChunk.shadowmap_pars_fragment.includes("unpackRGBAToDepth");

/**
 * How suns meet a material of the glTF: { lit, transmission, casts }. A medium has all of its light from transfer; shadow
 * maps hold one depth, so that glass and what is blended casts no shadow.
 */
export function sunTraits(gltfMaterial) {
  const extensions = gltfMaterial?.extensions ?? {};
  const through = extensions.KHR_materials_diffuse_transmission;
  const volume = extensions.KHR_materials_volume;
  const factor = through?.diffuseTransmissionFactor ?? 0;
  const medium = factor > 0 && volume?.thicknessFactor > 0 && volume.attenuationDistance > 0;
  const color = through?.diffuseTransmissionColorFactor ?? [1, 1, 1];
  const glass = (extensions.KHR_materials_transmission?.transmissionFactor ?? 0) > 0;
  return {
    lit: !medium,
    transmission: new Vector4(...color, Math.min(Math.max(factor, 0), 1)),
    casts: !glass && gltfMaterial?.alphaMode !== "BLEND",
  };
}

/**
 * `source`: the material that GLTFLoader made. `uniforms` of the model, and the strength of what shines; `defines` of the
 * geometry's attributes; `traits`: of sunTraits; null: the model keeps no direct light apart.
 */
export function relitMaterial(source, { uniforms, defines, traits }) {
  const material = new MeshLambertMaterial({
    name: source.name,
    color: source.color,
    map: source.map ?? null,
    emissive: source.emissive ?? 0x000000,
    emissiveMap: source.emissiveMap ?? null,
    emissiveIntensity: source.emissiveIntensity ?? 1,
    alphaTest: source.alphaTest,
    transparent: source.transparent,
    opacity: source.opacity,
    side: source.side,
    shadowSide: DoubleSide, // every triangle blocks from both sides
    vertexColors: source.vertexColors,
    depthWrite: source.depthWrite,
  });
  material.defines = { ...defines };
  if (traits?.lit) material.defines.PRT_SUNS = 1;
  if (PACKED) material.defines.PRT_PACKED_SHADOW_MAPS = 1;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    if (traits) shader.uniforms.prtTransmission = { value: traits.transmission };
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>\n${exitRadiance}\n${FRAME}\nout vec3 prtRadiance;\ncentroid out vec3 prtPlace;`)
      .replace("#include <begin_vertex>", `#include <begin_vertex>${LIT_VERTEX}`)
      // Places in shadow maps are found for each pixel.
      .replace("#include <shadowmap_vertex>", "");
    // In the place of all that three's lights would add: ambient light is in the sky.
    shader.fragmentShader = shader.fragmentShader
      .replace(
        "#include <lights_lambert_pars_fragment>",
        "varying vec3 vViewPosition;\nin vec3 prtRadiance;\nuniform vec3 prtStrength;",
      )
      .replace(
        "#include <shadowmap_pars_fragment>",
        `#include <shadowmap_pars_fragment>\n#ifdef PRT_SUNS\n${sunLight}\n#endif`,
      )
      .replace("#include <lights_lambert_fragment>", "")
      .replace("#include <lights_fragment_begin>", LIT)
      .replace("#include <lights_fragment_maps>", "")
      .replace("#include <lights_fragment_end>", "");
  };
  material.customProgramCacheKey = () => `prtkit:${JSON.stringify(material.defines)}`;
  return material;
}

// From the attributes of a mesh to the frame of the bake, in which guides are; the place is seen from their origin.
const FRAME = `
#if ! defined( PRT_GUIDE_NORMAL ) && ! defined( PRT_GUIDE_POSITION )
vec3 prtBakedPlace() { return vec3( 0.0 ); }
vec3 prtBakedNormal() { return vec3( 0.0 ); }
#elif defined( PRT_BAKED_ATTRIBUTES )
in vec3 prt_place, prt_normal;
vec3 prtBakedPlace() { return prt_place; }
vec3 prtBakedNormal() { return prt_normal; }
#else
uniform mat4 prtToBake;
uniform mat3 prtNormalToBake;
vec3 prtBakedPlace() { return ( prtToBake * vec4( position, 1.0 ) ).xyz; }
vec3 prtBakedNormal() {
  vec3 turned = prtNormalToBake * normal;
  float squared = dot( turned, turned );
  return squared > 0.0 ? turned * inversesqrt( squared ) : vec3( 0.0 );
}
#endif
`;

const LIT_VERTEX = `
  prtRadiance = prt_exit_radiance( prtBakedPlace(), prtBakedNormal() );
  prtPlace = ( modelMatrix * vec4( transformed, 1.0 ) ).xyz;`;

const LIT = `
  totalEmissiveRadiance *= prtStrength;
  reflectedLight.indirectDiffuse += max( prtRadiance, vec3( 0.0 ) ) * diffuseColor.rgb;
#if defined( PRT_SUNS ) && NUM_DIR_LIGHTS > 0
  if ( prtSunsApart ) reflectedLight.directDiffuse += prtSunRadiance( diffuseColor.rgb, normal );
#endif`;
