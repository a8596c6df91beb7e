// The picture of the page: the module that draws, its canvas, and the signs over it. When the browser takes the picture away (the driver
// was restarted, another page needed the graphics card) it is made anew on another canvas; the bone is still there, so nothing else ends.
import {start, trouble} from '../common/burr.js';
import {fit, is_lost, wanted_size} from '../common/canvas.js';
import {show} from '../common/skin.js';

const kAgain = 300, kAgainMost = 5000;  // between two tries to make it anew [ms]
const kGiveWay = 2;                     // of the time of a picture, while ticks are left out
const kFinest = 5000;                   // a picture for the report is as fine as it is after this time [ms]

const $ = (id) => document.getElementById(id);
// Signs over the picture, one for each kind of mark. d: of an SVG path about 0, 0; r [px]
const kSigns = {
  target: (r) => `M${-r} 0A${r} ${r} 0 1 0 ${r} 0A${r} ${r} 0 1 0 ${-r} 0`,
  plane: () => '',
  spare: (r) => `${kSigns.target(r)}M${-0.7 * r} ${-0.7 * r}L${0.7 * r} ${0.7 * r}`,
  place: (r) => `M${-r} 0H${r}M0 ${-r}V${r}`,
};
const kLeastSign = 6;               // [px]
const kOnLine = 1e-3;               // any radius: only the middle of its circle is wanted [m]
const svg = (kind, more = {}) => {
  const one = document.createElementNS('http://www.w3.org/2000/svg', kind);
  for (const [name, value] of Object.entries(more)) one.setAttribute(name, value);
  return one;
};

export class Picture {
  // host: lost(), back(), attach(canvas), mark(name), ready(), drawn(fresh), aim(view), busy(), fail(error)
  constructor(host) {
    this.host = host;
    this.view = null;        // the module
    this.alive = false;      // there is a picture
    this.count = this.made = 0;  // pictures drawn; how often the picture was made
    this.waiting = [];       // patches and parts for the view
    this.dirty = true;
    this.pictured = null;    // who waits for a picture of the canvas
    this.skin_whole = this.unseen = this.drew = false;  // unseen: a bone that shall be seen whole is not in the picture yet
    this.before = this.took = 0;
    this.marks = [];         // of the target of the step
    this.lines = [];
    this.evidence = null;    // a ring of its own
  }
  get canvas() { return $('picture'); }

