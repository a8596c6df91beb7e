// The course of a session on the page: the steps of the case beside the picture, and at the end the question, the user's own
// marks, what burr found, and the report. What is said and decided comes from score_worker.js, which runs the window's code.
import {bound_worker} from '../common/bound_worker.js';
import * as words from '../common/words.js';
import {ask, button, make} from './ask.js';

const {word} = words;
const kRest = 3000;  // from the end of a measurement to the next [ms], as in the window

const $ = (id) => document.getElementById(id);

export class Course {
  // host: tell(message for the worker that ticks), say(text, ms), figures(), picture(), keep(bytes, name, type), changed(),
  // opened(compiled), step(id), done(), marked(score), light(what is lit or null), look_at(place, its name),
  // kept() the id of the recording in the browser's storage, or null
  constructor(host) {
    this.host = host;
    this.worker = null;
    this.loaded = false;  // the worker is there, and asks for nothing any more
    this.texts = {};      // of the window, by key
    this.cases = [];      // that there are: {name, title, voxel_mm}
    this.open = false;    // the sheet of the steps, where the screen is narrow
    this.pages = null;    // review.js, when it is loaded
    this.asked = null;    // who waits for a case or a recording
    this.clear();
  }

  clear() {
    this.steps = null;
    this.shown = false;
    this.questions = [];
    this.marks = new Map();  // own: id -> "met", "unmet", "unknown"
    this.found = null;       // what burr found: {report, score}
    this.file = null;        // the recording, when the work is done
    this.page = null;        // of the review: "own", "waits", "found", "exam"
    this.looking = false;
    this.lit = null;         // what is lit: {step, rings, tissues, colour}
    this.trouble = '';
    clearTimeout(this.timer);
  }

  // Of a bone that is ready, before its first cut; or of a session that came back, with what had happened in it.
  begin(name, voxel, mode, work, events = null) {
    this.work = work;
    this.mode = mode;
    this.begin_worker();
    this.post({kind: 'open', name, voxel, mode, language: words.present(), came_back: events});
  }
  begin_worker() {
    if (this.worker !== null) return;
    this.worker = bound_worker(new URL('score_worker.js', import.meta.url));
    this.worker.onmessage = ({data}) => this.hear(data);
    this.worker.onerror = (what) => this.fail(what.message || 'worker');
  }
  // What is known of a case, and its bone.
  ask_case(name, voxel = 0) { return this.ask_worker({kind: 'case', name, voxel}); }
  // A recording, to be computed again: what it says of itself, its bone if that is wanted, and the port from which its ticks come.
  ask_redo(file, with_bone) { return this.ask_worker({kind: 'redo', file, with_bone}); }
  ask_worker(message) {
    this.begin_worker();
    return new Promise((go, stop) => {
      this.asked = {go, stop};
      this.worker.postMessage({...message, language: words.present()});
    });
  }
  // Of a bone that has no case: no steps, no score. What still comes of the bone before is left.
  leave(work) {
    this.work = work;
    this.mode = 'free';
    this.host.changed();
  }
  close() {
    this.clear();
    $('course').hidden = $('review').hidden = true;
    this.host.light(null);
    $('ask').close();
    this.host.changed();
  }
  post(message, transfer = []) {
    this.worker?.postMessage({...message, work: this.work}, transfer);
  }
  fail(text) {
    this.trouble = text;
    this.loaded = true;
    this.asked?.stop(new Error(text));
    console.error(text);
    this.host.say(word('no_steps', text), 12000);
    if (this.page) this.show_review();
    this.host.changed();
  }

