// The page "mill": a bone to cut, with mouse, finger or keys. The program runs twice: in picture.js it draws and says where the hand is;
// in worker.js it ticks.
import {bound_worker} from '../common/bound_worker.js';
import {compile, trouble} from '../common/burr.js';
import * as words from '../common/words.js';
import {make} from './ask.js';
import {Course} from './course.js';
import {dress, dress_sound} from './dress.js';
import {Embed} from './embed.js';
import {Hand} from './hand.js';
import {Kept} from './kept.js';
import {Picture} from './picture.js';
import {Sessions} from './sessions.js';
import {Sound} from './sound.js';
import {Tools} from './tools.js';
import {Watch} from './watch.js';

const {word, number} = words;

const kTicks = 1000;                   // a second
const kModes = ['free', 'learn', 'practise', 'exam'];
const kBusy = 2000;                    // after ticks were left out the picture gives way so long [ms]
const kBehind = 40;                    // patches that wait: the picture is behind what is felt
const kMostForce = 3.3;                // of the hand; the bar is full there  [N]
const kRecoverAgain = 60000;           // a worker that ends twice so quickly ends the page [ms]

const $ = (id) => document.getElementById(id);

let worker = null, compiled = null, spare = null;
let opening = null;     // of the picture
let answered = true;    // a state has come that was not answered yet
let rest = null;        // what is not needed for the first cut is loaded, or on its way
let list = null, make_stl = null;  // of that: the work that is kept; the file of a shape
let recovered = -kRecoverAgain;
let lost_at = -kBusy;   // when ticks were last left out [ms]

const picture = new Picture({
  lost: () => {
    hand.let_go();
    say(word('picture_lost'));
  },
  back: () => say(word('picture_back'), 5000),
  attach: (canvas) => hand.attach(canvas),
  mark: (name) => mark(name),
  ready: () => burr.ready,
  aim: (view) => point(view),
  busy: () => performance.now() - lost_at < kBusy,
  drawn: (fresh) => { if (fresh) write(); },
  fail: (what) => fail(what),
});

// What the tests and the curious read.
const burr = window.burr = {
  mode: 'free',
  times: {},  // ms since the page was asked for
  get pictures() { return picture.count; },
  picture,
  state: {ticks: 0, left_out: 0, behind: 0, p50: 0, p99: 0},
  figures: {},
  ready: false,
  voxel: 0.5,
  own: {},  // of a scan that is opened
  pressing: () => hand.pressed,
  // where the burr is in the picture, and its radius there [pixel of the canvas]
  place: () => [...picture.view.numbers(picture.view.view_burr(), 3)],
  measure: () => worker.postMessage({kind: 'measure'}),  // times of ticks begin anew
  hash: () => worker.postMessage({kind: 'hashes'}),      // gives burr.hashes
  refined: () => picture.refined(),
  // of the last picture: share that was drawn anew, patches sent, patches drawn, triangles drawn, step of the governor
  drawn: () => [...picture.view.numbers(picture.view.view_drawn(), 5)],
  worker: () => worker,
};
const mark = (name) => { burr.times[name] ??= Math.round(performance.now()); };

