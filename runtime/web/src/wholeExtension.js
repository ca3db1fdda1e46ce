// Validates the JSON of PRTKIT_transfer and the other extensions before it is used (docs/format.md).

import { FACTORS } from "./instanceModes.js";

export const TRANSFER = "PRTKIT_transfer";
export const OCCLUDERS = "PRTKIT_occlusion_volume";
export const INSTANCES = "PRTKIT_instances";
export const LOBES = "PRTKIT_lobes";
/** Name of the set of these receivers in messages. */
export const nameOf = (receivers) => `${TRANSFER}: ${receivers}`;
export const [VERTICES, TEXELS, PROBES] = ["vertices", "texels", "probes"].map(nameOf);

/** Throws an Error with `what` unless `holds`. `name`: the extension with the error, or the set of PRTKIT_transfer. */
export function expect(holds, what, name = VERTICES) {
  if (!holds) throw new Error(`${name}: ${what}`);
}

/** Limit for scales of predictors, for float weights, and for the distance of a vertex from the world origin in metres. */
export const LARGEST_WEIGHT = 1e9;
/** Limit for values of bases. */
export const LARGEST_TRANSFER = 1e6;

const isObject = (v) => typeof v === "object" && v !== null && !Array.isArray(v);
const isWhole = (v, least, most) => Number.isInteger(v) && v >= least && v <= most;
const isView = (v) => isObject(v) && isWhole(v.bufferView, 0, 2 ** 31);
const areFloats = (v) => isView(v) && (v.componentType ?? 5126) === 5126;
const areDrops = (v) => Array.isArray(v) && v.every((drop) => isWhole(drop, 0, 15));
const areRows = (v) => isView(v) && areDrops(v.drops);

const LAYOUTS = [[], ["direct"], ["indirect"], ["combined"], ["direct", "indirect"]];

function areTerms(terms) {
  if (!Array.isArray(terms) || terms.length > 66) return false;
  if (!terms.every((term) => term?.channels === 1 || term?.channels === 3)) return false;
  const skies = terms.filter(({ kind }) => kind !== "lamp");
  const lamps = terms.slice(skies.length);
  const names = lamps.map(({ name }) => name);
  return (
    terms.length > 0 &&
    names.every((name) => typeof name === "string" && name !== "") &&
    new Set(names).size === names.length &&
    terms.every(({ members }) => members === undefined || (Array.isArray(members) && members.every((m) => typeof m === "string"))) &&
    lamps.every(({ kind }) => kind === "lamp") &&
    LAYOUTS.some((kinds) => kinds.length === skies.length && kinds.every((kind, i) => kind === skies[i].kind))
  );
}

const KINDS = ["normal", "position"];

const areThree = (v) => Array.isArray(v) && v.length === 3 && v.every((x) => Math.abs(x) <= LARGEST_WEIGHT && typeof x === "number");

/** True if predictors contain each kind at most once, normals first. */
function arePredictors(predictors) {
  if (!Array.isArray(predictors)) return false;
  const kinds = predictors.map((predictor) => KINDS.indexOf(predictor?.kind));
  return (
    kinds.every((kind, i) => kind >= 0 && (i === 0 || kind > kinds[i - 1])) &&
    predictors.every(
      ({ kind, scale, origin }) =>
        areThree(scale) && scale.every((s) => Math.fround(s) !== 0) && (kind === "normal" || areThree(origin)),
    )
  );
}

/** Throws unless there is one step for all axes, or one for each group of axes in each cluster. */
function checkSteps({ step, steps, values }, holds) {
  const least = steps === undefined ? step : steps?.least;
  holds(Number.isFinite(least) && least >= 0, "the step of the bases is not a number of at least 0");
  if (steps === undefined) return;
  holds(step === undefined, "the bases have both step and steps");
  const axes = Array.isArray(steps.axes) ? steps.axes : [];
  const total = axes.reduce((sum, count) => (isWhole(count, 0, 65536) ? sum + count : NaN), 0);
  holds(
    areRows(steps) && steps.drops.length === axes.length && total === values.drops.length,
    "the steps of the bases do not match their axes",
  );
}

function checkBases(bases, holds) {
  holds(isObject(bases), "bases are missing");
  if (bases.values === undefined) return holds(areFloats(bases), "the bases are not floats");
  holds(areRows(bases.values) && areRows(bases.axes), "the rows of the coded bases are invalid");
  holds(
    areFloats(bases.origin) && areFloats(bases.scales) && (bases.units === undefined || areFloats(bases.units)),
    "origin, scales or units of the coded bases are not floats",
  );
  checkSteps(bases, holds);
}

