// The headset's page: tells where head and controllers are and what is pressed, and shows why the robot doesn't move. It
// decides nothing: the server judges every message.
'use strict';

const SEND_MS = 15, HOLD_MS = 1000, PULLED = 0.7;

// Entering VR may close the connection, and it comes back.
const cameraView = new CameraView($('camera'), $('camera'));
const connection = new Connection({hear: (state) => { cameraView.hear(state.camera, connection.late_ms); show(); }, lost: () => {}});
function stop() { connection.stop(); show(); }
wireStop(stop);

// ---- what is told ---------------------------------------------------------------------------------------------------
const hand = () => ({pose: null, leads: false, presses: 0, backs: 0, grip: false, wasLeading: false, pulledAt: 0, standAt: 0, stick: false, stopped: false});
const hands = {left: hand(), right: hand()};
const counts = {n: 0, presses: 0, recentres: 0, spans: 0, uprights: 0};
let session = null, space = null, head = null, held = false, toldAt = 0;

const pose = (found) => {
  if (!found || found.emulatedPosition) return null;       // a guessed place is none
  const {position: p, orientation: q} = found.transform;
  return [p.x, p.y, p.z, q.x, q.y, q.z, q.w].map((value) => Math.round(value * 1e6) / 1e6);
};
function look(frame) {
  head = pose(frame.getViewerPose(space));
  let anyGrip = false;
  for (const side of ['left', 'right']) hands[side].pose = null;
  for (const source of session.inputSources) {
    const own = hands[source.handedness];
    if (!own || !source.gamepad || !source.gripSpace) continue;
    own.pose = pose(frame.getPose(source.gripSpace, space));
    const down = (i) => Boolean(source.gamepad.buttons[i] && source.gamepad.buttons[i].pressed);
    own.leads = down(0);
    if (own.leads && !own.wasLeading) own.presses += 1;
    own.wasLeading = own.leads;
    own.grip = down(1);
    anyGrip = anyGrip || own.grip;
    if (down(3) && !own.stick) source.handedness === 'right' ? counts.recentres += 1 : counts.spans += 1;
    own.stick = down(3);
    if (down(5) && !own.stopped) stop();
    own.stopped = down(5);
    own.standAt = heldFor(down(4) && !held, own.standAt, () => connection.say('{"request":"stand"}'));
    own.pulledAt = heldFor((source.gamepad.axes[3] || 0) > PULLED, own.pulledAt, () => { held ? own.backs += 1 : counts.uprights += 1; });
  }
  if (anyGrip && !held) counts.presses += 1;
  held = anyGrip;
}
/// Calls once when it has been down for a second. Returns what to pass next time.
function heldFor(down, since, call) {
  if (!down) return 0;
  if (since === 0) return performance.now();
  if (since > 0 && performance.now() - since >= HOLD_MS) { call(); return -1; }
  return since;
}
function tell(shown) {
  if (!connection.state || !connection.state.you.paired) return;
  toldAt = performance.now();
  const part = ({pose: place, leads, presses, backs}) => ({pose: place, leads, presses, backs});
  connection.say(JSON.stringify({
    vr: ++counts.n, t: performance.now(), shown, head, left: part(hands.left), right: part(hands.right), held,
    presses: counts.presses, recentres: counts.recentres, spans: counts.spans, uprights: counts.uprights}));
}
function letGo() {
  head = null;
  held = false;
  for (const own of Object.values(hands)) { own.pose = null; own.leads = false; }
  tell(false);
}

// ---- the session ----------------------------------------------------------------------------------------------------
let gl = null, program = null;
async function enter() {
  const canvas = document.createElement('canvas');
  gl = canvas.getContext('webgl', {xrCompatible: true, alpha: false});
  session = await navigator.xr.requestSession('immersive-vr', {requiredFeatures: ['local-floor']});
  await gl.makeXRCompatible();
  session.updateRenderState({baseLayer: new XRWebGLLayer(session, gl)});
  space = await session.requestReferenceSpace('local-floor');
  space.addEventListener('reset', () => { counts.recentres += 1; });      // the system's own: everything is elsewhere now
  session.addEventListener('visibilitychange', () => { if (session && session.visibilityState !== 'visible') letGo(); });
  session.addEventListener('end', () => { letGo(); session = null; });
  prepare();
  session.requestAnimationFrame(onFrame);
}
function onFrame(time, frame) {
  if (!session) return;
  session.requestAnimationFrame(onFrame);
  const shown = session.visibilityState === 'visible';
  if (shown) look(frame); else { head = null; held = false; }
  if (performance.now() - toldAt >= SEND_MS) tell(shown);
  paint(frame);
}
document.addEventListener('visibilitychange', () => { if (document.hidden && session) letGo(); });
$('enter').addEventListener('click', () => enter().catch((error) => { $('support').textContent = String(error.message || error); }));
if (navigator.xr) {
  navigator.xr.isSessionSupported('immersive-vr').then((has) => {
    $('enter').disabled = !has;
    $('support').textContent = has ? '' : 'this browser has no headset';
  });
} else {
  $('support').textContent = 'this browser has no WebXR';
}

