// The live page: shows what the server says of the robot, and says what fingers do. It decides nothing: the server and
// the robot's controller judge every message.
'use strict';

const CHANNELS = [
  ['vx_m_s', 'forwards', 'm/s'], ['vy_m_s', 'left', 'm/s'], ['omega_rad_s', 'turn', 'rad/s'],
  ['pitch_rad', 'bend', 'rad'], ['roll_rad', 'lean', 'rad'], ['height_m', 'height', 'm']];
const HELD_MS = 33, IDLE_MS = 200;        // between messages
const HOLD_MS = 1000;                     // of a button that moves the robot

// ---- the connection: what is held counts no longer when it, or the page, is away -------------------------------------
const connection = new Connection({hear: show, lost: release});
const cameraView = new CameraView($('camera'), $('camera'));
let number = 0, presses = 0;
// A phone that slept has a clock that stood still, and a connection that may be dead: begin anew.
document.addEventListener('visibilitychange', () => {
  release();
  if (!document.hidden) connection.open();
});
window.addEventListener('blur', release);
window.addEventListener('pagehide', release);
function stop() {
  connection.stop();
  release();
  header();
}
wireStop(stop);

// ---- sticks: hold to drive ------------------------------------------------------------------------------------------
const sticks = [
  {element: $('main-stick'), pointer: null, x: 0, y: 0, flat: false},
  {element: $('side-stick'), pointer: null, x: 0, y: 0, flat: true}];

function draw(stick) {
  const reach = stick.element.clientWidth / 2 - 30;
  stick.element.querySelector('.knob').style.transform = `translate(${stick.x * reach}px, ${stick.y * reach}px)`;
}
function release() {
  for (const stick of sticks) {
    stick.pointer = null;
    stick.x = stick.y = 0;
    draw(stick);
  }
  tell();
}
function push(stick, event) {
  const reach = stick.element.clientWidth / 2;
  let x = (event.clientX - stick.fromX) / reach, y = stick.flat ? 0 : (event.clientY - stick.fromY) / reach;
  const r = Math.hypot(x, y);
  if (r > 1) { x /= r; y /= r; }
  stick.x = x;
  stick.y = y;
  draw(stick);
}
for (const stick of sticks) {
  const {element} = stick;
  element.addEventListener('pointerdown', (event) => {
    event.preventDefault();
    if (stick.pointer !== null) return;
    const first = sticks.every((one) => one.pointer === null);
    stick.pointer = event.pointerId;
    stick.fromX = event.clientX;
    stick.fromY = event.clientY;
    element.setPointerCapture(event.pointerId);
    if (first) presses += 1;
    tell();
  });
  element.addEventListener('pointermove', (event) => { if (event.pointerId === stick.pointer) push(stick, event); });
  const end = (event) => {
    if (event.pointerId !== stick.pointer) return;
    stick.pointer = null;
    stick.x = stick.y = 0;
    draw(stick);
    tell();
  };
  for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) element.addEventListener(name, end);
  element.addEventListener('contextmenu', (event) => event.preventDefault());
}
let toldAt = 0;
function tell() {
  toldAt = performance.now();
  if (!connection.state || !connection.state.you.paired) return;
  const unit = (value) => Math.max(-1, Math.min(1, value)) || 0;
  connection.say(JSON.stringify({
    n: ++number, t: performance.now(), held: sticks.some((stick) => stick.pointer !== null), press: presses,
    forwards: unit(-sticks[0].y), turn: unit(-sticks[0].x), left: unit(-sticks[1].x)}));
}
setInterval(() => {
  const held = sticks.some((stick) => stick.pointer !== null);
  if (performance.now() - toldAt >= (held ? 0 : IDLE_MS)) tell();
}, HELD_MS);

// ---- buttons that are held ------------------------------------------------------------------------------------------
for (const button of document.querySelectorAll('button.hold')) {
  let timer = 0;
  const end = () => { clearTimeout(timer); timer = 0; button.classList.remove('pressed'); };
  const begin = () => {
    if (timer) return;
    button.classList.add('pressed');
    timer = setTimeout(() => { end(); connection.say(JSON.stringify({request: button.dataset.request})); }, HOLD_MS);
  };
  button.addEventListener('pointerdown', (event) => { event.preventDefault(); begin(); });
  for (const name of ['pointerup', 'pointercancel', 'pointerleave', 'blur']) button.addEventListener(name, end);
  button.addEventListener('keydown', (event) => { if ((event.key === 'Enter' || event.key === ' ') && !event.repeat) begin(); });
  button.addEventListener('keyup', end);
  button.addEventListener('contextmenu', (event) => event.preventDefault());
}

// ---- what is shown --------------------------------------------------------------------------------------------------
function row(body, cells) {
  const line = document.createElement('tr');
  cells.forEach((text, i) => {
    const cell = document.createElement(i === 0 ? 'th' : 'td');
    cell.textContent = text;
    line.append(cell);
  });
  body.append(line);
}
/// With a sign, unless it is shown as zero.
const fixed = (value, digits = 2) => {
  if (typeof value !== 'number') return '–';
  const size = Math.abs(value).toFixed(digits);
  return (Number(size) === 0 ? '' : value < 0 ? '−' : '+') + size;
};

function header() {
  connection.showHeader();
  document.body.classList.toggle('stale', connection.isLost());
  document.body.classList.toggle('silent', Boolean(connection.state) && !connection.state.heard);
}
setInterval(header, 200);

