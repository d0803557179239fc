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
      to[at + 21] = z;
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
    // Patches of the last mesh, and behind them those that they were bisected from.
    const coarserCount = a.coarser_patch_born.length;
    this.patches = texels(this.patchCount + coarserCount, this.patchStride, (p, to, at) => {
      const c = p - this.patchCount, older = c >= 0, n = older ? c : p;
      to[at] = (older ? a.coarser_patch_row : a.patch_row)[n];
      to[at + 2] = (older ? a.coarser_patch_level : a.patch_level)[n];
      to[at + 3] = (older ? a.coarser_patch_error : a.patch_error)[n];
      const indirect = older ? a.coarser_patch_indirect : a.patch_indirect;
      copy(to, at + 4, indirect, 4 * n * bands, 4 * bands);
    });
    for (let p = 0; p < this.patchCount; ++p) {
      // Coarser patches are of the side of those below them.
      this.patches[4 * this.patchStride * p + 1] = a.patch_side[p];
      for (let c = a.patch_above[p]; c >= 0; c = a.coarser_patch_above[c])
        this.patches[4 * this.patchStride * (this.patchCount + c) + 1] = a.patch_side[p];
    }
    this.pieces = texels(a.piece_patch.length, this.pieceStride, (p, to, at) => {
      to[at] = a.piece_patch[p];
      copy(to, at + 4, a.piece_direct, 4 * p * bands, 4 * bands);
    });
    this.rows = texels(a.rows.length / 2, 1, (r, to, at) => copy(to, at, a.rows, 2 * r, 2));
    this.hullCorners = a.hull_corners;
    this.hullZones = a.hull_zones;
    this.patchArea = [...a.patch_area, ...a.coarser_patch_size];
    this.zoneVolume = [...a.zone_volume, ...a.coarser_zone_size];
    this.zoneMedium = a.zone_medium;
    this.arrays = a;
    this.lastMesh = this.mesh = Math.max(0, meta.meshes.length - 1);
  }

  // The element of a mesh that holds an element of the last one: itself, or count + the index of a
  // coarser one.
  elementOf(kind, index, mesh, count) {
    const a = this.arrays;
    if (a[`${kind}_born`][index] <= mesh) return index;
    let coarser = a[`${kind}_above`][index];
    while (a[`coarser_${kind}_born`][coarser] > mesh) coarser = a[`coarser_${kind}_above`][coarser];
    return count + coarser;
  }

  // Fills zones and pieces with what a mesh of meta.meshes holds. Leaves stay those of the last
  // one: a linear function is the same in all that its element was bisected into. Direct light on
  // patches stays, as it is drawn anew for every picture.
  showMesh(mesh) {
    const a = this.arrays, {bands, zoneStride, perBand, zones} = this;
    const copy = (at, values, from) => {
      for (let k = 0; k < 4; ++k) zones[at + k] = values[from + k];
    };
    for (let z = 0; z < this.zoneCount; ++z) {
      if (a.zone_row[z] < 0) continue;
      const shown = this.elementOf('zone', z, mesh, this.zoneCount), c = shown - this.zoneCount;
      const older = c >= 0, n = older ? c : z, at = 4 * zoneStride * z;
      zones[at + 20] = (older ? a.coarser_zone_row : a.zone_row)[n];
      zones[at + 21] = shown;
      zones[at + 22] = (older ? a.coarser_zone_level : a.zone_level)[n];
      zones[at + 23] = (older ? a.coarser_zone_error : a.zone_error)[n];
      for (let b = 0; b < bands; ++b) {
        const to = at + 4 * (LIGHT + perBand * b), from = 4 * (n * bands + b);
        copy(to, older ? a.coarser_zone_direct : a.zone_direct, from);
        copy(to + 4, older ? a.coarser_zone_indirect : a.zone_indirect, from);
      }
    }
    for (let p = 0; p < a.piece_patch.length; ++p)
      this.pieces[4 * this.pieceStride * p] =
          this.elementOf('patch', a.piece_patch[p], mesh, this.patchCount);
    this.mesh = mesh;
  }
}
