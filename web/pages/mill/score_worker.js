// The second worker of the page: the steps of the case, and at the end its score and the report (burr_score). It loads after
// the first cut is possible. What it measures takes seconds, and no tick waits for that.
//
//     page -> worker   open {name, voxel, mode, language, work, came_back}, look {bytes}, done, choose {row}, language {language},
//                      light, mark {file}, page {png, width, height, caption}; of no bone yet: case {name, voxel}, redo {file, with_bone}
//     worker -> page   opened {compiled, words, cases, steps, events, questions}, asked {about, bone, port} or {why}, looked {ticked, steps, events}, steps {steps, events}, lit {light},
//                      dressed {words, steps, questions, marks}, marked {marks} or {why}, page {html} or {why}, broken {text}
import make from '../burr_score.mjs';
import {compile, start} from '../common/burr.js';
import {load_codecs} from '../common/codecs.mjs';

const kBrick = 1028;  // bytes; web::ChangedBrick

let burr = null, compiled = null, marked = false;
let work = 0;

self.onmessage = ({data}) => {
  queue = queue.then(() => take(data)).catch((what) => tell({kind: 'broken', text: String(what?.message ?? what)}));
};
let queue = Promise.resolve();

function tell(message, transfer = []) {
  self.postMessage({...message, work}, transfer);
}
const json = (pointer) => JSON.parse(burr.text(pointer));
const why = () => burr.text(burr.score_why());
const texts = () => ({words: json(burr.score_words()), cases: json(burr.score_cases()), steps: json(burr.score_steps()), questions: json(burr.score_questions())});
const changed = (events) => ({events: json(events), steps: json(burr.score_steps())});

async function load() {
  compiled ??= await compile('burr_score.wasm');
  burr ??= await start(compiled, make, await load_codecs('zstd'));
}

async function take(data) {
  if (data.kind === 'case' || data.kind === 'redo') {
    await load();
    burr.with_texts([data.language], burr.score_speak);
    return data.kind === 'case' ? give_case(data) : give_redo(data);
  }
  if (data.kind === 'open') {
    work = data.work;
    await load();
    marked = false;
    burr.with_texts([data.language], burr.score_speak);
    if (!burr.with_texts([data.name, data.mode], (name, mode) => burr.score_open(name, mode, data.voxel))) throw new Error(why());
    let events = json(burr.score_begin());
    if (data.came_back) {  // its recording has them already
      events = [];
      steps_of(data.came_back);
    }
    tell({kind: 'opened', compiled, events, ...texts()});
  } else if (data.work !== work) {
    return;  // about a bone that is gone
  } else if (data.kind === 'look') {
    burr.with_bytes([data.bytes], (bytes) => burr.score_take(bytes, data.bytes.length / kBrick));
    const ticked = data.measure && burr.score_look() === 1 ? json(burr.score_steps()).now.title : '';
    tell({kind: 'looked', ticked, ...(ticked ? changed(burr.score_done(1)) : {})});
  } else if (data.kind === 'done') {
    tell({kind: 'steps', ...changed(burr.score_done(0))});
  } else if (data.kind === 'choose') {
    tell({kind: 'steps', ...changed(burr.score_choose(data.row))});
  } else if (data.kind === 'light') {
    tell({kind: 'lit', light: json(burr.score_light())});
  } else if (data.kind === 'language') {
    burr.with_texts([data.language], burr.score_speak);
    tell({kind: 'dressed', ...texts(), marks: marked ? json(burr.score_marks()) : null});
  } else if (data.kind === 'mark') {
    const begun = performance.now();
    burr.module.FS.writeFile('/burr.mcap', data.file, {canOwn: true});
    marked = burr.score_mark() === 1;
    if (!marked) return tell({kind: 'marked', why: why()});
    tell({kind: 'marked', marks: json(burr.score_marks()), ms: performance.now() - begun, memory: burr.module.HEAPU8.length});
  } else if (data.kind === 'page') {
    const caption = new TextEncoder().encode(`${data.caption}\0`);
    const html = burr.with_bytes([data.png, caption], (png, text) => {
      const page = burr.score_page(png, data.png.length, data.width, data.height, text);
      return page === 0 ? null : burr.text(page);
    });
    tell(html === null ? {kind: 'page', why: why()} : {kind: 'page', html});
  }
}

// ---- a case that is not the page's, and a session that comes back

function give_case({name, voxel}) {
  const about = burr.with_texts([name], (text) => burr.score_case(text, voxel));
  if (about === 0) return tell({kind: 'asked', why: why()});
  const bone = burr.bytes(burr.score_bone(), burr.score_bone_size()).slice();
  tell({kind: 'asked', about: json(about), bone}, [bone.buffer]);
}

// The steps as they were: what had happened to them, once more.
function steps_of(course) {
  for (const {kind, what, value} of course) {
    const {rows} = json(burr.score_steps()), row = rows.findIndex((one) => one.id === what);
    if (row < 0 || !/^step/.test(kind)) continue;
    if (!rows[row].current) burr.score_choose(row);
    if (kind === 'step_done') burr.score_done(value === 'measured' ? 1 : 0);
  }
}

const kPart = 4000;                                             // ticks at a time
const kEnd = ['done', 'ended', 'reopened', 'self_mark'];        // what belongs to an end that is taken back
const kMount = '/kept';
let mounted = false;

function give_redo({file, with_bone}) {
  const {FS, WORKERFS} = burr.module;
  if (mounted) FS.unmount(kMount);
  else FS.mkdir(kMount);
  FS.mount(WORKERFS, {blobs: [{name: 'burr.mcap', data: file}]}, kMount);
  mounted = true;
  const refuse = () => tell({kind: 'asked', why: burr.text(burr.redo_why()).replaceAll(`${kMount}/burr.mcap: `, '')});
  if (!burr.with_texts([`${kMount}/burr.mcap`], burr.redo_open)) return refuse();
  const about = json(burr.redo_about());
  let bone = null;
  if (with_bone) {
    const at = burr.redo_bone();
    if (at === 0) return refuse();
    bone = burr.bytes(at, burr.redo_bone_size()).slice();
  }
  const {port1, port2} = new MessageChannel();
  send_ticks(port1, about);
  tell({kind: 'asked', about, bone, port: port2}, [port2, bone?.buffer].filter(Boolean));
}

// A part for each question; what was noted after a tick follows the part that ends with it.
function send_ticks(port, about) {
  const notes = about.course.filter(({kind}) => !kEnd.includes(kind));
  let at = 0;
  port.onmessage = () => {
    const until = notes.length > 0 ? Math.min(at + kPart, notes[0].tick + 1) : at + kPart;
    const count = until > at ? burr.redo_read(until - at) : 0;
    at += count;
    const mine = [];
    while (notes.length > 0 && notes[0].tick < at) mine.push(notes.shift());
    const copy = (pointer, size) => burr.bytes(pointer, size).slice();
    const ticks = copy(burr.redo_ticks(), count * burr.redo_tick_size());
    const commands = copy(burr.redo_commands(), burr.redo_command_count() * burr.redo_command_size());
    const last = at >= about.ticks || count < until - at;
    port.postMessage({count, ticks, commands, command_count: burr.redo_command_count(), notes: mine, last, share: at / Math.max(1, about.ticks)});
    if (last) burr.redo_close();
  };
}
