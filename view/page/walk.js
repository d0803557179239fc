// The walk of walk.frag in double precision, over the same numbers: for what is picked, for where
// the eye stands, and as the GPU's oracle.

const FAR = 1e30;

function segmentWeights(tau) {
  let opacity, back;
  if (tau < 0.05) {
    opacity = tau * (1 - tau * (1 / 2 - tau * (1 / 6 - tau * (1 / 24 - tau / 120))));
    back = tau * (1 / 2 - tau * (1 / 3 - tau * (1 / 8 - tau * (1 / 30 - tau / 144))));
  } else {
    opacity = -Math.expm1(-tau);
    back = (opacity - tau * (1 - opacity)) / tau;
  }
  return [opacity - back, back, 1 - opacity];
}

function segmentWeightsOfHalves(first, second) {
  const w = segmentWeights(first + second);
  const excess = 2 / 3 * Math.exp(-0.5 * (first + second)) * Math.expm1(0.5 * (second - first));
  const moved = Math.min(Math.max(excess, -w[1]), w[0]);
  return [w[0] - moved, w[1] + moved, w[2]];
}

class Walker {
  constructor(tables, environment) {
    this.t = tables;
    this.environment = environment;
  }

  plane(table, at, x) {
    return table[at] * x[0] + table[at + 1] * x[1] + table[at + 2] * x[2] + table[at + 3];
  }
  slope(table, at, d) {
    return table[at] * d[0] + table[at + 1] * d[1] + table[at + 2] * d[2];
  }

  // The rope of the zone that holds x: the one whose nearest face is deepest inside.
  zoneAt(x) {
    const {zones, zoneStride, zoneCount} = this.t;
    let best = -1, deepest = -FAR;
    for (let z = 0; z < zoneCount; ++z) {
      let least = FAR;
      for (let k = 0; k < 4 && least > deepest; ++k)
        least = Math.min(least, this.plane(zones, 4 * (zoneStride * z + k), x));
      if (least > deepest) {
        deepest = least;
        best = z;
      }
    }
    return 4 * best;
  }

  descend(rope, eye, d, t) {
    const {nodes} = this.t;
    while (rope >= 0 && (rope & 3) === 1) {
      const at = 8 * (rope >> 2);
      const start = this.plane(nodes, at, eye), slope = this.slope(nodes, at, d);
      const second = slope === 0 ? start > 0 : (slope > 0) === (t >= -start / slope);
      rope = nodes[at + (second ? 5 : 4)];
    }
    return rope;
  }

  pieceAt(wall, x) {
    const {nodes, walls} = this.t;
    let rope = walls[4 * wall];
    while (rope >= 0 && (rope & 3) === 1) {
      const at = 8 * (rope >> 2);
      rope = nodes[at + (this.plane(nodes, at, x) > 0 ? 5 : 4)];
    }
    return rope;
  }

  // What a ray meets, in order: onZone(zone, row, tIn, tOut) in media (false stops). Returns the
  // wall and the distance, or null where it leaves or ends in the dark. From `begin` on; what is
  // before it, walls too, is passed. `end`: where a clip plane stands.
  follow(eye, d, rope, t, begin, end, onZone) {
    const {zones, zoneStride, walls} = this.t;
    rope = this.descend(rope, eye, d, t);
    for (let step = 0; step < 20000; ++step) {
      if (rope < 0) return {left: true, t};
      if ((rope & 3) === 2) {
        if (t >= begin) return {wall: rope >> 2, t};
        rope = this.descend(walls[4 * (rope >> 2) + 1], eye, d, t);
        continue;
      }
      const zone = rope >> 2, at = 4 * zoneStride * zone;
      let out = FAR, face = 0;
      for (let k = 0; k < 4; ++k) {
        const slope = this.slope(zones, at + 4 * k, d);
        const tFace = slope < 0 ? -this.plane(zones, at + 4 * k, eye) / slope : FAR;
        if (tFace < out) {
          out = tFace;
          face = k;
        }
      }
      out = Math.max(t, out);
      const row = zones[at + 20];
      if (t < begin && out >= begin) t = begin;
      if (t >= begin) {
        if (row === -2) return {solid: true, zone, t};
        if (row >= 0 && out > t && onZone(zone, row, t, Math.min(out, end)) === false) return null;
        if (row >= 0 && out >= end) return null;
      }
      t = out;
      rope = this.descend(zones[at + 16 + face], eye, d, t);
    }
    return null;
  }

