// The picture of the page: the module that draws, its canvas, and the rings over it. When the browser takes the picture away (the driver
// was restarted, another page needed the graphics card) it is made anew on another canvas; the bone is still there, so nothing else ends.
import {start, trouble} from '../common/burr.js';
import {fit, wanted_size} from '../common/canvas.js';
import {show} from '../common/skin.js';

const kAgain = 300, kAgainMost = 5000;  // between two tries to make it anew [ms]

const $ = (id) => document.getElementById(id);
const svg = (kind, more = {}) => {
  const one = document.createElementNS('http://www.w3.org/2000/svg', kind);
  for (const [name, value] of Object.entries(more)) one.setAttribute(name, value);
  return one;
};

export class Picture {
  // host: lost(), back(), attach(canvas), mark(name), ready(), drawn(fresh), aim(view), fail(error)
  constructor(host) {
    this.host = host;
    this.view = null;        // the module
    this.alive = false;      // there is a picture
    this.count = this.made = 0;  // pictures drawn; how often the picture was made
    this.waiting = [];       // patches and parts for the view
    this.dirty = true;
    this.pictured = null;    // who waits for a picture of the canvas
    this.skin_whole = this.unseen = this.drew = false;  // unseen: a bone that shall be seen whole is not in the picture yet
    this.before = 0;
    this.rings = [];
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
      this.pictured = go;
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
      const took = this.drew ? now - this.before : 0;  // of the picture before, if the one after it follows at once
      this.before = now;
      this.drew = this.dirty || fresh || this.pictured !== null || view.view_refined() === 0;
      if (!this.drew) return;
      this.dirty = false;
      if (view.view_show(1e-3 * now, 1e-3 * took, 0) === 0) throw new Error(view.text(view.view_why()));
      ++this.count;
      this.draw_rings();
      if (this.pictured && view.view_refined() === 1) this.give_picture();  // now: later the canvas is empty
      if (this.skin_whole || this.count > 1 || fresh) this.host.mark('first_picture');
      if (this.skin_whole) this.host.mark('whole_picture');
      this.host.drawn(fresh);
    } catch (what) {
      this.host.fail(what);
    }
  }
  give_picture() {
    const {canvas} = this, go = this.pictured;
    this.pictured = null;
    canvas.toBlob(async (blob) => go({png: new Uint8Array(await blob.arrayBuffer()), width: canvas.width, height: canvas.height}));
  }

  // ---- rings: of the target of the step, and of a place of evidence

  // what: {tissues, colour, rings: [{at, radius, name}]}, or null
  light(what) {
    if (!this.view) return;
    this.view.view_unlight();
    for (const tissue of what?.tissues ?? []) this.view.view_light(tissue, ...what.colour);
    this.rings = (what?.rings ?? []).map((one) => this.ring(one));
    this.place_rings();
  }
  // Turns the view to a place [m] and marks it.
  look_at(at, high, name) {
    this.view.view_turn_to(...at, high);
    this.evidence = this.ring({at, radius: 0.06 * high, name}, 'evidence');
    this.place_rings();
  }
  look_away() {
    this.evidence = null;
    this.place_rings();
  }
  ring(one, kind) {
    const made = {...one, circle: svg('circle', kind && {class: kind}), text: svg('text', kind && {class: kind})};
    made.text.textContent = one.name;
    return made;
  }
  place_rings() {
    $('light').replaceChildren(...this.all_rings().flatMap(({circle, text}) => [circle, text]));
    if (this.alive) this.draw_rings();
    this.dirty = true;
  }
  all_rings() { return this.evidence ? [...this.rings, this.evidence] : this.rings; }
  draw_rings() {
    const {view, canvas} = this, scale = canvas.clientHeight / Math.max(1, canvas.height);
    for (const {at, radius, circle, text} of this.all_rings()) {
      const [x, y, r] = view.numbers(view.view_place(...at, radius), 3), wide = Math.max(6, scale * r);
      for (const one of [circle, text]) one.setAttribute('visibility', r < 0 ? 'hidden' : 'visible');
      for (const [name, value] of [['cx', scale * x], ['cy', scale * y], ['r', wide]]) circle.setAttribute(name, value);
      text.setAttribute('x', scale * x + wide + 5);
      text.setAttribute('y', scale * y + 4);
    }
  }
}
