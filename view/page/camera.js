// Where the eye stands and looks: from there to rays. Lengths count from the origin of the arrays.

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const scaled = (a, s) => [s * a[0], s * a[1], s * a[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross =
    (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => scaled(a, 1 / Math.hypot(...a));

const STEEPEST = 1.55;  // [rad]: straight up and down the picture would have no upright

class View {
  constructor(camera) {
    this.show(camera);
  }

  // A camera of the scene: { eye, forward, up, half_x, half_y }, up its own upright.
  show(camera) {
    this.eye = [...camera.eye];
    this.upright = unit(camera.up);
    this.forward = unit(camera.forward);
    this.halfX = camera.half_x;
    this.halfY = camera.half_y;
  }

  turn(yaw, pitch) {
    const side = unit(cross(this.forward, this.upright));
    const level = cross(this.upright, side);
    const height = Math.atan2(dot(this.forward, this.upright), dot(this.forward, level)) + pitch;
    const steep = Math.min(Math.max(height, -STEEPEST), STEEPEST);
    const ahead = add(scaled(level, Math.cos(yaw)), side, Math.sin(yaw));
    this.forward = unit(add(scaled(ahead, Math.cos(steep)), this.upright, Math.sin(steep)));
  }

  // Steps ahead, to the right and up [m].
  move(ahead, right, up) {
    const side = unit(cross(this.forward, this.upright));
    this.eye = add(add(add(this.eye, this.forward, ahead), side, right), this.upright, up);
  }

  // The frame of a picture of that shape: all that the camera sees is seen, and more at two sides.
  frame(width, height) {
    const side = unit(cross(this.forward, this.upright));
    const shape = width / height, own = this.halfX / this.halfY;
    const halfX = shape > own ? this.halfY * shape : this.halfX;
    return {
      eye: this.eye,
      forward: this.forward,
      right: scaled(side, halfX),
      up: scaled(cross(side, this.forward), halfX / shape)
    };
  }

  toText() {
    return [...this.eye, ...this.forward, ...this.upright, this.halfX, this.halfY]
        .map((v) => Number(v.toFixed(6)))
        .join(',');
  }

  // False: it is no such text.
  fromText(text) {
    const n = String(text).split(',').map(Number);
    if (n.length !== 11 || !n.every(Number.isFinite)) return false;
    const [forward, up] = [n.slice(3, 6), n.slice(6, 9)];
    if (!(Math.hypot(...cross(forward, up)) > 1e-6 && n[9] > 0 && n[10] > 0)) return false;
    this.show({eye: n.slice(0, 3), forward, up, half_x: n[9], half_y: n[10]});
    return true;
  }
}

// The ray through (x, y) of a frame, -1 to 1 to the right and up.
function rayOf(frame, x, y) {
  return unit(add(add(frame.forward, frame.right, x), frame.up, y));
}

// Where a ray from outside enters a box; 0 inside, -1: it misses.
function entryDistance(eye, d, low, high) {
  let near = -FAR, far = FAR;
  for (let k = 0; k < 3; ++k) {
    const a = (low[k] - eye[k]) / d[k], b = (high[k] - eye[k]) / d[k];
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near > far || far < 0 ? -1 : Math.max(0, near);
}