// ---- what is seen: a panel ahead with mode, reason and measured motion ----------------------------------------------
const panel = $('panel').getContext('2d');
let panelPainted = true;
function show() {
  const {state} = connection, news = state && state.news, alarm = connection.alarm(), lost = connection.isLost();
  connection.showHeader();
  const doing = state ? state.text || (state.you.drives ? 'you drive' : 'it is driven') : '';
  $('text').textContent = doing;
  const note = state ? state.you.note : '';
  $('note').textContent = note;
  $('note').hidden = !note;
  const lines = [[`${(state && state.robot) || 'no robot'}: ${connection.mode()}`, '#ffffff', 64]];
  if (alarm) lines.push([alarm, '#ff8a65', 36]);
  if (!lost && !state.you.paired) lines.push([connection.words(), '#ff8a65', 36]);
  if (news && news.fault && !doing.includes(news.fault)) lines.push([`fault: ${news.fault}`, '#ff8a65', 36]);
  if (state) lines.push([doing, '#ffffff', 36]);
  if (note) lines.push([note, '#ffcc80', 36]);
  if (state && state.asked) {
    const of = (values, i) => values ? values[i].toFixed(2) : '–';
    lines.push([`forwards ${of(state.asked, 0)} m/s (does ${of(state.measured, 0)}), turn ${of(state.asked, 2)} rad/s`, '#b0d4f1', 34]);
  }
  for (const line of (state && state.arms) || []) lines.push([line, '#b0d4f1', 30]);
  panel.fillStyle = lost ? '#5a1a10' : '#14202c';
  panel.fillRect(0, 0, PANEL.width, PANEL.height);
  panel.drawImage($('robot-view'), PANEL.width - PANEL.robot, PANEL.height - PANEL.robot, PANEL.robot, PANEL.robot);
  panelPainted = true;
  let placed = wrapped(lines, 1);
  for (let scale = 0.95; placed.at(-1).y > PANEL.height - PANEL.margin && scale > 0.4; scale -= 0.05) placed = wrapped(lines, scale);
  for (const {text, colour, size, y} of placed) {
    panel.fillStyle = colour;
    panel.font = fontOf(size);
    panel.fillText(text, PANEL.margin, y);
  }
}
const PANEL = {width: 1024, height: 512, robot: 400, margin: 24};
const fontOf = (size) => `${size}px system-ui, sans-serif`;
/// (lines, scale of their letters) => the same with as many words in a line as fit beside the robot, each with its place.
function wrapped(lines, scale) {
  const placed = [];
  let y = PANEL.margin;
  for (const [text, colour, fullSize] of lines) {
    const size = fullSize * scale;
    panel.font = fontOf(size);
    for (let rest = text.split(/ +/); rest.length > 0;) {
      y += size * 1.25;
      const width = PANEL.width - 2 * PANEL.margin - (y > PANEL.height - PANEL.robot ? PANEL.robot : 0);
      let count = rest.length;
      while (count > 1 && panel.measureText(rest.slice(0, count).join(' ')).width > width) count -= 1;
      placed.push({text: rest.splice(0, count).join(' '), colour, size, y});
    }
  }
  return placed;
}
let drawnBundle = null;
setInterval(() => {                                        // drawing the robot takes a good part of a frame: five times a second
  const {state} = connection;
  if (state && state.joints && state.news.info && state.news.info.bundle !== drawnBundle) {
    drawnBundle = state.news.info.bundle;
    robotView.load().catch(() => {});
  }
  if (state) robotView.show(state.joints, state.tilt);
  show();
}, 200);

// Where they hang in the room [m]; with the camera's picture ahead, the panel is below it.
const AHEAD_M = 1.8;
const panelSurface = {canvas: $('panel'), width: 1.6, height: 0.8, up: () => surfaces().length > 1 ? 0.75 : 1.35, texture: null};
const cameraSurface = {canvas: $('camera'), width: 1.2, height: 0.9, up: () => 1.65, texture: null};
const surfaces = () => connection.state && connection.state.camera ? [panelSurface, cameraSurface] : [panelSurface];
function corners({width: w, height: h, up}) {
  const u = up(), a = AHEAD_M;
  return new Float32Array([-w / 2, u - h / 2, -a, 0, 1, w / 2, u - h / 2, -a, 1, 1, -w / 2, u + h / 2, -a, 0, 0, w / 2, u + h / 2, -a, 1, 0]);
}
function prepare() {
  const compile = (kind, text) => { const one = gl.createShader(kind); gl.shaderSource(one, text); gl.compileShader(one); return one; };
  program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER,
    'attribute vec3 at; attribute vec2 uv; uniform mat4 view, lens; varying vec2 on; void main() { on = uv; gl_Position = lens * view * vec4(at, 1.0); }'));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER,
    'precision mediump float; varying vec2 on; uniform sampler2D panel; void main() { gl_FragColor = texture2D(panel, on); }'));
  gl.linkProgram(program);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  for (const surface of [panelSurface, cameraSurface]) {
    surface.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, surface.texture);
    for (const [what, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, what, value);
  }
}
function paint(frame) {
  const layer = session.renderState.baseLayer, viewer = frame.getViewerPose(space);
  gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
  gl.clearColor(0.35, 0.4, 0.45, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  if (!viewer) return;
  gl.useProgram(program);
  for (const surface of surfaces()) {
    gl.bindTexture(gl.TEXTURE_2D, surface.texture);
    if (surface === panelSurface ? panelPainted : cameraView.takePainted())
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, surface.canvas);
    gl.bufferData(gl.ARRAY_BUFFER, corners(surface), gl.DYNAMIC_DRAW);
    for (const [name, size, offset] of [['at', 3, 0], ['uv', 2, 12]]) {
      const place = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 20, offset);
    }
    for (const view of viewer.views) {
      const port = layer.getViewport(view);
      gl.viewport(port.x, port.y, port.width, port.height);
      gl.uniformMatrix4fv(gl.getUniformLocation(program, 'view'), false, view.transform.inverse.matrix);
      gl.uniformMatrix4fv(gl.getUniformLocation(program, 'lens'), false, view.projectionMatrix);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }
  panelPainted = false;
}

connection.open();
