// Draws the robot: its shapes from the server, its joints and its tilt from each state. Plain perspective, far faces first.
'use strict';

const robotView = (() => {
  const canvas = document.getElementById('robot-view'), ink = canvas.getContext('2d');
  const SIDES = 10, DISTANCE_M = 3.2, TILT = 0.18;
  let links = null, faces = [], turn = 0.6, dragged = null;

  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
  const times = (a, b) => {                                  // of two 3 x 4 matrices, by rows
    const c = new Array(12);
    for (let r = 0; r < 3; ++r)
      for (let k = 0; k < 4; ++k)
        c[4 * r + k] = a[4 * r] * b[k] + a[4 * r + 1] * b[4 + k] + a[4 * r + 2] * b[8 + k] + (k === 3 ? a[4 * r + 3] : 0);
    return c;
  };
  const placed = (t, [x, y, z]) => [0, 4, 8].map((r) => t[r] * x + t[r + 1] * y + t[r + 2] * z + t[r + 3]);
  const turned = ([x, y, z], angle) => {                     // Rodrigues' formula
    const c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
    return [c + d * x * x, d * x * y - s * z, d * x * z + s * y, 0, d * x * y + s * z, c + d * y * y, d * y * z - s * x, 0,
      d * x * z - s * y, d * y * z + s * x, c + d * z * z, 0];
  };

  function prism(corners, half) {                            // of a convex outline in xy
    const low = corners.map(([x, y]) => [x, y, -half]), high = corners.map(([x, y]) => [x, y, half]), n = corners.length;
    return [high, low.slice().reverse(), ...corners.map((_, i) => [low[i], low[(i + 1) % n], high[(i + 1) % n], high[i]])];
  }
  function facesOf(shape) {
    const circle = (radius) => Array.from({length: SIDES}, (_, i) => [radius * Math.cos(2 * Math.PI * i / SIDES), radius * Math.sin(2 * Math.PI * i / SIDES)]);
    if (shape.box) {
      const [x, y, z] = shape.box.map((size) => size / 2);
      return prism([[x, y], [-x, y], [-x, -y], [x, -y]], z);
    }
    if (shape.cylinder) return prism(circle(shape.cylinder[0]), shape.cylinder[1] / 2);
    const r = shape.sphere, found = [], rings = 5;
    for (let i = 0; i < rings; ++i) {
      const ring = (k) => circle(r * Math.sin(Math.PI * k / rings)).map(([x, y]) => [x, y, r * Math.cos(Math.PI * k / rings)]);
      const top = ring(i), bottom = ring(i + 1);
      for (let k = 0; k < SIDES; ++k) found.push([top[k], bottom[k], bottom[(k + 1) % SIDES], top[(k + 1) % SIDES]]);
    }
    return found;
  }
  async function load() {
    const answer = await fetch('/robot.json', {cache: 'no-store'});
    if (!answer.ok) return;
    links = await answer.json();
    faces = [];
    links.forEach((link, i) => link.shapes.forEach((shape) => facesOf(shape).forEach((face) => faces.push({link: i, corners: face.map((corner) => placed(shape.at, corner))}))));
  }

  function show(joints, tilt) {
    const {width, height} = canvas;
    ink.clearRect(0, 0, width, height);
    if (!links || !joints) return;
    const [w, x, y, z] = tilt || [1, 0, 0, 0];
    const base = [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 0, 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
      2 * (y * z - w * x), 0, 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), 0];
    const at = [];
    links.forEach((link, i) => {
      const own = link.joint < 0 ? link.at : times(link.at, turned(link.axis, joints[link.joint] || 0));
      at[i] = link.parent < 0 ? base : times(at[link.parent], own);
    });
    // The camera looks at the pelvis from ahead, a little from above; its x is to the right, its y down, its z into the picture.
    const ct = Math.cos(turn), st = Math.sin(turn), ca = Math.cos(TILT), sa = Math.sin(TILT);
    const seen = ([px, py, pz]) => {
      const ahead = -(px * ct + py * st), right = -px * st + py * ct;
      return [right, -(pz * ca + ahead * sa), ahead * ca - pz * sa + DISTANCE_M];
    };
    const scale = height * 1.55;
    const drawn = [];
    let floor = 0;
    for (const {link, corners} of faces) {
      const world = corners.map((corner) => placed(at[link], corner));
      for (const corner of world) floor = Math.min(floor, corner[2]);
      const view = world.map(seen);
      const [a, b, c] = view, u = [0, 1, 2].map((k) => b[k] - a[k]), v = [0, 1, 2].map((k) => c[k] - a[k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const length = Math.hypot(...n) || 1;
      if (n[0] * a[0] + n[1] * a[1] + n[2] * a[2] >= 0) continue;          // it faces away
      const light = Math.max(0, (-0.45 * n[0] - 0.7 * n[1] - 0.55 * n[2]) / length);
      drawn.push({far: view.reduce((sum, corner) => sum + corner[2], 0) / view.length, view, light});
    }
    drawn.sort((one, other) => other.far - one.far);
    const point = ([px, py, pz]) => [width / 2 + scale * px / pz, height * 0.47 + scale * py / pz];
    ink.strokeStyle = '#d5dae1';
    ink.lineWidth = 1;
    for (let k = -3; k <= 3; ++k) {
      for (const [from, to] of [[[-1.2, 0.4 * k, floor], [1.2, 0.4 * k, floor]], [[0.4 * k, -1.2, floor], [0.4 * k, 1.2, floor]]]) {
        ink.beginPath();
        ink.moveTo(...point(seen(from)));
        ink.lineTo(...point(seen(to)));
        ink.stroke();
      }
    }
    for (const {view, light} of drawn) {
      const shade = (low, high) => Math.round(low + (high - low) * light);
      ink.fillStyle = ink.strokeStyle = `rgb(${shade(50, 225)}, ${shade(62, 232)}, ${shade(76, 240)})`;
      ink.beginPath();
      view.forEach((corner, i) => (i === 0 ? ink.moveTo(...point(corner)) : ink.lineTo(...point(corner))));
      ink.closePath();
      ink.fill();
      ink.stroke();
    }
  }
  canvas.addEventListener('pointerdown', (event) => { dragged = event.clientX; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener('pointermove', (event) => { if (dragged !== null) { turn -= 0.01 * (event.clientX - dragged); dragged = event.clientX; } });
  canvas.addEventListener('pointerup', () => { dragged = null; });
  canvas.addEventListener('pointercancel', () => { dragged = null; });
  return {load, show};
})();