let drawnBundle = null, drawnSession = null, wasPaired = '';
function show(state) {
  const {news} = state, {paired} = state.you;
  if (paired && paired !== wasPaired) tell();
  wasPaired = paired;
  document.body.classList.toggle('reader', !paired);
  $('text').textContent = (state.text || (state.you.drives ? 'you drive' : 'it is driven')) + (state.limited ? '; ' + state.limited : '');
  $('note').textContent = state.you.note;
  $('note').hidden = !state.you.note;
  $('fault').textContent = news ? news.fault : '';
  $('fault').hidden = !news || !news.fault;
  sticks[0].element.classList.toggle('drives', state.you.drives);
  sticks[1].element.classList.toggle('drives', state.you.drives);
  showChannels(state);
  showFacts(state);
  if (news && news.info && (news.info.bundle !== drawnBundle || news.session !== drawnSession)) {
    drawnBundle = news.info.bundle;
    drawnSession = news.session;
    robotView.load().catch(() => {});
  }
  robotView.show(state.joints, state.tilt);
  cameraView.hear(state.camera, connection.late_ms);
  header();
}
function showChannels(state) {
  const body = $('channels');
  body.textContent = '';
  CHANNELS.forEach(([name, label, unit], i) => {
    const of = (group) => state.news && state.news[group] ? state.news[group][name] : undefined;
    row(body, [`${label} ${unit}`, fixed(state.asked ? state.asked[i] : undefined), fixed(of('command')), fixed(of('optimised')),
      fixed(state.measured ? state.measured[i] : undefined)]);
  });
  keep(state.asked ? state.asked[0] : undefined, state.news && state.news.command ? state.news.command.vx_m_s : undefined,
    state.measured ? state.measured[0] : undefined);
}
function showFacts(state) {
  const body = $('facts'), news = state.news;
  body.textContent = '';
  if (!news) return;
  const age = news.command_age_s < 0 ? 'no command yet' : `last command ${news.command_age_s.toFixed(2)} s ago`;
  row(body, ['driven by', `${news.driving_source || 'nobody'}, ${age}`]);
  row(body, ['fault', news.fault || 'none']);
  row(body, ['limited', state.limits]);
  if (news.foot_load) row(body, ['feet carry', `left ${(100 * news.foot_load[0]).toFixed(0)} %, right ${(100 * news.foot_load[1]).toFixed(0)} %`]);
  if (news.hottest) row(body, ['hottest', `${news.hottest.temperature_degC.toFixed(0)} °C at ${news.hottest.joint}`]);
  for (const line of state.arms || []) row(body, [line.slice(0, 14).trim(), line.slice(14)]);
  if (news.timing) {
    const t = news.timing;
    row(body, ['tick', `p50 ${t.tick_p50_us.toFixed(0)} µs, p99 ${t.tick_p99_us.toFixed(0)} µs; ${t.missed_ticks} missed`]);
    row(body, ['wake-up', `p50 ${t.wake_p50_us.toFixed(0)} µs, p99 ${t.wake_p99_us.toFixed(0)} µs`]);
  }
  row(body, ['real-time', news.realtime ? 'granted' : 'NOT granted']);
  if (news.messages) {
    const ignored = Object.entries(news.messages).filter(([name, count]) => name !== 'accepted' && count > 0)
      .map(([name, count]) => `${count} ${name.replaceAll('_', ' ')}`);
    row(body, ['messages', [`${news.messages.accepted} accepted`, ...ignored].join(', ')]);
  }
  if (news.info) {
    row(body, ['policy', `${news.info.policy}, backend ${news.info.backend}`]);
    row(body, ['software', `${news.info.software}, bundle ${news.info.bundle.slice(0, 12)}`]);
    for (const text of news.info.refused) row(body, ['refused', text]);
  }
}

// ---- the last seconds of the forward velocity -----------------------------------------------------------------------
const KEPT_S = 20, past = [];
function keep(asked, taken, measured) {
  const now = performance.now() / 1000;
  past.push([now, asked, taken, measured]);
  while (past.length && past[0][0] < now - KEPT_S) past.shift();
  const canvas = $('tracking'), ink = canvas.getContext('2d'), {clientWidth: width, clientHeight: height} = canvas;
  const LEFT = 34, scale = window.devicePixelRatio || 1;   // of the curves: numbers stand to the left of them
  canvas.width = Math.round(scale * width);                // it is empty now
  canvas.height = Math.round(scale * height);
  ink.scale(scale, scale);
  const values = past.flatMap(([, ...rest]) => rest).filter((value) => typeof value === 'number');
  const top = Math.max(0.5, ...values), bottom = Math.min(-0.2, ...values);
  const y = (value) => height - 6 - (height - 12) * (value - bottom) / (top - bottom);
  ink.strokeStyle = '#d5dae1';
  ink.lineWidth = 1;
  ink.beginPath();
  ink.moveTo(LEFT, y(0));
  ink.lineTo(width, y(0));
  ink.stroke();
  ink.fillStyle = '#55606c';
  ink.font = '12px system-ui, sans-serif';
  ink.textAlign = 'right';
  ink.textBaseline = 'middle';
  for (const value of [top, 0, bottom]) ink.fillText(fixed(value, 1), LEFT - 4, Math.max(8, Math.min(height - 8, y(value))));
  ink.lineWidth = 2;
  ['#7d8894', '#00558a', '#d55e00'].forEach((colour, k) => {
    ink.strokeStyle = colour;
    ink.beginPath();
    let down = false;
    for (const point of past) {
      const value = point[k + 1];
      if (typeof value !== 'number') { down = false; continue; }
      const x = width - (width - LEFT) * (now - point[0]) / KEPT_S;
      if (down) ink.lineTo(x, y(value)); else ink.moveTo(x, y(value));
      down = true;
    }
    ink.stroke();
  });
}

connection.open();
