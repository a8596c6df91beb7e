// The page "mill": a bone to cut, with mouse or finger. The program runs twice: here it draws the
// picture and says where the hand is; in worker.js it ticks.
import {bound_worker} from '../common/bound_worker.js';
import {compile, start, trouble} from '../common/burr.js';
import {fit, wanted_size} from '../common/canvas.js';
import {begin_bone, show} from '../common/skin.js';
import {Course} from './course.js';
import {Sound} from './sound.js';
import {Watch} from './watch.js';
import * as words from '../common/words.js';

const {word, number} = words;

// tick/command.h, CommandKind
const Command = {spindle_speed: 0, burr_radius: 1, undo: 5, redo: 6, reset: 7};
// as the window offers them (apps/burr/window/mill/drill.cpp)
const kSizes = [0.6, 0.8, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7];  // [mm]
const kRpmStep = 5000, kRpmMost = 80000;
const kTurn = 0.006;                   // of the view, per pixel of the pointer  [rad]
const kTicks = 1000;                   // a second
const kModes = ['free', 'learn', 'practise', 'exam'];
const kLeastDepth = 0.5, kMostDepth = 6;  // of a press  [mm]
const kMostForce = 3.3;                // of the hand; the bar is full there  [N]

const $ = (id) => document.getElementById(id);
const canvas = $('picture');

// What the tests and the curious read.
const burr = window.burr = {
  mode: 'free',
  times: {},  // ms since the page was asked for
  pictures: 0,
  state: {ticks: 0, left_out: 0, p50: 0, p99: 0},
  figures: {},
  ready: false,
  voxel: 0.5,
  own: {},  // of a scan that is opened
  // where the burr is in the picture, and its radius there [pixel of the canvas]
  pressing: () => pressed,
  place: () => [...view.numbers(view.view_burr(), 3)],
  measure: () => worker.postMessage({kind: 'measure'}),  // times of ticks begin anew
  hash: () => worker.postMessage({kind: 'hashes'}),      // gives burr.hashes
  refined: () => view.view_refined() === 1 && waiting.length === 0,
  // of the last picture: share that was drawn anew, patches sent, patches drawn, triangles drawn, step of the governor
  drawn: () => [...view.numbers(view.view_drawn(), 5)],
};
const mark = (name) => { burr.times[name] ??= Math.round(performance.now()); };

let view = null, worker = null, compiled = null;
let pointer = null;     // in the picture [pixel of the canvas]
let pressed = false, depth = 4;
let answered = true;    // a state has come that was not answered yet
let dirty = true;       // the picture must be drawn
let speed = 80000, size = 5;  // as they were asked for
let states = 0;         // since another size was asked for
let work = 0;           // number of the bone
let about = null;       // the case, case.json
let sounds = null;      // the sound is loaded, or on its way
let pictured = null;    // who waits for a picture of the canvas
let before = 0, drew = false;
let skin_whole = false;
let own = null;         // the user's own bone, on its way to the worker
let is_own = false;     // the bone is the user's: it has no case, so no steps and no score
let unseen = false;     // it is not in the picture yet
const waiting = [];     // patches and parts for the view

const course = new Course({
  tell: (message) => worker.postMessage(message),
  say: (text, for_ms) => say(text, for_ms),
  figures: () => burr.figures,
  picture: () => new Promise((go) => { pictured = go; dirty = true; }),
  keep: (bytes, name, type) => keep(bytes, name, type),
  changed: () => dress_course(),
  // an exam watches over nobody
  opened: (compiled_score) => (burr.mode === 'exam' ? watch.host.opened() : watch.open(compiled_score, burr.voxel, burr.mode, work)),
  step: (id) => watch.step(id),
  light: (what) => light(what),
});
burr.course = course;
const sound = burr.sound = new Sound();
const watch = burr.watch = new Watch({
  lift: (text) => {
    pressed = false;  // stop and look; it must be pressed again
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
  },
});

main().catch(fail);

async function main() {
  worker = bound_worker(new URL('worker.js', import.meta.url));
  worker.onmessage = ({data}) => hear(data);
  worker.onerror = (what) => fail(new Error(what.message || 'worker'));
  // a page that nobody sees stands still
  document.addEventListener('visibilitychange', () => {
    pressed = false;
    worker.postMessage({kind: 'pause', on: document.hidden});
  });
  const asked = new URLSearchParams(location.search).get('mode');
  if (kModes.includes(asked)) burr.mode = asked;
  [compiled, , about] = await Promise.all([compile(), words.load(), load_case()]);
  mark('compiled');
  begin();
  dress();
  view = await start(compiled);
  const [wide, high] = wanted_size(canvas);
  if (view.view_open(wide, high) === 0) throw trouble('no_webgl');
  burr.gpu = view.text(view.view_gpu());
  view.view_bone(burr.voxel);
  listen();
  mark('view');
  requestAnimationFrame(draw);
}

