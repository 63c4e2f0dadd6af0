// What connection.js promises, with a browser of our own whose clock this test moves.
// Usage: node connection_test.mjs; exit codes: 0 passed, 1 not
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {fileURLToPath} from 'node:url';
import {test} from 'node:test';
import vm from 'node:vm';

const source = fs.readFileSync(fileURLToPath(new URL('../../src/live_page/connection.js', import.meta.url)), 'utf8');

/// A browser with one page. sockets: all that the page opened.
class Browser {
  constructor(hash, kept = '') {
    this.now = 1000;
    this.timers = [];
    this.sockets = [];
    this.answers = {ok: true};                           // the server gives out pages
    this.storage = {'pmg.token': kept};
    this.elements = {};
    const browser = this;
    class WebSocket {
      static OPEN = 1;
      constructor(url, protocols) { Object.assign(this, {url, protocols, readyState: 0, bufferedAmount: 0, sent: []}); browser.sockets.push(this); }
      send(text) { assert.equal(this.readyState, 1, 'sent to a socket that is not open'); this.sent.push(text); }
      close() { if (this.readyState < 3) { this.readyState = 3; this.onclose(); } }
    }
    const element = () => ({textContent: '', className: '', disabled: false, hidden: false, listeners: {},
      classList: {add() {}, remove() {}}, addEventListener(name, call) { this.listeners[name] = call; }});
    const document = {...element(), getElementById: (id) => (this.elements[id] ??= element())};
    this.document = document;
    this.context = vm.createContext({
      WebSocket, document, location: {host: 'robot:8443', hash, pathname: '/'}, history: {replaceState: (_, __, path) => { this.address = path; }},
      localStorage: {getItem: (key) => this.storage[key], setItem: (key, value) => { this.storage[key] = value; }},
      fetch: () => this.answers ? Promise.resolve(this.answers) : Promise.reject(new Error('no network')),
      performance: {now: () => this.now}, Date: {now: () => this.now},
      setTimeout: (call, ms) => this.timers.push({at: this.now + ms, call}), heard: 0, lostTimes: 0});
    vm.runInContext(source + '\nconst connection = new Connection({hear: () => { heard += 1; }, lost: () => { lostTimes += 1; }});', this.context);
    this.connection = vm.runInContext('connection', this.context);
    this.connection.open();
  }
  get socket() { return this.sockets.at(-1); }
  opens() { this.socket.readyState = 1; this.socket.onopen(); }
  /// late_ms: how long the state travelled; its server's clock has a zero of its own.
  hears(paired = 'phone', late_ms = 0) { this.socket.onmessage({data: JSON.stringify({at_s: 77 + (this.now - late_ms) / 1000, heard: true, robot: 'z1', news: {mode: 'stand'}, you: {paired}})}); }
  async passes(ms) {
    await new Promise((resolve) => setImmediate(resolve));   // what is promised comes first
    this.now += ms;
    for (let due; (due = this.timers.find(({at}) => at <= this.now)); due.call()) this.timers.splice(this.timers.indexOf(due), 1);
  }
  async dropsAndIsBackAfter(ms) { this.socket.close(); await this.passes(ms); this.opens(); }
  async isRefused() { this.socket.close(); await this.passes(500); }
}
const paired = () => { const browser = new Browser('#secret'); browser.opens(); browser.hears(); return browser; };

test('the token is kept, taken out of the address and told to the server', () => {
  const browser = new Browser('#secret');
  assert.deepEqual([...browser.socket.protocols], ['pmg', 'pmg.token.secret']);
  assert.equal(browser.address, '/');
  assert.equal(browser.storage['pmg.token'], 'secret');
  assert.deepEqual([...new Browser('', 'secret').socket.protocols], ['pmg', 'pmg.token.secret']);
  assert.deepEqual([...new Browser('').socket.protocols], ['pmg']);
});

test('a stop goes out at once, whatever waits in the browser, where all else is left out', () => {
  const browser = paired();
  browser.socket.bufferedAmount = 5000;
  assert.equal(browser.connection.say('old'), false);
  browser.connection.stop();
  assert.deepEqual(browser.socket.sent, ['stop']);
});

test('a stop without a connection is sent when it is back within ten seconds, and said until then', async () => {
  const browser = paired();
  browser.socket.close();
  browser.connection.stop();
  assert.match(browser.connection.alarm(), /THE STOP IS NOT SENT: no connection/);
  await browser.passes(9000);
  browser.opens();
  assert.deepEqual(browser.socket.sent, ['stop']);
  browser.hears();
  assert.equal(browser.connection.alarm(), '');
});

test('a stop of more than ten seconds ago is not sent, and is said', async () => {
  const browser = paired();
  browser.socket.close();
  browser.connection.stop();
  await browser.dropsAndIsBackAfter(10000);
  browser.hears();
  assert.deepEqual(browser.socket.sent, []);
  assert.match(browser.connection.alarm(), /NOT SENT in time: press it again/);
});

test('a stop that is pressed again counts from the last press', async () => {
  const browser = paired();
  browser.socket.close();
  browser.connection.stop();
  await browser.passes(9000);
  browser.connection.stop();
  await browser.passes(9000);
  browser.opens();
  assert.deepEqual(browser.socket.sent, ['stop']);
});

