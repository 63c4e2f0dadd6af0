// What every page has: its token, one connection that comes back, a stop that is kept until it is heard, and the line
// that says all this. A page decides nothing: the server and the robot's controller judge every message.
'use strict';

const $ = (id) => document.getElementById(id);

/// How much longer a state travelled than the fastest one of its connection, as io::Transit counts it: the two clocks have
/// different zeros, and the minimum grows by 1 ms a second, so that clocks that drift apart make nothing late for ever.
class Transit {
  constructor() { Object.assign(this, {smallest_ms: Infinity, taken_ms: 0}); }
  take(stamp_ms, received_ms) {
    const offset_ms = received_ms - stamp_ms, grown_ms = this.smallest_ms + (received_ms - this.taken_ms) / 1000;
    this.smallest_ms = Math.min(grown_ms, offset_ms);
    this.taken_ms = received_ms;
    return offset_ms - this.smallest_ms;
  }
}

/// Calls hear(state) for each state of the server, and lost() when the connection ends.
class Connection {
  static GONE_MS = 1000;               // since the server's newest state left it
  static STOP_KEPT_MS = 10000;         // a stop that couldn't be sent is sent if the connection is back by then
  static AGAIN_MS = 500;               // between a connection's end and the next
  static REFUSALS = 2;                 // of the token; after so many the page looks without it
  static WAITING_BYTES = 4096;         // in the browser; what waits behind them would be old when it goes out

  constructor({hear, lost}) {
    Object.assign(this, {hear, lost, state: null, socket: null, heardAt: -Infinity, late_ms: 0, paired: false, refused: 0, stopAt: 0, onItsWay: false});
    this.token = location.hash.slice(1);
    try {
      if (this.token) localStorage.setItem('pmg.token', this.token);
      this.token = localStorage.getItem('pmg.token') || '';
    } catch { /* a browser that keeps nothing: the token counts until the page is closed */ }
    history.replaceState(null, '', location.pathname);   // so that it isn't seen, nor sent to anybody with the address
  }

  /// Begins a connection; an earlier one no longer counts.
  open() {
    const old = this.socket, withToken = Boolean(this.token) && this.refused < Connection.REFUSALS;
    const opening = new WebSocket(`wss://${location.host}/socket`, withToken ? ['pmg', 'pmg.token.' + this.token] : ['pmg']);
    const transit = new Transit();
    let opened = false;
    this.socket = opening;
    this.paired = withToken;                             // once it is open: the server has taken the token
    this.onItsWay = false;
    opening.onopen = () => { opened = true; this.sendStop(); };
    opening.onmessage = (event) => {
      if (opening !== this.socket) return;
      this.state = JSON.parse(event.data);
      const now = performance.now();
      this.late_ms = transit.take(1000 * this.state.at_s, now);
      this.heardAt = now - this.late_ms;
      // The browser has sent it, and the connection lives.
      if (this.onItsWay && !this.isLost() && opening.bufferedAmount === 0) { this.onItsWay = false; this.stopAt = 0; }
      this.hear(this.state);
    };
    opening.onclose = () => {
      if (opening !== this.socket) return;               // a newer one has taken its place
      this.lost();
      if (withToken && opened) this.refused = 0;
      // A browser doesn't say why a socket wasn't opened: a server that gives out pages but no socket has refused the token.
      const asked = withToken && !opened ? fetch('/page.css', {cache: 'no-store'}).then((answer) => { if (answer.ok) this.refused += 1; }) : Promise.resolve();
      asked.catch(() => {}).finally(() => setTimeout(() => { if (opening === this.socket) this.open(); }, Connection.AGAIN_MS));
    };
    if (old) old.close();
  }
  isOpen() { return Boolean(this.socket) && this.socket.readyState === WebSocket.OPEN; }
  isLost() { return !this.isOpen() || !(performance.now() - this.heardAt <= Connection.GONE_MS); }   // a state without a time, too
  isRefused() { return Boolean(this.token) && this.refused >= Connection.REFUSALS; }

  /// False: not sent.
  say(text) {
    if (!this.isOpen() || this.socket.bufferedAmount > Connection.WAITING_BYTES) return false;
    this.socket.send(text);
    return true;
  }
  stop() {
    this.stopAt = Date.now();
    this.sendStop();
  }
  sendStop() {
    if (!this.stopAt || Date.now() - this.stopAt >= Connection.STOP_KEPT_MS || !this.isOpen() || !this.paired) return;
    this.socket.send('stop');                            // however much waits
    this.onItsWay = true;
  }
  /// What keeps a stop from the robot, and what keeps everything; empty: nothing.
  alarm() {
    if (!this.paired && Date.now() - this.stopAt >= Connection.STOP_KEPT_MS) this.stopAt = 0;   // a page that only looks
    if (this.stopAt && !(this.onItsWay && !this.isLost()))
      return this.isLost() ? 'THE STOP IS NOT SENT: no connection. Use the emergency stop.'
        : !this.paired ? 'THE STOP IS NOT SENT: this page is not paired. Use the emergency stop.'
          : 'THE STOP WAS NOT SENT in time: press it again.';
    if (this.isLost()) return 'No connection to the server: what is shown is old, and nothing here has an effect.';
    return this.state && !this.state.heard ? 'The robot is not heard. Its own controller brings the velocity to zero without commands.' : '';
  }
  /// Who this page is to the server.
  words() {
    const paired = this.state && this.state.you.paired;
    if (this.isLost()) return 'no connection';
    if (paired) return `paired as ${paired}`;
    return this.isRefused() ? 'this token is not taken (revoked, or too many pages): you may look, and do nothing; reload to try again'
      : 'not paired: you may look, and do nothing (pmg_web pair NAME)';
  }
  mode() {
    const news = this.state && this.state.news;
    return !news ? 'not heard' : !this.state.heard ? 'no longer heard' : news.mode + (news.hanging ? ', hanging' : '');
  }
  /// Robot, mode, link, stop button and alarm, on every page the same.
  showHeader() {
    const {state} = this, alarm = this.alarm();
    $('robot').textContent = (state && state.robot) || 'no robot';
    $('mode').textContent = this.mode();
    $('mode').className = 'badge ' + (state && state.news && state.heard ? state.news.mode : 'gone');
    $('link').textContent = this.words();
    $('stop').disabled = !(state && state.you.paired);
    $('alarm').textContent = alarm;
    $('alarm').hidden = !alarm;
  }
}

/// The stop button and Esc, in whatever place of a page. stop(): the page's.
function wireStop(stop) {
  const press = () => {
    stop();
    $('stop').classList.add('sent');
    setTimeout(() => $('stop').classList.remove('sent'), 400);
  };
  $('stop').addEventListener('pointerdown', (event) => { event.preventDefault(); press(); });
  $('stop').addEventListener('keydown', (event) => { if (event.key === 'Enter' || event.key === ' ') press(); });
  document.addEventListener('keydown', (event) => { if (event.key === 'Escape') press(); });
}