const hand = burr.hand = new Hand({
  view: () => (picture.alive ? picture.view : null),
  turned: () => { picture.dirty = true; },
  press: () => {
    $('card').hidden = true;
    worker.postMessage({kind: 'press'});
  },
  take_back: () => worker.postMessage({kind: 'take_back'}),
  back: () => course.goes_back(),
});
const kept = burr.kept = new Kept();
const course = burr.course = new Course({
  tell: (message) => worker.postMessage(message),
  say: (text, for_ms) => say(text, for_ms),
  figures: () => burr.figures,
  picture: () => picture.snapshot(),
  keep: (bytes, name, type) => keep(bytes, name, type),
  changed: () => dress_course(),
  // an exam watches over nobody
  opened: (compiled_score) => (burr.mode === 'exam' ? watch.host.opened() : watch.open(compiled_score, sessions.about.name, burr.voxel, burr.mode, sessions.work)),
  step: (id) => {
    watch.step(id);
    embed.tell('step', {id: id ?? null});
  },
  marked: (score) => embed.tell('marked', {score}),
  done: () => embed.tell('done', embed.host.figures()),
  light: (what) => picture.light(what),
  look_at: (place, name) => look_at(place, name),
  kept: () => (kept.failed ? null : kept.id),
});
const sound = burr.sound = new Sound();
const embed = burr.embed = new Embed({
  open: (name, mode) => sessions.end_then(() => {
    if (kModes.includes(mode)) burr.mode = mode;
    return sessions.open_case(name || sessions.about.name).catch(() => say(word('no_case', name), 12000));
  }),
  language: (code) => speak(code),
  finish: () => course.ask_done(),
  recording: () => {
    if (course.file) course.file.arrayBuffer().then((bytes) => embed.give({file: new Uint8Array(bytes), complete: true}));
    else if (burr.ready && course.page === null) worker.postMessage({kind: 'save', declared: false});
    else return false;
    return true;
  },
  figures: () => (burr.ready ? {time_s: burr.state.ticks / kTicks, force_n: burr.figures.force ?? 0, removed_mm3: burr.figures.removed ?? 0} : null),
});
const tools = burr.tools = new Tools({
  command: (what, value) => command(what, value),
  voxel: () => burr.voxel,
  fastest: () => sessions.about.rpm,
  suck: (on) => picture.view?.view_suction(on ? 1 : 0),
  say: (key) => say(word(key), 5000),
});
const sessions = burr.sessions = new Sessions({
  burr, picture, course, kept, hand, tools,
  say: (...what) => say(...what),
  send: (...what) => worker.postMessage(...what),
  save: () => acts.save(),
  closed: () => {
    watch.close();
    $('to_marks').hidden = true;
    answered = true;
    dress(burr, sessions.dressed());
  },
});
const watch = burr.watch = new Watch({
  lift: (text) => {
    hand.let_go();  // stop and look; it must be pressed again
    say(text, 8000);
  },
  note: (event) => course.note(event),
  near: (to_spare, injured) => sound.near(to_spare, injured),
  rows: (port) => worker.postMessage({kind: 'rows', port}, [port]),
  opened: () => {
    course.loaded = true;
    watch.step(course.steps?.now?.id);
    watch.heard(sound.on);
    dress_course();
    embed.tell('loaded');
  },
});

main().catch(fail);

async function main() {
  worker = listen_to(new_worker());
  // a page that nobody sees stands still
  document.addEventListener('visibilitychange', () => {
    hand.let_go();
    worker.postMessage({kind: 'pause', on: document.hidden});
  });
  const asked = new URLSearchParams(location.search);
  if (kModes.includes(asked.get('mode'))) burr.mode = asked.get('mode');
  [compiled, , sessions.first] = await Promise.all([compile(), words.load(), load_case()]);
  sessions.compiled = compiled;
  sessions.about = sessions.shown = sessions.first;
  mark('compiled');
  const name = asked.get('case'), another = name !== null && name !== sessions.first.name;
  if (another) say(word('shaping'));
  else sessions.begin();
  dress(burr, sessions.dressed());
  $('card').hidden = false;
  opening = picture.open(compiled);
  await opening;
  burr.gpu = picture.view.text(picture.view.view_gpu());
  picture.view.view_bone(burr.voxel);
  listen();
  mark('view');
  if (another) await sessions.open_case(name).catch(() => {
    sessions.begin();
    say(word('no_case', name), 12000);
  });
  const file = asked.get('bone');
  if (file) await sessions.open_link(file);
}

// Everything else, when the first cut is possible. From then on the host is asked for nothing.
async function load_rest() {
  const [{KeptList}, {stl}, pages] = await Promise.all([import('./kept_list.js'), import('./stl.js'), import('./review.js'), words.load_others(), sound.load(), prepare_spare()]);
  list = new KeptList(kept, {go_on: (session) => sessions.go_on(session), keep: (...what) => keep(...what)});
  make_stl = stl;
  course.pages = pages;
  dress_course();
  dress_sound(sound);
  await opening;
  if (!new URLSearchParams(location.search).has('bone')) await list.offer().catch(() => {});
}

