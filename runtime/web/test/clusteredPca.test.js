// Tests the decoder of clustered transfer.

import assert from "node:assert/strict";
import { test } from "node:test";
import { clusterTable, updateConstants, lightColumns, shaderRows } from "../src/clusteredPca.js";
import { codedRows } from "../src/codedRows.js";
import { viewsOf } from "../src/wholeExtension.js";
import { encodedRows } from "./encodedRows.js";
import { decodedSet } from "./transferSets.js";

/** Packs numbers of given widths into bytes, lowest bit first. */
function bits(values) {
  const bytes = [];
  let position = 0;
  for (const [value, width] of values)
    for (let b = 0; b < width; ++b, ++position) {
      if (position % 8 === 0) bytes.push(0);
      if ((value >> b) & 1) bytes[bytes.length - 1] |= 1 << (position % 8);
    }
  return new Uint8Array(bytes);
}
const bytesOf = (...values) => new Uint8Array(new Float32Array(values).buffer);

/**
 * Two clusters of order 1: one with mean 2 and directions 0.5 and 0.25, one with mean 3 and no directions.
 * Widths 3 and 5.
 */
const plain = {
  receivers: "vertices",
  coding: "clustered",
  order: 1,
  terms: [{ kind: "combined", channels: 1 }],
  components: [2, 0],
  bases: { bufferView: 0, componentType: 5126 },
  packing: { clusterBits: 1, bufferView: 1 },
};
const plainViews = [bytesOf(2, 0.5, 0.25, 3), bits([[2, 4], [4, 4]])];

test("plain bases are read unchanged", () => {
  const clusters = decodedSet(plain, (i) => plainViews[i]);
  assert.deepEqual([...clusters.rows], [2, 0.5, 0.25, 3]);
  assert.deepEqual(clusters.firstRows, [0, 3]);
  assert.deepEqual(clusters.widths, [[3, 5], []]);
  assert.deepEqual([...clusterTable(clusters)], [0, 2, 2 | (4 << 4), 0, 3, 0, 0, 0]);
});

test("shader rows times integers equal rows times weights", () => {
  const clusters = decodedSet(plain, (i) => plainViews[i]);
  const constants = updateConstants(clusters, shaderRows(clusters), [10, 20, 30], new Float32Array(16));
  for (const [q0, q1] of [[0, 0], [7, 31], [3, 17]]) {
    const w0 = (2 * q0 - 7) / 7;
    const w1 = (2 * q1 - 31) / 31;
    [10, 20, 30].forEach((light, channel) => {
      const shader = constants[channel] + q0 * constants[4 + channel] + q1 * constants[8 + channel];
      assert.ok(Math.abs(shader - light * (2 + 0.5 * w0 + 0.25 * w1)) < 1e-4);
    });
  }
  assert.equal(constants[12], 30); // the second cluster
});

test("coded bases are sums over axes", () => {
  // One axis (3, -1) of three channels and order 1 would be dimension 3; here dimension 3, two axes.
  const extension = {
    receivers: "vertices",
    coding: "clustered",
    order: 1,
    terms: [{ kind: "direct", channels: 3 }],
    components: [1],
    bases: {
      origin: { bufferView: 0, componentType: 5126 },
      scales: { bufferView: 1, componentType: 5126 },
      step: 0.5,
      axes: { bufferView: 2, drops: [0, 0, 1] },
      values: { bufferView: 3, drops: [0, 2] },
    },
  };
  const views = [
    bytesOf(1, 2, 3),
    bytesOf(2, 4),
    encodedRows([0, 0, 1], [[4, [3, -1, 2]], [3, [-4, 0, -1]]]),
    // The mean and the direction; the second axis has no residual.
    encodedRows([0, 2], [[5, [-16, 3]], [2, [1, 0]]]),
  ];
  const { rows } = decodedSet(extension, (i) => views[i]);
  const axes = [[3, -1, 2], [-4, 0, -1]];
  for (let a = 0; a < 3; ++a) {
    assert.equal(rows[a], [1, 2, 3][a] + 0.5 * (2 * -16 * axes[0][a] + 4 * 3 * axes[1][a]));
    assert.equal(rows[3 + a], 2 * 0.5 * (2 * 1 * axes[0][a]));
  }
  // With units, the contribution of the axes is multiplied by them, and the start value of the mean is not.
  const scaled = { ...extension, bases: { ...extension.bases, units: { bufferView: 4, componentType: 5126 } } };
  const wide = decodedSet(scaled, (i) => [...views, bytesOf(1, 0.5, 4)][i]).rows;
  for (let a = 0; a < 3; ++a) {
    assert.equal(wide[a] - [1, 2, 3][a], [1, 0.5, 4][a] * (rows[a] - [1, 2, 3][a]));
    assert.equal(wide[3 + a], [1, 0.5, 4][a] * rows[3 + a]);
  }
  assert.throws(() => decodedSet(scaled, (i) => [...views, bytesOf(1)][i]), /the units do not contain \d+ floats/);
});

