// Projects a sky outside the main thread, which a large sky would block for a second.

import { HalfFloatType } from "three";
import { projectEquirectangular, texels } from "./equirectangular.js";
import { MAX_ORDER, ShLight } from "./sphericalHarmonics.js";

/**
 * Returns a promise of the result of projectEquirectangular, computed by a separate worker on a copy of the
 * texels; without workers, as in node, in the calling thread. Rejects with the errors of
 * projectEquirectangular, and with an Error if the worker does not start.
 */
export async function projectInWorker(texture, order = MAX_ORDER, { center = "x" } = {}) {
  if (typeof Worker === "undefined") return projectEquirectangular(texture, order, { center });
  const { value: _value, ...image } = texels(texture);
  const worker = new Worker(new URL("./projectionWorker.js", import.meta.url), { type: "module" });
  try {
    const answer = await new Promise((resolve, reject) => {
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = () => reject(new Error("prtkit: projectionWorker.js does not start; is it served from the folder of the plug-in?"));
      worker.postMessage({ image: { ...image, center, half: texture.type === HalfFloatType }, order });
    });
    if (answer.error) throw new RangeError(answer.error);
    return new ShLight(answer.order, answer.polar);
  } finally {
    worker.terminate();
  }
}