function new_worker() { return bound_worker(new URL('worker.js', import.meta.url)); }
function listen_to(one) {
  one.onmessage = ({data}) => hear(data);
  one.onerror = (what) => {
    what.preventDefault?.();
    crashed(new Error(what.message || 'worker'));
  };
  return one;
}
// A worker that has loaded its scripts takes the place of one that ends, without asking the host for anything.
const prepare_spare = () => new Promise((go) => {
  spare = new_worker();
  spare.onmessage = ({data}) => { if (data.kind === 'here') go(); };
  spare.onerror = () => {
    spare = null;
    go();
  };
});

async function load_case() {
  const answer = await fetch(new URL('../case.json', import.meta.url));
  if (!answer.ok) throw new Error(`case.json: ${answer.status}`);
  return answer.json();
}

// The page stops, and its last sentence stays.
function fail(what) {
  if (burr.trouble) return;
  burr.trouble = String(what?.message ?? what);
  picture.stopped = true;
  worker?.terminate();
  const lacking = typeof WebAssembly !== 'object' || what instanceof WebAssembly.CompileError;
  embed.tell('stopped', {why: burr.trouble});
  say(lacking ? word('no_module') : what?.why ? word(what.why, ...what.parts) : word(sessions.cut > 0 && kept.id && !kept.failed ? 'broken_kept' : 'broken', burr.trouble));
  console.error(what);
}
// The worker has ended: what it had cut is in the browser's storage, and another worker goes on with it.
async function crashed(what) {
  const now = performance.now();
  if (burr.trouble || !spare || kept.failed || !(sessions.cut > 0) || now - recovered < kRecoverAgain) return fail(what);
  recovered = now;
  worker.terminate();
  worker = listen_to(spare);
  spare = null;
  watch.renew();
  say(word('comes_back', String(what?.message ?? what)));
  const session = await list.own();
  if (!session) return fail(what);
  await sessions.go_on(session);
  prepare_spare();
}

// ---- from the worker

function hear(data) {
  if (burr.trouble || data.work !== sessions.work) return;
  switch (data.kind) {
    case 'shaped':
      mark('shaped');
      if (data.tissues) {
        burr.voxel = data.voxel;
        sessions.show_bone(data.tissues, data.voxel);
      }
      break;
    case 'redone':
      say(word('bringing_back', number(100 * data.share, 0)));
      break;
    case 'parted':
      sessions.parted = data.tick;
      break;
    case 'skin':
      picture.waiting.push(...data.patches);
      break;
    case 'skin_done':
      picture.skin_whole = true;
      break;
    case 'soft':
      picture.waiting.push(...data.parts.map((one) => ({...one, soft: true})));
      break;
    case 'ready':
      ready();
      break;
    case 'state':
      picture.waiting.push(...data.patches, {row: data.row});
      sound.row(data.row);
      if (data.left_out > burr.state.left_out) lost_at = performance.now();
      burr.state = {ticks: data.ticks, left_out: data.left_out, behind: data.behind, p50: data.p50, p99: data.p99};
      answered = false;
      ++tools.states;
      break;
    case 'hashes':
      burr.hashes = data;
      break;
    case 'went_back':
      say_went_back(data);
      break;
    case 'changed':
      course.look(data.bytes);
      break;
    case 'shape':
      keep(make_stl(data.parts), 'burr.stl', 'model/stl');
      break;
    case 'unkept':
      kept.failed = data.why;
      say(word('not_kept', data.why), 20000);
      break;
    case 'saved':
      take_saved(data);
      break;
    case 'broken':
      if (data.why) fail(Object.assign(new Error(data.text), {why: data.why, parts: data.parts}));
      else crashed(new Error(data.text));
      break;
  }
  picture.dirty = true;
}

function ready() {
  burr.ready = true;
  picture.view?.view_anew();
  mark('ready');
  if (sessions.is_own) course.leave(sessions.work);
  else course.begin(sessions.about.name, burr.voxel, burr.mode, sessions.work, sessions.before?.events);
  rest ??= load_rest().catch((what) => console.error(what));
  embed.tell('ready', {case: sessions.is_own ? null : sessions.about.name, mode: burr.mode, voxel_mm: burr.voxel, language: words.present()});
  if (sessions.before) sessions.came_back();
  else say(word('drag_mill') + '. ' + word('how_mouse'), 12000);
}
function say_went_back({what, did, whole, of_reset}) {
  const key = {
    undo: did ? (of_reset ? 'reset_undone' : 'undone') : 'nothing_undone',
    redo: did ? 'redone' : 'nothing_redone',
    reset: !whole ? 'reset_part' : did ? 'back_to_start' : 'nothing_reset',
    take_back: did ? 'taken_back' : '',
  }[what];
  burr.went_back = {what, did, whole};
  if (key) say(word(key), 5000);
}