function checkPacking({ packing, components }, holds) {
  if (packing === undefined) return;
  holds(isView(packing) && isWhole(packing.clusterBits, 0, 16), "packing is invalid");
  holds(components.length <= 2 ** packing.clusterBits, "clusterBits cannot number all clusters");
  holds(components.every((m) => m <= 16), "a cluster has more than 16 packed components");
  const { words } = packing;
  if (words === undefined) return;
  const { frequencies } = words;
  holds(isView(words) && isWhole(words.vertices, 1, 2 ** 31 - 1), "the coded words are invalid");
  holds(isWhole(frequencies?.byteLength, 0, 2 ** 31 - 1) && areDrops(frequencies.drops), "the frequencies of the coded words are invalid");
}

function checkClusters({ components, predictors, centers, bases, packing }, holds) {
  holds(Array.isArray(components) && isWhole(components.length, 1, 65536), "components is not a list of 1 to 65536 numbers");
  holds(components.every((m) => isWhole(m, 0, 600)), "a cluster does not have 0 to 600 components");
  if (predictors !== undefined) {
    holds(arePredictors(predictors) && predictors.length > 0, "the predictors are invalid");
    holds(areRows(centers) && centers.drops.length === 3 * predictors.length, "the centers do not match the predictors");
  }
  checkBases(bases, holds);
  checkPacking({ packing, components }, holds);
}

/** Throws unless weights are packed, in words as they are, without predictors. */
function checkWords({ predictors, packing }, holds) {
  holds(predictors === undefined, "predictors are only for vertices");
  holds(packing !== undefined, "the weights are not packed");
  holds(packing.words === undefined, "coded words are only for vertices");
}

const LARGEST_MAP = 16384; // texels along a side: maximum size of textures

const isMap = (map) =>
  isObject(map) &&
  isWhole(map.width, 1, LARGEST_MAP) &&
  isWhole(map.height, 1, LARGEST_MAP) &&
  ["boolean", "undefined"].includes(typeof map.repeats) &&
  Array.isArray(map.images);

function checkTexels(set, holds, images) {
  checkWords(set, holds);
  const { maps } = set;
  holds(Array.isArray(maps) && maps.length > 0 && maps.every(isMap), "the maps are invalid");
  holds(isWhole(maps[0].images.length, 1, 8), "a texel does not have 1 to 8 words");
  for (const map of maps)
    holds(
      map.images.length === maps[0].images.length && map.images.every((image) => isWhole(image, 0, images - 1)),
      "an image of a map does not exist, or maps have different numbers of images",
    );
}

const areNumbers = (v) => Array.isArray(v) && v.length === 3 && v.every((x) => Number.isFinite(x) && Math.abs(x) < 1e30);

function checkProbes(set, holds) {
  checkWords(set, holds);
  const { incidentOrder, origin, spacing, size, bricks, visibility, words } = set;
  holds(isWhole(incidentOrder, 2, 4), "the order of incident light is not 2 to 4");
  holds(areNumbers(origin) && spacing > 0 && spacing < 1e18, "the spacing or the origin is invalid");
  holds(Array.isArray(size) && size.length === 3 && size.every((n) => isWhole(n, 1, 1024)), "the size is not 1 to 1024 bricks along each axis");
  holds([bricks, visibility, words].every(isView), "bricks, visibility or words are missing");
}

const CHECKS = new Map([["vertices", () => {}], ["texels", checkTexels], ["probes", checkProbes]]);

function checkSet(set, images) {
  const { receivers, coding, order, terms, bake } = set;
  const holds = (value, what) => expect(value, what, nameOf(receivers));
  holds(coding !== "raw", "the file is an uncompressed bake; compress it: prt compress baked.glb -o shipped.glb");
  holds(coding === "clustered", "the coding is neither raw nor clustered");
  holds(isWhole(order, 1, 10) && areTerms(terms), "order or terms are invalid");
  const media = bake?.media ?? [];
  holds(Array.isArray(media) && media.every((name) => typeof name === "string"), "the media of the bake are not a list of names");
  holds(terms.every(({ towards }) => towards === undefined), 'a lamp term has "towards", because older versions stored suns as lamps; bake the scene again');
  checkClusters(set, holds);
  CHECKS.get(receivers)(set, holds, images);
}

const VERSION = 6;
const FORMER = ["PRTKIT_clustered_pca", "PRTKIT_lightmap", "PRTKIT_transfer_volume"];

