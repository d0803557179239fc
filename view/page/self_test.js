// #selftest: every pixel of a small picture by the GPU against the walk in double precision; the
// outcome stands in the page, for tests. Relative to the pixel's own radiance, but no less than a
// thousandth of the mean.

function selfTest(picture, meta, camera) {
  const width = 96, height = 72, bands = meta.bands;
  const look = {layers: [1, 1, 1, 1, 1], medium: true, clip: null, colours: 0, scale: [0, 1, 0]};
  const frame = new View(camera).frame(width, height);
  const target = picture.target('test', width, height);
  picture.draw(target, frame, look);
  const gpu = picture.read(target), cpu = new Float64Array(3 * width * height);
  const inside = picture.isInside(frame.eye),
        start = inside ? picture.walker.zoneAt(frame.eye) : -1;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const d = rayOf(frame, 2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1);
      const t = inside ? 0 : entryDistance(frame.eye, d, meta.hull_min, meta.hull_max);
      const rope = inside || t < 0 ?
          start :
          picture.walker.zoneAt(add(frame.eye, d, t + 1e-7 * picture.meta.diagonal));
      const sum = picture.walker.radiance(frame.eye, d, rope, t, look.layers, true);
      const mean = sum.reduce((a, b) => a + b, 0) / bands;
      for (let c = 0; c < 3; ++c) cpu[3 * (y * width + x) + c] = bands === 3 ? sum[c] : mean;
    }
  const mean = cpu.reduce((a, b) => a + b, 0) / cpu.length;
  let worst = 0, place = 0, squares = 0;
  cpu.forEach((value, k) => {
    const pixel = Math.floor(k / 3), seen = gpu[4 * pixel + k % 3];
    // Of the pixel's brightest channel: what a grazing ray is off by has the colour of what jumps.
    const brightest = Math.max(...cpu.slice(3 * pixel, 3 * pixel + 3));
    const error = Math.abs(seen - value) / Math.max(brightest, 1e-3 * mean, 1e-30);
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
    rms: Math.sqrt(squares / cpu.length),
    worst_at: [place % width, Math.floor(place / width)],
    gpu: [...gpu.subarray(4 * place, 4 * place + 3)],
    cpu: [...cpu.subarray(3 * place, 3 * place + 3)]
  };
}