async function load_case() {
  const answer = await fetch(new URL('../case.json', import.meta.url));
  if (!answer.ok) throw new Error(`case.json: ${answer.status}`);
  return answer.json();
}

// The worker begins with a bone, the first one or another.
function begin() {
  say(word('shaping'));
  worker.postMessage({kind: 'start', compiled, voxel: burr.voxel, own, work: ++work, hidden: document.hidden, task: {about, mode: burr.mode}},
                     own ? [own.buffer] : []);
  own = null;
}

// The page stops, and its last sentence stays.
function fail(what) {
  if (burr.trouble) return;
  burr.trouble = String(what?.message ?? what);
  worker?.terminate();
  const lacking = typeof WebAssembly !== 'object' || what instanceof WebAssembly.CompileError;
  say(lacking ? word('no_module') : what?.why ? word(what.why, ...what.parts) : word('broken', burr.trouble));
  console.error(what);
}

// ---- from the worker

function hear(data) {
  if (burr.trouble || data.work !== work) return;
  switch (data.kind) {
    case 'shaped':
      mark('shaped');
      if (data.tissues) {
        burr.voxel = data.voxel;
        begin_bone(view, data.tissues, data.voxel, 1000, true);
        unseen = true;
      }
      break;
    case 'skin':
      waiting.push(...data.patches);
      break;
    case 'skin_done':
      skin_whole = true;
      break;
    case 'soft':
      waiting.push(...data.parts.map((one) => ({...one, soft: true})));
      break;
    case 'ready':
      burr.ready = true;
      view?.view_anew();
      mark('ready');
      say(word('drag_mill') + '. ' + word('how_mouse'), 12000);
      if (is_own) course.leave(work);
      else course.begin(burr.voxel, burr.mode, work);
      sounds ??= sound.load().then(dress_sound);
      break;
    case 'state':
      waiting.push(...data.patches, {row: data.row});
      sound.row(data.row);
      burr.state = {ticks: data.ticks, left_out: data.left_out, p50: data.p50, p99: data.p99};
      answered = false;
      ++states;
      break;
    case 'hashes':
      burr.hashes = data;
      break;
    case 'changed':
      course.look(data.bytes);
      break;
    case 'saved':
      if (course.takes(data)) break;
      if (data.file) keep(data.file, 'burr.mcap', 'application/octet-stream'), say(word('saved'), 12000);
      else say(data.why ? word('not_saved', data.why) : word('saved_before'));
      break;
    case 'broken':
      fail(Object.assign(new Error(data.text), {why: data.why, parts: data.parts}));
      break;
  }
  dirty = true;
}

function take_waiting() {
  for (const one of waiting) show(view, one);
  waiting.length = 0;
}

// ---- each picture

function draw(now) {
  requestAnimationFrame(draw);
  if (!view || burr.trouble) return;
  try {
    const fresh = waiting.length > 0;
    take_waiting();
    if (fresh && !burr.ready) view.view_anew();
    if (unseen && skin_whole && fresh) {
      unseen = false;
      view.view_whole();
    }
    if (fit(canvas)) dirty = true;
    if (burr.ready) point();
    const took = drew ? now - before : 0;  // of the picture before, if the one after it follows at once
    before = now;
    drew = dirty || fresh || pictured !== null || view.view_refined() === 0;
    if (!drew) return;
    dirty = false;
    if (view.view_show(1e-3 * now, 1e-3 * took, 0) === 0) throw new Error(view.text(view.view_why()));
    ++burr.pictures;
    draw_light();
    if (pictured && view.view_refined() === 1) {  // now: later the canvas is empty
      const go = pictured;
      pictured = null;
      canvas.toBlob(async (blob) => go({png: new Uint8Array(await blob.arrayBuffer()), width: canvas.width, height: canvas.height}));
    }
    if (skin_whole || burr.pictures > 1 || fresh) mark('first_picture');
    if (skin_whole) mark('whole_picture');
    if (fresh) write();
  } catch (trouble) {
    fail(trouble);
  }
}

