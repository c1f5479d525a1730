/* Where the body is looked at from: turned about z and the horizontal, with some perspective. */

class Camera {
  constructor(low, high) {
    this.center = low.map((l, i) => (l + high[i]) / 2);
    this.radius = Math.hypot(...low.map((l, i) => high[i] - l)) / 2 || 1;
    this.box = [low, high];
    this.reset();
  }

  reset() {
    this.yaw = -0.6, this.pitch = 0.3, this.zoom = 1, this.pan = [0, 0];
    this.tall = this.wide = 0;
    const look = { axes: this.axes(), center: this.center, pan: [0, 0], distance: 4.5 * this.radius, focus: 1 };
    for (let k = 0; k < 8; k++) {
      const [x, y] = project(look, this.box[k & 1][0], this.box[k >> 1 & 1][1], this.box[k >> 2][2]);
      this.wide = Math.max(this.wide, Math.abs(x)), this.tall = Math.max(this.tall, Math.abs(y));
    }
  }

  turn(right, up) {
    this.yaw += right;
    this.pitch = Math.max(-1.57, Math.min(1.57, this.pitch + up));
  }

  scale(factor) { this.zoom = Math.max(0.2, Math.min(50, this.zoom * factor)); }

  /* Rows: right, up and towards the eye, z being up. */
  axes() {
    const [c, s, p, q] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    return [c, s, 0, -q * s, q * c, p, p * s, -p * c, q];
  }

  /* To the plane of the picture: x and y are `focus` at its half height, z is the distance. */
  look(width, height) {
    const distance = 4.5 * this.radius;
    const focus = 0.85 * this.zoom * Math.min(1 / this.tall, width / height / this.wide);
    return { axes: this.axes(), center: this.center, pan: this.pan.map((p) => p * this.radius), distance, focus,
             aspect: width / height, near: distance - 1.2 * this.radius, far: distance + 1.2 * this.radius };
  }
}

/* A point as the camera sees it: x and y from -1 to 1 across a square of the picture's height, and
   its distance. */
function project(look, x, y, z) {
  const a = look.axes, dx = x - look.center[0], dy = y - look.center[1], dz = z - look.center[2];
  const right = a[0] * dx + a[1] * dy + a[2] * dz + look.pan[0];
  const up = a[3] * dx + a[4] * dy + a[5] * dz + look.pan[1];
  const away = look.distance - (a[6] * dx + a[7] * dy + a[8] * dz);
  return [look.focus * right / away, look.focus * up / away, away];
}