/**
 * Two clusters of order 1 with predictors: a mean, six rows and one direction of two bits; a mean and six
 * rows.
 */
const predicted = {
  receivers: "vertices",
  coding: "clustered",
  order: 1,
  terms: [{ kind: "combined", channels: 1 }],
  components: [1, 0],
  predictors: [
    { kind: "normal", scale: [2, 4, 8] },
    { kind: "position", origin: [10, 20, 30], scale: [1, 0.5, 0.25] },
  ],
  centers: { bufferView: 2, drops: [0, 0, 0, 1, 0, 0] },
  bases: { bufferView: 0, componentType: 5126 },
  packing: { clusterBits: 1, bufferView: 1 },
};
const predictedRows = [2, 1, 10, 100, 1000, 10000, 100000, 0.5, 3, 6, 5, 4, 3, 2, 1];
const predictedViews = [
  bytesOf(...predictedRows),
  bits([[1, 4]]),
  encodedRows([0, 0, 0, 1, 0, 0], [[3, [-1, 2, 0, 1, 3, -4]], [0, [0, 0, 0, 0, 0, 0]]]),
];

test("coded rows are decoded for all sizes", () => {
  const drops = [0, 3, 7];
  const values = Array.from({ length: 500 }, (_, r) => [((r * 7919) % 20001) - 10000, ((r * 31) % 41) - 20, r % 3 - 1]);
  const code = encodedRows(drops, values.map((row) => [15, row]));
  assert.deepEqual([...codedRows(code, drops, values.length)], values.flat());
  assert.throws(() => codedRows(code.subarray(0, code.length - 1), drops, values.length), /end too early/);
  assert.equal(codedRows(new Uint8Array(0), [], 3).length, 0);
});

test("predictors have rows after the mean, and centers", () => {
  const clusters = decodedSet(predicted, (i) => predictedViews[i]);
  assert.deepEqual([...clusters.rows], predictedRows);
  assert.deepEqual(clusters.firstRows, [0, 8]);
  assert.deepEqual([...clusters.centers], [-1, 2, 0, 1, 3, -4, 0, 0, 0, 0, 0, 0]);
  assert.deepEqual([...clusterTable(clusters)], [0, 1, 1, 0, 8, 0, 0, 0]);
});

test("shader rows times coordinates equal rows times scaled coordinates minus the center", () => {
  const clusters = decodedSet(predicted, (i) => predictedViews[i]);
  const constants = updateConstants(clusters, shaderRows(clusters), [1, 2, 3], new Float32Array(4 * 15));
  const x = [0, 0.6, 0.8, 1, -2, 0.5];
  const scales = [2, 4, 8, 1, 0.5, 0.25];
  [[0, 1], [8, 0]].forEach(([first, directions], k) => {
    const factors = [1, ...x.map((value, i) => scales[i] * value - clusters.centers[6 * k + i])];
    const stored = [1, ...x];
    if (directions) {
      factors.push((2 * 2 - 3) / 3);
      stored.push(2);
    }
    const expected = factors.reduce((sum, factor, j) => sum + factor * predictedRows[first + j], 0);
    [1, 2, 3].forEach((light, c) => {
      const shader = stored.reduce((sum, value, j) => sum + value * constants[4 * (first + j) + c], 0);
      assert.ok(Math.abs(shader - light * expected) < 1e-6 * 400000 * light, `${shader}, not ${light * expected}`);
    });
  });
});