  async open(compiled) {
    const view = await start(compiled);
    if (view.view_open(...wanted_size(this.canvas)) === 0) throw trouble('no_webgl');
    this.view = view;
    this.alive = true;
    this.made = 1;
    this.attach();
    requestAnimationFrame((now) => this.draw(now));
  }
  attach() {
    this.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      if (event.target === this.canvas && this.alive) this.lose();
    });
    this.host.attach(this.canvas);
  }
  lose() {
    this.alive = false;
    this.view.view_lost();
    this.host.lost();
    this.again(kAgain);
  }
  again(wait) {
    setTimeout(() => {
      const old = this.canvas, fresh = old.cloneNode(false), focused = document.activeElement === old;
      old.replaceWith(fresh);
      if (this.view.view_open(...wanted_size(fresh)) === 0) return this.again(Math.min(kAgainMost, 2 * wait));
      this.alive = this.dirty = true;
      ++this.made;
      this.attach();
      if (focused) fresh.focus();
      this.view.view_anew();
      this.host.back();
    }, wait);
  }

  forget() {
    this.waiting.length = 0;
    this.skin_whole = false;
  }
  refined() { return this.alive && this.view.view_refined() === 1 && this.waiting.length === 0; }
  snapshot() {
    return new Promise((go) => {
      this.pictured = {go, until: performance.now() + kFinest};
      this.dirty = true;
    });
  }

  draw(now) {
    requestAnimationFrame((next) => this.draw(next));
    if (this.stopped) return;
    try {
      const {view, waiting} = this, fresh = waiting.length > 0;
      for (const one of waiting) show(view, one);
      waiting.length = 0;
      if (!this.alive) {  // the session goes on without a picture
        this.host.aim(null);
        if (fresh) this.host.drawn(fresh);
        return;
      }
      if (fresh && !this.host.ready()) view.view_anew();
      if (this.unseen && this.skin_whole && fresh) {
        this.unseen = false;
        view.view_whole();
      }
      if (fit(this.canvas)) this.dirty = true;
      if (this.host.ready()) this.host.aim(view);
      if (this.drew) this.took = now - this.before;  // the picture before, until the browser asks for the next
      this.drew = false;
      // the picture gives way to the ticks
      if (this.host.busy() && now - this.before < (1 + kGiveWay) * this.took) {
        this.dirty ||= fresh;
        if (fresh) this.host.drawn(fresh);
        return;
      }
      const {took} = this;
      this.drew = this.dirty || fresh || this.pictured !== null || view.view_refined() === 0;
      if (!this.drew) return;
      this.before = now;
      this.dirty = false;
      if (view.view_show(1e-3 * now, 1e-3 * took, 0) === 0) {
        if (is_lost(this.canvas)) return this.lose();
        throw new Error(view.text(view.view_why()));
      }
      ++this.count;
      this.draw_signs();
      // now: later the canvas is empty
      if (this.pictured && (view.view_refined() === 1 || performance.now() > this.pictured.until)) this.give_picture();
      if (this.skin_whole || this.count > 1 || fresh) this.host.mark('first_picture');
      if (this.skin_whole) this.host.mark('whole_picture');
      this.host.drawn(fresh);
    } catch (what) {
      this.host.fail(what);
    }
  }
  give_picture() {
    const {canvas} = this, {go} = this.pictured;
    this.pictured = null;
    canvas.toBlob(async (blob) => go({png: new Uint8Array(await blob.arrayBuffer()), width: canvas.width, height: canvas.height}));
  }

  // ---- signs over the picture: of the target of the step, and the ring of a place of evidence

  // The target and what is to be spared, in their colours. what: {tissues: [{ids, colour}], marks: [{kind, at, radius, text}], lines: [[a, b]]},
  // or null
  light(what) {
    if (!this.view) return;
    this.view.view_unlight();
    for (const {ids, colour} of what?.tissues ?? []) for (const tissue of ids) this.view.view_light(tissue, ...colour);
    this.marks = (what?.marks ?? []).map((one) => this.sign(one));
    this.lines = (what?.lines ?? []).map((ends) => ({ends, line: svg('line', {class: 'plane'})}));
    this.place_signs();
  }
  // Turns the view to a place [m] and marks it.
  look_at(at, high, name) {
    this.view.view_turn_to(...at, high);
    this.evidence = this.sign({at, radius: 0.06 * high, text: name, kind: 'evidence'});
    this.place_signs();
  }
  look_away() {
    this.evidence = null;
    this.place_signs();
  }
  sign(one) {
    const made = {...one, sign: svg('path', {class: one.kind}), name: svg('text', {class: one.kind})};
    made.name.textContent = one.text;
    return made;
  }
  all_signs() { return this.evidence ? [...this.marks, this.evidence] : this.marks; }
  place_signs() {
    $('light').replaceChildren(...this.lines.map(({line}) => line), ...this.all_signs().flatMap(({sign, name}) => [sign, name]));
    if (this.alive) this.draw_signs();
    this.dirty = true;
  }
  draw_signs() {
    const {view, canvas} = this, scale = canvas.clientHeight / Math.max(1, canvas.height);
    for (const {at, radius, kind, sign, name} of this.all_signs()) {
      const [x, y, r] = view.numbers(view.view_place(...at, radius), 3), is_ring = kind === 'target' || kind === 'evidence';
      const wide = is_ring ? Math.max(kLeastSign, scale * r) : kLeastSign;  // a ring has the size of what it is about
      for (const one of [sign, name]) one.setAttribute('visibility', r < 0 ? 'hidden' : 'visible');
      sign.setAttribute('transform', `translate(${scale * x} ${scale * y})`);
      sign.setAttribute('d', (kSigns[kind] ?? kSigns.target)(wide));
      name.setAttribute('x', scale * x + wide + 5);
      name.setAttribute('y', scale * y + 4);
    }
    for (const {ends, line} of this.lines) {
      const [a, b] = ends.map((at) => view.numbers(view.view_place(...at, kOnLine), 3));
      line.setAttribute('visibility', a[2] < 0 || b[2] < 0 ? 'hidden' : 'visible');
      for (const [key, value] of [['x1', a[0]], ['y1', a[1]], ['x2', b[0]], ['y2', b[1]]]) line.setAttribute(key, scale * value);
    }
  }
}