  hear(data) {
    if (data.kind === 'asked') {
      const {go, stop} = this.asked;
      return data.why ? stop(new Error(data.why)) : go(data);
    }
    if (data.kind === 'broken') return this.fail(data.text);
    if (data.work !== this.work) return;
    if (data.words) this.texts = data.words;
    if (data.cases) this.cases = data.cases;
    if (data.questions) this.questions = data.questions;
    if (data.steps) this.steps = data.steps;
    if (data.events?.length > 0 && this.lit) this.put_out();  // it was the target of another step
    for (const event of data.events ?? []) this.note(event);
    if (data.steps) this.host.step(this.steps.now?.id);
    if (data.kind === 'opened') {
      this.host.opened(data.compiled);
      this.shown = this.steps.offer === 'always';
      if (this.mode === 'exam') this.host.say(this.texts.exam_begins, 8000);
      this.rest();
    } else if (data.kind === 'looked') {
      this.looking = false;
      if (data.ticked) this.host.say(this.text('steps_ticked', data.ticked), 8000);
      this.rest();
    } else if (data.kind === 'marked') {
      this.took = {ms: data.ms, memory: data.memory};
      this.found = data.marks ?? null;
      this.trouble = data.why ?? '';
      this.page = 'found';
      if (this.found) this.host.marked(this.found.score);
    } else if (data.kind === 'lit') {
      this.light(data.light);
    } else if (data.kind === 'dressed' && data.marks) {
      this.found = data.marks;
    } else if (data.kind === 'page') {
      if (data.html) this.host.keep(new TextEncoder().encode(data.html), 'burr.html', 'text/html');
      this.report_saved = data.html?.length ?? data.why;
    }
    this.show();
  }