test("steps of coded bases are powers of two in each cluster and group of axes", () => {
  const extension = {
    receivers: "vertices",
    coding: "clustered",
    order: 1,
    terms: [{ kind: "direct", channels: 3 }],
    components: [0, 0],
    bases: {
      origin: { bufferView: 0, componentType: 5126 },
      scales: { bufferView: 1, componentType: 5126 },
      steps: { least: 0.5, axes: [1, 2], bufferView: 2, drops: [0, 0] },
      axes: { bufferView: 3, drops: [0, 0, 0] },
      values: { bufferView: 4, drops: [0, 0, 0] },
    },
  };
  const views = [
    bytesOf(100, 200, 300),
    bytesOf(1, 2, 4),
    encodedRows([0, 0], [[4, [0, 3]], [4, [5, -1]]]),
    encodedRows([0, 0, 0], [[2, [1, 0, 0]], [2, [0, 1, 0]], [2, [0, 0, 1]]]),
    encodedRows([0, 0, 0], [[5, [5, 6, 7]], [5, [9, 10, 11]]]),
  ];
  assert.deepEqual(viewsOf(extension).sort(), [0, 1, 2, 3, 4]);
  const { rows } = decodedSet(extension, (i) => views[i]);
  assert.deepEqual([...rows], [102.5, 248, 412, 244, 205, 311]);
  for (const axes of [[1, 1], [3], [1, -1, 3], "12", [1, 65537]])
    assert.throws(
      () => decodedSet({ ...extension, bases: { ...extension.bases, steps: { ...extension.bases.steps, axes } } }, (i) => views[i]),
      /steps of the bases/,
    );
  assert.throws(
    () => decodedSet({ ...extension, bases: { ...extension.bases, steps: { ...extension.bases.steps, least: -1 } } }, (i) => views[i]),
    /step of the bases/,
  );
});

test("rows of predictors have the step of means in coded bases", () => {
  const extension = {
    ...predicted,
    components: [1],
    predictors: [predicted.predictors[0]],
    centers: { bufferView: 4, drops: [0, 0, 0] },
    bases: {
      origin: { bufferView: 0, componentType: 5126 },
      scales: { bufferView: 1, componentType: 5126 },
      step: 0.5,
      axes: { bufferView: 2, drops: [0] },
      values: { bufferView: 3, drops: [0] },
    },
    packing: { clusterBits: 0, bufferView: 5 },
  };
  const views = [
    bytesOf(100),
    bytesOf(1),
    encodedRows([0], [[3, [2]]]),
    encodedRows([0], [5, 6, 7, 8, 9].map((value) => [5, [value]])),
    encodedRows([0, 0, 0], [[0, [0, 0, 0]]]),
    bits([[1, 4]]),
  ];
  assert.deepEqual([...decodedSet(extension, (i) => views[i]).rows], [105, 6, 7, 8, 18]);
});

test("invalid predictors are rejected", () => {
  const [normal, position] = predicted.predictors;
  const wrong = [
    "normal", [{ ...normal, kind: "tangent" }], [normal, normal], [position, normal], [position, position], [null],
    [{ ...normal, scale: [1, 2] }], [{ ...normal, scale: [1, 0, 2] }], [{ ...normal, scale: [1, NaN, 2] }],
    [{ kind: "position", scale: [1, 1, 1] }], [{ ...position, origin: [1, 2, "3"] }],
  ];
  for (const predictors of wrong)
    assert.throws(() => decodedSet({ ...predicted, predictors }, (i) => predictedViews[i]), /predictors/);
  assert.throws(() => decodedSet({ ...predicted, predictors: [normal] }, (i) => predictedViews[i]), /centers/);
  assert.throws(() => decodedSet(predicted, (i) => (i === 2 ? new Uint8Array(0) : predictedViews[i])), /end too early/);
});

test("three channels are multiplied by three colours", () => {
  const clusters = { order: 1, terms: [{ kind: "combined", channels: 3 }], rowCount: 1 };
  assert.deepEqual([...updateConstants(clusters, [1, 2, 3], [10, 20, 30], new Float32Array(4))], [10, 40, 90, 0]);
});

test("the direct term is lit by the sky, other terms by sky and suns", () => {
  const terms = [{ kind: "direct", channels: 1 }, { kind: "indirect", channels: 3 }];
  const clusters = { order: 1, terms, rowCount: 1 };
  const columns = lightColumns(clusters, [10, 20, 30, 99], [1, 2, 3]);
  assert.deepEqual([...columns], [10, 20, 30, 11, 22, 33]);
  const row = [5, 1, 2, 3];
  assert.deepEqual([...updateConstants(clusters, row, columns, new Float32Array(4))], [50 + 11, 100 + 44, 150 + 99, 0]);
  const whole = { order: 1, terms: [{ kind: "combined", channels: 1 }] };
  assert.deepEqual([...lightColumns(whole, [10, 20, 30], [1, 2, 3])], [11, 22, 33]);
  assert.deepEqual([...lightColumns(clusters, [10, 20, 30])], [10, 20, 30, 10, 20, 30]);
});

