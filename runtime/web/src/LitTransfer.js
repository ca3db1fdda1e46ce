// Lights the compressed transfer of one file by a sky, separate suns and lamps.

import { Vector3 } from "three";
import { lightColumns } from "./clusteredPca.js";
import { checkSunLights, sunsOf } from "./directionalSuns.js";
import { lightOfSuns } from "./lightFile.js";
import { shownBy, rotationForModel, rotationIntoModel } from "./rotations.js";
import { warnOfUnusedLights } from "./unusedLights.js";

/** Base class; derived classes implement `update(sky, suns)`, with coefficients in the space of the bake. */
export class LitTransfer {
  /** `clusters`: see clustersOf; `root`: the scene of the file, whose world rotation `setSky` uses. */
  constructor(clusters, root = null) {
    this.root = root;
    this.clusters = clusters;
    this.order = clusters.order;
    this.channels = Math.max(...clusters.terms.map((term) => term.channels));
    this.hasDirectTerm = clusters.terms[0].kind === "direct";
    /** Names of the lamps that can be dimmed. */
    this.lamps = clusters.terms.filter(({ kind }) => kind === "lamp").map(({ name }) => name);
    /** Strength of each lamp, as uniforms of emissive materials. */
    this.strengths = new Map(this.lamps.map((name) => [name, { value: new Vector3() }]));
    this.setStrengths({});
    this.sky = null; // see setSky
    this.suns = null; // see setLight and setSky
    this.areLightsChecked = true; // no light is set yet
  }

  /**
   * Lights by `light` rotated about +Y by `angle` radians. `suns`: the light of the suns that three's
   * directional lights add with their shadows; here they light only after a bounce. Without a separate direct
   * term they are fully included here, and three's lights add nothing. `lamps`: strengths by name, numbers or
   * [red, green, blue]; other lamps keep the strength of the scene.
   */
  setLight(light, angle = 0, suns = null, lamps = {}) {
    if (Array.isArray(suns)) throw new Error("prtkit: setLight takes the result of lightOfSuns as suns; only setSky takes an array of lights");
    this.checkOrders(light, suns);
    this.setStrengths(lamps);
    this.sky = null;
    this.suns = suns;
    this.areLightsChecked = false;
    this.update(light.coefficients(angle), suns ? suns.coefficients(angle) : null);
  }

  /**
   * Lights by `light` as `scene` shows it, in every frame: rotated by its environmentRotation, times its
   * environmentIntensity, or those of the background if it has no environment; and relative to the rotation
   * of the model. `suns`: see setLight, or an array of DirectionalLights of `scene`, read in every frame.
   * `lamps`: see setLight.
   */
  setSky(light, scene, { suns = null, lamps = {} } = {}) {
    this.checkOrders(light, suns);
    this.setStrengths(lamps);
    this.sky = { light, scene, suns, shown: "" };
    this.suns = suns;
    this.areLightsChecked = false;
    this.followSky();
  }

  /** Computes the light again if the display of the sky has changed. */
  followSky() {
    if (!this.sky) return;
    const { light, scene, suns, shown } = this.sky;
    const { euler, strength } = shownBy(scene);
    const own = Array.isArray(suns) ? sunsOf(suns, scene) : null;
    const ownValues = (own ?? []).flatMap(({ towards, irradiance }) => [...towards, ...irradiance]);
    const now = [euler.x, euler.y, euler.z, euler.order, strength, ...this.root.matrixWorld.elements.slice(0, 11), ...ownValues].join();
    if (now === shown) return;
    this.sky.shown = now;
    const rotation = rotationForModel(scene, this.root);
    const seen = (source) => source.rotated(rotation).times(strength).coefficients();
    const ownLight = own && lightOfSuns(own, this.order).rotated(rotationIntoModel(this.root)).coefficients();
    this.update(seen(light), ownLight ?? (suns ? seen(suns) : null));
  }

  /** Warns on the console of lights in the drawn `scene` that do not light this; once after each change of light. */
  checkLights(scene) {
    if (this.areLightsChecked || !scene) return;
    this.areLightsChecked = true;
    warnOfUnusedLights(scene, this.suns);
  }

  checkOrders(light, suns) {
    if (Array.isArray(suns)) checkSunLights(suns);
    for (const { order } of suns && !Array.isArray(suns) ? [light, suns] : [light])
      if (order < this.order) throw new RangeError(`the light has order ${order}, the model needs ${this.order}`);
  }

  /** Returns the colours that multiply the terms; see lightColumns. */
  columns(sky, suns) {
    return lightColumns(this.clusters, sky, suns, this.lampStrengths());
  }

  /** Returns the strengths of all lamps, [lamps][3]. */
  lampStrengths() {
    return [...this.strengths.values()].flatMap(({ value }) => value.toArray());
  }

  /** Returns the factor on the emission of a material of this name. */
  strengthOf(material) {
    const lamp = this.clusters.terms.find(({ kind, name, members = [name] }) => kind === "lamp" && members.includes(material));
    return lamp ? this.strengths.get(lamp.name) : { value: new Vector3(1, 1, 1) };
  }

  /** Returns the entries of `lamps` that exist here. */
  knownOf(lamps) {
    return Object.fromEntries(Object.entries(lamps).filter(([name]) => this.strengths.has(name)));
  }

  setStrengths(lamps) {
    const given = Object.entries(lamps).map(([name, strength]) => [
      name,
      typeof strength === "number" ? [strength, strength, strength] : strength,
    ]);
    for (const [name, strength] of given) {
      if (!this.strengths.has(name)) throw new RangeError(`there is no lamp "${name}"`);
      if (strength?.length !== 3 || ![...strength].every((value) => value >= 0 && value < Infinity))
        throw new RangeError(`the strength of lamp "${name}" is not one or three numbers of at least zero`);
    }
    for (const { value } of this.strengths.values()) value.set(1, 1, 1);
    for (const [name, strength] of given) this.strengths.get(name).value.set(...strength);
  }
}
