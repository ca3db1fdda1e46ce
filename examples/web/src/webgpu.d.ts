// Of WebGPURenderer: all that PrtkitLoader.d.ts has, with a plug-in whose materials are nodes.
export * from "./PrtkitLoader.js";
export { PrtkitPlugin } from "./PrtkitLoader.js";
