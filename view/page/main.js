// The page: settings, the loop that draws, and the link that restores a view.

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

const by = (id) => document.getElementById(id);
const CURVES = ['shoulder', 'filmic', 'reinhard', 'linear'];

// Ends of the colours of what zones hold: from the 0.5th to the 99.5th percentile, errors and J by
// their logarithms over three decades at most.
function colourScales(tables) {
  const {zones, zoneStride, zoneCount, rows, bands, perBand} = tables;
  const levels = [], errors = [], sources = [];
  for (let z = 0; z < zoneCount; ++z) {
    const at = 4 * zoneStride * z, row = zones[at + 20];
    if (row < 0) continue;
    levels.push(zones[at + 22]);
    errors.push(zones[at + 23]);
    // Where the leaf is near its largest: its functions at the middle of the hull say nothing.
    const point = insidePoint(zones, at);
    let value = 0;
    for (let b = 0; b < bands; ++b) {
      const f = at + 4 * (LIGHT + perBand * b);
      for (const g of [f, f + 4])
        value +=
            zones[g] * point[0] + zones[g + 1] * point[1] + zones[g + 2] * point[2] + zones[g + 3];
      value += rows[4 * (row * bands + b) + 1];
    }
    sources.push(value / bands);
  }
  const range = (values, byLogs) => {
    const kept = values.filter((v) => !byLogs || v > 0).sort((a, b) => a - b);
    if (kept.length === 0) return [0, 1, 0];
    const of = (share) => kept[Math.floor(share * (kept.length - 1))];
    const high = of(0.995), low = byLogs ? Math.max(of(0.005), high / 1000) : of(0.005);
    return high > low ? [low, high, byLogs ? 1 : 0] : [low, low + 1, 0];
  };
  return [[0, 1, 0], range(levels, false), range(errors, true), range(sources, true)];
}

// The point that has the same distance from the four faces of a leaf.
function insidePoint(zones, at) {
  const row = (k) => [0, 1, 2, 3].map((c) => zones[at + 4 * k + c] - (k ? zones[at + c] : 0));
  const [a, b, c] = [row(1), row(2), row(3)];
  const determinant = dot(a, cross(b, c));
  if (determinant === 0) return [0, 0, 0];
  const sum = add(add(scaled(cross(b, c), a[3]), cross(c, a), b[3]), cross(a, b), c[3]);
  return scaled(sum, -1 / determinant);
}

class Page {
  constructor(meta, tables, sources) {
    this.meta = meta;
    this.canvas = by('canvas');
    this.fit();
    this.picture = new Picture(this.canvas, tables, meta, sources);
    this.tables = tables;
    this.scales = colourScales(tables);
    this.view = new View(meta.cameras[meta.camera]);
    this.exposure = 0;
    this.cameraIndex = meta.camera;
    this.controls = new Controls(this.canvas, this.view, meta.diagonal, {
      moved: () => this.moved(),
      pick: (x, y) => this.pick(x, y),
      key: (name) => this.key(name)
    });
    this.fill();
    this.readLink();
    this.listen();
    this.settingsChanged();
  }

  fill() {
    const cameras = this.meta.cameras.map(
        (camera, index) => element(
            'option', {value: index},
            camera.name + (camera.perspective ? '' : ' (in perspective)')));
    by('camera').append(...cameras);
    by('camera').value = this.meta.camera;
    by('curve').value = CURVES[this.meta.curve];
    by('passes').hidden = this.tables.lastMesh === 0;
    by('pass').max = by('pass').value = this.tables.lastMesh;
  }

  listen() {
    by('camera').addEventListener('change', () => this.goTo(Number(by('camera').value)));
    for (const input of by('panel').querySelectorAll('input, select'))
      if (input.id !== 'camera') input.addEventListener('input', () => this.settingsChanged());
    by('panel').addEventListener('submit', (event) => event.preventDefault());
    by('pick').addEventListener('click', () => this.pick(0, 0));
    by('link').addEventListener('click', () => this.copyLink());
    new ResizeObserver(() => {
      if (this.fit()) this.moved();
    }).observe(this.canvas);
    window.addEventListener('hashchange', () => {
      if (location.hash !== this.link()) {
        this.readLink();
        this.settingsChanged();
      }
    });
    this.canvas.addEventListener(
        'webglcontextlost', () => showNotice('The graphics driver gave up. Load the page again.'));
  }