// Where the hand is for the pointer, once for each state of the worker.
function point() {
  if (answered) return;
  answered = true;
  let aim = null;
  if (pointer) {
    const at = view.view_aim(pointer.x, pointer.y, pressed ? 1 : 0, 1e-3 * depth, 1, 0);
    aim = view.bytes(at, view.view_aim_size()).slice();
  }
  worker.postMessage({kind: 'next', aim});
}

function write() {
  const [time, force, removed, size_now, rpm, now, touching, flags] = view.numbers(view.view_figures(), 8);
  const size_mm = Math.round(100 * size_now) / 100;
  burr.figures = {time, force, removed, size: size_mm, rpm, now, touching, flags};
  if (states > 2) size = size_mm;  // the servo has answered by now, or refused
  if (!burr.ready) return;
  $('force').textContent = number(force, 1);
  $('bar').style.width = `${Math.min(100, 100 * force / kMostForce)}%`;
  $('removed').textContent = number(removed, 1);
  $('size').textContent = number(size_mm, size_mm % 1 === 0 ? 0 : 1);
  $('rpm').textContent = number(rpm, 0);
  const lost = burr.state.left_out;
  $('loop').textContent = lost > 0 ? word('left_out', number(lost, 0)) : word('ticks_good');
}

// ---- the target of the step: tissues in the colours of target and spare, and signs over the picture, one for each kind

// d: of an SVG path about 0, 0; r [px]
const kSigns = {
  target: (r) => `M${-r} 0A${r} ${r} 0 1 0 ${r} 0A${r} ${r} 0 1 0 ${-r} 0`,
  plane: () => '',
  spare: (r) => `${kSigns.target(r)}M${-0.7 * r} ${-0.7 * r}L${0.7 * r} ${0.7 * r}`,
  place: (r) => `M${-r} 0H${r}M0 ${-r}V${r}`,
};
let marks = [], lines = [];
function light(what) {
  if (!view) return;
  view.view_unlight();
  for (const {ids, colour} of what?.tissues ?? []) for (const tissue of ids) view.view_light(tissue, ...colour);
  const make = (kind, of) => {
    const one = document.createElementNS('http://www.w3.org/2000/svg', kind);
    one.setAttribute('class', of);
    return one;
  };
  marks = (what?.marks ?? []).map((mark) => {
    const [sign, name] = [make('path', mark.kind), make('text', mark.kind)];
    name.textContent = mark.text;
    return {...mark, sign, name};
  });
  lines = (what?.lines ?? []).map((ends) => ({ends, line: make('line', 'plane')}));
  $('light').replaceChildren(...lines.map(({line}) => line), ...marks.flatMap(({sign, name}) => [sign, name]));
  draw_light();
  dirty = true;
}
function draw_light() {
  const scale = canvas.clientHeight / Math.max(1, canvas.height);
  for (const {at, radius, kind, sign, name} of marks) {
    const [x, y, r] = view.numbers(view.view_place(...at, radius), 3);
    const wide = kind === 'target' ? Math.max(6, scale * r) : 6;  // a ring has the size of what it is about
    for (const one of [sign, name]) one.setAttribute('visibility', r < 0 ? 'hidden' : 'visible');
    sign.setAttribute('transform', `translate(${scale * x} ${scale * y})`);
    sign.setAttribute('d', kSigns[kind](wide));
    name.setAttribute('x', scale * x + wide + 5);
    name.setAttribute('y', scale * y + 4);
  }
  for (const {ends, line} of lines) {
    const [a, b] = ends.map((at) => view.numbers(view.view_place(...at, 0.001), 3));
    line.setAttribute('visibility', a[2] < 0 || b[2] < 0 ? 'hidden' : 'visible');
    for (const [name, value] of [['x1', a[0]], ['y1', a[1]], ['x2', b[0]], ['y2', b[1]]]) line.setAttribute(name, scale * value);
  }
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
const acts = {
  undo: () => go_back(Command.undo, 'undone'),
  redo: () => go_back(Command.redo, 'redone'),
  reset: () => go_back(Command.reset, 'back_to_start'),
  smaller: () => resize(-1),
  larger: () => resize(1),
  slower: () => change_speed(-kRpmStep),
  faster: () => change_speed(kRpmStep),
  less: () => change_depth(1 / 1.25),
  more: () => change_depth(1.25),
  home: () => {
    if (is_own) view.view_whole();
    else view.view_home();
    dirty = true;
  },
  finer: begin_finer,
  own: open_own,
  finish: () => course.ask_done(),
  show_steps: () => course.show_steps(),
  sound: () => sound.toggle(kTicks).then(dress_sound).then(() => watch.heard(sound.on)),
  step_done: () => course.step_done(),
  light: () => course.toggle_light(),
  save: () => {
    if (!burr.ready) return;
    if (course.save()) return;
    $('save').disabled = true;
    worker.postMessage({kind: 'save', declared: false});
  },
};

// In an exam nothing comes back.
function go_back(what, key) {
  if (course.refuses_back()) return;
  command(what);
  say(word(key), 3000);
}

// Gives a file to the user. It goes nowhere else.
function keep(bytes, name, type) {
  if (name === 'burr.mcap') burr.saved = bytes.length;
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);  // the browser has taken it by then
}

