// What is under a point of the picture, in numbers: the walk on the CPU, over the same arrays.

const PI = Math.PI;
const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const figure = (v) =>
    (v === 0                                      ? '0' :
         Math.abs(v) >= 1e-3 && Math.abs(v) < 1e5 ? String(Number(v.toPrecision(4))) :
                                                    v.toExponential(3));
// One number, or one a band.
const figures = (values) =>
    (values.every((v) => v === values[0]) ? figure(values[0]) : values.map(figure).join(', '));

// (x, y): −1 to 1 to the right and up. Returns null (nothing there) or { what, rows: [[name, value
// with its unit], …] }.
function pick(picture, meta, frame, x, y, clip, coloured) {
  const {walker} = picture, d = rayOf(frame, x, y);
  const entry = entryDistance(frame.eye, d, meta.hull_min, meta.hull_max);
  if (entry < 0) return null;
  const rope =
      walker.zoneAt(entry > 0 ? add(frame.eye, d, entry + 1e-7 * meta.diagonal) : frame.eye);
  let begin = 0, end = FAR;
  if (clip) {
    const start = dot(clip, frame.eye) + clip[3], slope = dot(clip, d), t = -start / slope;
    if (start < 0)
      begin = slope > 0 ? t : FAR;
    else if (t > 0 && coloured)
      end = t;
  }
  let zones = 0, cut = null;
  const hit = walker.follow(frame.eye, d, rope, entry, begin, end, (zone, row, tIn, tOut) => {
    ++zones;
    if (coloured && (tIn === begin && begin > 0))
      cut = {zone, t: tIn};
    else if (tOut === end)
      cut = {zone, t: tOut};
    return cut === null;
  });
  const place = (t) => add(frame.eye, d, t);
  if (cut) return describeZone(walker, meta, cut.zone, place(cut.t), cut.t);
  if (!hit || hit.wall === undefined) return null;
  return describePatch(walker, meta, hit, place(hit.t), zones);
}

function placeRow(meta, x, t) {
  return [
    ['place', `${add(x, meta.origin).map((v) => v.toFixed(3)).join(', ')} m`],
    ['distance', `${figure(t)} m`]
  ];
}

function describeZone(walker, meta, zone, x, t) {
  const {zones, zoneStride, zoneVolume, zoneMedium} = walker.t, at = 4 * zoneStride * zone;
  const shown = zones[at + 21];
  // A function that fits may dip below zero at a corner; light does not.
  const source = walker.sourceAt(zone, x).map(
      (s) => ({...s, direct: Math.max(0, s.direct), indirect: Math.max(0, s.indirect)}));
  const of = (f) => figures(source.map(f));
  return {
    what: `zone ${shown} of ${meta.names.media[zoneMedium[zone]].name}`,
    kind: 'zone',
    index: shown,
    rows: [
      ...placeRow(meta, x, t), ['J', `${of((s) => s.emission + s.direct + s.indirect)} W/m²/sr`],
      ['J, direct', `${of((s) => s.direct)} W/m²/sr`],
      ['J, indirect', `${of((s) => s.indirect)} W/m²/sr`],
      ['extinction', `${of((s) => s.extinction)} /m`],
      ['estimated error', `${figure(zones[at + 23])} W/m²/sr`],
      ['volume', `${figure(zoneVolume[shown])} m³`], ['level', String(zones[at + 22])]
    ]
  };
}

function describePatch(walker, meta, hit, x, zones) {
  const seen = walker.radianceAt(hit.wall, x);
  if (!seen) return null;
  const {patches, patchStride, patchArea} = walker.t, at = 4 * patchStride * seen.patch;
  const side = meta.names.sides[patches[at + 1]], of = (f) => figures(seen.parts.map(f));
  // The arrays hold reflected light; irradiance is known where something is reflected.
  const irradiance = side.reflectance.every((r) => r > 0) ? [[
    'irradiance',
    `${figures(seen.parts.map((p, b) => PI * (p.direct + p.indirect) / side.reflectance[b]))} W/m²`
  ]] :
                                                            [];
  return {
    what: `patch ${seen.patch} of ${side.name}`,
    kind: 'patch',
    index: seen.patch,
    rows: [
      ...placeRow(meta, x, hit.t),
      ['radiance', `${of((p) => p.emission + p.direct + p.indirect)} W/m²/sr`],
      ['of it direct', `${of((p) => p.direct)} W/m²/sr`],
      ['of it indirect', `${of((p) => p.indirect)} W/m²/sr`],
      ['of it emitted', `${of((p) => p.emission)} W/m²/sr`], ...irradiance,
      ['estimated error', `${figure(patches[at + 3])} W/m²/sr`],
      ['area', `${figure(patchArea[seen.patch])} m²`], ['level', String(patches[at + 2])],
      ['zones in between', String(zones)]
    ]
  };
}
