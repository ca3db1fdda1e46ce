// Directional lights of a user's own scene as suns.

import { Vector3 } from "three";

/** True if three uses `light`: the light and all its ancestors up to `scene` are visible. */
function isIn(scene, light) {
  for (let at = light; at?.visible; at = at.parent) if (at === scene) return true;
  return false;
}

/** Throws an Error unless all of `lights` are DirectionalLights. */
export function checkSunLights(lights) {
  for (const light of lights)
    if (!light?.isDirectionalLight)
      throw new Error(`prtkit: suns must be an array of DirectionalLights or the result of lightOfSuns; it contains ${light?.type ?? typeof light}`);
}

/** Returns `lights` as suns for lightOfSuns, in world directions; omits lights that three does not use. */
export function sunsOf(lights, scene) {
  return lights
    .filter((light) => isIn(scene, light))
    .map((light) => {
      light.updateWorldMatrix(true, false);
      light.target.updateWorldMatrix(true, false);
      const towards = new Vector3().setFromMatrixPosition(light.matrixWorld);
      towards.sub(new Vector3().setFromMatrixPosition(light.target.matrixWorld)).normalize();
      return { towards: towards.toArray(), irradiance: light.color.toArray().map((value) => value * light.intensity), halfAngle: 0 };
    });
}
