// The arrays of the solution: unpacked from the page, and laid out as texels for the GPU and for
// the walk on the CPU.

// Bytes of base64; where the browser has a way of its own, by that.
function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// Numbers are stored byte by byte: all first bytes, all second ones …, which gzip likes better.
function numbersOf(bytes, type, count) {
  const joined = new Uint8Array(4 * count);
  for (let k = 0; k < 4; ++k)
    for (let i = 0, from = k * count; i < count; ++i) joined[4 * i + k] = bytes[from + i];
  return type === 'f' ? new Float32Array(joined.buffer) : new Int32Array(joined.buffer);
}

// meta.arrays: [name, 'f' or 'i', count], in their order.
async function unpackArrays(meta, base64) {
  const stream = new Blob([bytesOfBase64(base64)]).stream();
  const plain = stream.pipeThrough(new DecompressionStream('gzip'));
  const bytes = new Uint8Array(await new Response(plain).arrayBuffer());
  const arrays = {};
  let offset = 0;
  for (const [name, type, count] of meta.arrays) {
    arrays[name] = numbersOf(bytes.subarray(offset, offset + 4 * count), type, count);
    offset += 4 * count;
  }
  if (offset !== bytes.length) throw new Error('The data in this page is cut short.');
  return arrays;
}

// Texels of four floats, `stride` an element; fill(index, texels, first).
function texels(count, stride, fill) {
  const table = new Float32Array(4 * stride * Math.max(count, 1));
  for (let i = 0; i < count; ++i) fill(i, table, 4 * stride * i);
  return table;
}

const LIGHT = 6;  // texels of a zone before its functions: planes, ropes, what it is

class Tables {
  constructor(meta, a) {
    const bands = this.bands = meta.bands;
    this.varying = a.zone_extinction.length > 0;
    this.perBand = this.varying ? 3 : 2;
    this.zoneStride = LIGHT + this.perBand * bands;
    this.patchStride = this.pieceStride = 1 + bands;
    this.zoneCount = a.zone_row.length;
    this.patchCount = a.patch_row.length;
    const copy = (to, at, from, first, count = 4) => {
      for (let k = 0; k < count; ++k) to[at + k] = from[first + k];
    };
    this.zones = texels(this.zoneCount, this.zoneStride, (z, to, at) => {
      for (let k = 0; k < 4; ++k) {
        const face = a.zone_planes[4 * z + k], sign = face & 1 ? -1 : 1;
        for (let c = 0; c < 4; ++c) to[at + 4 * k + c] = sign * a.planes[4 * (face >> 1) + c];
      }
      copy(to, at + 16, a.zone_ropes, 4 * z);
      to[at + 20] = a.zone_row[z];
      to[at + 21] = a.zone_medium[z];
      to[at + 22] = a.zone_level[z];
      to[at + 23] = a.zone_error[z];
      for (let b = 0; b < bands; ++b) {
        const to_band = at + 4 * (LIGHT + this.perBand * b), from = 4 * (z * bands + b);
        copy(to, to_band, a.zone_direct, from);
        copy(to, to_band + 4, a.zone_indirect, from);
        if (this.varying) copy(to, to_band + 8, a.zone_extinction, from);
      }
    });
    this.nodes = texels(a.nodes.length / 3, 2, (n, to, at) => {
      copy(to, at, a.planes, 4 * a.nodes[3 * n]);
      copy(to, at + 4, a.nodes, 3 * n + 1, 2);
    });
    this.walls = texels(a.walls.length / 2, 1, (w, to, at) => copy(to, at, a.walls, 2 * w, 2));
    this.patches = texels(this.patchCount, this.patchStride, (p, to, at) => {
      to[at] = a.patch_row[p];
      to[at + 1] = a.patch_side[p];
      to[at + 2] = a.patch_level[p];
      to[at + 3] = a.patch_error[p];
      copy(to, at + 4, a.patch_indirect, 4 * p * bands, 4 * bands);
    });
    this.pieces = texels(a.piece_patch.length, this.pieceStride, (p, to, at) => {
      to[at] = a.piece_patch[p];
      copy(to, at + 4, a.piece_direct, 4 * p * bands, 4 * bands);
    });
    this.rows = texels(a.rows.length / 2, 1, (r, to, at) => copy(to, at, a.rows, 2 * r, 2));
    this.hullCorners = a.hull_corners;
    this.hullZones = a.hull_zones;
    this.patchArea = a.patch_area;
    this.zoneVolume = a.zone_volume;
  }
}
