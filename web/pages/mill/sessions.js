// The sessions of the page, one after the other: which bone and which case, how one ends and another begins, and how one comes back from
// the browser's storage.
import {begin_bone} from '../common/skin.js';
import {forget_kept} from '../common/store.js';
import * as words from '../common/words.js';
import {ask, make} from './ask.js';

const {word, number, duration} = words;
const kTicks = 1000;  // a second
const kModes = ['free', 'learn', 'practise', 'exam'];
const kOwnCase = {name: '', text: '', rubric_hash: '0', phantom: '', spare: [], targets: [], burr_mm: 5, diamond: false, rpm: 80000};

export class Sessions {
  // host: burr, picture, course, kept, hand, tools; say(text, ms), send(message for the worker that ticks), save(), closed()
  constructor(host) {
    this.host = host;
    this.work = 0;         // number of the bone
    this.first = null;     // the page's own case, case.json
    this.about = null;     // the present one
    this.shown = null;     // that of the bone before
    this.is_own = false;   // the bone is the user's: it has no case, so no steps and no score
    this.cut = 0;          // the most that was gone in this session [mm^3]
    this.copied = -1;      // what was gone when it was saved
    this.before = null;    // the session that comes back: {id, about, events}
    this.parted = null;    // the tick at which it came back otherwise than it was
  }
  dressed() { return {is_own: this.is_own, depth: this.host.tools.depth}; }

  // The worker begins with a bone: the page's own, or `bone` (bytes); redo: a port to the ticks of the session that comes back.
  begin({bone = null, redo = null} = {}) {
    const {burr, kept, say, send} = this.host, {about} = this;
    say(word(redo ? 'bringing_back' : 'shaping', 0));
    this.cut = 0;
    this.copied = -1;
    this.parted = null;
    const facts = {id: kept.begin(), begun: this.before?.about.begun ?? Date.now(), mode: burr.mode, voxel: burr.voxel, case: about.name};
    send({kind: 'start', compiled: this.compiled, voxel: burr.voxel, bone, own: this.is_own, work: ++this.work, hidden: document.hidden,
          task: {about, mode: burr.mode}, kept: facts, redo}, [bone?.buffer, redo].filter(Boolean));
  }
  begin_anew(what = {}) {
    const {burr, picture, course, tools, send, closed} = this.host, {about, first} = this;
    send({kind: 'leave'});
    course.close();
    picture.look_away();
    burr.ready = false;
    burr.times = {};
    picture.forget();
    tools.begin(about);
    if (!what.bone) {
      picture.view.view_work(...first.at, ...first.into, 0.5e-3 * first.burr_mm);
      picture.view.view_bone(burr.voxel);
      if (this.shown !== about) picture.view.view_home();
    }
    this.shown = about;
    closed();
    this.begin(what);
    picture.dirty = true;
  }
  // Another bone than the page's own.
  show_bone(tissues, voxel) {
    const {burr, picture} = this.host, {about} = this;
    burr.voxel = voxel;
    if (about.at) picture.view.view_work(...about.at, ...about.into, 0.5e-3 * about.burr_mm);
    begin_bone(picture.view, tissues, voxel, kTicks, true);
    if (about.at) picture.view.view_home();
    picture.unseen = this.is_own;
  }

  // What ends a session asks once; no: what to do when the user goes on.
  end_then(act, no = () => {}) {
    const {burr, course, kept, hand, save} = this.host;
    if (!(this.cut > 0) || course.page !== null) return act();
    hand.let_go();
    const text = word(kept.failed ? 'anew_unkept' : 'anew_text', duration(burr.state.ticks / kTicks), number(burr.figures.removed, 1));
    const saved = () => {
      save();
      no();
    };
    ask(word('anew_title'), [make('p', {}, text)], [['anew_yes', word('anew_yes'), act], ['anew_save', word('save'), saved], ['anew_no', word('anew_no'), no]])
        .oncancel = no;
  }

  begin_mode(mode) {
    this.host.burr.mode = mode;
    if (this.is_own) this.leave_own();
    if (this.about === this.first) this.begin_anew();
    else this.open_case(this.about.name);
  }
  // The page's own bone again, after another one.
  leave_own() {
    if (this.about !== this.first) this.host.burr.voxel = 0.5;
    this.is_own = false;
    this.about = this.first;
  }
  // The same bone with finer voxels, in the same worker.
  begin_finer() {
    const {burr} = this.host;
    burr.voxel = this.about === this.first && burr.voxel === 0.5 ? 0.25 : 0.5;
    this.is_own = false;
    this.about = this.first;
    this.begin_anew();
  }
  // Another case: its bone is made by the worker that knows cases.
  async open_case(name) {
    const {burr, course, say} = this.host;
    say(word('shaping'));
    if (name === this.first.name) {
      this.leave_own();
      return this.begin_anew();
    }
    const {about, bone} = await course.ask_case(name);
    this.is_own = false;
    this.about = about;
    burr.voxel = about.voxel_mm;
    this.begin_anew({bone});
  }

  // What reads scans is loaded when somebody has one.
  async open_own(files) {
    const {burr, say} = this.host;
    try {
      const {open_scan} = await import('../common/import.js');
      open_scan(burr.own, ({blob}) => this.end_then(() => {
        this.is_own = true;
        this.about = kOwnCase;
        burr.mode = 'free';
        this.begin_anew({bone: blob});
      }), files);
    } catch {
      say(word('scan_broken'), 12000);
    }
  }
  // A scan beside the page, by a link: ?bone=scans/one.nrrd. Only of the page's own host.
  async open_link(file) {
    try {
      const at = new URL(file, location.href);
      if (at.origin !== location.origin) throw new Error(at.host);
      const answer = await fetch(at);
      if (!answer.ok) throw new Error(`${answer.status}`);
      await this.open_own([new File([await answer.blob()], decodeURIComponent(at.pathname.split('/').at(-1)))]);
    } catch (what) {
      this.host.say(word('no_bone_file', String(what?.message ?? what)), 20000);
    }
  }

  // A session of the browser's storage goes on: it is computed again, with undo and all.
  async go_on(session) {
    const {burr, course, say} = this.host, facts = session.about, {first} = this;
    say(word('bringing_back', 0));
    try {
      const opened = await course.ask_redo(await session.file(), facts.case !== first.name);
      this.is_own = facts.case === '';
      this.about = this.is_own ? kOwnCase : facts.case === first.name ? first : (await course.ask_case(facts.case, facts.voxel)).about;
      burr.mode = kModes.includes(opened.about.mode) ? opened.about.mode : 'free';
      burr.voxel = facts.voxel;
      this.before = {id: session.id, about: facts, events: opened.about.course};
      this.begin_anew({bone: opened.bone, redo: opened.port});
    } catch (what) {
      burr.not_brought = String(what?.message ?? what);
      say(word('not_brought', burr.not_brought), 20000);
    }
  }
  // Its recording is made once more, with all ticks; the old one is not needed any more.
  came_back() {
    const {burr, say} = this.host, {id, about} = this.before;
    this.before = null;
    if (this.parted !== null) return say(word('brought_part', duration(this.parted / kTicks)), 20000);
    say(word('brought_back', duration(about.ticks / kTicks), number(about.removed, 1)), 12000);
    burr.brought_back = about;
    forget_kept(id);
  }
}