function take_saved(data) {
  if (!(data.file && data.complete) && embed.give(data)) return;
  if (data.file && !data.complete) {
    sessions.copied = burr.figures.removed;
    keep(data.file, 'burr.mcap', 'application/octet-stream');
    say(word('saved'), 12000);
  } else if (!course.takes(data)) {
    say(data.why ? word('not_saved', data.why) : word('saved_before'), 12000);
  }
  if (data.complete) embed.again();
}

// ---- each picture

// Where the hand is for the pointer, once for each state of the worker.
function point(view) {
  if (answered) return;
  answered = true;
  let aim = null;
  if (view && hand.pointer) {
    const at = view.view_aim(hand.pointer.x, hand.pointer.y, hand.pressed ? 1 : 0, 1e-3 * tools.depth, 1, 0);
    aim = view.bytes(at, view.view_aim_size()).slice();
  }
  worker.postMessage({kind: 'next', aim});
}

function write() {
  const {view} = picture;
  const [time, force, removed, size_now, rpm, now, touching, flags, wet] = view.numbers(view.view_figures(), 9);
  const size_mm = Math.round(100 * size_now) / 100;
  burr.figures = {time, force, removed, size: size_mm, rpm, now, touching, flags, wet};
  if (burr.ready) sessions.cut = Math.max(sessions.cut, removed);  // before, the row may be that of the session before
  tools.seen(size_mm, wet > 0);
  if (!burr.ready) return;
  $('force').textContent = number(force, 1);
  $('bar').style.width = `${Math.min(100, 100 * force / kMostForce)}%`;
  $('removed').textContent = number(removed, 1);
  $('size').textContent = number(size_mm, size_mm % 1 === 0 ? 0 : 1);
  $('rpm').textContent = number(rpm, 0);
  const lost = burr.state.left_out;
  $('loop_title').textContent = word(lost > 0 ? 'left_out' : 'ticks');
  $('loop').textContent = lost > 0 ? number(lost, 0) : word(burr.state.behind > kBehind ? 'picture_behind' : 'ticks_good');
}

// ---- from the user

let said = 0;
function say(text, for_ms = 0) {
  $('say').textContent = text;
  clearTimeout(said);
  if (for_ms > 0) said = setTimeout(() => say(''), for_ms);
}

function command(what, value = 0) {
  if (burr.ready) worker.postMessage({kind: 'command', what, value});
}
// In an exam nothing comes back. What is said comes when it is known whether there was anything.
function go_back(what) {
  if (burr.ready && !course.refuses_back()) worker.postMessage({kind: 'back', what});
}
const acts = {
  undo: () => go_back('undo'),
  redo: () => go_back('redo'),
  reset: () => go_back('reset'),
  smaller: () => tools.resize(-1),
  larger: () => tools.resize(1),
  slower: () => tools.change_speed(-1),
  faster: () => tools.change_speed(1),
  less: () => tools.change_depth(-1),
  more: () => tools.change_depth(1),
  coolant: () => { if (burr.ready) tools.toggle_coolant(); },
  suction: () => tools.toggle_suction(),
  home: () => {
    if (!picture.alive) return;
    if (sessions.is_own) picture.view.view_whole();
    else picture.view.view_home();
    picture.dirty = true;
  },
  finer: () => sessions.end_then(() => sessions.begin_finer()),
  own: () => sessions.open_own(),
  shape: () => { if (burr.ready && make_stl) worker.postMessage({kind: 'shape'}); },
  kept: () => list?.show_all(),
  finish: () => course.ask_done(),
  show_steps: () => course.show_steps(),
  sound: () => sound.toggle(kTicks).then(() => dress_sound(sound)).then(() => watch.heard(sound.on)),
  step_done: () => course.step_done(),
  light: () => course.toggle_light(),
  save: () => {
    if (burr.ready && !course.save()) worker.postMessage({kind: 'save', declared: false});
  },
  menu_open: () => $('menu').showModal(),
  menu_close: () => $('menu').close(),
  card_close: () => {
    $('card').hidden = true;
    picture.canvas.focus();
  },
  to_marks: () => {
    picture.look_away();
    $('to_marks').hidden = true;
    course.show_again();
  },
};