/** Returns the sets of PRTKIT_transfer in a glTF by their receivers: { vertices, texels, probes }, those that exist. */
export function setsOf({ extensions, images }) {
  const holds = (value, what) => expect(value, what, TRANSFER);
  const again = "write the file again with this version of prt";
  for (const name of FORMER) holds(extensions?.[name] === undefined, `the file has ${name}, a format of a former version; ${again}`);
  const extension = extensions?.[TRANSFER];
  if (extension === undefined) return {};
  holds(isObject(extension), "the extension is not an object");
  const { version, sets } = extension;
  holds(version === VERSION, `the file has ${TRANSFER} of version ${JSON.stringify(version)}, but this program reads version ${VERSION}; ${again}`);
  holds(Array.isArray(sets) && sets.length > 0, "sets is not a list of at least one set");
  const found = {};
  for (const set of sets) {
    holds(CHECKS.has(set?.receivers), "the receivers of a set are not vertices, texels or probes");
    holds(!found[set.receivers], `there is more than one set of ${set.receivers}`);
    checkSet(set, images?.length ?? 0);
    found[set.receivers] = set;
  }
  return found;
}

/** Validates PRTKIT_occlusion_volume of a node. */
export function checkOccluder(extension) {
  const holds = (value, what) => expect(value, what, OCCLUDERS);
  holds(isObject(extension), "the extension is not an object");
  const { version, min, max, reach, texels } = extension;
  holds(version === 1, `version ${version} is not supported, only 1; run prt ao again`);
  holds(areNumbers(min) && areNumbers(max) && min.every((low, axis) => low < max[axis]), "the box is invalid");
  holds(reach > 0 && reach < 1e30, "the reach is not a number above 0");
  holds(isView(texels), "texels are missing");
}

const MOST_INSTANCES = 1_000_000;
const LARGEST_SCALE = 500; // scale of a byte of factors

/** Validates PRTKIT_instances at the top level. */
export function checkInstances(extension) {
  const holds = (value, what) => expect(value, what, INSTANCES);
  holds(isObject(extension), "the extension is not an object");
  const { version, count, factors, boxes, lamps } = extension;
  holds(version === 3, `version ${version} is not supported, only 3; bake the model again`);
  holds(lamps === undefined || (isView(lamps) && isWhole(lamps.count, 1, 64)), "the lamps are invalid");
  holds(isWhole(count, 1, MOST_INSTANCES), `the count is not 1 to ${MOST_INSTANCES}`);
  holds(isView(factors), "factors are missing");
  const { scales } = factors;
  const areScales = Array.isArray(scales) && scales.length === FACTORS && scales.every((scale) => scale >= 0 && scale <= LARGEST_SCALE && typeof scale === "number");
  holds(areScales, `the scales of the factors are not ${FACTORS} numbers from 0 to ${LARGEST_SCALE}`);
  holds(Array.isArray(boxes) && boxes.length > 0, "boxes are missing");
  for (const box of boxes)
    holds(areThree(box?.middle) && areThree(box.half) && box.half.every((width) => Math.fround(width) > 0), "a box is invalid");
}

/** Validates the extension of node `n`, with `count` instances and `boxes` boxes in the file. */
export function checkInstanceNode(extension, n, count, boxes) {
  const isRight = isObject(extension) && isWhole(extension.first, 0, count - 1) && isWhole(extension.box, 0, boxes - 1);
  expect(isRight, `node ${n} names an instance or a box that does not exist`, INSTANCES);
}

/** Validates PRTKIT_lobes. */
export function checkLobes(extension) {
  const holds = (value, what) => expect(value, what, LOBES);
  holds(isObject(extension), "the extension is not an object");
  const { version, order, lobes, profiles } = extension;
  holds(version === 1, `version ${version} is not supported, only 1; run prt lobes again`);
  holds(isWhole(order, 2, 4) && isWhole(lobes, 1, 3), "the order is not 2 to 4, or the number of lobes is not 1 to 3");
  holds(areFloats(profiles) && isWhole(profiles.count, 1, 256), "the profiles are not 1 to 256 profiles of floats");
}

/** Returns the buffer views of a set of transfer. */
export function viewsOf({ packing, centers, predictors, bases, bricks, visibility, words }) {
  const { origin, units, scales, steps, axes, values } = bases;
  const coded = values ? [origin, units, scales, steps, axes, values] : [bases];
  const used = [packing, predictors && centers, ...coded, bricks, visibility, words];
  return used.filter((view) => view !== undefined).map(({ bufferView }) => bufferView);
}