// the servo refuses a burr of less than four voxels, and one for which there is no room
function resize(by) {
  const fitting = kSizes.filter((one) => one >= 4 * burr.voxel);
  const next = by < 0 ? fitting.findLast((one) => one < size - 0.01) : fitting.find((one) => one > size + 0.01);
  if (next === undefined) return;
  size = next;
  states = 0;
  command(Command.burr_radius, 0.5e-3 * size);
}
function change_speed(by) {
  speed = Math.min(kRpmMost, Math.max(kRpmStep, speed + by));
  command(Command.spindle_speed, speed * Math.PI / 30);
}
function change_depth(factor) {
  depth = Math.min(kMostDepth, Math.max(kLeastDepth, depth * factor));
  $('depth').textContent = number(depth, 1);
}

// What reads scans is loaded when somebody has one.
async function open_own() {
  try {
    const {open_scan} = await import('../common/import.js');
    open_scan(burr.own, ({blob}) => {
      own = blob;
      is_own = true;
      burr.mode = 'free';
      begin_anew();
    });
  } catch {
    say(word('scan_broken'), 12000);
  }
}

// The page's own bone again, after one of the user's.
function leave_own() {
  if (is_own) burr.voxel = 0.5;
  is_own = false;
}

// The same bone with finer voxels, in the same worker.
function begin_finer() {
  burr.voxel = !is_own && burr.voxel === 0.5 ? 0.25 : 0.5;
  is_own = false;
  begin_anew();
}

function begin_anew() {
  course.close();
  watch.close();
  burr.ready = skin_whole = false;
  burr.times = {};
  waiting.length = 0;
  answered = true;
  speed = 80000;
  size = 5;
  states = 0;
  if (!own) view.view_bone(burr.voxel);
  $('save').disabled = false;
  dress();
  begin();
  dirty = true;
}

const keys = {
  u: 'undo', y: 'redo', r: 'reset', '[': 'smaller', ']': 'larger', PageDown: 'smaller', PageUp: 'larger', ',': 'slower',
  '.': 'faster', '+': 'more', '=': 'more', '-': 'less', f: 'home', j: 'step_done', a: 'light', o: 'show_steps', m: 'sound',
};

