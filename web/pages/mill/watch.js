// What the page says about the structures that must not be cut, while somebody works: the distance to the nearest, the warning of the
// sound, one sentence about technique, and in "learn" the stop. What is said and decided comes from watch_worker.js, which runs the window's code.
import {bound_worker} from '../common/bound_worker.js';
import * as words from '../common/words.js';

const {number} = words;
const $ = (id) => document.getElementById(id);

export class Watch {
  // host: rows(port for the worker that ticks), lift(sentence), note(event), near(to_spare, injured), opened()
  constructor(host) {
    this.host = host;
    this.worker = null;
    this.ready = false;   // it may be asked
    this.found = null;
    this.allowed = null;
  }
  // compiled: burr_score.
  open(compiled, name, voxel, mode, work) {
    this.work = work;
    if (this.worker === null) {
      this.worker = bound_worker(new URL('watch_worker.js', import.meta.url));
      this.worker.onmessage = ({data}) => this.hear(data);
      this.worker.onerror = (what) => this.fail(what.message || 'worker');
      this.renew();
    }
    this.post({kind: 'open', compiled, name, voxel, mode, language: words.present()});
  }
  // Rows come from another worker that ticks.
  renew() {
    if (this.worker === null) return;
    const {port1, port2} = new MessageChannel();
    this.worker.postMessage({kind: 'rows', port: port1}, [port1]);
    this.host.rows(port2);
  }
  close() {
    this.work = null;
    this.ready = false;
    this.found = this.allowed = null;
    this.host.near(null, false);
    this.show();
  }
  post(message) {
    this.worker?.postMessage({...message, work: this.work});
  }
  fail(text) {
    console.error(text);
    this.close();
    this.host.opened();
  }
  heard(on) { this.post({kind: 'heard', on}); }  // whether the sound is on
  step(id) { if (this.ready) this.post({kind: 'step', id: id ?? ''}); }
  speak() { if (this.ready) this.post({kind: 'language', language: words.present()}); }

  hear(data) {
    if (data.kind === 'broken') return this.fail(data.text);
    if (data.work !== this.work) return;
    if (data.allowed) this.allowed = data.allowed;
    if (data.kind === 'opened') {
      this.ready = true;
      this.host.opened();
    } else if (data.kind === 'looked') {
      this.post({kind: 'next'});
      this.found = data.found;
      for (const event of data.found.events) this.host.note(event);
      this.host.near(data.found.to_spare, data.found.injured);
      if (data.found.stop) this.host.lift(data.found.stop);
    }
    this.show();
  }

  // As the strip of the window (window/parts/hud.cpp).
  show() {
    const {found, allowed} = this;
    $('near').hidden = !allowed?.distance;
    $('advice').textContent = found?.advice ?? '';
    if (!allowed?.distance) return;
    const near = found?.nearest;
    const tone = !near || near.mm >= 2 ? '' : near.mm < 1 ? 'bad' : 'warn';
    $('near_title').textContent = near ? near.title : allowed.far;
    $('near_mm').textContent = near ? number(near.mm, 1) : '> 20';
    $('near_sign').textContent = {bad: '!!', warn: '!'}[tone] ?? '';
    $('near').className = tone;
  }
}
