// #selftest: every pixel of a small picture by the GPU against the walk in double precision; the
// outcome stands in the page, for tests. Relative to the pixel's own radiance, but no less than a
// thousandth of the mean. Functions jump at the faces of leaves, and where a ray grazes a face single
// precision places the jump only as well as it places the eye beside it: what rays differ by that
// run that near to the pixel's own does not count.

function selfTest(picture, meta, camera) {
  const width = 96, height = 72, bands = meta.bands;
  const look = {layers: [1, 1, 1, 1, 1], medium: true, clip: null, colours: 0, scale: [0, 1, 0]};
  const frame = new View(camera).frame(width, height);
  const target = picture.target('test', width, height);
  picture.draw(target, frame, look);
  const gpu = picture.read(target), cpu = new Float64Array(3 * width * height);
  const inside = picture.isInside(frame.eye),
        start = inside ? picture.walker.zoneAt(frame.eye) : -1;
  // Of a ray from beside the eye, so much to the right and up.
  const radiance = (x, y, right, up) => {
    const eye = add(add(frame.eye, frame.right, right), frame.up, up);
    const d = rayOf(frame, 2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1);
    const t = inside ? 0 : entryDistance(eye, d, meta.hull_min, meta.hull_max);
    const rope = inside || t < 0 ?
        start :
        picture.walker.zoneAt(add(eye, d, t + 1e-7 * picture.meta.diagonal));
    const sum = picture.walker.radiance(eye, d, rope, t, look.layers, true);
    const mean = sum.reduce((a, b) => a + b, 0) / bands;
    return [0, 1, 2].map(c => bands === 3 ? sum[c] : mean);
  };
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) cpu.set(radiance(x, y, 0, 0), 3 * (y * width + x));
  const mean = cpu.reduce((a, b) => a + b, 0) / cpu.length;
  const notable = 2e-5;  // what single precision leaves of rays that graze nothing
  const near = 1.2e-7 * meta.diagonal;
  let worst = 0, place = 0, squares = 0, grazing = 0;
  cpu.forEach((value, k) => {
    const pixel = Math.floor(k / 3), seen = gpu[4 * pixel + k % 3];
    // Of the pixel's brightest channel: what a grazing ray is off by has the colour of what jumps.
    const brightest = Math.max(...cpu.slice(3 * pixel, 3 * pixel + 3));
    const scale = Math.max(brightest, 1e-3 * mean, 1e-30);
    let error = Math.abs(seen - value) / scale;
    if (error > notable) {
      const x = pixel % width, y = Math.floor(pixel / width);
      const beside = [[near, 0], [-near, 0], [0, near], [0, -near]].map(
          ([right, up]) => radiance(x, y, right, up)[k % 3]);
      error -= (Math.max(...beside, value) - Math.min(...beside, value)) / scale;
      error = Math.max(notable, error);
      ++grazing;
    }
    squares += error * error;
    if (!(error <= worst)) {
      worst = error;
      place = Math.floor(k / 3);
    }
  });
  return {
    pixels: width * height,
    mean,
    worst,
    grazing,
    rms: Math.sqrt(squares / cpu.length),
    worst_at: [place % width, Math.floor(place / width)],
    gpu: [...gpu.subarray(4 * place, 4 * place + 3)],
    cpu: [...cpu.subarray(3 * place, 3 * place + 3)]
  };
}
