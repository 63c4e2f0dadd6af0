// The client that Foxglove's makers published reads a simulated robot's topics from pmg_web.
// Usage: node foxglove_client_test.mjs FOLDER_OF_PROGRAMS FOLDER_OF_PACKAGES; exit codes: 0 passed, 1 not
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';

const [programs, packages] = process.argv.slice(2);
const require = createRequire(path.join(packages, 'package.json'));
const {FoxgloveClient} = require('@foxglove/ws-protocol');
const {WebSocket} = require('ws');

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pmg_foxglove_test_'));
const url = `udpm://239.255.76.67:${20000 + process.pid % 20000}?ttl=0`;
const children = [];
function start(name, ...args) {
  const child = spawn(path.join(programs, name), args, {cwd: folder, stdio: ['ignore', 'pipe', 'inherit']});
  children.push(child);
  return child;
}
const within = (seconds, what, promise) => Promise.race([promise, new Promise((_, reject) => setTimeout(() => reject(new Error(`after ${seconds} s not: ${what}`)), 1000 * seconds).unref())]);

async function run() {
  start('pmg_controller', '--hal', 'sil', '--robot', 'z1', '--no-log', '--lcm-url', url).stdout.resume();
  const web = start('pmg_web', '--port', '0', '--foxglove', '0', '--lcm-url', url, '--folder', path.join(folder, 'web'));
  let said = '';
  const address = await within(60, 'its address', new Promise((resolve) => web.stdout.on('data', (text) => {
    said += text;
    const found = /^Foxglove: (ws:\/\/localhost:\d+)$/m.exec(said);
    if (found) resolve(found[1]);
  })));
  const client = new FoxgloveClient({ws: new WebSocket(address.replace('localhost', '127.0.0.1'), [FoxgloveClient.SUPPORTED_SUBPROTOCOL])});
  const wanted = new Set(['STATE', 'STATUS', 'REFERENCE', 'ROBOT_INFO', '/tf', '/joint_states', '/robot_description']);
  const topics = new Map(), got = new Map();
  const info = new Promise((resolve) => client.on('serverInfo', resolve));
  const refused = new Promise((resolve) => client.on('status', resolve));
  client.on('error', (error) => { throw error; });
  const all = new Promise((resolve) => {
    client.on('advertise', (channels) => {
      for (const channel of channels) {
        assert.equal(channel.encoding, 'json');
        assert.equal(JSON.parse(channel.schema).type, 'object', channel.topic);
        if (wanted.has(channel.topic)) topics.set(client.subscribe(channel.id), channel);
      }
    });
    client.on('message', ({subscriptionId, timestamp, data}) => {
      const {topic} = topics.get(subscriptionId);
      assert.ok(Math.abs(Number(timestamp / 1000000n) - Date.now()) < 30000, 'the time is UTC');
      got.set(topic, JSON.parse(new TextDecoder().decode(data)));
      if (got.size === wanted.size) resolve();
    });
  });
  assert.deepEqual((await within(60, 'its name', info)).capabilities, []);
  await within(60, 'a message of each topic', all).catch((error) => { error.message += `, but of ${[...got.keys()]}; advertised were ${[...topics.values()].map(({topic}) => topic)}`; throw error; });
  assert.equal(got.get('STATUS').robot, 'z1');
  assert.ok('left_knee' in got.get('STATE').q_rad);
  assert.equal(got.get('/joint_states').joints.length, 31);
  assert.ok(got.get('/tf').transforms.some(({child_frame_id: child}) => child === 'torso'));
  assert.match(got.get('/robot_description').data, /<robot name="z1"/);
  client.advertise({topic: 'COMMAND', encoding: 'json', schemaName: 'pmg.COMMAND'});
  assert.equal((await within(60, 'a refusal', refused)).level, 2);
  client.close();
  console.log(`- ${[...got.keys()].join(', ')}`);
}

let failed = null;
try { await run(); } catch (error) { failed = error; } finally {
  for (const child of children) child.kill('SIGTERM');
  for (const child of children) await new Promise((resolve) => child.exitCode === null && child.signalCode === null ? child.once('exit', resolve) : resolve());
  fs.rmSync(folder, {recursive: true, force: true});
}
if (failed) { console.error(failed); process.exit(1); }
process.exit(0);