test("invalid terms are rejected", () => {
  const of = (...kinds) => kinds.map((kind) => ({ kind, channels: 1 }));
  for (const terms of [undefined, [], of("lamp"), of("indirect", "direct"), of("direct", "combined"), of("direct", "direct"), of("direct,indirect")])
    assert.throws(() => decodedSet({ ...plain, terms }, (i) => plainViews[i]), /terms/);
  const sun = { kind: "lamp", channels: 1, name: "sun 12:00", towards: [0, 1, 0] };
  assert.throws(() => decodedSet({ ...plain, terms: [...of("combined"), sun] }, (i) => plainViews[i]), /bake the scene again/);
  assert.throws(() => decodedSet({ ...plain, terms: [{ kind: "combined", channels: 2 }] }, (i) => plainViews[i]), /terms/);
});

test("damaged files are rejected with a reason", () => {
  assert.throws(() => decodedSet({ ...plain, order: 11 }, (i) => plainViews[i]), /order/);
  assert.throws(() => decodedSet({ ...plain, components: [3, 0] }, (i) => plainViews[i]), /do not contain \d+ floats/);
  assert.throws(() => decodedSet(plain, (i) => [plainViews[0], new Uint8Array(0)][i]), /the widths of the packed weights end too early/);
  const third = [bytesOf(2, 0.5, 0.25, 3, 4), plainViews[1]]; // a byte has two widths
  assert.throws(() => decodedSet({ ...plain, components: [2, 1] }, (i) => third[i]), /the widths of the packed weights end too early/);
});

test("invalid values are rejected with a reason", () => {
  const refused = (changes, reason, views = plainViews) =>
    assert.throws(() => decodedSet({ ...plain, ...changes }, (i) => views[i]), reason);
  for (const order of [0, 2.5, "1", null]) refused({ order }, /order/);
  for (const components of [[], "2", [2, -1], [2, 0.5], [601], new Array(65537).fill(0)]) refused({ components }, /components/);
  for (const bases of [undefined, 7, {}, { bufferView: -1 }, { bufferView: 0, componentType: 5131 }]) refused({ bases }, /bases/);
  for (const packing of [null, {}, { bufferView: 1, clusterBits: 17 }, { bufferView: 1, clusterBits: 0.5 }]) refused({ packing }, /packing/);
  refused({ packing: { bufferView: 1, clusterBits: 0 } }, /cannot number all clusters/);
  refused({ components: [17, 0] }, /16 packed/);
  for (const wrong of [NaN, Infinity, -1.1e6]) refused({}, /not finite/, [bytesOf(2, wrong, 0.25, 3), plainViews[1]]);
});

test("rows of zeros are limited to the memory for the file size", () => {
  const rows = 65536;
  const drops = new Array(200).fill(0);
  const coded = { origin: { bufferView: 0 }, scales: { bufferView: 1 }, step: 1, axes: { bufferView: 2, drops: [0] } };
  const zeros = new Uint8Array(rows * 8);
  const extension = { ...plain, packing: undefined, components: new Array(rows).fill(7), bases: { ...coded, values: { bufferView: 3, drops } } };
  const views = [bytesOf(0), new Uint8Array(800), new Uint8Array(200), zeros];
  assert.throws(() => decodedSet(extension, (i) => views[i]), /the bases would need 426 MB/);
});

test("a row has a value for each coefficient of each channel", () => {
  const extension = {
    receivers: "vertices",
    coding: "clustered",
    order: 2,
    terms: [{ kind: "combined", channels: 3 }],
    components: [0],
    bases: { bufferView: 0, componentType: 5126 },
  };
  const values = Array.from({ length: 12 }, (_, i) => i);
  assert.deepEqual([...decodedSet(extension, () => bytesOf(...values)).rows], values);
  assert.throws(() => decodedSet(extension, () => bytesOf(...values.slice(1))), /do not contain \d+ floats/);
});
