// Warns on the console of lights of a user's scene that do not light baked meshes.

const silent = new WeakSet(); // lights that were reported, or baked

/** Excludes the lights that the loader created from a file with transfer: they are lamps of the bake. */
export function noteLightsOfFile(root) {
  root.traverse((object) => object.isLight && silent.add(object));
}

/** Returns the reason why `light` does not light baked meshes like other meshes, or null. `suns`: see setSky. */
export function whyUnused(light, suns) {
  if (!light.isDirectionalLight) return "does not light baked meshes: only the sky, suns and baked lamps do";
  if (!suns) return "does not light baked meshes: pass it in setSky(light, scene, { suns: [...] })";
  if (Array.isArray(suns) && !suns.includes(light)) return "lights baked meshes without bounces: also pass it in suns of setSky";
  return null;
}

/** Warns once of each such light of `scene`. */
export function warnOfUnusedLights(scene, suns) {
  scene.traverseVisible((light) => {
    if (!light.isLight || !(light.intensity > 0) || silent.has(light)) return;
    const reason = whyUnused(light, suns);
    if (reason === null) return;
    silent.add(light);
    console.warn(`prtkit: ${light.type} "${light.name || light.uuid}" ${reason}`);
  });
}