  // The canvas has the pixels of its place; true: other ones than before.
  fit() {
    const {canvas} = this, ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(ratio * canvas.clientWidth));
    const height = Math.max(1, Math.round(ratio * canvas.clientHeight));
    if (canvas.width === width && canvas.height === height) return false;
    canvas.width = width;
    canvas.height = height;
    return true;
  }

  // The settings as the panel has them.
  look() {
    const layers =
        [...by('layers').querySelectorAll('input')].slice(0, 5).map((i) => (i.checked ? 1 : 0));
    const colours = this.clip() ? Number(by('colours').value) : 0;
    return {
      layers,
      medium: by('medium').checked,
      clip: this.clip(),
      colours,
      scale: this.scales[colours],
      white: this.meta.cameras[this.cameraIndex].white / 2 ** this.exposure,
      curve: CURVES.indexOf(by('curve').value),
      edges: by('edges').checked,
      rays: by('smooth').checked && !colours ? MOST_RAYS : 1
    };
  }

  cutPlace() {
    const k = 'xyz'.indexOf(by('cut').value);
    const {hull_min: low, hull_max: high} = this.meta;
    // Never on a face of the hull, nor on round numbers where walls stand.
    const at = Math.min(Math.max(Number(by('cut_at').value), 1e-4), 1 - 1e-4) + 1.37e-5;
    return low[k] + at * (high[k] - low[k]);
  }

  clip() {
    const k = by('cut').value ? 'xyz'.indexOf(by('cut').value) : -1;
    if (k < 0) return null;
    const sign = by('cut_other').checked ? 1 : -1;
    const plane = [0, 0, 0, -sign * this.cutPlace()];
    plane[k] = sign;
    return plane;
  }

  goTo(index) {
    if (!this.meta.cameras[index]) return false;
    this.cameraIndex = index;
    by('camera').value = index;
    this.view.show(this.meta.cameras[index]);
    say(`Camera ${this.meta.cameras[index].name}`);
    this.moved();
    return true;
  }

  key(name) {
    const toggle = (id) => {
      by(id).checked = !by(id).checked;
      this.settingsChanged();
      say(`${by(id).parentElement.textContent.trim()}: ${by(id).checked ? 'on' : 'off'}`);
      return true;
    };
    if (name === 'm') return toggle('medium');
    if (name === 'g') return toggle('edges');
    if (name === 'p') return this.pick(0, 0);
    if ((name === '[' || name === ']') && this.tables.lastMesh > 0) {
      by('pass').value = this.tables.mesh + (name === ']' ? 1 : -1);
      this.settingsChanged();
      say(`Mesh after the pass: ${by('pass_value').textContent}`);
      return true;
    }
    if (name === '+' || name === '-' || name === '=') {
      by('exposure').value = this.exposure + (name === '-' ? -0.5 : 0.5);
      this.settingsChanged();
      say(`Exposure ${this.exposure} stops`);
      return true;
    }
    return /^[1-9]$/.test(name) && this.goTo(Number(name) - 1);
  }

  settingsChanged() {
    this.exposure = Number(by('exposure').value);
    by('exposure_value').textContent = this.exposure;
    const axis = 'xyz'.indexOf(by('cut').value);
    by('cut_value').textContent =
        by('cut').value ? (this.cutPlace() + this.meta.origin[axis]).toFixed(2) : '–';
    this.showMesh(Number(by('pass').value));
    const look = this.look(), [low, high] = look.scale;
    const unit = look.colours > 1 ? ' W/m²/sr' : '';
    by('scale').textContent =
        look.colours ? `Colours: dark blue ${figure(low)} to yellow ${figure(high)}${unit}` : '';
    const shape = JSON.stringify([look.layers, look.medium, look.clip, look.colours, this.tables.mesh]);
    if (shape === this.shape) {
      this.picture.showAgain(look);
      this.wake();
    } else {
      this.moved();
    }
    this.shape = shape;
    this.keepLink();
  }

  showMesh(index) {
    const mesh = this.meta.meshes[index];
    if (!mesh) return;
    const text = `${mesh.passes}: ${mesh.patches} patches, ${mesh.zones} zones`;
    by('pass_value').textContent = text;
    by('pass').setAttribute('aria-valuetext', text);
    if (index === this.tables.mesh) return;
    this.tables.showMesh(index);
    this.picture.uploadMesh(this.tables);
  }

  moved() {
    this.dirty = true;
    this.lastMoved = performance.now();
    this.canvas.dataset.state = 'drawing';
    this.wake();
  }

  wake() {
    if (this.awake) return;
    this.awake = true;
    this.then = performance.now();
    requestAnimationFrame((now) => this.frame(now));
  }

  // One turn of the loop: a step, a coarse picture, or a strip of a fine one.
  frame(now) {
    const seconds = Math.min(0.2, Math.max(0, (now - this.then) / 1000));
    this.then = now;
    if (this.controls.held.size) {
      this.controls.advance(seconds);
      this.dirty = true;
      this.lastMoved = now;
    }
    const look = this.look(), frame = this.view.frame(this.canvas.width, this.canvas.height);
    let more = true;
    if (this.dirty) {
      this.dirty = false;
      this.picture.drawMoving(frame, look);
      this.canvas.dataset.first ||=
          Math.round(performance.now());  // [ms] since the page was asked for
    } else if (now - this.lastMoved > 150) {
      more = this.picture.drawStrip(frame, look);
      if (!this.kept) this.keepLink();
    }
    this.canvas.dataset.state = more ? 'drawing' : 'done';
    if (more || this.controls.held.size) return requestAnimationFrame((next) => this.frame(next));
    this.awake = false;
    this.keepLink();
    return undefined;
  }

  pick(x, y) {
    const look = this.look(), frame = this.view.frame(this.canvas.width, this.canvas.height);
    const found = pick(this.picture, this.meta, frame, x, y, look.clip, look.colours > 0);
    this.picked = found;
    if (!found) {
      by('picked').replaceChildren(element('p', {}, 'Nothing there: the ray leaves the scene.'));
      return true;
    }
    const rows = found.rows.map(
        ([name, value]) =>
            element('tr', {}, element('th', {scope: 'row'}, name), element('td', {}, value)));
    by('picked').replaceChildren(element('table', {}, element('caption', {}, found.what), ...rows));
    return true;
  }

  // All that is set, as the part of the address behind #.
  link() {
    const values = {
      view: this.view.toText(),
      camera: this.cameraIndex,
      exposure: this.exposure,
      curve: by('curve').value,
      layers: this.look().layers.join(''),
      medium: Number(by('medium').checked),
      edges: Number(by('edges').checked),
      smooth: Number(by('smooth').checked)
    };
    if (this.tables.mesh < this.tables.lastMesh) values.pass = this.tables.mesh;
    if (by('cut').value)
      Object.assign(values, {
        cut: by('cut').value,
        at: by('cut_at').value,
        colours: by('colours').value,
        other: Number(by('cut_other').checked)
      });
    return `#${Object.entries(values).map(([key, value]) => `${key}=${value}`).join('&')}`;
  }

  keepLink() {
    this.kept = true;
    try {
      history.replaceState(null, '', this.link());
    } catch {
      // Some browsers forbid it for files; the button still gives the link.
    }
  }

  readLink() {
    const values = new URLSearchParams(location.hash.slice(1));
    const has = (key) => values.has(key);
    const index = Number(values.get('camera'));
    if (has('camera') && this.meta.cameras[index]) this.cameraIndex = index;
    by('camera').value = this.cameraIndex;
    if (has('camera')) this.view.show(this.meta.cameras[this.cameraIndex]);
    if (has('view')) this.view.fromText(values.get('view'));
    if (has('exposure')) by('exposure').value = values.get('exposure');
    if (CURVES.includes(values.get('curve'))) by('curve').value = values.get('curve');
    if (has('layers'))
      [...by('layers').querySelectorAll('input')].slice(0, 5).forEach((input, k) => {
        input.checked = values.get('layers')[k] !== '0';
      });
    if (has('medium')) by('medium').checked = values.get('medium') !== '0';
    if (has('edges')) by('edges').checked = values.get('edges') === '1';
    if (has('smooth')) by('smooth').checked = values.get('smooth') !== '0';
    const pass = Number(values.get('pass'));
    by('pass').value = has('pass') && this.meta.meshes[pass] ? pass : this.tables.lastMesh;
    by('cut').value = ['x', 'y', 'z'].includes(values.get('cut')) ? values.get('cut') : '';
    if (has('at')) by('cut_at').value = values.get('at');
    if (/^[0-3]$/.test(values.get('colours'))) by('colours').value = values.get('colours');
    if (has('other')) by('cut_other').checked = values.get('other') === '1';
  }

  async copyLink() {
    this.keepLink();
    const text = location.href.replace(/#.*/, '') + this.link();
    try {
      await navigator.clipboard.writeText(text);
      say('The link is on the clipboard.');
    } catch {
      say(text);
    }
  }
}