// Gives a file to the user. It goes nowhere else.
function keep(bytes, name, type) {
  if (name === 'burr.mcap') burr.saved = bytes.length;
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);  // the browser has taken it by then
}

// A place of evidence [m]: the view turns to it, and a ring marks it.
function look_at(place, name) {
  if (!picture.alive) return;
  $('to_marks').hidden = false;
  $('to_marks').focus();
  picture.look_at(place, 4e-3 * Math.max(3, sessions.about.burr_mm), name);
}

const keys = {
  u: 'undo', y: 'redo', r: 'reset', '[': 'smaller', ']': 'larger', PageDown: 'smaller', PageUp: 'larger', ',': 'slower',
  '.': 'faster', '+': 'more', '=': 'more', '-': 'less', f: 'home', i: 'coolant', 6: 'suction', j: 'step_done', a: 'light', o: 'show_steps', m: 'sound',
};

function listen() {
  window.addEventListener('blur', () => hand.let_go());
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey && event.key === 'Enter') return void course.ask_done();
    if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLSelectElement || event.target instanceof HTMLInputElement) return;
    if (course.covers() || document.querySelector('dialog[open]')) return;  // its buttons have the keys
    if (hand.key_down(event)) event.preventDefault();
    else if (keys[event.key] && !event.repeat) acts[keys[event.key]](), event.preventDefault();
    else if (keys[event.key]) event.preventDefault();
  });
  window.addEventListener('keyup', (event) => { if (event.key === ' ' && hand.by_key) hand.key_up(); });
  // a file that is dropped here would take the place of the page
  window.addEventListener('dragover', (event) => event.preventDefault());
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    if (event.dataTransfer?.files.length > 0 && !document.querySelector('dialog[open]')) sessions.open_own([...event.dataTransfer.files]);
  });
  // reload, Back, another address: asked once, by the browser, if something was cut that no file has
  window.addEventListener('beforeunload', (event) => {
    if (sessions.cut > 0 && Math.abs(sessions.copied - burr.figures.removed) > 1e-6 && !burr.trouble && !course.file) event.preventDefault();
  });
  for (const id of Object.keys(acts)) $(id)?.addEventListener('click', () => acts[id]());
  for (const id of ['home', 'finer', 'own', 'shape', 'kept']) $(id).addEventListener('click', () => { if ($('menu').open) $('menu').close(); });
  $('language').addEventListener('change', () => speak($('language').value));
  $('volume').addEventListener('input', () => sound.volume($('volume').valueAsNumber));
  $('mode').addEventListener('change', () => {
    const mode = $('mode').value;
    sessions.end_then(() => sessions.begin_mode(mode), () => { $('mode').value = burr.mode; });
  });
  $('case').addEventListener('change', () => {
    const name = $('case').value;
    if ($('menu').open) $('menu').close();
    sessions.end_then(() => sessions.open_case(name).catch(() => say(word('no_case', name), 12000)), () => { $('case').value = sessions.about.name; });
  });
}

function speak(code) {
  if (!words.languages().some((one) => one.code === code)) return;
  words.choose(code).then(() => {
    dress(burr, sessions.dressed());
    course.speak();
    watch.speak();
  });
}

// What the course of the session allows now.
function dress_course() {
  $('finish').disabled = !course.can_finish();
  $('show_steps').hidden = !course.offers_steps();
  const back = course.goes_back();
  for (const id of ['undo', 'redo', 'reset']) $(id).disabled = !back;
  if (course.cases.length > 0) {
    $('case').replaceChildren(...course.cases.map(({name, title}) => {
      const option = make('option', {value: name}, title);
      option.selected = name === sessions.about.name;
      return option;
    }));
    if (sessions.is_own) $('case').value = '';
  }
  Promise.resolve(rest).then(() => { burr.loaded = course.loaded; });
  if (course.loaded) mark('score');
}
