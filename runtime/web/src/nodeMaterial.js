// Materials of WebGPURenderer lit by transfer, like those of relitMaterial.js for WebGLRenderer.
// transferShader.js describes the use of transfer; separate suns use three's shadows here.

import {
  clearcoatNormalView,
  clearcoatRoughness,
  diffuseColor,
  materialEmissive,
  materialLightMap,
  materialRoughness,
  metalness,
  normalFlat,
  normalView,
  property,
  roughness,
  uniform,
  vec3,
} from "three/tsl";
import { DoubleSide, LightingNode, MeshLambertNodeMaterial, MeshPhysicalNodeMaterial, MeshStandardNodeMaterial, NodeMaterial, Vector3, Vector4 } from "three/webgpu";
import { radianceOfVertices } from "./radianceNodes.js";
import { matte } from "./relitMaterial.js";
import { lightOfVolume } from "./volumeNodes.js";

// Uniforms of the material being drawn.
const strength = uniform(new Vector3()).onObjectUpdate(({ material }) => material._transfer.uniforms.prtStrength.value);
const separateSuns = uniform(0).onObjectUpdate(({ material }) => Number(material._transfer.uniforms.prtSeparateSuns.value));
const transmission = uniform(new Vector4()).onObjectUpdate(({ material }) => material._transfer.traits.transmission);
const emission = materialEmissive.mul(strength); // one node for all, so that they share programs
const baseColor = property("vec3", "prtBaseColor");

/** Updates the model's light before an object with it is drawn. */
class LightNode extends LightingNode {
  constructor(model) {
    super();
    this.model = model;
    this.updateBeforeType = "render";
  }

  updateBefore({ renderer, scene }) {
    this.model.beforeRender(renderer, scene);
  }

  setup() {}
}

/** Adds separate suns, also through thin sheets: see sunLoop.glsl. */
function sunLight(lighting, thin) {
  const { direct } = lighting;
  return (data, builder) => {
    const { lightDirection, reflectedLight } = data;
    const cosine = normalView.dot(lightDirection);
    const arrives = cosine.mul(normalFlat.dot(lightDirection)).greaterThan(0).select(separateSuns, 0);
    const lightColor = data.lightColor.mul(arrives).toVar();
    if (!thin) return direct.call(lighting, { ...data, lightColor }, builder);
    const directDiffuse = vec3(0).toVar();
    direct.call(lighting, { ...data, lightColor, reflectedLight: { ...reflectedLight, directDiffuse } }, builder);
    const behind = cosine.negate().max(0).mul(transmission.a).div(Math.PI);
    reflectedLight.directDiffuse.addAssign(directDiffuse.mul(transmission.a.oneMinus()).add(lightColor.mul(transmission.rgb).mul(behind)));
  };
}

/**
 * Changes the sums of three's lighting model for moving objects: the light of a volume is the diffuse light
 * and the mirrored light, as in transferShader.js.
 */
function moving(lighting, { volume, reflects }) {
  lighting.direct = sunLight(lighting, false);
  if (lighting.indirectSpecular === undefined) {
    lighting.indirect = ({ context: { reflectedLight } }) =>
      reflectedLight.indirectDiffuse.addAssign(lightOfVolume(volume).irradianceOverPi(normalView).mul(diffuseColor.rgb));
    return lighting;
  }
  const { indirectDiffuse } = lighting;
  lighting.indirectDiffuse = (builder) => {
    indirectDiffuse.call(lighting, builder);
    const { irradianceOverPi, mirrored } = lightOfVolume(volume);
    const { iblIrradiance, radiance } = builder.context;
    iblIrradiance.assign(irradianceOverPi(normalView).mul(Math.PI));
    radiance.assign(mirrored(normalView, roughness, reflects ? radiance : null));
    const { clearcoatRadiance } = lighting;
    if (clearcoatRadiance)
      clearcoatRadiance.assign(mirrored(clearcoatNormalView, clearcoatRoughness, reflects ? clearcoatRadiance : null));
  };
  return lighting;
}

