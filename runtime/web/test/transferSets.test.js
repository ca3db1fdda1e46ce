// Tests the top level of PRTKIT_transfer: its sets, and files of former versions.
import assert from "node:assert/strict";
import { test } from "node:test";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin } from "../src/PrtkitLoader.js";
import { setsOf } from "../src/wholeExtension.js";
import { setIn, transferOf } from "./transferSets.js";
import { volumeModel } from "./volumeModel.js";

const load = (change) => {
  const file = volumeModel({}, change);
  const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
};
const transferIn = ({ extensions }) => extensions.PRTKIT_transfer;
const probes = (json) => setIn(json, "probes");

const again = "write the file again with this version of prt";
const former = (name) => [(json) => (json.extensions = { [name]: { version: 2 } }), `: the file has ${name}, a format of a former version; ${again}`];
const wrong = {
  "a former version": [(json) => (json.extensions.PRTKIT_transfer = { version: 5, order: 2, terms: [] }), `: the file has PRTKIT_transfer of version 5, but this program reads version 6; ${again}`],
  "a later version": [(json) => (transferIn(json).version = 7), `: the file has PRTKIT_transfer of version 7, but this program reads version 6; ${again}`],
  "a version that is not a number": [(json) => (transferIn(json).version = { toString: "6\n" }), `: the file has PRTKIT_transfer of version {"toString":"6\\n"}, but this program reads version 6; ${again}`],
  "transfer of vertices of a former version": former("PRTKIT_clustered_pca"),
  "a lightmap of a former version": former("PRTKIT_lightmap"),
  "a volume of a former version": former("PRTKIT_transfer_volume"),
  "a volume of a former version, and sets": [(json) => (json.extensions.PRTKIT_transfer_volume = {}), `: the file has PRTKIT_transfer_volume, a format of a former version; ${again}`],
  "not an object": [(json) => (json.extensions.PRTKIT_transfer = [6]), ": the extension is not an object"],
  "no list of sets": [(json) => delete transferIn(json).sets, ": sets is not a list of at least one set"],
  "no sets": [(json) => (transferIn(json).sets = []), ": sets is not a list of at least one set"],
  "a set that is not an object": [(json) => transferIn(json).sets.push(null), ": the receivers of a set are not vertices, texels or probes"],
  "unknown receivers": [(json) => (probes(json).receivers = "faces"), ": the receivers of a set are not vertices, texels or probes"],
  "a property of objects as receivers": [(json) => (probes(json).receivers = "toString"), ": the receivers of a set are not vertices, texels or probes"],
  "two sets of the same receivers": [(json) => transferIn(json).sets.push(probes(json)), ": there is more than one set of probes"],
  "an unknown coding": [(json) => (probes(json).coding = "neural"), ": probes: the coding is neither raw nor clustered"],
  "no coding": [(json) => delete probes(json).coding, ": probes: the coding is neither raw nor clustered"],
  "a raw set": [(json) => (probes(json).coding = "raw"), ": probes: the file is an uncompressed bake; compress it: prt compress baked.glb -o shipped.glb"],
  "clusters of a raw set": [(json) => transferIn(json).sets.push({ ...probes(json), receivers: "vertices", coding: "raw" }), ": vertices: the file is an uncompressed bake; compress it: prt compress baked.glb -o shipped.glb"],
};
for (const [what, [change, message]] of Object.entries(wrong))
  test(`${what}: rejected with a reason`, () => assert.rejects(load((json) => void change(json)), { constructor: Error, message: `PRTKIT_transfer${message}` }));

test("sets are found in any order", () => {
  const set = { coding: "clustered", order: 1, terms: [{ kind: "combined", channels: 1 }], components: [0], bases: { bufferView: 0 } };
  const packing = { clusterBits: 0, bufferView: 1 };
  const texels = { ...set, receivers: "texels", packing, maps: [{ width: 1, height: 1, images: [0] }] };
  const vertices = { ...set, receivers: "vertices" };
  assert.deepEqual(setsOf({ extensions: transferOf(texels, vertices), images: [{}] }), { vertices, texels });
  assert.deepEqual(setsOf({}), {});
  assert.deepEqual(setsOf({ extensions: null }), {});
});
