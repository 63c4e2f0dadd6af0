// What camera.js promises, with a browser of our own whose clock and server this test moves.
// Usage: node camera_test.mjs; exit codes: 0 passed, 1 not
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {fileURLToPath} from 'node:url';
import {test} from 'node:test';
import vm from 'node:vm';

const source = fs.readFileSync(fileURLToPath(new URL('../../src/live_page/camera.js', import.meta.url)), 'utf8');
const settled = () => new Promise((resolve) => setImmediate(resolve));

/// A browser that shows the camera. asked: answers that the server still owes, each {come, fail}.
class Browser {
  constructor() {
    Object.assign(this, {now: 10000, asked: [], texts: [], drawn: 0, timers: [], given: 0});
    const ink = {drawImage: () => { this.drawn += 1; this.texts = []; }, fillRect() {}, fillText: (text) => { this.texts.push(text); }};
    this.canvas = {width: 640, height: 480, hidden: true, getContext: () => ink};
    const context = vm.createContext({
      canvas: this.canvas, performance: {now: () => this.now}, AbortSignal: {timeout: (ms) => ({ms})}, createImageBitmap: async (blob) => blob,
      setInterval: (call, ms) => this.timers.push(call),
      fetch: (path, {signal}) => new Promise((come, fail) => {
        assert.equal(path, '/camera.jpg');
        this.asked.push({fail, signal, come: (ok = true) => come({ok, blob: async () => `picture ${++this.given}`})});
      })});
    this.view = vm.runInContext(source + '\nnew CameraView(canvas, canvas)', context);
  }
  hears(number, age_s = 0, late_ms = 0) { this.view.hear({number, age_s}, late_ms); }
  async gets() { this.asked.shift().come(); await settled(); }
  passes(ms) { this.now += ms; for (const call of this.timers) call(); }
}

test('it is hidden where the server shows no camera, and says so where no picture has come', () => {
  const browser = new Browser();
  browser.view.hear(undefined);
  assert.equal(browser.canvas.hidden, true);
  browser.view.hear({});
  browser.passes(100);
  assert.equal(browser.canvas.hidden, false);
  assert.deepEqual(browser.texts, ['no picture']);
  assert.equal(browser.asked.length, 0);
});

test('a fresh picture has no mark, and one that has stopped is marked with its age', async () => {
  const browser = new Browser();
  browser.hears(1, 0.05);
  await browser.gets();
  browser.passes(100);
  assert.deepEqual(browser.texts, []);
  browser.passes(400);
  assert.deepEqual(browser.texts, ['OLD PICTURE: 0.6 s']);
  for (let k = 0; k < 10; ++k) { browser.passes(100); browser.hears(1, 0.65 + 0.1 * k); }  // states come, pictures don't
  assert.deepEqual(browser.texts, ['OLD PICTURE: 1.6 s']);
  assert.equal(browser.asked.length, 0, 'a picture that it has is not asked for again');
});

test('a picture that arrives late is as old as it is', async () => {
  const browser = new Browser();
  browser.hears(1, 0.3);
  browser.passes(400);
  await browser.gets();
  assert.match(browser.view.words(), /OLD PICTURE: 0.7 s/);
});

test('a picture of which a late state tells is as much older', async () => {
  const browser = new Browser();
  browser.hears(1, 0.1, 450);
  await browser.gets();
  browser.passes(100);
  assert.deepEqual(browser.texts, ['OLD PICTURE: 0.7 s']);   // 0.65
});

test('a slow browser has one picture on its way, whatever comes meanwhile, and then gets the newest', async () => {
  const browser = new Browser();
  for (let k = 1; k <= 600; ++k) { browser.hears(k); browser.passes(100); }
  assert.equal(browser.asked.length, 1);
  await browser.gets();
  browser.hears(601);
  assert.equal(browser.asked.length, 1);
  await browser.gets();
  assert.equal(browser.view.picture, 'picture 2');
  assert.equal(browser.view.words(), '');
});

test('a picture that never comes is given up, and the next is asked for', async () => {
  const browser = new Browser();
  browser.hears(1);
  await browser.gets();
  browser.hears(2);
  assert.equal(browser.asked[0].signal.ms, 2000);
  browser.asked.shift().fail(new Error('timeout'));
  await settled();
  browser.passes(2000);
  assert.match(browser.texts[0], /OLD PICTURE: 2.0 s/);
  browser.hears(3);
  assert.equal(browser.asked.length, 1);
  browser.asked[0].come(false);
  await settled();
  assert.equal(browser.view.picture, 'picture 1', 'an error is no picture');
});

test('of another robot nothing is shown until its own picture comes', async () => {
  const browser = new Browser();
  browser.hears(1);
  await browser.gets();
  browser.hears(2);
  browser.view.hear({});
  await browser.gets();                                      // it was on its way
  browser.passes(100);
  assert.deepEqual(browser.texts, ['no picture']);
});

test('a headset takes the canvas anew when it has changed', async () => {
  const browser = new Browser();
  browser.view.takePainted();
  assert.equal(browser.view.takePainted(), false);
  browser.passes(100);
  assert.equal(browser.view.takePainted(), true);
});
