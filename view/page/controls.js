// Keys, mouse and fingers: what they do to the view.

const STEP_KEYS = {
  w: [1, 0, 0],
  s: [-1, 0, 0],
  d: [0, 1, 0],
  a: [0, -1, 0],
  e: [0, 0, 1],
  q: [0, 0, -1]
};
const TURN_KEYS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1]
};

class Controls {
  // on.moved(): the view is another; on.pick(x, y): in −1 … 1; on.key(name): any other key, true
  // where it meant something.
  constructor(canvas, view, diagonal, on) {
    Object.assign(this, {canvas, view, on, pace: diagonal / 8, held: new Set(), fast: false});
    this.pointers = new Map();
    canvas.addEventListener('keydown', (event) => this.keyDown(event));
    canvas.addEventListener('keyup', (event) => this.held.delete(this.name(event)));
    canvas.addEventListener('blur', () => this.held.clear());
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    canvas.addEventListener('pointerup', (event) => this.up(event));
    canvas.addEventListener('pointercancel', (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
  }

  name(event) {
    return event.key.length === 1 ? event.key.toLowerCase() : event.key;
  }

  keyDown(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const name = this.name(event);
    this.fast = event.shiftKey;
    if (STEP_KEYS[name] || TURN_KEYS[name]) {
      // A tap is a step, whatever the frames take.
      if (!this.held.has(name)) this.advance(0.05, [name]);
      this.held.add(name);
      this.on.moved();
    } else if (!this.on.key(name)) {
      return;
    }
    event.preventDefault();
  }

  // What the keys that are held do in so many seconds.
  advance(seconds, names = this.held) {
    const way = this.pace * seconds * (this.fast ? 4 : 1);
    for (const name of names) {
      if (STEP_KEYS[name]) this.view.move(...scaled(STEP_KEYS[name], way));
      if (TURN_KEYS[name]) this.view.turn(...TURN_KEYS[name].map((v) => 1.2 * v * seconds));
    }
  }

  down(event) {
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, {x: event.clientX, y: event.clientY, moved: 0});
  }

  drag(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (!pointer) return;
    const dx = event.clientX - pointer.x, dy = event.clientY - pointer.y;
    const spread = () => {
      const [a, b] = [...this.pointers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    const before = this.pointers.size === 2 ? spread() : 0;
    pointer.x = event.clientX;
    pointer.y = event.clientY;
    pointer.moved += Math.abs(dx) + Math.abs(dy);
    if (pointer.moved < 4) return;
    const part = 1 / this.canvas.clientHeight;
    if (this.pointers.size === 2) {
      const way = 0.5 * this.pace * part;
      this.view.move(12 * way * (spread() - before), -4 * way * dx, 4 * way * dy);
    } else {
      this.view.turn(-2 * this.view.halfY * part * dx, 2 * this.view.halfY * part * dy);
    }
    this.on.moved();
  }

  up(event) {
    const pointer = this.pointers.get(event.pointerId);
    this.pointers.delete(event.pointerId);
    if (!pointer || pointer.moved >= 4) return;
    const box = this.canvas.getBoundingClientRect();
    this.on.pick(
        2 * (event.clientX - box.left) / box.width - 1,
        1 - 2 * (event.clientY - box.top) / box.height);
  }

  wheel(event) {
    event.preventDefault();
    this.view.move(-0.1 * this.pace * Math.sign(event.deltaY), 0, 0);
    this.on.moved();
  }
}
