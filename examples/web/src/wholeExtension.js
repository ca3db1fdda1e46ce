// What the JSON of PRTKIT_clustered_pca must be before anything is computed from it (docs/format.md).

/** Throws an Error that says `what` is wrong with the file, unless `holds`. */
export function expect(holds, what) {
  if (!holds) throw new Error(`PRTKIT_clustered_pca: ${what}`);
}

/** Of scales of guides and float weights, and metres that a vertex is from the origin of the world. */
export const LARGEST_WEIGHT = 1e9;
/** Of values of bases. */
export const LARGEST_TRANSFER = 1e6;

const isObject = (v) => typeof v === "object" && v !== null && !Array.isArray(v);
const isWhole = (v, least, most) => Number.isInteger(v) && v >= least && v <= most;
const isView = (v) => isObject(v) && isWhole(v.bufferView, 0, 2 ** 31);
const areFloats = (v) => isView(v) && (v.componentType ?? 5126) === 5126;
const areRows = (v) => isView(v) && Array.isArray(v.drops) && v.drops.every((drop) => isWhole(drop, 0, 15));

const LAYOUTS = [[], ["direct"], ["indirect"], ["whole"], ["direct", "indirect"]];

const isUnit = (v) => Array.isArray(v) && v.length === 3 && Math.abs(Math.hypot(...v) - 1) <= 1e-3;

function areParts(parts) {
  if (!Array.isArray(parts) || parts.length > 66) return false;
  if (!parts.every((part) => part?.channels === 1 || part?.channels === 3)) return false;
  const skies = parts.filter(({ kind }) => kind !== "lamp");
  const lamps = parts.slice(skies.length);
  const names = lamps.map(({ name }) => name);
  return (
    parts.length > 0 &&
    names.every((name) => typeof name === "string" && name !== "") &&
    new Set(names).size === names.length &&
    parts.every(({ members }) => members === undefined || (Array.isArray(members) && members.every((m) => typeof m === "string"))) &&
    lamps.every(({ kind, towards }) => kind === "lamp" && (towards === undefined || isUnit(towards))) &&
    skies.every(({ towards }) => towards === undefined) &&
    LAYOUTS.some((kinds) => kinds.length === skies.length && kinds.every((kind, i) => kind === skies[i].kind))
  );
}

const KINDS = ["normal", "position"];

const areThree = (v) => Array.isArray(v) && v.length === 3 && v.every((x) => Math.abs(x) <= LARGEST_WEIGHT && typeof x === "number");

/** Whether guides are none, or each kind once at most, normals first. */
function areGuides(guides) {
  if (!Array.isArray(guides)) return false;
  const kinds = guides.map((guide) => KINDS.indexOf(guide?.kind));
  return (
    kinds.every((kind, i) => kind >= 0 && (i === 0 || kind > kinds[i - 1])) &&
    guides.every(
      ({ kind, scale, origin }) =>
        areThree(scale) && scale.every((s) => Math.fround(s) !== 0) && (kind === "normal" || areThree(origin)),
    )
  );
}

function checkBases(bases) {
  expect(isObject(bases), "there are no bases");
  if (bases.values === undefined) return expect(areFloats(bases), "the bases are no floats");
  expect(areRows(bases.values) && areRows(bases.axes), "the rows of the coded bases are wrong");
  expect(
    areFloats(bases.origin) && areFloats(bases.scales) && (bases.units === undefined || areFloats(bases.units)),
    "what the coded bases are of are no floats",
  );
  expect(Number.isFinite(bases.step) && bases.step >= 0, "the step of the bases is no number from 0 on");
}

function checkPacking({ packing, components }) {
  if (packing === undefined) return;
  expect(isView(packing) && isWhole(packing.clusterBits, 0, 16), "the packing is wrong");
  expect(components.length <= 2 ** packing.clusterBits, "the clusters do not fit their bits");
  expect(components.every((m) => m <= 16), "a cluster has more than 16 packed components");
}

/** Throws an Error that says what is wrong with the object at the top level of a glTF. */
export function checkExtension(extension) {
  expect(isObject(extension), "the extension is no object");
  const { version, order, parts, components, guides, centers } = extension;
  expect(version === 6, `version ${version} is not known, only 6; compress the model again`);
  expect(isWhole(order, 1, 10) && areParts(parts), "order or parts are wrong");
  expect(Array.isArray(components) && isWhole(components.length, 1, 65536), "the components are no list of 1 to 65536");
  expect(components.every((m) => isWhole(m, 0, 600)), "the components of a cluster are wrong");
  if (guides !== undefined) {
    expect(areGuides(guides) && guides.length > 0, "the guides are wrong");
    expect(areRows(centers) && centers.drops.length === 3 * guides.length, "the centers are not those of the guides");
  }
  checkBases(extension.bases);
  checkPacking(extension);
}

/** The buffer views that an extension, which is right, names. */
export function viewsOf({ packing, centers, guides, bases }) {
  const { origin, units, scales, axes, values } = bases;
  const used = [packing, guides && centers, ...(values ? [origin, units, scales, axes, values] : [bases])];
  return used.filter((part) => part !== undefined).map(({ bufferView }) => bufferView);
}
