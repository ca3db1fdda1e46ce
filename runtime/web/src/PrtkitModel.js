// The compressed transfer of one file, shared by its meshes, and its light.

import { updateConstants, shaderRows } from "./clusteredPca.js";
import { LitSurfaces } from "./LitSurfaces.js";
import { clustersTextureOf, constantsTextureOf } from "./tables.js";

export class PrtkitModel extends LitSurfaces {
  /** `clusters`: see clustersOf; `root`: the scene of the file, whose world rotation `setSky` uses. */
  constructor(clusters, root = null) {
    super(clusters, root);
    this.rows = shaderRows(this.clusters);
    this.constantsTexture = constantsTextureOf(this.clusters.rowCount);
    this.clustersTexture = clustersTextureOf(this.clusters);
    this.uniforms = {
      prt_constants: { value: this.constantsTexture },
      prt_clusters: { value: this.clustersTexture },
      prtSeparateSuns: { value: false },
    };
    this.vertices = 0;
    this.bytesPerVertex = 0;
    this.texels = 0;
    this.bytesPerTexel = 0;
    this.maps = null; // RelitMaps, if texels have the transfer
    this.instances = null; // PrtkitInstances, if instances share the transfer of their mesh
    this.occluders = null; // PrtkitOccluders
    this.occludedAt = -1; // frame
    this.occluderUniforms = {
      prt_occluder_texture: { value: null },
      prtOccluderRows: { value: [] },
      prtOccluderCount: { value: 0 },
      prtOccluderReach: { value: null },
    };
    this.canOcclude = true; // WebGLRenderer only
    this.beforeRender = (renderer, scene, camera, geometry, object) => {
      this.instances?.checkSize(renderer);
      this.followSky();
      this.checkLights(scene);
      this.followOccluders(renderer, object);
      this.maps?.update(renderer, this.constantsTexture.version);
    };
  }

  /** Sets the occluders near the surfaces: PrtkitOccluders, or null. */
  setOccluders(occluders) {
    if (!this.canOcclude) throw new Error("prtkit: WebGPURenderer does not support occluders");
    this.occluders = occluders;
    this.occludedAt = -1;
  }

  /** Adds occluders to the shaders only while some exist. */
  followOccluders(renderer, object) {
    const { occluders } = this;
    for (const material of object ? [object.material].flat() : []) {
      if (material._transfer?.model !== this || Boolean(occluders) === Boolean(material.defines?.PRT_OCCLUDERS)) continue;
      if (occluders) material.defines.PRT_OCCLUDERS = 1;
      else delete material.defines.PRT_OCCLUDERS;
      material.needsUpdate = true;
    }
    if (!occluders || renderer.info.render.frame === this.occludedAt) return;
    this.occludedAt = renderer.info.render.frame;
    occluders.update();
    const { prt_occluder_texture: texture, prtOccluderRows: rows, prtOccluderCount: count, prtOccluderReach: reach } = this.occluderUniforms;
    [texture.value, rows.value, count.value, reach.value] = [occluders.texture, occluders.rows, occluders.count, occluders.reach];
  }

  /** Computes the constants of all clusters from coefficients in the space of the bake. */
  update(sky, suns) {
    updateConstants(this.clusters, this.rows, this.columns(sky, suns), this.constantsTexture.image.data);
    this.constantsTexture.needsUpdate = true;
    this.instances?.update(sky, suns, this.lampStrengths());
    this.uniforms.prtSeparateSuns.value = suns !== null && this.hasDirectTerm;
  }

  /** Frees the tables. Materials and geometries are disposed of as three's are. */
  dispose() {
    this.sky = null;
    for (const other of this.others()) other.dispose();
    this.maps?.dispose();
    this.instances?.dispose();
    this.constantsTexture.dispose();
    this.clustersTexture.dispose();
  }
}
