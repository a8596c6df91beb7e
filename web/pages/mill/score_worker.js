// The second worker of the page: the steps of the case, and at the end its score and the report (burr_score). It loads after
// the first cut is possible. What it measures takes seconds, and no tick waits for that.
//
//     page -> worker   open {voxel, mode, language, work}, look {bytes}, done, choose {row}, language {language},
//                      light, mark {file}, page {png, width, height, caption}
//     worker -> page   opened {compiled, words, steps, events, questions}, looked {ticked, steps, events}, steps {steps, events}, lit {light},
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
const texts = () => ({words: json(burr.score_words()), steps: json(burr.score_steps()), questions: json(burr.score_questions())});
const changed = (events) => ({events: json(events), steps: json(burr.score_steps())});

async function take(data) {
  if (data.kind === 'open') {
    work = data.work;
    compiled ??= await compile('burr_score.wasm');
    burr ??= await start(compiled, make, await load_codecs('zstd'));
    marked = false;
    burr.with_texts([data.language], burr.score_speak);
    if (!burr.with_texts([data.mode], (mode) => burr.score_open(mode, data.voxel))) throw new Error(why());
    tell({kind: 'opened', compiled, events: json(burr.score_begin()), ...texts()});
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
