// What the robot's camera shows, and how old that is: nobody shall drive by a picture that has stopped.
'use strict';

/// Draws on a canvas of its own, the marks too, so that a headset shows what a page shows.
class CameraView {
  static OLD_MS = 500;                   // from then on a picture is marked
  static GIVE_UP_MS = 2000;              // of a picture on its way: then the newest is asked for anew

  /// whole: what is hidden while the server shows no camera.
  constructor(canvas, whole) {
    Object.assign(this, {canvas, whole, picture: null, number: null, takenAt: -Infinity, comes: false, underway: false, painted: true});
    this.ink = canvas.getContext('2d');
    setInterval(() => this.draw(), 100);
  }

  /// camera: of each state; late_ms: how late the state was. A slow browser asks for the next picture when it has the one before, and gets the newest.
  hear(camera, late_ms) {
    this.whole.hidden = !camera;
    this.comes = Boolean(camera) && camera.number !== undefined;
    if (!this.comes) { this.picture = null; return; }
    if (!this.underway && camera.number !== this.number) this.fetch(camera.number, performance.now() - 1000 * camera.age_s - late_ms);
  }
  /// The picture that comes is the one of this number or a newer one: it was taken at this time or later.
  async fetch(number, takenAt) {
    this.underway = true;
    try {
      const answer = await fetch('/camera.jpg', {cache: 'no-store', signal: AbortSignal.timeout(CameraView.GIVE_UP_MS)});
      if (!answer.ok) return;
      const picture = await createImageBitmap(await answer.blob());
      if (!this.comes) return;             // it is another robot's now
      Object.assign(this, {picture, number, takenAt});
      this.draw();
    } catch { /* the next state asks anew; meanwhile this one grows old */ } finally {
      this.underway = false;
    }
  }
  /// What keeps an operator from driving by it; empty: it is fresh.
  words() {
    const age_ms = performance.now() - this.takenAt;
    return !this.picture ? 'no picture' : age_ms > CameraView.OLD_MS ? `OLD PICTURE: ${(age_ms / 1000).toFixed(1)} s` : '';
  }
  /// Whether the canvas has changed since the last call.
  takePainted() {
    const {painted} = this;
    this.painted = false;
    return painted;
  }
  draw() {
    const {ink, picture} = this, words = this.words(), {width, height} = this.canvas;
    this.painted = true;
    if (picture) ink.drawImage(picture, 0, 0, width, height);
    if (!words) return;
    ink.fillStyle = picture ? 'rgba(90, 90, 90, 0.75)' : '#5a5a5a';
    ink.fillRect(0, 0, width, height);
    ink.fillStyle = '#ffffff';
    ink.font = `bold ${Math.round(height / 10)}px system-ui, sans-serif`;
    ink.textAlign = 'center';
    ink.fillText(words, width / 2, height / 2);
  }
}
