// Transfer of the surfaces of one file; its volume and its figure get the same light.

import { LitTransfer } from "./LitTransfer.js";

export class LitSurfaces extends LitTransfer {
  constructor(clusters, root) {
    super(clusters, root);
    this.volume = null; // PrtkitVolume, if the file also has probes
    this.figure = null; // PrtkitLobes, if the file also has lobes
  }

  setLight(light, angle = 0, suns = null, lamps = {}) {
    for (const other of this.others()) other.checkOrders(light, suns);
    super.setLight(light, angle, suns, lamps);
    for (const other of this.others()) other.setLight(light, angle, suns, other.knownOf(lamps));
  }

  setSky(light, scene, { suns = null, lamps = {} } = {}) {
    for (const other of this.others()) other.checkOrders(light, suns);
    super.setSky(light, scene, { suns, lamps });
    for (const other of this.others()) other.setSky(light, scene, { suns, lamps: other.knownOf(lamps) });
  }

  /** Returns what is lit together with the surfaces. */
  others() {
    return [this.volume, this.figure].filter(Boolean);
  }
}