test('a stop into a connection that is dead without knowing it is sent again by the next', async () => {
  const browser = paired();
  browser.connection.stop();
  browser.socket.bufferedAmount = 10;
  browser.hears();
  assert.notEqual(browser.connection.stopAt, 0, 'it lies in the browser still');
  await browser.dropsAndIsBackAfter(3000);
  assert.deepEqual(browser.socket.sent, ['stop']);
  browser.hears();
  browser.connection.open();
  browser.opens();
  assert.deepEqual(browser.socket.sent, [], 'once it is heard it is over');
});

test('after two refusals the token is tried no more, the page looks, and says so', async () => {
  const browser = paired();
  browser.socket.close();                                // revoked
  await browser.passes(500);
  await browser.isRefused();
  assert.equal(browser.socket.protocols.length, 2);
  await browser.isRefused();
  assert.equal(browser.socket.protocols.length, 1, 'without the token');
  browser.opens();
  browser.hears('');
  assert.match(browser.connection.words(), /token is not taken/);
  const tried = browser.sockets.length;
  browser.connection.stop();
  assert.deepEqual(browser.socket.sent, [], 'a page that only looks stops nothing');
  assert.match(browser.connection.alarm(), /THE STOP IS NOT SENT: this page is not paired/);
  await browser.passes(60000);
  browser.hears('');
  assert.equal(browser.sockets.length, tried);
  assert.equal(browser.connection.alarm(), '');
});

test('a server that is away is no refusal', async () => {
  const browser = paired();
  for (const answer of [null, {ok: false}]) {
    browser.answers = answer;
    for (let k = 0; k < 5; ++k) await browser.isRefused();
    assert.equal(browser.socket.protocols.length, 2);
  }
});

test('two refusals count in a row alone', async () => {
  const browser = paired();
  browser.socket.close();
  await browser.passes(500);
  for (let k = 0; k < 3; ++k) {
    await browser.isRefused();
    browser.opens();
    browser.socket.close();
    await browser.passes(500);
  }
  assert.equal(browser.socket.protocols.length, 2);
});

test('a state that travelled for more than a second is no connection, and no proof that a stop went out', async () => {
  const browser = paired(), {connection} = browser;
  await browser.passes(10000);
  browser.hears('phone', 400);
  assert.ok(Math.abs(connection.late_ms - 390) < 1e-6, `${connection.late_ms}: the fastest may have become 10 ms slower`);
  assert.equal(connection.isLost(), false);
  await browser.passes(600);
  browser.hears('phone', 1000);
  assert.equal(connection.isLost(), false);
  connection.stop();
  await browser.passes(400);
  browser.hears('phone', 1400);
  assert.equal(connection.isLost(), true);
  assert.notEqual(connection.stopAt, 0);
  assert.match(connection.alarm(), /THE STOP IS NOT SENT: no connection/);
  browser.hears();
  assert.equal(connection.late_ms, 0);
  assert.equal(connection.alarm(), '');
});

test('each connection has a fastest state of its own: a server that was started again has another clock', async () => {
  const browser = paired();
  await browser.dropsAndIsBackAfter(500);
  browser.hears('phone', 100000);
  assert.equal(browser.connection.isLost(), false);
});

test('a state that does not say when it was made is none', () => {
  const browser = paired();
  browser.socket.onmessage({data: '{"you": {"paired": "phone"}}'});
  assert.equal(browser.connection.isLost(), true);
});

test('a stop that a dead connection swallowed is said when it is too old to be sent again', async () => {
  const browser = paired();
  browser.connection.stop();
  await browser.dropsAndIsBackAfter(11000);
  browser.hears();
  assert.match(browser.connection.alarm(), /NOT SENT in time: press it again/);
});

test('one connection at a time: an earlier one says nothing and brings no second', async () => {
  const browser = paired(), first = browser.socket;
  browser.connection.open();
  assert.equal(first.readyState, 3);
  assert.equal(browser.context.lostTimes, 0, 'the page itself left it');
  browser.opens();
  browser.hears();
  const heard = browser.context.heard;
  first.onmessage({data: '{}'});
  assert.equal(browser.context.heard, heard);
  await browser.passes(2000);
  assert.equal(browser.sockets.length, 2);
  browser.socket.close();
  browser.connection.open();                             // while the next one waits for its half second
  await browser.passes(2000);
  assert.equal(browser.sockets.length, 3);
});

test('the header says what is not possible', async () => {
  const browser = paired(), {connection, elements} = browser;
  connection.showHeader();
  assert.deepEqual([elements.robot.textContent, elements.mode.textContent, elements.link.textContent, elements.stop.disabled, elements.alarm.hidden],
    ['z1', 'stand', 'paired as phone', false, true]);
  await browser.passes(1001);
  connection.showHeader();
  assert.equal(elements.link.textContent, 'no connection');
  assert.match(elements.alarm.textContent, /nothing here has an effect/);
  browser.hears('');
  connection.showHeader();
  assert.equal(elements.stop.disabled, true);
});

test('the button, its keys and Esc stop', () => {
  const browser = paired();
  vm.runInContext('let stops = 0; wireStop(() => { stops += 1; });', browser.context);
  browser.elements.stop.listeners.pointerdown({preventDefault() {}});
  for (const key of ['Enter', ' ', 'x']) browser.elements.stop.listeners.keydown({key});
  for (const key of ['Escape', 'x']) browser.document.listeners.keydown({key});
  assert.equal(vm.runInContext('stops', browser.context), 4);
});