  text(key, ...parts) {
    return (this.texts[key] ?? key).replace(/\{[^}]*\}/g, (gap) => parts.shift() ?? gap);
  }
  note(event) {
    this.host.tell({kind: 'note', what: {what: '', where: '', value: '', ...event}});
  }
  speak() {
    if (!this.loaded) return;
    this.post({kind: 'language', language: words.present()});
    if (this.lit) this.post({kind: 'light'});  // its names
  }

  // ---- the target of the step, lit

  lights() { return this.steps?.target && this.page === null; }
  toggle_light() {
    if (this.lit) return this.put_out();
    if (this.lights()) this.post({kind: 'light'});
    else if (this.page === null && this.steps) this.host.say(this.text(this.mode === 'exam' ? 'refused_exam' : 'refused_case'), 3000);
  }
  light(light) {
    if (!light || this.page !== null) return;
    if (!this.lit) this.note({kind: 'help_shown', what: 'target', where: light.step});
    this.lit = light;
    this.host.light(light);
  }
  put_out() {
    this.note({kind: 'help_hidden', what: 'target', where: this.lit.step});
    this.lit = null;
    this.host.light(null);
    this.show();
  }

  // ---- the steps

  offers_steps() { return this.steps !== null && this.steps.offer !== 'never'; }
  goes_back() { return this.page === null && (this.steps === null ? this.mode !== 'exam' : this.steps.back); }
  // True: it says so.
  refuses_back() {
    if (this.goes_back()) return false;
    if (this.page === null) this.host.say(this.text('refused_exam'), 3000);
    return true;
  }
  show_steps() {
    if (!this.offers_steps()) return;
    this.shown = !this.shown;
    this.note({kind: this.shown ? 'help_shown' : 'help_hidden', what: 'steps'});
    this.show();
  }
  step_done() {
    if (this.offers_steps() && this.page === null) this.post({kind: 'done'});
  }
  rest() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.measure(), kRest);
  }
  // Asks for the bricks that were cut, so that the other worker's bone is as this one's; it measures where the step says how.
  measure() {
    if (this.page !== null || this.looking) return;
    if (!this.offers_steps() || !this.steps.now?.measured || $('ask').open) return this.rest();
    this.looking = true;
    this.host.tell({kind: 'changed'});
  }
  look(bytes) {
    this.post({kind: 'look', bytes, measure: this.page === null}, [bytes.buffer]);
  }

  show() {
    const panel = $('course');
    panel.hidden = !this.shown || !this.offers_steps() || this.page !== null;
    if (!panel.hidden) {
      const held = [...panel.querySelectorAll('button')].indexOf(document.activeElement);
      panel.classList.toggle('open', this.open);
      panel.replaceChildren(...this.panel());
      if (held >= 0) ([...panel.querySelectorAll('button')][held] ?? $('picture')).focus();
    }
    if (this.page !== null) this.show_review();
    this.host.changed();
  }
  panel() {
    const {now, rows} = this.steps;
    const about = now ? [
      make('p', {class: 'small'}, now.count), make('p', {class: 'title'}, now.title), make('p', {}, now.say),
      now.tool && make('p', {class: 'small'}, now.tool), now.spare && make('p', {class: 'warn'}, now.spare),
      button(this.text('steps_done', 'J'), () => this.step_done(), {id: 'step_done'}),
      this.lights() && button(this.text(this.lit ? 'steps_unlight' : 'steps_light', 'A'), () => this.toggle_light(), {id: 'step_light'}),
    ] : [make('p', {class: 'good title'}, this.text('steps_all_done'))];
    const fold = button(this.open ? '▾' : '▴', () => {
      this.open = !this.open;
      this.show();
    }, {id: 'course_fold', 'aria-expanded': String(this.open), 'aria-controls': 'course', 'aria-label': word(this.open ? 'fold_close' : 'fold_open')});
    const list = make('ol', {}, ...rows.map((row, n) => make('li', {}, button(
        (row.done ? '✓ ' : row.current ? '▸ ' : '○ ') + row.title,
        () => { if (!row.current) this.post({kind: 'choose', row: n}); },
        {title: row.current ? '' : this.text(row.done ? 'steps_reopen' : 'steps_choose'), ...(row.current && {'aria-current': 'step'})}))));
    return [...about.filter(Boolean), list, fold];
  }

  // ---- the end

  can_finish() { return this.loaded && this.pages !== null && this.steps !== null && this.page === null; }
  covers() { return (this.page !== null && !$('review').hidden) || $('ask').open; }

  ask_done() {
    if (!this.can_finish() || $('ask').open) return;
    if (!(this.host.figures().removed > 0)) return this.host.say(this.text('done_nothing'), 5000);
    ask(this.text('done_title'), [
      make('p', {}, this.text('done_told')),
      this.steps.open > 0 && make('p', {class: 'warn'}, this.text('done_open_steps', this.steps.open)),
    ], [['done_yes', this.text('done_yes'), () => this.finish()], ['done_no', this.text('done_no')]]);
  }

  // The work is done: the picture is taken, then the user marks his own work.
  async finish() {
    if (this.lit) this.put_out();
    this.page = 'own';
    clearTimeout(this.timer);
    this.show();
    this.picture = await this.host.picture();
  }
  own_finished(kept) {
    if (kept) for (const [what, value] of this.marks) this.note({kind: 'self_mark', what, value});
    this.page = this.steps.marks ? 'waits' : 'exam';
    this.host.done();
    this.host.tell({kind: 'save', declared: true});
    this.show();
  }
  // The recording has come. False: it is not of the end of a course.
  takes(data) {
    if (this.page === null) return false;
    if (!data.file) {
      this.page = 'found';
      this.trouble = data.why || word('saved_before');
      this.show();
      return true;
    }
    this.file = new Blob([data.file]);
    if (this.page === 'waits') this.post({kind: 'mark', file: data.file}, [data.file.buffer]);
    this.show();
    return true;
  }
  show_again() {
    $('review').hidden = false;
    this.show_review();
  }
  look_at(item) {
    $('review').hidden = true;
    this.host.look_at(item.place, item.text);
  }
  save() {
    if (this.page === null) return false;
    this.file?.arrayBuffer().then((bytes) => this.host.keep(new Uint8Array(bytes), 'burr.mcap', 'application/octet-stream'));
    return true;
  }
  async save_report() {
    this.picture ??= await this.host.picture();
    this.post({kind: 'page', ...this.picture, caption: word('at_end')});
  }

  show_review() {
    const review = $('review');
    const top = review.querySelector('.body')?.scrollTop ?? 0;
    const was = review.dataset.page;
    review.hidden = false;
    review.dataset.page = this.page;
    review.replaceChildren(...(this.page === 'own' ? this.pages.own(this) : this.pages.result(this)));
    const title = review.querySelector('h1').textContent;
    for (const one of [review, review.querySelector('nav')]) one.setAttribute('aria-label', title);
    if (was === this.page) review.querySelector('.body').scrollTop = top;
    else review.querySelector('button.first')?.focus();
  }
}
