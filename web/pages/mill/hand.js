// The user's hand on the page: mouse, fingers and keys become a point of the picture, a press, and turns of the view.
//
// One finger mills. It is not pressed at once, since a second one may follow and turn the view: nothing is cut until that is certain, and
// what was cut just before a second finger came is taken back.
const kTurn = 0.006;              // of the view, per pixel of the pointer  [rad]
const kCertain = 130;             // after this one finger is meant [ms]
const kCertainForGood = 300;      // where nothing can be taken back
const kSpoilt = 700;              // a second finger that comes so soon after the press may begin was meant to turn [ms]
const kKeyTurn = 0.1, kKeyZoom = 1.1, kKeyMove = 0.02;  // of an arrow: [rad], of the distance, of the picture's height

export class Hand {
  // host: view() or null, turned(), press(), take_back(), back() whether anything can be taken back
  constructor(host) {
    this.host = host;
    this.pointer = null;      // in the picture [pixel of the canvas]
    this.pressed = false;
    this.fingers = new Map(); // pointers that are down: id -> {x, y, button}
    this.touched = 0;         // when the first finger came, by the clock of events
    this.turns = false;       // a second finger was there
  }
  let_go() {
    clearTimeout(this.certain);
    this.pressed = false;
  }
  press() {
    this.pressed = true;
    this.host.press();
  }

  at(event) {
    const {canvas} = this, box = canvas.getBoundingClientRect();
    return {x: (event.clientX - box.left) * canvas.width / Math.max(1, box.width), y: (event.clientY - box.top) * canvas.height / Math.max(1, box.height)};
  }
  // two fingers: their middle and how far they are apart
  pair() {
    const [a, b] = [...this.fingers.values()];
    return {x: 0.5 * (a.x + b.x), y: 0.5 * (a.y + b.y), apart: Math.hypot(a.x - b.x, a.y - b.y)};
  }
  view_by(dx, dy, button) {
    const view = this.host.view(), {canvas} = this;
    if (!view) return;
    const scale = canvas.height / Math.max(1, canvas.clientHeight);
    if (button === 2) view.view_orbit(-kTurn * dx / scale, kTurn * dy / scale);
    else view.view_pan(-dx / canvas.height, dy / canvas.height);
    this.host.turned();
  }
  zoom(by) {
    this.host.view()?.view_zoom(by);
    this.host.turned();
  }

  // The canvas that the picture is on; after a lost picture there is another one.
  attach(canvas) {
    this.canvas = canvas;
    this.let_go();
    this.fingers.clear();
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const kind of ['pointerup', 'pointercancel']) canvas.addEventListener(kind, (event) => this.up(event));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 33 : 1)));
    }, {passive: false});
    canvas.addEventListener('blur', () => { if (this.by_key) this.key_up(); });
  }

  down(event) {
    event.preventDefault();
    this.canvas.focus({preventScroll: true});
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch { /* a pointer of a script */ }
    this.fingers.set(event.pointerId, {...this.at(event), button: event.button});
    const first = this.fingers.size === 1;
    if (first) {
      this.turns = false;
      this.pointer = this.at(event);
      this.touched = event.timeStamp;
    }
    if (event.pointerType !== 'touch') {
      if (first && event.button === 0) this.press();
      else this.let_go();
      return;
    }
    if (first) {
      this.certain = setTimeout(() => { if (this.fingers.size === 1 && !this.turns) this.press(); }, this.host.back() ? kCertain : kCertainForGood);
      return;
    }
    // by the times of the fingers: a busy page may hear of the second one late
    const spoilt = this.pressed && event.timeStamp - this.touched < kCertain + kSpoilt && this.host.back();
    this.turns = true;
    this.let_go();
    if (spoilt) this.host.take_back();
  }
  move(event) {
    const finger = this.fingers.get(event.pointerId), now = this.at(event);
    if (!finger) {
      if (this.fingers.size === 0) this.pointer = now;
      return;
    }
    if (this.fingers.size === 2 && event.pointerType === 'touch') {
      const was = this.pair();
      Object.assign(finger, now);
      const is = this.pair();
      this.view_by(is.x - was.x, is.y - was.y, 2);
      if (was.apart > 1) this.zoom(is.apart / was.apart);
    } else if (finger.button === 0) {
      if (!this.turns) this.pointer = now;
    } else {
      this.view_by(now.x - finger.x, now.y - finger.y, finger.button);
    }
    Object.assign(finger, now);
  }
  up(event) {
    this.fingers.delete(event.pointerId);
    if (this.fingers.size === 0 || event.pointerType === 'touch') this.let_go();
  }

  // ---- keys. True: it was one of these.

  key_down(event) {
    const on_picture = document.activeElement === this.canvas || document.activeElement === document.body;
    const arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (event.key === ' ') {
      if (!on_picture) return false;
      if (event.repeat || this.pressed) return true;
      this.pointer ??= this.middle();
      this.by_key = true;
      this.press();
      return true;
    }
    if (event.shiftKey && arrow) {
      const {canvas} = this, from = this.pointer ?? this.middle(), by = kKeyMove * canvas.height * (this.pressed ? 0.25 : 1);
      this.pointer = {x: Math.min(canvas.width, Math.max(0, from.x + by * arrow[0])), y: Math.min(canvas.height, Math.max(0, from.y - by * arrow[1]))};
      return true;
    }
    if (event.shiftKey && (event.key === 'PageUp' || event.key === 'PageDown')) {
      this.zoom(event.key === 'PageUp' ? kKeyZoom : 1 / kKeyZoom);
      return true;
    }
    if (!arrow || !on_picture) return false;
    this.host.view()?.view_orbit(kKeyTurn * arrow[0], kKeyTurn * arrow[1]);
    this.host.turned();
    return true;
  }
  key_up() {
    this.by_key = false;
    this.let_go();
  }
  middle() { return {x: 0.5 * this.canvas.width, y: 0.5 * this.canvas.height}; }
}
