// Materials as GLTFLoader makes them, lit by transfer, and by suns that are apart from it.

import { DoubleSide, MeshLambertMaterial, Vector3, Vector4 } from "three";
import { addLobes, addTransfer, addVolume, PACKED_SHADOW_MAPS } from "./transferShader.js";

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

/** What has no shading of its own, an unlit material, is matte. */
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

/** Gives `material` its light, and its clones theirs: three copies neither defines nor what is done before compiling. What the
 * source of one that moves does then, is done. */
function light(material, transfer) {
  const { uniforms, defines, traits, lightMap, model, source } = transfer;
  material.defines = { ...material.defines, ...defines };
  if (traits?.lit) material.defines.PRT_SUNS = 1;
  if (PACKED_SHADOW_MAPS) material.defines.PRT_PACKED_SHADOW_MAPS = 1;
  // Radiance of what has albedo 1; three has irradiance in light maps.
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
 * `source`, the material that GLTFLoader made, as one of its own, lit by `transfer`: `uniforms` of the model, and the strength
 * of what shines; `defines` of the geometry's attributes; `lightMap`, where texels have the transfer; `traits` of sunTraits,
 * null where the model keeps no direct light apart; `model`: whose light it is.
 */
export function relitMaterial(source, transfer) {
  return light(source.isMeshStandardMaterial ? source.clone() : matte(source), { ...transfer, own: source });
}

/** Whether a volume can light a material: what three has no light for stays what it is. Throws for what it cannot. */
function takesVolume({ isMeshStandardMaterial, isMeshLambertMaterial, isMeshPhongMaterial, isMeshToonMaterial, lights, type }) {
  if (isMeshStandardMaterial || isMeshLambertMaterial) return true;
  if (isMeshPhongMaterial || isMeshToonMaterial || lights === true)
    throw new Error(`prtkit: a volume lights MeshStandardMaterial, MeshPhysicalMaterial and MeshLambertMaterial, not ${type}`);
  return false;
}

/** What of a volume lights a material of what moves: as the transfer of relitMaterial. */
export function transferOfVolume(source, volume) {
  const traits = { lit: true, transmission: new Vector4(1, 1, 1, 0) };
  const uniforms = { ...volume.uniforms, prtStrength: { value: new Vector3(1, 1, 1) } };
  return { uniforms, defines: volume.defines, traits, model: volume, source };
}

/** The same of what has lobes, which `lobes`, a transfer of it, has. */
const turning = (transfer, { uniforms: { prt_lobe_profiles }, defines: { PRT_LOBES } }) => ({
  ...transfer,
  uniforms: { ...transfer.uniforms, prt_lobe_profiles },
  defines: { ...transfer.defines, PRT_LOBES },
});

/** A copy of `source` that `volume` lights, which stays what it is; itself where nothing is to be done. */
export function movingMaterial(source, volume, copied) {
  const transfer = source._transfer;
  const lobes = transfer?.defines.PRT_LOBES ? transfer : null;
  if (transfer && ((!transfer.source && !lobes) || transfer.model === volume)) return source; // baked, or lit by it
  const own = transfer?.source ?? transfer?.own ?? source;
  if (!takesVolume(own)) return source;
  const lit = transferOfVolume(own, volume);
  return copied(own, lobes ? turning(lit, lobes) : lit);
}

/** `source` lit by the transfer of a volume, by WebGLRenderer; its own shader is kept. */
export const copiedMaterial = (source, transfer) => light(source.clone(), transfer);
