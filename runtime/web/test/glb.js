// Writes test models: binary glTF files, and PNG.
import { crc32, deflateSync } from "node:zlib";
import { setsOf } from "../src/wholeExtension.js";

/** Buffer views and accessors of one file, one behind the other. */
export class Binary {
  constructor() {
    this.chunks = [];
    this.length = 0;
    this.bufferViews = [];
    this.accessors = [];
  }

  view(bytes, more = {}) {
    const padding = (4 - (bytes.byteLength % 4)) % 4;
    this.bufferViews.push({ buffer: 0, byteOffset: this.length, byteLength: bytes.byteLength, ...more });
    this.chunks.push(Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength), Buffer.alloc(padding));
    this.length += bytes.byteLength + padding;
    return this.bufferViews.length - 1;
  }

  accessor(array, type, more = {}) {
    const size = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[type];
    const componentType = { Float32Array: 5126, Uint32Array: 5125, Uint8Array: 5121 }[array.constructor.name];
    this.accessors.push({ bufferView: this.view(array), componentType, count: array.length / size, type, ...more });
    return this.accessors.length - 1;
  }

  file(json) {
    const { bufferViews, accessors } = this;
    const text = JSON.stringify({ asset: { version: "2.0" }, ...json, bufferViews, accessors, buffers: [{ byteLength: this.length }] });
    const chunk = Buffer.from(text.padEnd(Math.ceil(text.length / 4) * 4));
    const head = (...words) => Buffer.from(Uint32Array.of(...words).buffer);
    const bytes = 12 + 8 + chunk.length + 8 + this.length;
    return Buffer.concat([head(0x46546c67, 2, bytes, chunk.length, 0x4e4f534a), chunk, head(this.length, 0x004e4942), ...this.chunks]);
  }
}

/** A PNG of four channels of 8 bits. */
export function png(width, height, bytes) {
  const rows = Buffer.alloc(height * (4 * width + 1)); // each row begins with its filter: 0
  for (let y = 0; y < height; ++y) Buffer.from(bytes.buffer, bytes.byteOffset + 4 * width * y, 4 * width).copy(rows, y * (4 * width + 1) + 1);
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]);
    const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    sum.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, sum]);
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 6], 8);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", header), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

/** Returns the set of these receivers in a file, and a function that returns the bytes of its buffer views. */
export function setOf(file, receivers) {
  const length = file.readUInt32LE(12);
  const json = JSON.parse(file.toString("utf8", 20, 20 + length));
  const view = (i) => {
    const { byteOffset, byteLength } = json.bufferViews[i];
    return new Uint8Array(file.subarray(28 + length + byteOffset, 28 + length + byteOffset + byteLength));
  };
  return { set: setsOf(json)[receivers], view };
}
