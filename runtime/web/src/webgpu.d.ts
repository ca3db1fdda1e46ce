// For WebGPURenderer: exports of PrtkitLoader.d.ts, with a plug-in that creates node materials.
export * from "./PrtkitLoader.js";
export { PrtkitPlugin } from "./PrtkitLoader.js";