/** Changes the sums of three's lighting model: `radiance` of the transfer is the diffuse ambient light. */
function relit(lighting, { radiance, reflects, thin }) {
  const diffuse = radiance.max(0);
  if (lighting.indirectSpecular === undefined)
    lighting.indirect = ({ context: { irradiance, reflectedLight } }) =>
      reflectedLight.indirectDiffuse.addAssign(irradiance.div(Math.PI).add(diffuse).mul(diffuseColor.rgb));
  else {
    const { indirectDiffuse, ambientOcclusion } = lighting;
    lighting.indirectDiffuse = (builder) => {
      indirectDiffuse.call(lighting, builder);
      const { iblIrradiance, reflectedLight } = builder.context;
      const scattered = metalness.mul(materialRoughness.mul(materialRoughness).oneMinus()).oneMinus();
      if (reflects) iblIrradiance.assign(diffuse.mul(Math.PI));
      else reflectedLight.indirectDiffuse.addAssign(diffuse.mul(baseColor).mul(scattered));
    };
    // Occlusion of the surroundings is in the transfer.
    lighting.ambientOcclusion = (builder) => {
      const reflectedLight = { ...builder.context.reflectedLight, indirectDiffuse: vec3(0).toVar() };
      ambientOcclusion.call(lighting, { ...builder, context: { ...builder.context, reflectedLight } });
    };
  }
  lighting.direct = sunLight(lighting, thin);
  return lighting;
}

/**
 * Copies the properties of `source`, as three does for node materials; colours and vectors are copied by
 * value.
 */
function take(material, source) {
  for (const [key, value] of Object.entries(source)) {
    if (["uuid", "type", "version", "_transfer"].includes(key) || value?.isNode) continue;
    const isValue = value?.isColor || value?.isVector2 || value?.isVector3 || value?.isEuler || value?.isMatrix3;
    material[key] = isValue ? value.clone() : value;
  }
}

const lit = (Base) =>
  class extends Base {
    /** `transfer`: see relitMaterial. */
    light(transfer) {
      this._transfer = transfer;
      this.shadowSide = DoubleSide; // every triangle blocks from both sides
      if (transfer.lightMap) Object.assign(this, { lightMap: transfer.lightMap, lightMapIntensity: Math.PI });
      this.emissiveNode = emission;
      return this;
    }

    get isMapped() {
      return Boolean(this._transfer.lightMap);
    }

    /**
     * Returns a key of the node graph, shared by all materials of a model with equal attributes, coordinates
     * and suns.
     */
    customProgramCacheKey() {
      const { model, defines, traits, lightMap } = this._transfer;
      const key = [(model.constantsTexture ?? model.texture).id, JSON.stringify(defines), traits?.lit, traits?.transmission.w > 0, lightMap?.channel];
      return `${super.customProgramCacheKey()}:prtkit:${key.join(":")}`;
    }

    setupEnvironment(builder) {
      const node = super.setupEnvironment(builder);
      this._reflects = node !== null;
      return node;
    }

    setupLightMap(builder) {
      return this.isMapped ? null : super.setupLightMap(builder);
    }

    /** Omits three's lights except suns: other light is in the sky, or in lamps of the transfer. */
    setupLighting(builder) {
      const { lightsNode } = this;
      const { model, traits } = this._transfer;
      const suns = traits?.lit ? (lightsNode ?? builder.lightsNode).getLights().filter(({ isDirectionalLight }) => isDirectionalLight) : [];
      this.lightsNode = builder.renderer.lighting.createNode([...suns, new LightNode(model)]);
      try {
        return super.setupLighting(builder);
      } finally {
        this.lightsNode = lightsNode;
      }
    }

    setupVariants(builder) {
      baseColor.assign(diffuseColor.rgb);
      return super.setupVariants(builder);
    }

    setupLightingModel(builder) {
      const { model, defines, traits, source } = this._transfer;
      if (source) return moving(super.setupLightingModel(builder), { volume: model, reflects: this._reflects });
      if (builder.renderer.backend.isWebGPUBackend && defines.PRT_WEIGHT_VECTORS > 5)
        throw new Error("prtkit: WebGPU does not support this many weights per vertex: run prt compress with fewer --components, or with packed weights (--bits N)");
      return relit(super.setupLightingModel(builder), {
        radiance: this.isMapped ? materialLightMap.div(Math.PI) : radianceOfVertices(model, defines),
        reflects: this._reflects,
        thin: traits?.transmission.w > 0,
      });
    }

    copy(source) {
      super.copy(source);
      take(this, source);
      return this.light(source._transfer);
    }
  };

const LitPhysical = lit(MeshPhysicalNodeMaterial);
const LitStandard = lit(MeshStandardNodeMaterial);
const LitLambert = lit(MeshLambertNodeMaterial);

/** Returns a relit material for WebGPURenderer; see relitMaterial. */
export function nodeMaterial(source, transfer) {
  const Material = source.isMeshPhysicalMaterial ? LitPhysical : source.isMeshStandardMaterial ? LitStandard : LitLambert;
  const material = new Material();
  if (source.isNodeMaterial) NodeMaterial.prototype.copy.call(material, source); // with its own nodes
  take(material, source.isMeshStandardMaterial || transfer.source ? source : matte(source));
  return material.light(transfer);
}
