// A phone, a laptop and an emulated Quest 3 (IWER) in headless Chromium drive a simulated robot through pmg_controller and pmg_web.
// Usage: node browser_test.mjs FOLDER_OF_PROGRAMS FOLDER_OF_PACKAGES; exit codes: 0 passed, 1 not, 77 no Chromium
import assert from 'node:assert/strict';
import {spawn, spawnSync} from 'node:child_process';
import dgram from 'node:dgram';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';

const [programs, packages] = process.argv.slice(2);
const chromium = '/usr/bin/chromium';
if (!fs.existsSync(chromium)) { console.error('no chromium: scripts/setup --slow'); process.exit(77); }
const {chromium: launcher} = createRequire(path.join(packages, 'package.json'))('playwright-core');
const iwer = fs.readFileSync(path.join(packages, 'node_modules/iwer/build/iwer.min.js'), 'utf8');

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pmg_browser_test_'));
const port = 20000 + process.pid % 20000, url = `udpm://239.255.76.67:${port}?ttl=0`;
const children = [];
const program = (name) => path.join(programs, name);
const common = ['--folder', path.join(folder, 'web')];
function start(name, ...args) {
  const child = spawn(program(name), args, {cwd: folder, stdio: 'ignore'});
  children.push(child);
  return child;
}
/// Asks it to end, and waits until it has.
async function ended(child) {
  if (child.exitCode !== null || child.signalCode !== null) return;
  const exit = new Promise((resolve) => child.once('exit', resolve));
  child.kill('SIGCONT');
  child.kill('SIGTERM');
  await exit;
}
/// Calls heard(time [ms], vx [m/s]) for each COMMAND on the network.
function hearCommands(heard) {
  const socket = dgram.createSocket({type: 'udp4', reuseAddr: true});
  socket.on('message', (bytes) => {
    const end = bytes.indexOf(0, 8);                       // magic, number, channel
    if (bytes.toString('latin1', 8, end) !== 'COMMAND') return;
    let at = end + 1 + 8 + 4;                              // fingerprint, version
    const passText = () => { at += 4 + bytes.readInt32BE(at); };
    passText();                                            // robot
    at += 8;                                               // stamp
    passText();                                            // source
    heard(Date.now(), bytes.readDoubleBE(at + 8 + 8 + 8)); // session, sequence, lease
  });
  socket.bind(port, () => socket.addMembership('239.255.76.67'));
  return socket;
}
/// A camera whose pictures say which they are by their colour. sentAs: one of CAMERA's datagrams on the network, for its type.
class ColouredCamera {
  static STEP = 20;
  static colours = Array.from({length: 144}, (_, k) => [10 + ColouredCamera.STEP * (k % 12), 10 + ColouredCamera.STEP * Math.floor(k / 12), 250]);
  /// page: any that can make JPEGs.
  static async of(page, sentAs) {
    const jpegs = await page.evaluate((colours) => Promise.all(colours.map(async (rgb) => {
      const canvas = Object.assign(document.createElement('canvas'), {width: 320, height: 240}), ink = canvas.getContext('2d');
      ink.fillStyle = `rgb(${rgb})`;
      ink.fillRect(0, 0, 320, 240);
      return canvas.toDataURL('image/jpeg', 0.95).split(',')[1];
    })), ColouredCamera.colours);
    const begin = 8 + 'CAMERA'.length + 1;
    return Object.assign(new ColouredCamera(), {jpegs: jpegs.map((text) => Buffer.from(text, 'base64')), type: sentAs.subarray(begin, begin + 8),
      taken: [], socket: dgram.createSocket('udp4').unref(), session: BigInt(Date.now())});
  }
  /// Takes a picture now, and sends it so much later.
  take(late_ms) {
    const number = this.taken.push(Date.now()) - 1, jpeg = this.jpegs[number % this.jpegs.length];
    const int = (bytes, value) => { const out = Buffer.alloc(bytes); bytes === 8 ? out.writeBigInt64BE(BigInt(value)) : out.writeInt32BE(value); return out; };
    const message = Buffer.concat([Buffer.from('LC02'), int(4, number), Buffer.from('CAMERA\0'), this.type, int(8, BigInt(this.taken[number]) * 1000000n),
      int(4, 3), Buffer.from('z1\0'), int(8, this.session), int(8, number + 1), int(4, jpeg.length), jpeg]);
    setTimeout(() => this.socket.send(message, port, '239.255.76.67'), late_ms);
  }
  /// Ten pictures a second until the condition holds.
  async until(what, condition, late_ms = 0) {
    const timer = setInterval(() => this.take(late_ms), 100);
    try { await until(what, condition); } finally { clearInterval(timer); }
  }
  /// (what was seen, when) => the age [ms] of this picture; nothing: it is marked as old, or none.
  age_ms([red, green, blue], now) {
    if (blue < 200) return undefined;
    const near = (value) => Math.round((value - 10) / ColouredCamera.STEP), colour = near(red) + 12 * near(green);
    return now - this.taken.findLast((time, number) => number % this.jpegs.length === colour && time <= now);
  }
}
/// Resolves with the first datagram of this channel.
const firstOf = (channel) => new Promise((resolve) => {
  const socket = dgram.createSocket({type: 'udp4', reuseAddr: true});
  socket.on('message', (bytes) => {
    if (bytes.toString('latin1', 8, bytes.indexOf(0, 8)) === channel) { socket.close(); resolve(bytes); }
  });
  socket.bind(port, () => socket.addMembership('239.255.76.67'));
});
/// What a person could not read on this page, one line each: text that runs out of the window, is small, lies on other text, or is
/// hardly darker than its ground (WCAG 2's contrast: 4.5, large text 3; what is disabled is exempt).
const unreadable = (page) => page.evaluate((wide) => {
  const SMALL_PX = 9, complaints = [], texts = [];
  const luminance = (rgb) => rgb.map((value) => value / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + [0.2126, 0.7152, 0.0722][i] * v, 0);
  const colour = (text) => text.match(/[\d.]+/g).map(Number);
  const ground = (element) => {
    for (let e = element; e; e = e.parentElement) {
      const [r, g, b, alpha = 1] = colour(getComputedStyle(e).backgroundColor);
      if (alpha > 0) return [r, g, b];
    }
    return [255, 255, 255];
  };
  for (const element of document.body.querySelectorAll('*')) {
    const own = [...element.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
    if (!own.length || element.tagName === 'SCRIPT' || !element.checkVisibility()) continue;
    const style = getComputedStyle(element), size_px = parseFloat(style.fontSize), name = `"${own[0].data.trim()}"`;
    const rects = own.flatMap((node) => { const range = document.createRange(); range.selectNode(node); return [...range.getClientRects()]; });
    texts.push({element, name, rects});
    if (rects.some(({left, right}) => left < 0 || right > wide)) complaints.push(`${name} runs out of the window`);
    if (size_px < SMALL_PX) complaints.push(`${name} has ${size_px} px`);
    const [light, dark] = [luminance(colour(style.color).slice(0, 3)), luminance(ground(element))].sort((a, b) => b - a);
    const contrast = (light + 0.05) / (dark + 0.05), large = size_px >= 24 || (size_px >= 18.66 && Number(style.fontWeight) >= 700);
    if (!element.matches(':disabled') && contrast < (large ? 3 : 4.5)) complaints.push(`${name} has a contrast of ${contrast.toFixed(1)}`);
  }
  for (const [i, one] of texts.entries())
    for (const other of texts.slice(i + 1))
      if (one.rects.some((a) => other.rects.some((b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3)))
        complaints.push(`${one.name} lies on ${other.name}`);
  if (document.documentElement.scrollWidth > wide) complaints.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  for (const [canvas, [size_px, text]] of smallest) if (canvas.checkVisibility() && size_px < SMALL_PX) complaints.push(`"${text}" in ${canvas.id} has ${size_px} px`);
  return complaints;
}, page.viewportSize().width);
/// Before a page's own scripts: notes the smallest text in each of its canvases.
const noteTexts = () => {
  window.smallest = new Map();                             // canvas => [height in the window, px; text]
  const {fillText} = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...where) {
    const {canvas} = this, size_px = parseFloat(this.font.match(/[\d.]+px/)[0]) * this.getTransform().a * canvas.clientWidth / canvas.width;
    if (canvas.clientWidth && !(smallest.get(canvas)?.[0] <= size_px)) smallest.set(canvas, [size_px, text]);
    return fillText.call(this, text, ...where);
  };
};
/// Those of these elements that can't be seen without scrolling.
const below = (page, ...selectors) => page.evaluate((all) => all.filter((one) => {
  const {top, bottom, height} = document.querySelector(one).getBoundingClientRect();
  return height === 0 || top < 0 || bottom > innerHeight;
}), selectors);
/// Nearest rank.
const percentile = (values, percent) => values.toSorted((a, b) => a - b)[Math.ceil(values.length * percent / 100) - 1];
let tellMore = async () => '';
async function until(what, condition, seconds = 60) {
  const end = Date.now() + 1000 * seconds;
  while (Date.now() < end) {
    if (await condition()) return;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  console.error(await tellMore());
  assert.fail(`after ${seconds} s not: ${what}`);
}
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const step = (text) => console.log(`- ${text}`);

async function run(browser, token, robot) {
  const link = `https://localhost:${port}`;
  const open = async (options, place) => {
    const context = await browser.newContext({ignoreHTTPSErrors: true, ...options});
    const page = await context.newPage();
    page.on('pageerror', (error) => { console.error(error); process.exitCode = 1; });
    await page.addInitScript(noteTexts);
    if (place.startsWith('/vr')) await page.addInitScript(iwer);
    if (place.startsWith('/vr')) {
      await page.addInitScript(() => {
        window.quest = new IWER.XRDevice(IWER.metaQuest3);
        quest.installRuntime({forceInstall: true});
        window.tracked = () => {  // IWER calls every place of a controller guessed, as a lost one's is
          for (const source of session.inputSources)
            for (const key of Object.getOwnPropertySymbols(source.gripSpace))
              if (source.gripSpace[key] && 'emulated' in source.gripSpace[key]) source.gripSpace[key].emulated = false;
        };
      });
    }
    await page.goto(link + place);
    pages.push(page);
    return page;
  };
  const mode = (page) => page.textContent('#mode');
  const is = (page, wanted) => until(`mode ${wanted}`, async () => (await mode(page)) === wanted);
  const pages = [];
  tellMore = async () => JSON.stringify(await Promise.all(pages.map((page) => page.evaluate(() => (({news, text, you, asked, arms}) => ({mode: news.mode, text, you, asked, arms}))(connection.state)))), null, 1);
  const asked = (page, i) => page.evaluate((k) => connection.state.asked[k], i);

  step('a page without a token shows the robot, and nothing to press');
  const reader = await open({viewport: {width: 1366, height: 768}}, '/');
  await is(reader, 'passive');
  assert.equal(await reader.isVisible('#main-stick'), false);
  assert.equal(await reader.isDisabled('#stop'), true);

  step('a phone stands the robot up and walks it by a finger on the stick');
  const phone = await open({viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true}, '/#' + token);
  await until('paired', async () => (await phone.textContent('#link')) === 'paired as phone');
  assert.equal(new URL(phone.url()).hash, '', 'the token is not left in the address');
  const press = async (page, selector) => { await page.hover(selector); await page.mouse.down(); await pause(1200); await page.mouse.up(); };
  const stand = async () => {
    await until('stands', async () => {
      if ((await phone.textContent('#text')).startsWith('stands;')) return true;
      // A browser that the computer held up may have seen the button let go too early.
      if (/passive|damping/.test(await mode(phone))) { await press(phone, 'button[data-request=stand]'); await pause(300); }
      return false;
    });
  };
  await stand();
  const box = await phone.locator('#main-stick').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  // A browser that the computer held up for 0.3 s has let go, as it must: then the finger touches anew.
  const push = async () => {
    if (await phone.evaluate(() => connection.state.you.drives)) return;
    await phone.mouse.up();
    await phone.mouse.move(x, y);
    await phone.mouse.down();
    await pause(300);
    await phone.mouse.move(x, y - 90, {steps: 5});
    await pause(1000);
  };
  const walks = async () => { await push(); return (await mode(phone)) === 'walk' && phone.evaluate(() => connection.state.measured && connection.state.measured[0] > 0.3); };
  await until('it walks', walks);

  step('a second page is told who drives, and stops the robot');
  const laptop = await open({viewport: {width: 1366, height: 650}}, '/#' + token);  // of 768 px, a browser's bars have the others
  await until('the note', async () => { await push(); return (await laptop.textContent('#note')) === 'phone drives the robot'; });

  step('a phone and a laptop show what they have readably, and what an operator needs without scrolling');
  const curves = (page) => page.evaluate(() => {
    const canvas = $('tracking'), {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height), found = new Set();
    for (let i = 0; i < data.length; i += 4) found.add(`${data[i]} ${data[i + 1]} ${data[i + 2]}`);
    return ['125 136 148', '0 85 138', '213 94 0'].filter((colour) => found.has(colour)).length;
  });
  // Of a robot that walks on as it is asked, what is taken hides what is asked: the finger begins anew.
  for (const page of [phone, laptop]) await until('three curves', async () => { if ((await curves(page)) === 3) return true; await phone.mouse.up(); await pause(300); await push(); return false; });
  for (const [page, ...first] of [[phone, '#stop', '#main-stick', '.modes'], [laptop, '#stop', '#main-stick', '.modes', '#camera', '#robot-view', '#tracking']]) {
    assert.deepEqual(await unreadable(page), []);
    assert.deepEqual(await below(page, ...first), []);
    assert.doesNotMatch(await page.textContent('#channels'), /[+−]0\.00/, 'zero has no sign');
  }
  assert.deepEqual(await unreadable(reader), []);
  await reader.setViewportSize({width: 1000, height: 768});
  assert.deepEqual(await unreadable(reader), []);
  await reader.setViewportSize({width: 1366, height: 768});
  await laptop.keyboard.press('Escape');
  await is(phone, 'damping');
  await phone.mouse.up();

  step('a page that is hidden lets go');
  await until('a damped robot lies, and the page says the way up', async () => /lies .*Lift on the page lifts it, then Stand/.test(await phone.textContent('#text')));
  await until('the hoist lifts', async () => {
    if ((await phone.textContent('#text')).includes('hoist')) return true;
    await press(phone, 'button[data-request=lift]');
    await pause(300);
    return false;
  });
  await until('it is lifted', async () => (await phone.textContent('#text')).startsWith('hangs on the hoist: Stand'));
  await stand();
  await until('it walks', walks);
  await phone.evaluate(() => window.dispatchEvent(new Event('blur')));
  await until('velocity zero', async () => (await asked(phone, 0)) === 0);
  await phone.mouse.up();
  await is(phone, 'stand');

  step('a headset drives by a step, and leads a palm by a trigger');
  const vr = await open({viewport: {width: 390, height: 844}}, '/vr#' + token);
  await until('paired', async () => (await vr.textContent('#link')) === 'paired as phone');
  assert.deepEqual(await unreadable(vr), []);
  await vr.setViewportSize({width: 320, height: 240});
  await vr.click('#enter');
  await until('a session', () => vr.evaluate(() => Boolean(session) && head !== null));
  await vr.evaluate(() => { tracked(); quest.controllers.right.position.set(0.25, 1.2, -0.4); });
  const button = (name, value) => vr.evaluate(([n, v]) => quest.controllers.right.updateButtonValue(n, v), [name, value]);
  const move = async (from, to) => {
    for (let i = 1; i <= 25; ++i) {
      await vr.evaluate((z) => { quest.controllers.right.position.z += z - quest.position.z; quest.position.z = z; }, from + (to - from) * i / 25);
      await pause(20);
    }
  };
  const rightArm = () => vr.evaluate(() => connection.state.arms[1]);
  let ahead_m = 0;
  const to = async (there_m) => { await move(-ahead_m, -there_m); ahead_m = there_m; };
  const drive = async (seconds = 60) => {
    await until('it drives', async () => {
      if ((await vr.evaluate(() => connection.state.you.drives)) && (await asked(vr, 0)) > 0.1 && (await mode(vr)) === 'walk') return true;
      await vr.evaluate(() => tracked());
      await to(0);
      for (const [name, value] of [['trigger', 0], ['squeeze', 0], ['thumbstick', 1], ['thumbstick', 0], ['squeeze', 1]]) {
        await button(name, value);  // centred: a new connection has its centre where the head was
        await pause(250);
      }
      await to(0.25);
      await pause(1500);
      return false;
    }, seconds);
  };
  await until('the palm is led', async () => {
    await drive();
    await button('trigger', 0);
    await pause(300);
    await button('trigger', 1);
    await pause(500);
    for (let i = 0; i < 15; ++i) { await vr.evaluate(() => { quest.controllers.right.position.y += 0.01; }); await pause(20); }
    await pause(500);
    return /at its target|on the way/.test(await rightArm());
  });

  step('poses reach the network (times are reported, not judged)');
  const commands = [];                                     // [time, vx]
  const listener = hearCommands((time, vx) => commands.push([time, vx]));
  /// [time] of each of ten steps of the head, to and fro, that the page told.
  const steps = () => vr.evaluate(() => new Promise((resolve) => {
    const told = [], {say} = connection, from_m = quest.position.z;
    let last = null, count = 0;
    connection.say = (text) => {
      const {head} = JSON.parse(text);
      if (head && last !== null && Math.abs(head[2] - last) > 0.02) told.push(Date.now());
      if (head) last = head[2];
      return say.call(connection, text);
    };
    const timer = setInterval(() => {
      if (++count <= 10) { quest.position.z = from_m + (count % 2 ? 0.05 + 0.0002 * count : 0); return; }
      clearInterval(timer);
      connection.say = say;
      resolve(told);
    }, 250);
  }));
  const delays_ms = [], WANTED = 100;
  await until(`${WANTED} steps of the head are seen in commands`, async () => {
    await drive(300);                                      // a browser that the computer held up for 0.3 s has let go, as it must
    const told = await steps();
    await pause(250);
    told.forEach((time, k) => {
      const within = commands.filter(([at]) => at >= time && at < (told[k + 1] ?? time + 250));
      const before = commands.findLast(([at]) => at < time)?.[1], kept = within.at(-1)?.[1];
      // It has arrived with the first command whose velocity is the one that the head then keeps asking for.
      if (before === undefined || !kept || Math.abs(kept - before) < 1e-6) return;
      delays_ms.push(within.find(([, vx]) => Math.abs(vx - kept) < 1e-9)[0] - time);
    });
    return delays_ms.length >= WANTED;
  }, 300);
  listener.close();
  step(`pose to LCM: p50 ${percentile(delays_ms, 50)} ms, p99 ${percentile(delays_ms, 99)} ms over ${delays_ms.length} steps of the head`);

  step('a lost controller holds its palm and nothing else');
  await vr.evaluate(() => { quest.controllers.right.connected = false; });
  await until('the palm stays', async () => /stays where it is/.test(await rightArm()));
  await vr.evaluate(() => { quest.controllers.right.connected = true; });
  await button('squeeze', 0);
  await button('trigger', 0);
  await is(vr, 'stand');

  const stays = async (why) => {
    await is(vr, 'stand');
    await pause(1000);
    assert.equal(await mode(vr), 'stand', `${why}: what is still squeezed doesn't count`);
    assert.equal(await asked(vr, 0), 0, why);
  };
  step('blur holds');
  await drive();
  await vr.evaluate(() => quest.updateVisibilityState('visible-blurred'));
  await until('velocity zero', async () => (await asked(vr, 0)) === 0);
  await vr.evaluate(() => quest.updateVisibilityState('visible'));
  await stays('blur');

  step('a socket that drops and comes back holds');
  await drive();
  await vr.evaluate(() => connection.socket.close());
  await until('the socket is back', () => vr.evaluate(() => connection.isOpen()));
  await stays('socket');

  step('the stop button in the hand stops');
  await drive();
  await button('b-button', 1);
  await is(vr, 'damping');

  step('a pairing that is revoked ends at once');
  spawnSync(program('pmg_web'), ['revoke', 'phone', ...common]);
  for (const page of [phone, vr])
    await until('not paired', async () => (await page.textContent('#link')).includes('this token is not taken'), 20);

  step('a page shows what the head sees, and marks a picture that has stopped');
  assert.equal(await reader.evaluate(() => cameraView.words()), 'no picture');
  await ended(robot);
  const seeing = start('pmg_controller', '--hal', 'sil', '--robot', 'z1', '--no-log', '--camera', '--lcm-url', url);
  // How fresh they are is the computer's affair here; what counts as fresh: camera_test.mjs.
  const shown = () => reader.evaluate(() => cameraView.number);
  const more = async () => { const before = await shown(); await until('newer pictures', async () => (await shown()) > (before ?? 0) + 2); };
  await more();
  assert.equal(await reader.isVisible('#camera'), true);
  assert.deepEqual(await reader.evaluate(async () => {
    const picture = await createImageBitmap(await (await fetch('/camera.jpg')).blob());
    return [picture.width, picture.height];
  }), [320, 240]);
  seeing.kill('SIGSTOP');
  await until('it is marked', async () => /^OLD PICTURE: ([3-9]|\d\d)/.test(await reader.evaluate(() => cameraView.words())));
  const opacity = (selector) => reader.evaluate((one) => {
    let product = 1;
    for (let e = document.querySelector(one); e; e = e.parentElement) product *= Number(getComputedStyle(e).opacity);
    return product;
  }, selector);
  for (const selector of ['#state', '#robot-view']) await until(`${selector} of a silent robot is grey`, async () => (await opacity(selector)) < 0.6);
  assert.equal(await opacity('#camera'), 1, 'its own mark stays readable');
  assert.deepEqual(await unreadable(reader), []);
  seeing.kill('SIGCONT');
  await more();

  step('no picture without a mark is old, on a page and in a headset, whatever is late');
  const camera = await ColouredCamera.of(reader, await firstOf('CAMERA'));
  await ended(seeing);
  for (const page of [reader, vr]) await until('its last picture is marked', () => page.evaluate(() => cameraView.words() !== ''));
  start('pmg_controller', '--hal', 'sil', '--robot', 'z1', '--no-log', '--lcm-url', url);
  for (const page of [reader, vr]) {
    await page.evaluate(() => {
      // Where no words stand: a quarter from the left, a fifth from above.
      const {canvas, ink, draw} = cameraView, at = [canvas.width / 4, canvas.height / 5];
      const onCanvas = () => [...ink.getImageData(...at, 1, 1).data].slice(0, 3);
      window.seen = [];                                    // [time, colour]
      window.inHeadset = [];                               // [colour on the canvas, colour before an eye]
      cameraView.draw = () => { draw.call(cameraView); seen.push([Date.now(), onCanvas()]); };
      if (!window.paint) return;
      const times = (m, v) => [0, 1, 2, 3].map((i) => m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2] + m[12 + i] * v[3]);
      const {paint} = window;
      window.paint = (frame) => {
        paint(frame);
        if (!connection.state.camera) return;
        const viewer = frame.getViewerPose(space);
        if (!viewer) return;
        const [view] = viewer.views, port = session.renderState.baseLayer.getViewport(view), {width, height, up} = cameraSurface;
        const [x, y, , w] = times(view.projectionMatrix, times(view.transform.inverse.matrix, [-width / 4, up() + 0.3 * height, -AHEAD_M, 1]));
        const eye = new Uint8Array(4);
        gl.readPixels(port.x + (x / w + 1) / 2 * port.width, port.y + (y / w + 1) / 2 * port.height, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, eye);
        inHeadset.push([onCanvas(), [...eye].slice(0, 3)]);
      };
    });
  }
  // A mark comes after half a second; the fastest way of a picture and of a state is counted as none.
  const MOST_MS = 500 + 200;
  const judged = async (page) => {
    const [seen, inHeadset] = await page.evaluate(() => [window.seen.splice(0), window.inHeadset.splice(0)]);
    const ages_ms = seen.map(([time, colour]) => camera.age_ms(colour, time)), unmarked_ms = ages_ms.filter((age_ms) => age_ms !== undefined);
    for (const age_ms of unmarked_ms) assert.ok(age_ms <= MOST_MS, `a picture of ${age_ms} ms has no mark`);
    for (const [shown, before] of inHeadset) assert.ok(shown.every((value, i) => Math.abs(value - before[i]) < 16), `${shown} is ${before} in the headset`);
    return {fresh: unmarked_ms.length, marked: ages_ms.length - unmarked_ms.length, frames: inHeadset.length};
  };
  for (const page of [reader, vr]) {
    const sum = {fresh: 0, marked: 0, frames: 0};
    const count = async () => { for (const [what, number] of Object.entries(await judged(page))) sum[what] += number; return sum; };
    await judged(page);
    await camera.until('fresh pictures', async () => (await count()).fresh >= 20);
    Object.assign(sum, {fresh: 0, marked: 0});
    await camera.until('pictures that come late', async () => (await count()).fresh + sum.marked >= 40, 400);
    sum.marked = 0;
    await until('the last one is marked', async () => (await count()).marked >= 10);
    await page.evaluate(() => {                            // states travel 1.5 s from now on
      const {socket} = connection, {onmessage} = socket;
      socket.onmessage = (event) => setTimeout(() => onmessage(event), 1500);
    });
    Object.assign(sum, {fresh: 0, marked: 0});
    await camera.until('pictures of which late states tell', async () => (await count()).fresh + sum.marked >= 40);
    sum.marked = 0;
    await until('the last one is marked', async () => (await count()).marked >= 30);
    assert.equal(await page.textContent('#link'), 'no connection');
    assert.equal(page === vr, sum.frames > 0);
  }
}

let failed = null;
try {
  const paired = spawnSync(program('pmg_web'), ['pair', 'phone', '--port', String(port), ...common], {encoding: 'utf8'});
  const token = /localhost:\d+\/#(\w+)/.exec(paired.stdout)[1];
  const robot = start('pmg_controller', '--hal', 'sil', '--robot', 'z1', '--no-log', '--lcm-url', url);
  start('pmg_web', '--camera', '--port', String(port), '--lcm-url', url, ...common);
  const browser = await launcher.launch({executablePath: chromium, args: ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic',
    '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync']});
  try { await run(browser, token, robot); } finally { await browser.close(); }
} catch (error) {
  failed = error;
} finally {
  await Promise.all(children.map(ended));
  fs.rmSync(folder, {recursive: true, force: true});
}
if (failed) { console.error(failed); process.exitCode = 1; }