function listen() {
  const fingers = new Map();  // pointers that are down: id -> {x, y, button}
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return {
      x: (event.clientX - box.left) * canvas.width / Math.max(1, box.width),
      y: (event.clientY - box.top) * canvas.height / Math.max(1, box.height),
    };
  };
  // two fingers: their middle and how far they are apart
  const pair = () => {
    const [a, b] = [...fingers.values()];
    return {x: 0.5 * (a.x + b.x), y: 0.5 * (a.y + b.y), apart: Math.hypot(a.x - b.x, a.y - b.y)};
  };
  const view_by = (event, dx, dy, button) => {
    const scale = canvas.height / Math.max(1, canvas.clientHeight);
    if (button === 2) view.view_orbit(-kTurn * dx / scale, kTurn * dy / scale);
    else view.view_pan(-dx / canvas.height, dy / canvas.height);
    dirty = true;
  };

  canvas.addEventListener('pointerdown', (event) => {
    event.preventDefault();
    canvas.focus();
    try {
      canvas.setPointerCapture(event.pointerId);
    } catch { /* a pointer of a script */ }
    fingers.set(event.pointerId, {...at(event), button: event.button});
    if (fingers.size === 1) pointer = at(event);
    const touch = event.pointerType === 'touch';
    pressed = fingers.size === 1 && event.button === 0;
    if (touch && fingers.size > 1) pressed = false;
  });
  canvas.addEventListener('pointermove', (event) => {
    const finger = fingers.get(event.pointerId);
    const now = at(event);
    if (!finger) {
      if (fingers.size === 0) pointer = now;
      return;
    }
    if (fingers.size === 2 && event.pointerType === 'touch') {
      const was = pair();
      Object.assign(finger, now);
      const is = pair();
      view_by(event, is.x - was.x, is.y - was.y, 2);
      if (was.apart > 1) view.view_zoom(is.apart / was.apart);
    } else if (finger.button === 0) {
      pointer = now;
    } else {
      view_by(event, now.x - finger.x, now.y - finger.y, finger.button);
    }
    Object.assign(finger, now);
  });
  const lift = (event) => {
    fingers.delete(event.pointerId);
    if (fingers.size === 0) pressed = false;
  };
  canvas.addEventListener('pointerup', lift);
  canvas.addEventListener('pointercancel', lift);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    view.view_zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 33 : 1)));
    dirty = true;
  }, {passive: false});
  window.addEventListener('blur', () => { pressed = false; });
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey && event.key === 'Enter') return void course.ask_done();
    if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLSelectElement || event.target instanceof HTMLInputElement) return;
    if (course.covers()) return;  // its buttons have the keys
    const arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (arrow) {
      view.view_orbit(0.1 * arrow[0], 0.1 * arrow[1]);
      dirty = true;
    } else if (keys[event.key]) {
      acts[keys[event.key]]();
    } else {
      return;
    }
    event.preventDefault();
  });
  // a file that is dropped here would take the place of the page
  for (const kind of ['dragover', 'drop']) window.addEventListener(kind, (event) => event.preventDefault());
  canvas.addEventListener('webglcontextlost', () => fail(new Error('WebGL')));
  for (const id of Object.keys(acts)) $(id)?.addEventListener('click', () => acts[id]());
  $('language').addEventListener('change', () => {
    words.choose($('language').value);
    dress();
    course.speak();
    watch.speak();
  });
  $('volume').addEventListener('input', () => sound.volume($('volume').valueAsNumber));
  $('mode').addEventListener('change', () => {
    burr.mode = $('mode').value;
    leave_own();
    begin_anew();
  });
}

// What the course of the session allows now.
function dress_course() {
  $('finish').disabled = !course.can_finish();
  $('show_steps').hidden = !course.offers_steps();
  const back = course.goes_back();
  for (const id of ['undo', 'redo', 'reset']) $(id).disabled = !back;
  Promise.resolve(sounds).then(() => { burr.loaded = course.loaded; });
  mark_score();
}
const mark_score = () => { if (course.loaded) mark('score'); };

function dress_sound() {
  $('sound').disabled = $('volume').disabled = sound.compiled === undefined || sound.trouble !== '';
  $('sound').textContent = word(sound.on ? 'mute' : 'sound_on');
  $('sound').title = sound.trouble;
  $('sound').setAttribute('aria-pressed', String(sound.on));
  $('volume').title = word('volume');
  $('volume').setAttribute('aria-label', word('volume'));
}

// The words of the page in the present language.
function dress() {
  dress_sound();
  for (const one of document.querySelectorAll('[data-word]')) one.textContent = word(one.dataset.word);
  for (const id of ['undo', 'redo', 'reset']) $(id).textContent = word(id);
  canvas.setAttribute('aria-label', word('bone'));
  for (const [id, key] of Object.entries({smaller: 'smaller', larger: 'larger', slower: 'slower', faster: 'faster',
                                          less: 'less_deep', more: 'deeper'})) {
    $(id).title = word(key);
    $(id).setAttribute('aria-label', word(key));
  }
  $('home').textContent = word('first_view');
  $('own').textContent = word('own_scan');
  $('save').textContent = word('save');
  $('save').title = word('save_tip');
  $('finer').textContent = `${number(burr.voxel === 0.5 && !is_own ? 0.25 : 0.5, 2)} mm`;
  if (burr.voxel === 0.5 && !is_own) $('finer').textContent = word('finer');
  $('finer').title = word('finer_tip');
  $('language').setAttribute('aria-label', word('language'));
  $('language').replaceChildren(...words.languages().map(({code, name}) => {
    const option = document.createElement('option');
    option.value = code;
    option.textContent = name;
    option.selected = code === words.present();
    return option;
  }));
  $('finish').textContent = word('done_button');
  $('finish').title = `${word('done_button')} (Ctrl + Enter)`;
  $('show_steps').textContent = word('steps');
  $('mode').title = word('mode_tip');
  $('mode').setAttribute('aria-label', word('mode_title'));
  $('mode').replaceChildren(...kModes.map((mode) => {
    const option = document.createElement('option');
    option.value = mode;
    option.textContent = word(`mode_${mode}`);
    option.selected = mode === burr.mode;
    return option;
  }));
  $('depth').textContent = number(depth, 1);
}
