// Materials of GLTFLoader, lit by transfer and by separate suns.

import { DoubleSide, MeshLambertMaterial, Vector3, Vector4 } from "three";
import { addLobes, addTransfer, addVolume, PACKED_SHADOW_MAPS } from "./transferShader.js";

/**
 * Returns the treatment of suns by a material of the glTF: { lit, transmission, casts }. A medium has all of
 * its light from transfer (`isMedium`: a bake has added it); shadow maps store one depth, so that glass and blended surfaces cast no shadow.
 */
export function sunTraits(gltfMaterial, isMedium = false) {
  const extensions = gltfMaterial?.extensions ?? {};
  const through = extensions.KHR_materials_diffuse_transmission;
  const volume = extensions.KHR_materials_volume;
  const factor = through?.diffuseTransmissionFactor ?? 0;
  const medium = isMedium || (factor > 0 && volume?.thicknessFactor > 0 && volume.attenuationDistance > 0);
  const color = through?.diffuseTransmissionColorFactor ?? [1, 1, 1];
  const glass = (extensions.KHR_materials_transmission?.transmissionFactor ?? 0) > 0;
  return {
    lit: !medium,
    transmission: new Vector4(...color, Math.min(Math.max(factor, 0), 1)),
    casts: !glass && gltfMaterial?.alphaMode !== "BLEND",
  };
}

/** Returns a matte material for a material without shading (unlit). */
export function matte(source) {
  return new MeshLambertMaterial({
    name: source.name,
    color: source.color,
    map: source.map ?? null,
    alphaTest: source.alphaTest,
    transparent: source.transparent,
    opacity: source.opacity,
    side: source.side,
    vertexColors: source.vertexColors,
    depthWrite: source.depthWrite,
    reflectivity: 0, // no environment
    userData: source.userData,
  });
}

/**
 * Adds the light to `material` and its clones, because three copies neither defines nor the function before
 * compiling. Also calls the function of the source material of a moving object.
 */
function light(material, transfer) {
  const { uniforms, defines, traits, lightMap, model, source } = transfer;
  material.defines = { ...material.defines, ...defines };
  if (traits?.lit) material.defines.PRT_SUNS = 1;
  if (PACKED_SHADOW_MAPS) material.defines.PRT_PACKED_SHADOW_MAPS = 1;
  // Radiance for albedo 1; three's light maps contain irradiance.
  if (lightMap) Object.assign(material, { lightMap, lightMapIntensity: Math.PI });
  material.shadowSide = DoubleSide; // every triangle blocks from both sides
  material.onBeforeCompile = (shader, renderer) => {
    source?.onBeforeCompile.call(material, shader, renderer);
    Object.assign(shader.uniforms, uniforms);
    Object.assign(shader.uniforms, model.occluderUniforms);
    if (traits) shader.uniforms.prtTransmission = { value: traits.transmission };
    const baked = defines.PRT_LOBES ? addLobes : addTransfer;
    const add = source ? addVolume : baked;
    add(shader, material.defines);
  };
  const ownKey = source?.customProgramCacheKey() ?? "";
  material.customProgramCacheKey = () => `prtkit:${JSON.stringify(material.defines)}${ownKey}`;
  material.onBeforeRender = model.beforeRender;
  Object.defineProperty(material, "_transfer", { value: transfer });
  material.clone = () => light(Object.getPrototypeOf(material).clone.call(material), transfer);
  return material;
}

/**
 * Returns a copy of `source`, the material of GLTFLoader, lit by `transfer`: `uniforms` of the model, and the
 * strength of emission; `defines` of the geometry's attributes; `lightMap`, if texels have the transfer;
 * `traits` of sunTraits, null if the model has no separate direct term; `model`: the source of the light.
 */
export function relitMaterial(source, transfer) {
  return light(source.isMeshStandardMaterial ? source.clone() : matte(source), { ...transfer, own: source });
}

/**
 * True if a volume can light a material; materials that three does not light are unchanged. Throws for
 * unsupported materials.
 */
function takesVolume({ isMeshStandardMaterial, isMeshLambertMaterial, isMeshPhongMaterial, isMeshToonMaterial, lights, type }) {
  if (isMeshStandardMaterial || isMeshLambertMaterial) return true;
  if (isMeshPhongMaterial || isMeshToonMaterial || lights === true)
    throw new Error(`prtkit: a volume does not light ${type}; use MeshStandardMaterial, MeshPhysicalMaterial or MeshLambertMaterial`);
  return false;
}

/** Returns the transfer of relitMaterial for a moving object in a volume. */
export function transferOfVolume(source, volume) {
  const traits = { lit: true, transmission: new Vector4(1, 1, 1, 0) };
  const uniforms = { ...volume.uniforms, prtStrength: { value: new Vector3(1, 1, 1) } };
  return { uniforms, defines: volume.defines, traits, model: volume, source };
}

/** Returns the transfer of a moving object with the lobes of the transfer `lobes`. */
const withLobes = (transfer, { uniforms: { prt_lobe_profiles }, defines: { PRT_LOBES } }) => ({
  ...transfer,
  uniforms: { ...transfer.uniforms, prt_lobe_profiles },
  defines: { ...transfer.defines, PRT_LOBES },
});

/**
 * Returns a copy of `source` lit by `volume`, with all other properties unchanged; `source` itself if no
 * change is needed.
 */
export function movingMaterial(source, volume, copied) {
  const transfer = source._transfer;
  const lobes = transfer?.defines.PRT_LOBES ? transfer : null;
  if (transfer && ((!transfer.source && !lobes) || transfer.model === volume)) return source; // baked, or lit by it
  const own = transfer?.source ?? transfer?.own ?? source;
  if (!takesVolume(own)) return source;
  const lit = transferOfVolume(own, volume);
  return copied(own, lobes ? withLobes(lit, lobes) : lit);
}

/** Returns `source` lit by a volume, for WebGLRenderer; custom shader changes are kept. */
export const copiedMaterial = (source, transfer) => light(source.clone(), transfer);
