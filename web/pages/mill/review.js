// The pages at the end of a session: the user's own marks, and what burr found. Loaded when the first cut is possible.
import * as words from '../common/words.js';
import {button, make} from './ask.js';

const {word} = words;
const kSigns = {good: '✓ ', bad: '✗ ', open: '○ ', none: '– '};
const mark_of = ({word: text, tone}) => make('span', {class: tone}, kSigns[tone] + text);

// As the window asks (review/self_marks_page.cpp).
export function own(course) {
  const answers = [['met', 'report_verdict_met'], ['unmet', 'report_verdict_unmet'], ['unknown', 'report_self_unknown']];
  const items = course.questions.flatMap((part) => part.items);
  const count = make('span', {class: 'dim'}, course.text('self_count', course.marks.size, items.length));
  const rows = new Map();
  const press = () => {
    for (const [id, buttons] of rows)
      for (const [value, one] of buttons) one.setAttribute('aria-pressed', String(course.marks.get(id) === value));
    count.textContent = course.text('self_count', course.marks.size, items.length);
  };
  const row = (item) => {
    const buttons = answers.map(([value, key]) => [value, button(course.text(key), () => {
      if (course.marks.get(item.id) === value) course.marks.delete(item.id);
      else course.marks.set(item.id, value);
      press();
    }, {'data-item': item.id, 'data-value': value})]);
    rows.set(item.id, buttons);
    return make('div', {class: 'choice', role: 'group', 'aria-label': item.text}, ...buttons.map(([, one]) => one),
                make('span', {}, item.text), item.gate ? make('span', {class: 'warn'}, course.text('report_gate')) : '');
  };
  const parts = course.questions.map((part) => make('section', {}, make('h2', {}, part.title), make('div', {class: 'choice'},
      ...answers.slice(0, 2).map(([value, key]) => button(course.text(key), () => {
        for (const item of part.items) if (!course.marks.has(item.id)) course.marks.set(item.id, value);
        press();
      })), make('span', {class: 'dim'}, course.text('self_rest'))), ...part.items.map(row)));
  press();
  return [
    make('h1', {}, course.text('self_title')), make('p', {class: 'dim'}, course.text('self_why')),
    make('div', {class: 'body single', tabindex: '0'}, ...parts),
    make('nav', {}, button(course.text('self_finish'), () => course.own_finished(true), {id: 'self_finish', class: 'first'}),
         button(course.text('self_skip'), () => course.own_finished(false), {id: 'self_skip'}), count),
  ];
}

// As the window shows it (review/review_page.cpp).
export function result(course) {
  const reason = course.page === 'exam' ? course.text('review_exam') : course.trouble;
  const inside = course.page === 'waits' ? [make('p', {}, course.text('review_waits')), make('progress')]
               : reason ? [make('p', {}, reason)]
               : found_parts(course, course.found.report);
  const single = course.page !== 'found' || reason;
  return [
    make('h1', {}, course.text('review_title')),
    make('div', {class: single ? 'body single' : 'body', tabindex: '0'}, ...inside),
    make('nav', {},
         course.found ? button(word('save_report'), () => course.save_report(), {id: 'save_report', class: 'first', title: word('save_report_tip')}) : '',
         button(word('save'), () => course.save(), {id: 'save_done', disabled: course.file === null}),
         button(course.text('review_again'), () => document.getElementById('mode').dispatchEvent(new Event('change')), {id: 'again'})),
  ];
}

function found_parts(course, report) {
  const gates = report.gates.length === 0 ? [] : [
    make('h2', {}, course.text('report_safety')), make('p', {}, report.held),
    ...report.gates.filter((gate) => gate.mark.tone !== 'good').map((gate) => make('p', {}, gate.text, ' ', mark_of(gate.mark), gate.when && `, ${gate.when}`)),
  ];
  const totals = report.parts.flatMap((part) => [
    make('p', {class: 'dim'}, part.title), make('p', {}, make('b', {}, part.met)), make('p', {class: 'warn'}, part.note)]);
  const next = report.next.length === 0 ? [make('p', {}, report.nothing_next)]
             : [make('ol', {}, ...report.next.map((one) => make('li', {}, one.say, make('div', {class: 'dim'}, one.why))))];
  const left = make('div', {}, make('p', {class: 'warn'}, report.unfinished), ...gates, make('h2', {}, course.text('report_totals')), ...totals,
                    make('h2', {}, course.text('report_self')), make('p', {}, report.self), make('h2', {}, course.text('report_next')), ...next);
  const head = make('tr', {}, report.has_self ? make('th', {}, report.you) : '', make('th', {}, report.machine), make('th', {}, course.text('report_item')));
  const rows = report.parts.flatMap((part) => [
    make('tr', {}, make('th', {colspan: '3'}, part.title)),
    ...part.items.map((item) => make('tr', {'data-item': item.id},
        report.has_self ? make('td', {class: 'mark'}, mark_of(item.self)) : '', make('td', {class: 'mark'}, mark_of(item.machine)),
        make('td', {}, item.text, item.gate ? ` (${course.text('report_gate')})` : '',
             make('div', {class: 'dim'}, item.figures, item.default && ` (${item.default})`),
             ...item.remarks.map((one) => make('div', {class: 'dim'}, one)),
             item.place && button(word('show_place'), () => course.look_at(item), {class: 'show_place'}), moment_of(course, item)))),
  ]);
  return [left, make('table', {}, head, ...rows)];
}

// The moment of an item, in the page that shows recordings: time and view both go there.
function moment_of(course, {at_s, place}) {
  const id = course.host.kept();
  if (at_s === null || !id) return null;
  const to = new URLSearchParams({kept: id, at: at_s.toFixed(2), language: words.present(), ...(place && {place: place.map((one) => one.toFixed(5)).join(',')})});
  return make('a', {href: `../replay/?${to}`, target: '_blank', rel: 'noopener', class: 'watch_moment'}, word('watch_moment', words.number(at_s, 1)));
}