function say(text) {
  by('status').textContent = text;
}

function showNotice(text) {
  by('notice').hidden = false;
  by('notice').replaceChildren(
      element('h2', {}, 'There is no picture'), element('p', {}, text),
      element(
          'p', {},
          'The picture needs WebGL2 with floating-point pictures: a browser of 2022 or ' +
              'newer, with its hardware acceleration switched on. What was solved stands in the ',
          element('a', {href: '#report'}, 'report'),
          ' below; tyndall render makes pictures without a browser.'));
  for (const input of by('panel').elements) input.disabled = true;
}

async function begin() {
  const meta = JSON.parse(by('meta').textContent);
  const testing = location.hash === '#selftest';
  try {
    const tables = new Tables(meta, await unpackArrays(meta, by('arrays').textContent));
    const sources = Object.fromEntries(
        ['walk_vert', 'walk_frag', 'display_frag'].map((id) => [id, by(id).textContent]));
    if (testing) {
      const picture = new Picture(by('canvas'), tables, meta, sources);
      const results = meta.cameras.map((camera) => selfTest(picture, meta, camera));
      if (tables.lastMesh > 0) {
        tables.showMesh(0);
        picture.uploadMesh(tables);
        results.push({...selfTest(picture, meta, meta.cameras[0]), mesh: meta.meshes[0].passes});
      }
      document.body.append(element('pre', {id: 'selftest'}, JSON.stringify(results)));
      return;
    }
    window.tyndall = new Page(meta, tables, sources);  // for tests, and for the curious
  } catch (error) {
    showNotice(error.message);
    if (testing)
      document.body.append(
          element('pre', {id: 'selftest'}, JSON.stringify({error: error.message})));
  }
}

begin();
