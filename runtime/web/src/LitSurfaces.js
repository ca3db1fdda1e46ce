// Transfer of the surfaces of one file; its volume gets the same light.

import { LitTransfer } from "./LitTransfer.js";

export class LitSurfaces extends LitTransfer {
  constructor(clusters, root) {
    super(clusters, root);
    this.volume = null; // PrtkitVolume, if the file also has probes
  }

  setLight(light, angle = 0, suns = null, lamps = {}) {
    this.volume?.checkOrders(light, suns);
    super.setLight(light, angle, suns, lamps);
    this.volume?.setLight(light, angle, suns, this.volume.knownOf(lamps));
  }

  setSky(light, scene, { suns = null, lamps = {} } = {}) {
    this.volume?.checkOrders(light, suns);
    super.setSky(light, scene, { suns, lamps });
    this.volume?.setSky(light, scene, { suns, lamps: this.volume.knownOf(lamps) });
  }
}