  // Of a zone at x: direct and indirect source radiance and emission of every band.
  sourceAt(zone, x) {
    const {zones, zoneStride, perBand, rows, bands} = this.t;
    const row = zones[4 * zoneStride * zone + 20];
    const source = [];
    for (let b = 0; b < bands; ++b) {
      const at = 4 * (zoneStride * zone + LIGHT + perBand * b);
      source.push({
        extinction: this.extinctionAt(zone, row, b, x),
        emission: rows[4 * (row * bands + b) + 1],
        direct: this.plane(zones, at, x),
        indirect: this.plane(zones, at + 4, x)
      });
    }
    return source;
  }

  extinctionAt(zone, row, band, x) {
    const {zones, zoneStride, perBand, rows, bands, varying} = this.t;
    if (!varying) return rows[4 * (row * bands + band)];
    const at = 4 * (zoneStride * zone + LIGHT + perBand * band + 2);
    return Math.max(0, this.plane(zones, at, x));
  }

  // Of the piece of a wall at x, likewise; with the patch that it is a part of.
  radianceAt(wall, x) {
    const {pieces, pieceStride, patches, patchStride, rows, bands} = this.t;
    const rope = this.pieceAt(wall, x);
    if (rope < 0) return null;
    const piece = 4 * pieceStride * (rope >> 2), patch = pieces[piece];
    const at = 4 * patchStride * patch, row = patches[at];
    const parts = [];
    for (let b = 0; b < bands; ++b)
      parts.push({
        emission: rows[4 * (row * bands + b) + 1],
        direct: Math.max(0, this.plane(pieces, piece + 4 * (1 + b), x)),
        indirect: Math.max(0, this.plane(patches, at + 4 * (1 + b), x))
      });
    return {patch, parts};
  }

  // Radiance along a ray [band], as the picture shows it.
  radiance(eye, d, rope, t, layers, medium) {
    const bands = this.t.bands, sum = new Array(bands).fill(0), through = new Array(bands).fill(1);
    const gained = (w, front, back) => {
      const part = (name) => Math.max(0, w[0] * front[name] + w[1] * back[name]);
      return layers[0] * part('emission') + layers[3] * part('direct') +
          layers[4] * part('indirect');
    };
    const place = (s) => [0, 1, 2].map((k) => eye[k] + s * d[k]);
    const end = this.follow(eye, d, rope, t, 0, FAR, (zone, row, tIn, tOut) => {
      if (!medium) return true;
      const first = this.sourceAt(zone, place(tIn)), last = this.sourceAt(zone, place(tOut));
      for (let b = 0; b < bands; ++b) {
        const kIn = first[b].extinction, kOut = last[b].extinction, quarter = (tOut - tIn) / 4;
        const half = 0.5 * (kIn + kOut);
        const w = this.t.varying ?
            segmentWeightsOfHalves(quarter * (kIn + half), quarter * (half + kOut)) :
            segmentWeights(kIn * (tOut - tIn));
        sum[b] += through[b] * gained(w, first[b], last[b]);
        through[b] *= w[2];
      }
      return Math.max(...through) > 1e-7;
    });
    if (end && end.left)
      for (let b = 0; b < bands; ++b) sum[b] += layers[0] * through[b] * this.environment[b];
    const seen = end && end.wall !== undefined ? this.radianceAt(end.wall, place(end.t)) : null;
    if (seen)
      seen.parts.forEach((p, b) => {
        sum[b] +=
            through[b] * (layers[0] * p.emission + layers[1] * p.direct + layers[2] * p.indirect);
      });
    return sum;
  }
}
