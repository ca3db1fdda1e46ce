// The plug-in for WebGPURenderer, with all other exports of PrtkitLoader.js.
//
//   import { PrtkitPlugin } from "prtkit-web/webgpu";
//   const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));

import { nodeMaterial } from "./nodeMaterial.js";
import { NodeTexelPass } from "./nodeTexelPass.js";
import { PrtkitPlugin as ForWebGL } from "./PrtkitLoader.js";

export * from "./PrtkitLoader.js";

/** For `GLTFLoader.register`; creates node materials. */
export class PrtkitPlugin extends ForWebGL {
  constructor(parser) {
    super(parser);
    this.canOcclude = false;
    this.canShare = false;
  }

  passOf(model, { PRT_CLUSTER_BITS: clusterBits }) {
    return new NodeTexelPass(model, clusterBits);
  }

  materialOf(source, transfer) {
    return nodeMaterial(source, transfer);
  }

  copiedMaterial(source, transfer) {
    return nodeMaterial(source, transfer);
  }

  checkRenderer(renderer) {
    if (renderer.isWebGLRenderer) throw new Error("prtkit: WebGLRenderer needs PrtkitPlugin of prtkit-web");
  }
}
